//! Table 1 of Esmail 2018 (`validation/esmail-2018-table-1/table.toml`), cell by cell against
//! `regimes::family` and, at rational points, against the exact formulas of the regimes and the
//! solver; the gap between its columns; and the page that shows them side by side.

use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

use serde::Deserialize;
use willis::analysis::{Analysis, Selection, SolutionReport, Verdict, analyze};
use willis::exact::Rational;
use willis::regimes::{
    ClosedFormula, Family, FamilyRange, FormulaRequest, Group, RegimeSelection, Row, family, formulas,
};
use willis::train::{
    EfficiencySpec, GearSpec, MeshSpec, OperationSpec, ShiftElementSpec, Specification, StateSpec, Train,
};
use willis::units::{AngularSpeed, Torque};

use crate::common::Dice;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../validation/esmail-2018-table-1")
}

// ------------------------------------------------------------------ the paper's table

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    source: String,
    checked: String,
    model: String,
    columns: [String; 2],
    formula: Vec<Formula>,
    cell: Vec<Cell>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Formula {
    loss: String,
    status: Status,
    note: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Cell {
    inputs: Vec<String>,
    outputs: Vec<String>,
    /// From 1.
    column: usize,
    /// From 1.
    formula: usize,
    combination: [Combination; 2],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Combination {
    torques: String,
    speeds: String,
    status: Status,
    note: Option<String>,
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
enum Status {
    #[serde(rename = "as printed")]
    Printed,
    #[serde(rename = "supplied")]
    Supplied,
}

fn table() -> Table {
    toml::from_str(&fs::read_to_string(folder().join("table.toml")).unwrap()).unwrap_or_else(|e| panic!("{e}"))
}

/// Links in the order of [`Signs`] and [`Point`].
const LINKS: [&str; 3] = ["1", "2", "4"];
type Signs = [i8; 3];

fn link(name: &str) -> usize {
    LINKS.iter().position(|l| *l == name).unwrap_or_else(|| panic!("no link {name}"))
}

impl Combination {
    /// Signs of `T1, T2 > 0 and T4 < 0`.
    fn signs(&self) -> Signs {
        let mut signs = [0; 3];
        let mut waiting = Vec::new();
        for part in self.torques.split(" and ").flat_map(|p| p.split(", ")) {
            let (name, sign) = match part.split_once(' ') {
                None => (part, 0),
                Some((name, "> 0")) => (name, 1),
                Some((name, "< 0")) => (name, -1),
                _ => panic!("{}", self.torques),
            };
            waiting.push(link(name.strip_prefix('T').unwrap()));
            if sign != 0 {
                waiting.drain(..).for_each(|l| signs[l] = sign);
            }
        }
        assert!(signs.iter().all(|s| *s != 0), "{}", self.torques);
        signs
    }

    /// `2`, `4`, `1`, `0` of `w2 > w4 > w1 > 0`.
    fn order(&self) -> Vec<String> {
        self.speeds.split(" > ").map(|s| s.trim_start_matches('w').to_owned()).collect()
    }
}

impl Cell {
    /// The paper's assignment: the sign of each link's power.
    fn powers(&self) -> Signs {
        let mut powers = [0; 3];
        self.inputs.iter().for_each(|l| powers[link(l)] = 1);
        self.outputs.iter().for_each(|l| powers[link(l)] = -1);
        powers
    }
}

/// The end that drives, seen from the carrier: link 1 where `T1 (w1 − w2) > 0`.
fn driver(torques: Signs, order: &[String]) -> &'static str {
    let above = |a: &str, b: &str| order.iter().position(|o| o == a) < order.iter().position(|o| o == b);
    if (torques[0] > 0) == above("1", "2") { "1" } else { "4" }
}

/// The sign of each link's power by Eq. (20).
fn powers(torques: Signs, order: &[String]) -> Signs {
    let at = |n: &str| order.iter().position(|o| o == n).unwrap();
    [0, 1, 2].map(|l| if at(LINKS[l]) < at("0") { torques[l] } else { -torques[l] })
}

/// The eight orders of a column, steps 3 and 4 of the paper.
fn orders(column: usize) -> Vec<Vec<String>> {
    let chains = if column == 1 { ["142", "241"] } else { ["412", "214"] };
    let mut all = Vec::new();
    for chain in chains {
        for zero in 0..=3 {
            let mut order: Vec<String> = chain.chars().map(String::from).collect();
            order.insert(zero, "0".into());
            all.push(order);
        }
    }
    all
}

// ------------------------------------------------------------------ formulas

/// Speeds of links 1, 2, 4.
type Point = [Rational; 3];

/// Reads `[1 + (eta1*eta2 - 1)*R^4_{2,f}]^-1 - 1`.
struct Reader<'a> {
    rest: &'a str,
    speeds: &'a Point,
    meshes: &'a [Rational; 2],
}

fn evaluate(formula: &str, speeds: &Point, meshes: &[Rational; 2]) -> Rational {
    let mut reader = Reader { rest: formula.trim(), speeds, meshes };
    let value = reader.sum();
    assert!(reader.rest.is_empty(), "{formula}: `{}` is left over", reader.rest);
    value
}

impl Reader<'_> {
    fn take(&mut self, text: &str) -> bool {
        match self.rest.strip_prefix(text) {
            Some(rest) => {
                self.rest = rest.trim_start();
                true
            }
            None => false,
        }
    }

    fn sum(&mut self) -> Rational {
        let mut value = self.product();
        loop {
            if self.take("+") {
                value += self.product();
            } else if self.take("-") {
                value -= self.product();
            } else {
                return value;
            }
        }
    }

    fn product(&mut self) -> Rational {
        let mut value = self.factor();
        loop {
            if self.take("*") {
                value = value * self.factor();
            } else if self.take("/") {
                value = value / self.factor();
            } else {
                return value;
            }
        }
    }

    fn factor(&mut self) -> Rational {
        if self.take("-") {
            return -self.factor();
        }
        let value = if self.take("(") {
            self.bracket(")")
        } else if self.take("[") {
            self.bracket("]")
        } else if self.take("eta1") {
            self.meshes[0].clone()
        } else if self.take("eta2") {
            self.meshes[1].clone()
        } else if self.take("R^") {
            self.ratio()
        } else {
            assert!(self.take("1"), "`{}` is not understood", self.rest);
            Rational::ONE
        };
        if self.take("^-1") { value.recip() } else { value }
    }

    fn bracket(&mut self, close: &str) -> Rational {
        let value = self.sum();
        assert!(self.take(close), "`{close}` is missing before `{}`", self.rest);
        value
    }

    /// The rest of `R^v_{w,u}`: `(w_w − w_v)/(w_u − w_v)`, Eq. (5); f is at rest.
    fn ratio(&mut self) -> Rational {
        let (indices, rest) = self.rest.split_once('}').expect("`}`");
        self.rest = rest.trim_start();
        let (v, wu) = indices.split_once("_{").expect("`_{`");
        let (w, u) = wu.split_once(',').expect("`,`");
        let speed = |l: &str| if l == "f" { Rational::ZERO } else { self.speeds[link(l)].clone() };
        (speed(w) - speed(v)) / (speed(u) - speed(v))
    }
}

// ------------------------------------------------------------------ the solver

fn fraction(r: (i64, i64)) -> Rational {
    Rational::new(r.0, r.1)
}

/// The train of Fig. 1 with `R = Z1/Z4` and two meshes of their own efficiency on one planet.
fn figure(r: (i64, i64), meshes: &[Rational; 2]) -> Specification {
    let mesh = |link: &str, teeth: i64, eta: &Rational| {
        MeshSpec::new(GearSpec::external(link, teeth), GearSpec::external("p", 20))
            .carrier("2")
            .efficiency(EfficiencySpec::from(eta.clone()))
    };
    Train::builder("fig. 1")
        .members(["1", "2", "4", "p"])
        .terminals(LINKS)
        .mesh(mesh("1", r.0, &meshes[0]))
        .mesh(mesh("4", r.1, &meshes[1]))
}

fn solve(builder: Specification) -> Analysis {
    analyze(&builder.build().unwrap(), &Selection::default()).unwrap()
}

/// The answer at an operating point.
struct Truth {
    torques: Signs,
    powers: Signs,
    /// By the closed formula of the one regime that contains the point; the numeric solver agrees.
    efficiency: Rational,
    report: SolutionReport,
}

/// Points of one train: speeds of links 1, 2, 4 and the torque on link 1.
fn truths(r: (i64, i64), meshes: &[Rational; 2], points: &[(Point, i8)]) -> Vec<Truth> {
    let mut builder = figure(r, meshes);
    for (k, (w, t1)) in points.iter().enumerate() {
        builder = builder.operation(
            OperationSpec::new(k.to_string())
                .speed("1", AngularSpeed::rad_s(w[0].to_f64()))
                .speed("2", AngularSpeed::rad_s(w[1].to_f64()))
                .torque("1", Torque::n_m(f64::from(*t1))),
        );
    }
    let train = builder.build().unwrap();
    let analysis = analyze(&train, &Selection::default()).unwrap();
    let sheet = formulas(&train, &FormulaRequest::default()).unwrap();
    assert_eq!(analysis.operations.len(), points.len());
    let all = analysis.operations.iter().zip(points).map(|(o, (w, t1))| {
        assert_eq!(o.verdict, Verdict::Unique);
        assert_eq!(*o.speeds_rad_s.get("4").unwrap(), Some(w[2].to_f64()));
        let report = o.solutions[0].clone();
        let sign = |x: Option<f64>| x.unwrap().partial_cmp(&0.0).unwrap() as i8;
        let member = |l: usize| report.members.get(LINKS[l]).unwrap();
        // A formula refuses points outside its regimes.
        let exact = |f: &ClosedFormula| {
            let given = |name: &str| match name {
                "w_1" => Some(w[0].clone()),
                "w_2" => Some(w[1].clone()),
                "w_4" => Some(w[2].clone()),
                "T_1" => Some(Rational::from(i64::from(*t1))),
                _ => {
                    let a = f.arguments.iter().find(|a| a.name == name && a.fixed)?;
                    Some(a.exact.clone())
                }
            };
            f.evaluate(&given).ok()
        };
        let mut found: Vec<Rational> = sheet.formulas.iter().filter_map(exact).collect();
        assert_eq!(found.len(), 1, "R = {r:?}, {w:?}: {} regimes", found.len());
        let efficiency = found.remove(0);
        assert!((report.efficiency.unwrap() - efficiency.to_f64()).abs() < 1e-12, "R = {r:?}, {w:?}");
        if let Some(exact) = &report.efficiency_exact {
            assert_eq!(*exact, efficiency, "R = {r:?}, {w:?}");
        }
        Truth {
            torques: [0, 1, 2].map(|l| sign(member(l).torque_n_m)),
            powers: [0, 1, 2].map(|l| sign(member(l).power_w)),
            efficiency,
            report,
        }
    });
    all.collect()
}

/// Speeds in a given order, for `R = p/q`. `place` says where zero lies between its neighbours, or how far
/// beyond the last speed: of 1000.
fn point(order: &[String], (p, q): (i64, i64), place: i64) -> Point {
    let at = |n: &str| order.iter().position(|o| o == n).unwrap();
    let d = if at("1") < at("2") { 1000 } else { -1000 };
    let relative = [q * d, 0, p * d];
    let of = |name: &String| relative[link(name)];
    let zero = match at("0") {
        0 => of(&order[1]) + q * place,
        3 => of(&order[2]) - q * place,
        k => of(&order[k + 1]) + (of(&order[k - 1]) - of(&order[k + 1])) * place / 1000,
    };
    let speeds = relative.map(|w| Rational::from(w - zero));
    let mut sorted: Vec<(Rational, &str)> = speeds.iter().cloned().zip(LINKS).collect();
    sorted.push((Rational::ZERO, "0"));
    sorted.sort_by(|a, b| b.0.cmp(&a.0));
    assert!(sorted.windows(2).all(|w| w[0].0 != w[1].0) && sorted.iter().map(|s| s.1).eq(order), "{order:?} {p}/{q}");
    speeds
}

/// Pairs of mesh efficiencies; `eta1*eta2` is 0.9409 and 0.931.
fn efficiencies() -> [[Rational; 2]; 2] {
    [[fraction((97, 100)), fraction((97, 100))], [fraction((49, 50)), fraction((19, 20))]]
}

/// R of the paper's columns, outside the band for both pairs.
const OUTSIDE: [[(i64, i64); 5]; 2] =
    [[(20, 100), (20, 60), (25, 50), (36, 40), (92, 100)], [(108, 100), (44, 40), (50, 25), (60, 20), (200, 20)]];

/// And inside for both.
const INSIDE: [[(i64, i64); 3]; 2] = [[(20, 21), (50, 51), (999, 1000)], [(1000, 999), (51, 50), (21, 20)]];

const POINTS: usize = 3;

// ------------------------------------------------------------------ the comparison

/// `regimes::family` for the model of the table.
fn ours(table: &Table) -> Family {
    let train = Train::from_toml(&fs::read_to_string(folder().join(&table.model)).unwrap()).unwrap();
    family(&train, &RegimeSelection::default()).unwrap()
}

/// The range of R that stands for a column of the paper (from 1), and the band beside it.
fn case(f: &Family, column: usize, band: bool) -> usize {
    let label = match (column, band) {
        (1, false) => "0 < R < eta",
        (1, true) => "eta < R < 1",
        (2, true) => "1 < R < 1/eta",
        (2, false) => "R > 1/eta",
        _ => panic!("no column {column}"),
    };
    let k = f.cases.iter().position(|c| c.label == label).unwrap_or_else(|| panic!("no range {label}"));
    assert_eq!(f.cases[k].band, band);
    k
}

fn row_powers(row: &Row) -> Signs {
    let mut powers = [0; 3];
    row.inputs.iter().for_each(|l| powers[link(l)] = 1);
    row.outputs.iter().for_each(|l| powers[link(l)] = -1);
    powers
}

fn signs(range: &FamilyRange) -> Signs {
    LINKS.map(|l| *range.torque_signs.get(l).unwrap())
}

/// A cell of the paper beside what Willis has.
struct Compared<'t> {
    cell: &'t Cell,
    formula: &'t Formula,
    /// With the driver of the cell, in the row and column of the cell.
    group: Option<Group>,
    /// Points at which the printed formula was compared with the solver.
    points: usize,
    /// What does not agree.
    wrong: Vec<String>,
    /// Whether the assignment fails in the band, which the paper's column includes.
    wider: bool,
}

impl Compared<'_> {
    /// The regime of ours that has the torques and speeds of a combination.
    fn range(&self, c: &Combination) -> Option<&FamilyRange> {
        self.group.as_ref()?.ranges.iter().find(|r| signs(r) == c.signs() && r.order == c.order())
    }
}

fn compare<'t>(table: &'t Table, f: &Family) -> Vec<Compared<'t>> {
    let mut all: Vec<Compared> = Vec::new();
    for cell in &table.cell {
        let drives = driver(cell.combination[0].signs(), &cell.combination[0].order());
        let row = f.rows.iter().find(|r| r.inputs == cell.inputs && r.outputs == cell.outputs);
        let groups = row.map(|r| &r.cells[case(f, cell.column, false)]);
        let group = groups.and_then(|g| g.iter().find(|g| g.driver == drives)).cloned();
        let formula = &table.formula[cell.formula - 1];
        all.push(Compared { cell, formula, group, points: 0, wrong: vec![], wider: false });
    }
    for x in &mut all {
        let missing: Vec<_> = x.cell.combination.iter().filter(|c| x.range(c).is_none()).map(|c| &c.speeds).collect();
        x.wrong.extend(missing.into_iter().map(|s| format!("no regime with {s}")));
    }
    let mut places = Dice(2018);
    for meshes in &efficiencies() {
        for (column, inside) in [(1, false), (2, false), (1, true), (2, true)] {
            let ratios = if inside { &INSIDE[column - 1][..] } else { &OUTSIDE[column - 1][..] };
            for r in ratios {
                let mut points = Vec::new();
                for x in all.iter().filter(|x| x.cell.column == column) {
                    for c in &x.cell.combination {
                        points.extend((0..POINTS).map(|_| (point(&c.order(), *r, places.whole(1, 998)), c.signs()[0])));
                    }
                }
                let found = truths(*r, meshes, &points);
                let mut found = points.iter().zip(found);
                for x in all.iter_mut().filter(|x| x.cell.column == column) {
                    for c in &x.cell.combination {
                        for ((w, _), truth) in found.by_ref().take(POINTS) {
                            let holds = truth.torques == c.signs() && truth.powers == x.cell.powers();
                            if inside {
                                x.wider |= !holds;
                                if !holds {
                                    continue;
                                }
                            } else if !holds {
                                x.wrong.push(format!("R = {r:?}, {}: torques and powers", c.speeds));
                            }
                            let printed = evaluate(&x.formula.loss, w, meshes);
                            let own = x.group.as_ref().map(|g| evaluate(&g.loss, w, meshes));
                            let exact = &truth.efficiency - &Rational::ONE;
                            if printed != exact || own.as_ref() != Some(&exact) {
                                x.wrong.push(format!("R = {r:?}, {w:?}: {printed}, {own:?}, solver {exact}"));
                            }
                            x.points += 1;
                        }
                    }
                }
            }
        }
    }
    all
}

#[test]
fn the_transcription_is_whole() {
    let t = table();
    assert_eq!((t.cell.len(), t.formula.len()), (16, 12));
    let supplied = |s: Status| s == Status::Supplied;
    assert!(!t.formula.iter().any(|f| supplied(f.status)));
    let combinations = || t.cell.iter().flat_map(|cell| cell.combination.iter().map(move |c| (cell, c)));
    assert_eq!(combinations().filter(|(_, c)| supplied(c.status)).count(), 2);
    for column in [1, 2] {
        // Two triples of torque signs, Eqs. (18) and (19), and eight orders each; none twice.
        let mut all: Vec<_> =
            combinations().filter(|(x, _)| x.column == column).map(|(_, c)| (c.signs(), c.order())).collect();
        all.sort();
        let t2 = if column == 1 { 1 } else { -1 };
        let mut expected: Vec<_> = [[1, t2, -1], [-1, -t2, 1]]
            .into_iter()
            .flat_map(|s| orders(column).into_iter().map(move |o| (s, o)))
            .collect();
        expected.sort();
        assert_eq!(all, expected);
    }
    for (cell, c) in combinations() {
        assert_eq!(powers(c.signs(), &c.order()), cell.powers(), "Eq. (20): {}", c.speeds);
        assert_eq!(
            driver(c.signs(), &c.order()),
            driver(cell.combination[0].signs(), &cell.combination[0].order()),
            "one formula, one driver: {}",
            c.speeds
        );
        if supplied(c.status) {
            let possible: Vec<_> =
                orders(cell.column).into_iter().filter(|o| powers(c.signs(), o) == cell.powers()).collect();
            assert_eq!(possible, [c.order()], "not the only order");
        }
    }
}

/// Every cell of the paper is one of ours with the same combinations, and we have no other outside the band.
#[test]
fn val_esmail_2018_table_1_cell_by_cell() {
    let t = table();
    let f = ours(&t);
    // Eq. (15), from the teeth of the model by Eq. (4).
    assert_eq!(f.exact, fraction((-36, 24)) / fraction((-20, 40)));
    let mut regimes = 0;
    for column in [1, 2] {
        for row in &f.rows {
            for group in &row.cells[case(&f, column, false)] {
                let cells: Vec<&Cell> = t
                    .cell
                    .iter()
                    .filter(|c| c.column == column && c.powers() == row_powers(row))
                    .filter(|c| driver(c.combination[0].signs(), &c.combination[0].order()) == group.driver)
                    .collect();
                let at = format!("column {column}, {:?} -> {:?}, {} drives", row.inputs, row.outputs, group.driver);
                assert_eq!(cells.len(), 1, "{at}");
                let mut printed: Vec<_> = cells[0].combination.iter().map(|c| (c.signs(), c.order())).collect();
                let mut found: Vec<_> = group.ranges.iter().map(|r| (signs(r), r.order.clone())).collect();
                printed.sort();
                found.sort();
                assert_eq!(printed, found, "{at}");
                regimes += found.len();
            }
        }
    }
    assert_eq!(regimes, 32);
    // The paper's order of rows.
    let printed: Vec<_> = t.cell.iter().map(|c| (&c.inputs, &c.outputs)).collect();
    let mut found: Vec<_> = f.rows.iter().map(|r| (&r.inputs, &r.outputs)).filter(|r| printed.contains(r)).collect();
    found.dedup();
    let mut rows = printed;
    rows.dedup();
    assert_eq!(rows, found);
}

/// The printed formulas, in exact rationals, are the solver's efficiency wherever the assignment is right.
#[test]
fn val_esmail_2018_table_1_formulas_at_points() {
    let t = table();
    let all = compare(&t, &ours(&t));
    let wrong: Vec<_> = all.iter().flat_map(|x| &x.wrong).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let outside = 2 * 2 * OUTSIDE[0].len() * POINTS;
    let inside = 2 * 2 * INSIDE[0].len() * POINTS;
    for x in &all {
        // Where the assignment fails in the band, it fails at every point there.
        assert_eq!(x.points, if x.wider { outside } else { outside + inside });
        let drives = driver(x.cell.combination[0].signs(), &x.cell.combination[0].order());
        assert_eq!(x.wider, drives == if x.cell.column == 1 { "1" } else { "4" });
    }
    assert_eq!(all.iter().filter(|x| x.wider).count(), 8);
}

/// A combination of the paper at a point in the band.
struct InBand<'t> {
    cell: &'t Cell,
    combination: &'t Combination,
    speeds: Point,
    /// By the printed formula.
    printed: Rational,
    truth: Truth,
}

fn in_band<'t>(t: &'t Table, column: usize, r: (i64, i64), meshes: &[Rational; 2], place: i64) -> Vec<InBand<'t>> {
    let chosen: Vec<_> = t
        .cell
        .iter()
        .filter(|c| c.column == column)
        .flat_map(|cell| cell.combination.iter().map(move |c| (cell, c)))
        .collect();
    let points: Vec<_> = chosen.iter().map(|(_, c)| (point(&c.order(), r, place), c.signs()[0])).collect();
    let found = truths(r, meshes, &points);
    chosen
        .into_iter()
        .zip(points)
        .zip(found)
        .map(|(((cell, combination), (speeds, _)), truth)| {
            let loss = evaluate(&t.formula[cell.formula - 1].loss, &speeds, meshes);
            InBand { cell, combination, speeds, printed: loss + Rational::ONE, truth }
        })
        .collect()
}

/// Between eta and 1/eta the torque on the carrier is turned round whenever link 1 drives (R < 1) or
/// link 4 does (R > 1): on each side 8 of the 16 combinations are in the wrong row, two of them have no output.
#[test]
fn val_esmail_2018_table_1_fails_in_the_band() {
    let t = table();
    let f = ours(&t);
    for meshes in &efficiencies() {
        for column in [1, 2] {
            let range = case(&f, column, true);
            for r in INSIDE[column - 1] {
                let all = in_band(&t, column, r, meshes, 371);
                assert_eq!(all.len(), 16);
                let (mut changed, mut no_output) = (0, 0);
                for x in &all {
                    let at = format!("R = {r:?}, {}", x.combination.speeds);
                    // Ours, by its own column for the band.
                    let same = |r: &FamilyRange| r.order == x.combination.order() && signs(r)[0] == x.truth.torques[0];
                    let regimes: Vec<(&Row, &Group, &FamilyRange)> = f
                        .rows
                        .iter()
                        .flat_map(|row| row.cells[range].iter().map(move |g| (row, g)))
                        .flat_map(|(row, g)| g.ranges.iter().map(move |r| (row, g, r)))
                        .filter(|(.., r)| same(r))
                        .collect();
                    assert_eq!(regimes.len(), 1, "{at}");
                    let (row, group, regime) = regimes[0];
                    assert_eq!(row_powers(row), x.truth.powers, "{at}");
                    assert_eq!(signs(regime), x.truth.torques, "{at}");
                    let loss = evaluate(&group.loss, &x.speeds, meshes);
                    assert_eq!(loss + Rational::ONE, x.truth.efficiency, "{at}");
                    // The paper's.
                    let turned = x.truth.torques[1] != x.combination.signs()[1];
                    let by = driver(x.combination.signs(), &x.combination.order());
                    assert_eq!(turned, by == if column == 1 { "1" } else { "4" }, "{at}");
                    assert_eq!(turned, x.truth.powers != x.cell.powers(), "{at}");
                    assert_eq!(turned, x.printed != x.truth.efficiency, "{at}");
                    changed += usize::from(turned);
                    if x.truth.powers == [1, 1, 1] {
                        assert!(turned && x.truth.report.all_dissipated && x.truth.efficiency.is_zero(), "{at}");
                        no_output += 1;
                    }
                }
                assert_eq!((changed, no_output), (8, 2), "R = {r:?}");
            }
        }
    }
}

/// The example of the band, R = 1.02 and eta = 0.9409, torque on link 1 positive: a combination of the paper
/// at speeds (w1, w2, w4) in hundredths, the printed efficiency and the true answer.
fn example(t: &Table, cell: (&[&str], &[&str]), order: [&str; 4], speeds: [i64; 3]) -> (Rational, Truth) {
    let meshes = &efficiencies()[0];
    let found: Vec<_> = t
        .cell
        .iter()
        .filter(|c| c.column == 2 && c.inputs == cell.0 && c.outputs == cell.1)
        .filter(|c| c.combination.iter().any(|x| x.order() == order && x.signs()[0] == 1))
        .collect();
    assert_eq!(found.len(), 1);
    let w = speeds.map(|w| Rational::new(w, 100));
    let printed = evaluate(&t.formula[found[0].formula - 1].loss, &w, meshes) + Rational::ONE;
    let truth = truths((51, 50), meshes, &[(w, 1)]).remove(0);
    (printed, truth)
}

fn no_output(t: &Table) -> (Rational, Truth) {
    example(t, (&["1", "4"], &["2"]), ["2", "1", "0", "4"], [1, 101, -1])
}

fn other_row(t: &Table) -> (Rational, Truth) {
    example(t, (&["1"], &["2", "4"]), ["2", "1", "4", "0"], [300, 400, 298])
}

fn near(x: &Rational, printed: &str) {
    let decimals = printed.split_once('.').unwrap().1.len();
    assert_eq!(format!("{:.decimals$}", x.to_f64()), printed);
}

#[test]
fn val_esmail_2018_table_1_two_examples_in_the_band() {
    let t = table();
    let (printed, truth) = no_output(&t);
    near(&printed, "-2.08");
    assert_eq!((truth.powers, truth.efficiency.is_zero()), ([1, 1, 1], true));
    let (printed, truth) = other_row(&t);
    near(&printed, "0.97906");
    assert_eq!(truth.powers, [1, 1, -1]);
    near(&truth.efficiency, "0.98017");
}

/// Numbers that show the errata.
struct Errata {
    /// R = 3, eta = 0.95, link 1 drives: T2/T1; what Eq. (17) needs; the efficiency from 2 to 1, link 4 held.
    carrier: f64,
    eq_17: f64,
    backward: f64,
    /// R = 51/50, eta = 0.95, link 4 held: from 1 to 2, and the "efficiency" its torques give.
    locked: (Verdict, f64),
    /// Second worked case, R = 3, eta = 0.9409: T1 (w1 - w2), T4 (w4 - w2), and -P1/P4 relative to p and to 2.
    worked: [f64; 4],
    /// R = 1, eta = 0.95, link 1 drives: T2/T1.
    at_one: f64,
    /// A ring gear: T4/T1 and T2/T1 for R = -5/13, eta = 0.9702.
    ring: [f64; 2],
}

fn errata() -> Errata {
    let meshes = [fraction((19, 20)), Rational::ONE];
    let torque = |s: &SolutionReport, l: &str| s.members.get(l).unwrap().torque_n_m.unwrap();
    let held = |r| {
        let brake = ShiftElementSpec::brake("B4", "4");
        let state = StateSpec::new("4 held", ["B4"]).between("1", "2");
        solve(figure(r, &meshes).shift_element(brake).state(state)).ratios.0.remove(0).1
    };
    let integers = |w: [i64; 3]| w.map(Rational::from);

    let s = truths((60, 20), &meshes, &[(integers([2, 1, 4]), 1)]).remove(0).report;
    let carrier = torque(&s, "2") / torque(&s, "1");
    // R^4_{2,1} = R/(R - 1)
    let eq_17 = -carrier * 1.5;
    let backward = held((60, 20)).coast.efficiency.unwrap();

    // T2/T1 = 1/(eta R) - 1 with 4 driving, over w1/w2 = R/(R - 1) in the frame of link 4.
    let r: f64 = 1.02;
    let locked = (held((51, 50)).drive.verdict, -(1.0 / (0.95 * r) - 1.0) * r / (r - 1.0));

    let a = solve(
        figure((60, 20), &efficiencies()[0]).operation(
            OperationSpec::new("x")
                .speed("1", AngularSpeed::rad_s(-2.0))
                .speed("2", AngularSpeed::rad_s(-1.0))
                .torque("1", Torque::n_m(1.0)),
        ),
    );
    let o = &a.operations[0];
    let [t1, t4] = ["1", "4"].map(|l| torque(&o.solutions[0], l));
    let w = |l: &str| o.speeds_rad_s.get(l).unwrap().unwrap();
    let relative = |to: &str| -t1 * (w("1") - w(to)) / (t4 * (w("4") - w(to)));
    let worked = [t1 * (w("1") - w("2")), t4 * (w("4") - w("2")), relative("p"), relative("2")];

    let o = OperationSpec::new("x").speed("1", AngularSpeed::rad_s(2.0)).speed("2", AngularSpeed::rad_s(1.0));
    let a = solve(figure((20, 20), &meshes).operation(o.torque("1", Torque::n_m(1.0))));
    let at_one = torque(&a.operations[0].solutions[0], "2");

    let ring = MeshSpec::new(GearSpec::internal("4", 78), GearSpec::external("p", 24)).carrier("2").efficiency(0.99);
    let sun = MeshSpec::new(GearSpec::external("1", 30), GearSpec::external("p", 24)).carrier("2").efficiency(0.98);
    let builder = Train::builder("ring").members(["1", "2", "4", "p"]).terminals(LINKS).mesh(sun).mesh(ring);
    let o = OperationSpec::new("x").speed("1", AngularSpeed::rad_s(1.0)).speed("2", AngularSpeed::rad_s(0.0));
    let a = solve(builder.operation(o.torque("1", Torque::n_m(1.0))));
    let s = &a.operations[0].solutions[0];
    let ring = ["4", "2"].map(|l| torque(s, l) / torque(s, "1"));
    Errata { carrier, eq_17, backward, locked, worked, at_one, ring }
}

#[test]
fn val_esmail_2018_errata() {
    let e = errata();
    let close = |x: f64, y: f64| assert!((x - y).abs() < 1e-12, "{x} {y}");
    close(e.carrier, 0.95 / 3.0 - 1.0);
    close(e.eq_17, 1.025);
    close(e.backward, 2.0 / 2.05);
    assert_eq!(e.locked.0, Verdict::Locked);
    close(e.locked.1, (0.95 * 1.02 - 1.0) / (0.95 * 0.02));
    // w = (-2, -1, -4), the planet at +2: T4 = -1/(3 eta).
    close(e.worked[0], -1.0);
    close(e.worked[1], 1.0 / 0.9409);
    close(e.worked[2], 2.0 * 0.9409);
    close(e.worked[3], 0.9409);
    close(e.at_one, -0.05);
    // T4/T1 = eta/(5/13)
    close(e.ring[0], 0.9702 * 2.6);
    close(e.ring[1], -0.9702 * 2.6 - 1.0);
}

// ------------------------------------------------------------------ the page

fn speeds(order: &[String]) -> String {
    order.iter().map(|n| if n == "0" { n.clone() } else { format!("ω{n}") }).collect::<Vec<_>>().join(" > ")
}

fn torques(signs: Signs) -> String {
    let one = |l: usize| format!("T{} {} 0", LINKS[l], if signs[l] > 0 { '>' } else { '<' });
    [0, 1, 2].map(one).join(", ")
}

fn roles(inputs: &[String], outputs: &[String]) -> String {
    if outputs.is_empty() {
        return format!("{} → heat", inputs.join(","));
    }
    format!("{} → {}", inputs.join(","), outputs.join(","))
}

fn roles_of(powers: Signs) -> String {
    let of = |sign| (0..3).filter(|l| powers[*l] == sign).map(|l| LINKS[l].to_owned()).collect::<Vec<_>>();
    roles(&of(1), &of(-1))
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

/// A regime and its mirror image.
fn group_lines(page: &mut String, row: &Row, group: &Group) {
    let ranges: Vec<String> =
        group.ranges.iter().map(|r| format!("{}: {}", torques(signs(r)), speeds(&r.order))).collect();
    let roles = roles(&row.inputs, &row.outputs);
    writeln!(page, "| {roles} | {} | {} | {} |", group.driver, ranges.join("<br>or "), code(&group.loss)).unwrap();
}

fn side_by_side(page: &mut String, t: &Table, all: &[Compared]) {
    let mut last: Option<&Cell> = None;
    for x in all {
        let cell = x.cell;
        if last.is_none_or(|l| l.powers() != cell.powers()) {
            writeln!(page, "\n### {}\n", roles(&cell.inputs, &cell.outputs)).unwrap();
            *page += "| column | | paper | Willis | |\n|---|---|---|---|---|\n";
        }
        last = Some(cell);
        for (k, c) in cell.combination.iter().enumerate() {
            let own =
                x.range(c).map_or("none".to_owned(), |r| format!("{}<br>{}", torques(signs(r)), speeds(&r.order)));
            let mut verdict = match (x.range(c), c.status) {
                (None, _) => "**differs**",
                (_, Status::Printed) => "agrees",
                (_, Status::Supplied) => "speeds supplied; torques agree",
            }
            .to_owned();
            if x.wider {
                verdict += "; wider";
            }
            let column = if k == 0 { t.columns[cell.column - 1].replace("N_p4/N_p1", "N4/N1") } else { String::new() };
            let or = if k == 0 { "" } else { "or" };
            let printed = format!("{}<br>{}", c.torques, speeds(&c.order()));
            writeln!(page, "| {column} | {or} | {printed} | {own} | {verdict} |").unwrap();
        }
        let own = x.group.as_ref().map_or("none".to_owned(), |g| code(&g.loss));
        let verdict = match (&x.wrong[..], x.formula.status) {
            ([], Status::Printed) => format!("agrees at {} points", x.points),
            ([], Status::Supplied) => "supplied".to_owned(),
            (wrong, _) => format!("**differs**: {}", wrong[0]),
        };
        writeln!(page, "| | l | {} | {own} | {verdict} |", code(&x.formula.loss)).unwrap();
    }
}

fn notes(page: &mut String, t: &Table) {
    *page += "\n## What the text at hand is like\n\n";
    writeln!(page, "Transcription: {}.\n", t.checked).unwrap();
    *page += "| where | note |\n|---|---|\n";
    for cell in &t.cell {
        for c in &cell.combination {
            if let Some(note) = &c.note {
                let at = format!("{}, {}", roles(&cell.inputs, &cell.outputs), speeds(&c.order()));
                let supplied = if c.status == Status::Supplied { "**supplied**: " } else { "" };
                writeln!(page, "| {at} | {supplied}{note} |").unwrap();
            }
        }
    }
    for f in &t.formula {
        if let Some(note) = &f.note {
            writeln!(page, "| {} | {note} |", code(&f.loss)).unwrap();
        }
    }
}

fn band(page: &mut String, t: &Table, f: &Family) {
    for (column, r, other) in [(1, (49, 50), "1"), (2, (51, 50), "4")] {
        let range = case(f, column, true);
        writeln!(page, "\n### {}\n", f.cases[range].label).unwrap();
        writeln!(
            page,
            "Not in the paper, whose column `{}` includes this range. T2 is turned round when link {other} drives.\n",
            t.columns[column - 1]
        )
        .unwrap();
        *page += "| inputs → outputs | drives | torques and speeds | l |\n|---|---|---|---|\n";
        for row in &f.rows {
            row.cells[range].iter().for_each(|g| group_lines(page, row, g));
        }
        let all = in_band(t, column, r, &efficiencies()[0], 500);
        writeln!(
            page,
            "\nThe paper's combinations with T1 > 0 at R = {}/{}, η1 η2 = 0.9409 (with T1 < 0 they are the mirror \
             images):\n",
            r.0, r.1
        )
        .unwrap();
        *page += "| speeds | (ω1, ω2, ω4) | paper: T2, row | its η | Willis: T2, row | η | |\n|---|---|---|---|---|---|---|\n";
        for x in all.iter().filter(|x| x.combination.signs()[0] > 0) {
            let turned = x.truth.powers != x.cell.powers();
            let sign = |s: i8| if s > 0 { "+" } else { "−" };
            // |ω1 − ω2| = 1
            let scaled = x.speeds.clone().map(|w| format!("{:.2}", w.to_f64() / (1000 * r.1) as f64));
            writeln!(
                page,
                "| {} | ({}) | {} {} | {:.5} | {} {} | {:.5} | {} |",
                speeds(&x.combination.order()),
                scaled.join(", "),
                sign(x.combination.signs()[1]),
                roles(&x.cell.inputs, &x.cell.outputs),
                x.printed.to_f64(),
                sign(x.truth.torques[1]),
                roles_of(x.truth.powers),
                x.truth.efficiency.to_f64(),
                if turned { "**another row**" } else { "agrees" }
            )
            .unwrap();
        }
    }
}

fn errata_lines(page: &mut String, t: &Table) {
    let e = errata();
    let (printed, heat) = no_output(t);
    let (second, row) = other_row(t);
    *page += "\n## Errata\n\nNo formula and no assignment of the table is wrong where R is below η or above 1/η \
              (η = η1 η2). Beside that:\n\n| the paper | what holds | numbers |\n|---|---|---|\n";
    let mut line = |paper: &str, holds: &str, numbers: String| {
        writeln!(page, "| {paper} | {holds} | {numbers} |").unwrap();
    };
    line(
        "The columns are 0 < N4/N1 < 1 and N4/N1 > 1; the torque signs (18) and (19) follow from the side of 1 \
         alone.",
        "T2 = (η/R − 1) T1 when link 1 drives, (1/(η R) − 1) T1 when link 4 does. So (19) needs R < η and (18) needs \
         R > 1/η. Between, 8 of the 16 combinations of a column belong in another row, and two of those have three \
         inputs and no output.",
        format!(
            "R = 1.02, η = 0.9409, T1 > 0. (ω1, ω2, ω4) = (0.01, 1.01, −0.01): the table has 1,4 → 2, its formula \
             gives η = {:.2}; all three links are inputs, T2/T1 = {:.5}. (3, 4, 2.98): the table has 1 → 2,4 with \
             {:.5}; it is {} with {:.5}.",
            printed.to_f64(),
            heat.report.members.get("2").unwrap().torque_n_m.unwrap(),
            second.to_f64(),
            roles_of(row.powers),
            row.efficiency.to_f64()
        ),
    );
    line(
        "Eqs. (16) and (17): link 1 is the input both as seen from link 2 and as seen from link 4.",
        "For R > 1 both cannot be. When link 1 drives as seen from the carrier, power goes from link 2 to link 1 as seen \
         from link 4, and T2/T1 = −1/(η_4(2-1) R^4_{2,1}) with η_4(2-1) = (R − 1)/(R − η). The signs (18) remain, \
         outside the band."
            .replace("R^4_{2,1}", "`R^4_{2,1}`")
            .as_str(),
        format!(
            "R = 3, η = 0.95: T2/T1 = {:.5}; Eq. (17) would need η_4(1-2) = {:.3}. η_4(2-1) = {:.5}.",
            e.carrier, e.eq_17, e.backward
        ),
    );
    line(
        "0 < η_4(1-2) < 1 is used as a fact.",
        "It is the assumption that the train does not lock with link 4 held; it fails exactly in the band.",
        format!(
            "R = 51/50, η = 0.95, link 4 held, link 1 to link 2: the torques give {:.3} for the efficiency; the train \
             is locked.",
            e.locked.1
        ),
    );
    line(
        "Second worked case, as read: \"(ω4 − ω2) < 0, then T1 (ω1 − ω2) > 0\", link 4 is the input.",
        "The product is T4 (ω4 − ω2), positive because T4 < 0; T1 (ω1 − ω2) is negative. The result is right.",
        format!(
            "R = 3, η = 0.9409, (ω1, ω2, ω4) = (−2, −1, −4), T1 = 1: T1 (ω1 − ω2) = {:.0}, T4 (ω4 − ω2) = {:.5}.",
            e.worked[0], e.worked[1]
        ),
    );
    line(
        "Eq. (24), as read: η = −P1/P4 with potential powers relative to p.",
        "Relative to the carrier, link 2.",
        format!(
            "At the same point, gears of 60 and 20 teeth on a planet of 20: {:.4} relative to the planet, {:.4} relative \
             to link 2.",
            e.worked[2], e.worked[3]
        ),
    );
    line(
        "N4/N1 = 1, and one link or the whole train at rest, are left out by strict inequalities.",
        "At N4/N1 = 1 links 1 and 4 turn alike and T2 = (η − 1) T1 or (1/η − 1) T1 is friction alone. With one link at \
         rest the train is one of its six inversions; with ω1 = ω2 = ω4 nothing is lost and T4/T1 may lie anywhere from \
         −1/(η R) to −η/R.",
        format!("R = 1, η = 0.95, link 1 drives: T2/T1 = {:.2}.", e.at_one),
    );
    line(
        "N4/N1 < 0 is not among the cases.",
        "Right for Fig. 1, where both gears are suns. With a ring gear the same twelve formulas hold with other \
         combinations: T1 and T4 have one sign, whatever the losses (last table above).",
        format!("R = −5/13, η = 0.9702, link 1 drives: T4/T1 = {:.5}, T2/T1 = {:.5}.", e.ring[0], e.ring[1]),
    );
    line(
        "The loss is l in the text and L in the list of symbols; l is a power in Eqs. (1), (13), (21).",
        "In the table l is that power for unit input power, l = η − 1.",
        "–".to_owned(),
    );
}

fn page() -> String {
    let t = table();
    let f = ours(&t);
    let all = compare(&t, &f);
    let mut page = String::from(
        "# Esmail 2018, Table 1, cell by cell\n\nGenerated by `cargo xtask generate` from `table.toml`; every run of the \
         tests compares it again.\n\n",
    );
    writeln!(page, "Source: {}\n", t.source).unwrap();
    let name = t.model.rsplit('/').next().unwrap();
    writeln!(
        page,
        "Model: [{name}](../../examples/{name}); `willis regimes examples/{name} --family` prints our table.\n"
    )
    .unwrap();
    let combinations: Vec<(&Compared, &Combination)> =
        all.iter().flat_map(|x| x.cell.combination.iter().map(move |c| (x, c))).collect();
    let count =
        |keep: &dyn Fn(&Compared, &Combination) -> bool| combinations.iter().filter(|(x, c)| keep(x, c)).count();
    let supplied = count(&|_, c| c.status == Status::Supplied);
    let differ = count(&|x, c| x.range(c).is_none()) + all.iter().filter(|x| !x.wrong.is_empty()).count();
    writeln!(
        page,
        "{} cells, {} combinations of torque signs and order of speeds ({} as printed, {supplied} with the speeds \
         supplied), {} formulas as printed; {}. {} combinations hold in a narrower range than printed.\n",
        all.len(),
        combinations.len(),
        combinations.len() - supplied,
        t.formula.len(),
        if differ == 0 { "all agree".to_owned() } else { format!("**{differ} differ**") },
        count(&|x, _| x.wider),
    )
    .unwrap();
    writeln!(
        page,
        "N4/N1 is the paper's N_p4/N_p1 = `R^2_{{4,1}}`, here R; η = η1 η2; `R^v_{{w,u}}` = (ω_w − ω_v)/(ω_u − ω_v), f at \
         rest; l = η − 1 of the whole train. The paper's columns stand beside our ranges {} and {}.\n",
        f.cases[case(&f, 1, false)].label.replace("eta", "η"),
        f.cases[case(&f, 2, false)].label.replace("eta", "η")
    )
    .unwrap();
    page += "- `agrees`: the same in ours. A formula: its value, in exact fractions, is the efficiency of the regime at \
             random points, with R outside the band and, where the assignment holds there too, inside.\n\
             - `supplied`: missing in the text at hand; the only order that gives this row with the printed torques.\n\
             - `wider`: the printed range of N4/N1 is wider than that in which the combination belongs in this row: not \
             between η and 1/η.\n\n## The table\n";
    side_by_side(&mut page, &t, &all);
    page += "\n## Between the columns\n\nη < R < 1/η: friction turns round the torque on the carrier.\n";
    band(&mut page, &t, &f);
    page += "\n## A ring gear\n\n### R < 0\n\nNot in the paper.\n\n\
             | inputs → outputs | drives | torques and speeds | l |\n|---|---|---|---|\n";
    for row in &f.rows {
        row.cells[0].iter().for_each(|g| group_lines(&mut page, row, g));
    }
    errata_lines(&mut page, &t);
    notes(&mut page, &t);
    page
}

/// `WILLIS_WRITE=1 cargo test -p willis --test validation write_page` writes the page; otherwise it must
/// be up to date.
#[test]
fn write_page() {
    let page = page();
    let path = folder().join("README.md");
    if std::env::var_os("WILLIS_WRITE").is_some() {
        fs::write(path, page).unwrap();
    } else {
        let committed = fs::read_to_string(path).unwrap_or_default();
        assert!(
            committed == page,
            "validation/esmail-2018-table-1/README.md is out of date: run `cargo xtask generate`"
        );
    }
}
