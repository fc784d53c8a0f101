//! Builds the list of regimes of one configuration.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::{NameMap, Role};
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::symbolic::{Notation, Symbol};
use crate::train::{FRAME, MemberId};

use super::arrangement::{self, dot};
use super::cells::{
    Cells, efficiency_at, efficiency_between, efficiency_towards, enumerate, power_signs, without_friction,
};
use super::formula::{Efficiencies, Formula, Ratios, Shape, SymbolKind, element_label};
use super::report::{
    AssignmentReport, Atlas, BoundaryReport, ConditionReport, Crossing, ExamplePoint, FormulaReport, LinkReport,
    Neighbour, PlaneReport, Prescribed, RatioRange, Reach, RegimeReport, RegionReport, SymbolReport, Threshold,
};
use super::setup::{Linked, Pattern, Setup, TorqueCell};

/// Most closed formulas that are worked out for one state.
const MOST_FORMULAS: usize = 128;
/// Most terminals for which every assignment is listed.
const MOST_ASSIGNED: usize = 6;

/// The regimes of one configuration.
pub(crate) fn atlas(
    state: String,
    c: Configuration<'_>,
    members: &[MemberId],
    balance: Option<[MemberId; 2]>,
) -> Atlas {
    let train = c.train;
    let name = |m: MemberId| train.member_name(m).to_owned();
    let mut atlas = Atlas {
        state,
        degrees_of_freedom: c.degrees_of_freedom(),
        terminals: members.iter().filter(|m| c.node(**m).is_some()).map(|m| name(*m)).collect(),
        held: members.iter().filter(|m| c.node(**m).is_none()).map(|m| name(*m)).collect(),
        independent_torques: 0,
        base_speeds: vec![],
        reason: None,
        symbols: NameMap::default(),
        planes: vec![],
        regions: vec![],
        regimes: vec![],
        formulas: vec![],
        boundaries: vec![],
        assignments: vec![],
        efficiency_basis: None,
        lossless: vec![],
        link: None,
        notes: vec![],
    };
    // Input and output clutched together: no gear carries the load.
    let nodes: Vec<Option<usize>> = members.iter().map(|m| c.node(*m)).filter(Option::is_some).collect();
    if nodes.len() > 1 && nodes.iter().all(|n| *n == nodes[0]) {
        atlas.reason =
            Some("direct drive: the terminals turn as one, no mesh is loaded and the efficiency is 1".into());
        return atlas;
    }
    let setup = match Setup::new(c, members, Linked::of(balance)) {
        Ok(setup) => setup,
        Err(why) => {
            atlas.reason = Some(why);
            return atlas;
        }
    };
    if let Some(idle) = setup.idle(members) {
        atlas.notes.push(idle);
    }
    fill(&mut atlas, &setup);
    atlas
}

/// Lists everything that the cells of a configuration show.
fn fill(atlas: &mut Atlas, setup: &Setup<'_>) {
    atlas.terminals = names(setup, 0..setup.terminals.len());
    atlas.independent_torques = setup.independent_torques();
    atlas.base_speeds = names(setup, setup.base.iter().copied());
    atlas.link = setup.link.as_ref().map(|link| LinkReport {
        variator: link.variator.map(|_| setup.link_name()),
        ends: link.ends.map(|t| setup.terminal_name(t).to_owned()),
        efficiency: link.efficiency.each_ref().map(Rational::to_f64),
    });
    let cells = match enumerate(setup) {
        Ok(cells) => cells,
        Err(why) => {
            atlas.reason = Some(why);
            return;
        }
    };
    if !cells.singular && cells.torques.iter().all(Vec::is_empty) {
        atlas.reason = Some(
            "friction locks the train in every motion: no torques on its terminals but zero are in equilibrium".into(),
        );
        return;
    }
    note_peculiarities(atlas, setup, &cells);
    atlas.planes = cells.planes.iter().map(|f| plane(setup, f)).collect();
    atlas.regions = (0..cells.regions.len()).map(|k| region(setup, &atlas.base_speeds, &cells, k)).collect();
    let mut formulas = Formulas::new(setup, &cells);
    // What can happen without friction, to tell what friction makes.
    let frictionless = without_friction(setup, &cells);
    atlas.regimes = regimes(setup, &cells, &atlas.regions, &frictionless, &mut formulas);
    label_unloading(atlas, setup);
    // Now every plane has its name.
    bounding_planes(atlas, &cells);
    neighbours(atlas, setup);
    prescribed(atlas, setup);
    formulas.list(atlas);
    boundaries(atlas, setup);
    assignments(atlas, setup, &frictionless);
}

/// Names of some terminals.
fn names(setup: &Setup<'_>, of: impl IntoIterator<Item = usize>) -> Vec<String> {
    of.into_iter().map(|t| setup.terminal_name(t).to_owned()).collect()
}

/// Notes what is unusual: a threshold of self-locking, elements with a ratio of one, elements without loss.
fn note_peculiarities(atlas: &mut Atlas, setup: &Setup<'_>, cells: &Cells) {
    if cells.singular {
        atlas.notes.push(
            "for some drivers the train lies exactly on a self-locking threshold: there a whole range of torques balances, \
             which is not listed"
                .into(),
        );
    }
    for j in (0..setup.active.len()).filter(|&j| setup.ratio(j) == Rational::ONE && !setup.element(j).is_rigid()) {
        let e = setup.element(j);
        let [p, q, c] = [e.p, e.q, e.carrier].map(|m| setup.member_name(m));
        atlas.notes.push(format!(
            "the basic ratio of {} is 1: {p} and {q} turn alike whatever {c} does, and the torque of the teeth on {c} \
             is friction alone, (rho - 1) times that on {p}",
            element_label(setup, j)
        ));
    }
    let lossless: Vec<String> = (0..setup.active.len())
        .filter(|&j| !setup.lossy(j) && !setup.element(j).is_rigid())
        .map(|j| element_label(setup, j))
        .collect();
    if !lossless.is_empty() {
        atlas.notes.push(without_loss(&lossless));
    }
    atlas.lossless = lossless;
}

/// The regimes of all regions. Each pattern of roles and drivers gets its formula.
fn regimes(
    setup: &Setup<'_>,
    cells: &Cells,
    regions: &[RegionReport],
    frictionless: &BTreeSet<(usize, Vec<i8>)>,
    formulas: &mut Formulas<'_, '_>,
) -> Vec<RegimeReport> {
    let ids: Vec<Vec<String>> = (cells.torques.iter().enumerate())
        .map(|(k, list)| (0..list.len()).map(|n| regime_name(setup, k, list, n)).collect())
        .collect();
    let mut all = Vec::new();
    for (k, list) in cells.torques.iter().enumerate() {
        for (n, cell) in list.iter().enumerate() {
            let own = regime(setup, &regions[k], &cells.regions[k].point, cell);
            all.push(RegimeReport {
                id: ids[k][n].clone(),
                formula: formulas.id_of(&own.pattern, &own.power_signs),
                mirror: ids[cells.opposite(k)][cells.mirror(k, cell)].clone(),
                by_friction_only: !frictionless.contains(&(k, cell.signs.clone())),
                ..own
            });
        }
    }
    all
}

/// What a regime is by itself, before it stands in a list. Its torques balance at the speeds `base`.
fn regime(setup: &Setup<'_>, region: &RegionReport, base: &[Rational], cell: &TorqueCell) -> RegimeReport {
    let powers = power_signs(setup, base, &cell.signs);
    // At the example's speeds, which are rounder than those of the cell.
    let inside = &region.point;
    let torques = setup.torques_at(&cell.pattern, base, &cell.torques, inside);
    let exact = efficiency_at(setup, inside, &torques);
    let with = |sign: i8| names(setup, (0..powers.len()).filter(|&t| powers[t] == sign));
    RegimeReport {
        id: String::new(),
        region: region.number,
        torque_signs: setup.by_terminal(|t| cell.signs[t]),
        roles: setup.by_terminal(|t| role(powers[t])),
        inputs: with(1),
        outputs: with(-1),
        drivers: NameMap(drivers(setup, &cell.pattern)),
        formula: String::new(),
        efficiency_range: limits(setup, region, &cell.pattern, &torques),
        example: ExamplePoint {
            speeds: region.example.clone(),
            torques: setup.by_terminal(|t| torques[t].to_f64()),
            efficiency: exact.to_f64(),
            efficiency_exact: exact,
        },
        mirror: String::new(),
        by_friction_only: false,
        all_dissipated: powers.contains(&1) && !powers.contains(&-1),
        neighbours: vec![],
        pattern: cell.pattern.clone(),
        torques,
        power_signs: powers,
    }
}

/// What a terminal does, by the sign of its power.
pub(crate) fn role(power: i8) -> Role {
    match power {
        1 => Role::Input,
        -1 => Role::Output,
        _ => Role::Idle,
    }
}

/// Which planes bound each region: those across which there is another.
fn bounding_planes(atlas: &mut Atlas, cells: &Cells) {
    for r in &mut atlas.regions {
        let bounds = |p: &usize| {
            let mut across = r.signs.clone();
            across[*p] = -across[*p];
            cells.region(&across).is_some()
        };
        r.bounded_by = (0..atlas.planes.len()).filter(bounds).map(|p| atlas.planes[p].label.clone()).collect();
    }
}

/// Which regimes answer a torque prescribed on each terminal; with one independent torque it settles the others.
fn prescribed(atlas: &mut Atlas, setup: &Setup<'_>) {
    if setup.independent_torques() != 1 {
        return;
    }
    for region in &mut atlas.regions {
        let own: Vec<&RegimeReport> = atlas.regimes.iter().filter(|r| r.region == region.number).collect();
        region.prescribed = (0..setup.terminals.len())
            .map(|t| {
                let of =
                    |sign: i8| own.iter().filter(|r| r.torque_signs.0[t].1 == sign).map(|r| r.id.clone()).collect();
                Prescribed { terminal: setup.terminal_name(t).to_owned(), positive: of(1), negative: of(-1) }
            })
            .collect();
    }
}

/// The closed formulas of an atlas: one for each pattern of drivers and roles.
struct Formulas<'s, 't> {
    /// The solution they are all made from, or why there are none.
    shape: Result<Shape<'s, 't>, String>,
    all: Vec<Driven>,
}

/// Drivers and signs of the terminals' powers, and the formula that holds for them.
struct Driven {
    pattern: Pattern,
    powers: Vec<i8>,
    /// Or why it is not given; none where none is.
    own: Option<Result<Formula, String>>,
}

impl<'s, 't> Formulas<'s, 't> {
    fn new(setup: &'s Setup<'t>, cells: &Cells) -> Self {
        let mut distinct: BTreeSet<(&Pattern, Vec<i8>)> = BTreeSet::new();
        for (region, list) in cells.regions.iter().zip(&cells.torques) {
            distinct.extend(list.iter().map(|t| (&t.pattern, power_signs(setup, &region.point, &t.signs))));
        }
        let shape = match distinct.len() {
            n if n > MOST_FORMULAS => Err(format!(
                "there are {n} of them (at most {MOST_FORMULAS} are listed); ask for certain inputs and outputs, or name \
                 fewer terminals"
            )),
            _ => Shape::new(setup, &[]),
        };
        Self { shape, all: vec![] }
    }

    /// The name of the formula for these drivers and powers, which is worked out when first asked for.
    fn id_of(&mut self, pattern: &Pattern, powers: &[i8]) -> String {
        let known = self.all.iter().position(|d| d.pattern == *pattern && d.powers == powers);
        let at = known.unwrap_or_else(|| {
            let shape = self.shape.as_ref().ok();
            let own = shape.map(|s| s.formula(pattern, powers, Ratios::Basic, Efficiencies::Basic));
            self.all.push(Driven { pattern: pattern.clone(), powers: powers.to_vec(), own });
            self.all.len() - 1
        });
        formula_id(at)
    }

    /// Lists them and their symbols, or why there are none.
    fn list(&self, atlas: &mut Atlas) {
        let shape = match &self.shape {
            Ok(shape) => shape,
            Err(why) => {
                atlas.notes.push(format!("no closed formulas: {why}"));
                return;
            }
        };
        for (n, driven) in self.all.iter().enumerate() {
            let id = formula_id(n);
            let regimes: Vec<String> = atlas.regimes.iter().filter(|r| r.formula == id).map(|r| r.id.clone()).collect();
            match driven.own.as_ref().expect("made with the shape") {
                Ok(own) => atlas.formulas.push(formula_report(shape, id, driven, own, regimes)),
                Err(why) => atlas.notes.push(format!("no closed formula {id} ({}): {why}", regimes.join(", "))),
            }
        }
        // Placeholders have no meaning, and teeth are in no basic formula.
        let shown = shape.names.all().filter(|i| !i.meaning.is_empty() && i.kind != SymbolKind::Teeth);
        atlas.symbols = shown
            .map(|info| {
                let report = SymbolReport {
                    value: info.value.as_ref().map(Rational::to_f64),
                    exact: info.value.clone(),
                    meaning: info.meaning.clone(),
                    latex: info.latex.clone(),
                };
                (info.name.clone(), report)
            })
            .collect();
    }
}

/// The name of a formula, by its place in the list.
fn formula_id(n: usize) -> String {
    format!("F{}", n + 1)
}

/// The note on elements without loss.
fn without_loss(elements: &[String]) -> String {
    format!("without loss, so it does not matter who drives: {}", elements.join(", "))
}

impl Atlas {
    /// The notes without that on elements without loss, for readers to whom [`Atlas::lossless`] says it.
    pub fn notes_beside_losses(&self) -> impl Iterator<Item = &str> {
        let told = (!self.lossless.is_empty()).then(|| without_loss(&self.lossless));
        self.notes.iter().map(String::as_str).filter(move |note| told.as_deref() != Some(note))
    }
}

/// Label and matter of a plane.
pub(crate) fn plane(setup: &Setup<'_>, form: &[Rational]) -> PlaneReport {
    let train = setup.c.train;
    let same = |other: &[Rational]| arrangement::normal(other).is_some_and(|(f, _)| f == form);
    let at_rest: Vec<String> = (0..setup.terminals.len())
        .filter(|&t| same(setup.terminal_speed(t)))
        .map(|t| setup.terminal_name(t).to_owned())
        .collect();
    let meshes: Vec<usize> = (0..setup.active.len()).filter(|&j| setup.lossy(j) && same(&setup.sigma[j])).collect();
    let mut parts: Vec<String> = Vec::new();
    if !at_rest.is_empty() {
        parts.push(format!("{} at rest", at_rest.join(", ")));
    }
    // Elements that share a member turn as one piece.
    let mut pieces: Vec<Vec<MemberId>> = Vec::new();
    for &j in &meshes {
        let e = setup.element(j);
        let mut piece = vec![e.p, e.q, e.carrier];
        while let Some(k) = pieces.iter().position(|p| p.iter().any(|m| piece.contains(m))) {
            for m in pieces.remove(k) {
                if !piece.contains(&m) {
                    piece.push(m);
                }
            }
        }
        pieces.push(piece);
    }
    for mut piece in pieces {
        piece.sort_unstable();
        let names: Vec<&str> = piece.iter().map(|m| train.member_name(*m)).collect();
        if piece[0] != FRAME {
            let (last, rest) = names.split_last().expect("an element has three members");
            parts.push(format!("{} and {last} turn as one", rest.join(", ")));
        } else if at_rest.is_empty() {
            parts.push(format!("{} at rest", names[1..].join(", ")));
        }
    }
    PlaneReport {
        label: parts.join("; "),
        at_rest,
        without_relative_motion: meshes.iter().map(|&j| element_label(setup, j)).collect(),
        form: form.iter().map(Rational::to_f64).collect(),
        exact: form.to_vec(),
    }
}

/// The two directions that bound a region of the plane, counterclockwise.
fn bounding_rays(cells: &Cells, k: usize) -> Option<[Vec<Rational>; 2]> {
    let n = cells.regions.len();
    if n < 2 || cells.planes.first()?.len() != 2 {
        return None;
    }
    let ray = |before: usize, after: usize| -> Option<Vec<Rational>> {
        let (a, b) = (&cells.regions[before], &cells.regions[after]);
        let flipped = (0..a.signs.len()).find(|&i| a.signs[i] != b.signs[i])?;
        let f = &cells.planes[flipped];
        // Along the line, on the side to which both cells are near: between them.
        let along = vec![-f[1].clone(), f[0].clone()];
        let cross = |u: &[Rational], v: &[Rational]| &(&u[0] * &v[1]) - &(&u[1] * &v[0]);
        let flip = cross(&a.point, &along).sign() < 0 || cross(&along, &b.point).sign() < 0;
        Some(if flip { along.into_iter().map(|x| -x).collect() } else { along })
    };
    Some([ray((k + n - 1) % n, k)?, ray(k, (k + 1) % n)?])
}

fn region(setup: &Setup<'_>, base_speeds: &[String], cells: &Cells, k: usize) -> RegionReport {
    let cell = &cells.regions[k];
    let rays = bounding_rays(cells, k);
    // A point with small numbers: the sum of the bounding directions, of equal size.
    let point: Vec<Rational> = match &rays {
        Some([from, to]) => {
            let unit = |v: &[Rational]| {
                let size = v.iter().map(Rational::abs).max().unwrap_or(Rational::ONE);
                v.iter().map(|x| x / &size).collect::<Vec<_>>()
            };
            let (a, b) = (unit(from), unit(to));
            let sum: Vec<Rational> = a.iter().zip(&b).map(|(x, y)| x + y).collect();
            let inside = cells.planes.iter().zip(&cell.signs).all(|(f, s)| dot(f, &sum).sign() == *s);
            if inside { sum } else { cell.point.clone() }
        }
        None => cell.point.clone(),
    };
    let ratio = rays.as_ref().and_then(|[from, to]| {
        let first = [&from[0], &to[0], &point[0]].map(Rational::sign);
        let sign = first[2];
        (sign != 0 && first.iter().all(|s| *s == sign || *s == 0)).then(|| {
            let slope = |v: &[Rational]| (!v[0].is_zero()).then(|| (&v[1] / &v[0]).to_f64());
            let (low, high) = (slope(from), slope(to));
            RatioRange { of: format!("w_{}/w_{}", base_speeds[1], base_speeds[0]), denominator_sign: sign, low, high }
        })
    });
    let direction = |v: &[Rational]| [v[0].to_f64(), v[1].to_f64()];
    RegionReport {
        number: k + 1,
        order: order(setup, &point),
        signs: cell.signs.clone(),
        example: setup.by_terminal(|t| dot(setup.terminal_speed(t), &point).to_f64()),
        from: rays.as_ref().map(|r| direction(&r[0])),
        to: rays.as_ref().map(|r| direction(&r[1])),
        ratio,
        bounded_by: vec![],
        opposite: cells.opposite(k) + 1,
        prescribed: vec![],
        point,
        rays,
    }
}

/// Chains of speeds, from the largest down, that hold throughout a region.
pub(crate) fn order(setup: &Setup<'_>, point: &[Rational]) -> Vec<String> {
    let train = setup.c.train;
    let mut chains: Vec<String> = Vec::new();
    let mut told: Vec<MemberId> = Vec::new();
    for j in (0..setup.active.len()).filter(|&j| setup.lossy(j)) {
        let e = setup.element(j);
        let is_terminal =
            |m: MemberId| m == FRAME || setup.c.node(m).is_none_or(|n| setup.terminals.iter().any(|t| t.node == n));
        let mut members: Vec<(Rational, Option<MemberId>)> = Vec::new();
        for m in [e.p, e.q, e.carrier] {
            let Some(w) = setup.speed(m) else { continue };
            if setup.c.node(m).is_none() {
                continue;
            }
            members.push((dot(&w, point), Some(m)));
            told.push(m);
        }
        // Where a member that is no terminal stands towards zero may change within the region.
        if [e.p, e.q, e.carrier].into_iter().all(is_terminal) {
            members.push((Rational::ZERO, None));
        }
        members.sort_by(|a, b| b.0.cmp(&a.0));
        let mut text = String::new();
        for (k, (w, m)) in members.iter().enumerate() {
            if k > 0 {
                text += if *w == members[k - 1].0 { " = " } else { " > " };
            }
            text += &m.map_or("0".to_owned(), |m| format!("w_{}", train.member_name(m)));
        }
        if !chains.contains(&text) {
            chains.push(text);
        }
    }
    for t in &setup.terminals {
        if !told.iter().any(|m| setup.c.node(*m) == Some(t.node)) {
            let w = dot(setup.node_speed[t.node].as_ref().expect("known"), point);
            let name = &t.name;
            chains.push(if w.sign() > 0 { format!("w_{name} > 0") } else { format!("0 > w_{name}") });
        }
    }
    chains
}

pub(crate) fn regime_name(setup: &Setup<'_>, region: usize, list: &[TorqueCell], n: usize) -> String {
    if setup.independent_torques() > 1 {
        return format!("{}.{}", region + 1, n + 1);
    }
    let lead = |c: &TorqueCell| c.signs.iter().copied().find(|s| *s != 0).unwrap_or(0);
    let sign = lead(&list[n]);
    let alike: Vec<usize> = (0..list.len()).filter(|&i| lead(&list[i]) == sign).collect();
    let letter = match alike.len() {
        1 => String::new(),
        _ => char::from(b'a' + alike.iter().position(|i| *i == n).unwrap_or(0).min(25) as u8).to_string(),
    };
    format!("{}{}{letter}", region + 1, if sign < 0 { '-' } else { '+' })
}

pub(crate) fn drivers(setup: &Setup<'_>, pattern: &Pattern) -> Vec<(String, Option<String>)> {
    let elements = (0..setup.active.len()).filter(|&j| !setup.element(j).is_rigid()).map(|j| {
        let e = setup.element(j);
        let driver = pattern[j].map(|p| setup.member_name(if p { e.p } else { e.q }).to_owned());
        (element_label(setup, j), driver)
    });
    let link = setup.link.iter().filter(|link| link.variator.is_some()).map(|link| {
        let from = pattern[setup.active.len()].map(|forward| link.ends[usize::from(!forward)]);
        (setup.link_name(), from.map(|t| setup.terminal_name(t).to_owned()))
    });
    elements.chain(link).collect()
}

/// Efficiency on the two directions that bound a region.
fn limits(setup: &Setup<'_>, region: &RegionReport, pattern: &Pattern, torques: &[Rational]) -> Option<[f64; 2]> {
    if setup.independent_torques() > 1 {
        return None;
    }
    match &region.rays {
        Some([from, to]) => {
            let ends = [from, to].map(|r| efficiency_towards(setup, r, &region.point, pattern, torques).to_f64());
            let [low, high] = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            // Through a link it may be better or worse in between.
            let between = setup.link.is_some().then(|| efficiency_between(setup, pattern, [from, to]));
            Some(between.map_or([low, high], |[least, most]| [low.min(least), high.max(most)]))
        }
        None if setup.base.len() == 1 => Some([efficiency_at(setup, &region.point, torques).to_f64(); 2]),
        None => None,
    }
}

fn neighbours(atlas: &mut Atlas, setup: &Setup<'_>) {
    let by_signs: BTreeMap<Vec<i8>, usize> = atlas.regions.iter().map(|r| (r.signs.clone(), r.number)).collect();
    let mut by_region: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (k, r) in atlas.regimes.iter().enumerate() {
        by_region.entry(r.region).or_default().push(k);
    }
    for k in 0..atlas.regimes.len() {
        let own = &atlas.regions[atlas.regimes[k].region - 1];
        let mut all = Vec::new();
        for (p, plane) in atlas.planes.iter().enumerate() {
            let mut across = own.signs.clone();
            across[p] = -across[p];
            let Some(number) = by_signs.get(&across) else { continue };
            for &other in by_region.get(number).into_iter().flatten() {
                if continues(setup, atlas, &atlas.regimes[k], &atlas.regimes[other], p) {
                    all.push(Neighbour { plane: plane.label.clone(), regime: atlas.regimes[other].id.clone() });
                }
            }
        }
        atlas.regimes[k].neighbours = all;
    }
}

/// The direction between two neighbouring regions of the plane.
fn ray_between<'a>(a: &'a RegionReport, b: &RegionReport) -> Option<&'a [Rational]> {
    let ([from, to], [other_from, other_to]) = (a.rays.as_ref()?, b.rays.as_ref()?);
    let parallel = |u: &[Rational], v: &[Rational]| arrangement::by_angle(u, v).is_eq();
    if parallel(to, other_from) {
        Some(to)
    } else if parallel(from, other_to) {
        Some(from)
    } else {
        None
    }
}

/// Whether the torques of one regime go on into the other when the speeds cross a plane.
fn continues(setup: &Setup<'_>, atlas: &Atlas, a: &RegimeReport, b: &RegimeReport, plane: usize) -> bool {
    let signs = |r: &RegimeReport| r.torque_signs.0.iter().map(|x| x.1).collect::<Vec<i8>>();
    let slips = !atlas.planes[plane].without_relative_motion.is_empty();
    let (own, other) = (&atlas.regions[a.region - 1], &atlas.regions[b.region - 1]);
    if !slips && setup.link.is_some() {
        // Without friction's jump the torques on the plane itself agree.
        if let Some(ray) = ray_between(own, other) {
            let at = |r: &RegimeReport, region: &RegionReport| {
                let there = setup.torques_at(&r.pattern, &region.point, &r.torques, ray);
                let size = there.iter().map(Rational::abs).max().unwrap_or(Rational::ONE);
                let size = if size.is_zero() { Rational::ONE } else { size };
                there.into_iter().map(|x| x / &size).collect::<Vec<_>>()
            };
            return at(a, own) == at(b, other);
        }
    }
    if setup.independent_torques() == 1 {
        // Friction may turn a torque round; the first one keeps its sign.
        let lead = |r: &RegimeReport| signs(r).into_iter().find(|s| *s != 0);
        return lead(a) == lead(b) && (slips || a.pattern == b.pattern);
    }
    signs(a) == signs(b) && (slips || a.pattern == b.pattern)
}

/// Names the planes on which a torque or a tooth force vanishes, which only balanced powers make.
fn label_unloading(atlas: &mut Atlas, setup: &Setup<'_>) {
    let n = atlas.regions.len();
    for p in 0..atlas.planes.len() {
        if !atlas.planes[p].label.is_empty() {
            continue;
        }
        let mut zero: Vec<String> = Vec::new();
        for k in 0..n {
            let (a, b) = (&atlas.regions[k], &atlas.regions[(k + 1) % n]);
            if a.signs[p] == b.signs[p] {
                continue;
            }
            let Some(ray) = ray_between(a, b) else { continue };
            for (region, r) in [a, b]
                .into_iter()
                .flat_map(|x| atlas.regimes.iter().filter(move |r| r.region == x.number).map(move |r| (x, r)))
            {
                let there = setup.torques_at(&r.pattern, &region.point, &r.torques, ray);
                for (t, x) in there.iter().enumerate() {
                    if x.is_zero() && !zero.contains(&atlas.terminals[t]) {
                        zero.push(atlas.terminals[t].clone());
                    }
                }
            }
        }
        atlas.planes[p].label = match zero.is_empty() {
            true => "a mesh is unloaded".to_owned(),
            false => format!("no torque on {}", zero.join(", ")),
        };
    }
}

fn boundaries(atlas: &mut Atlas, setup: &Setup<'_>) {
    if setup.base.len() != 2 {
        return;
    }
    let n = atlas.regions.len();
    let mut all = Vec::new();
    for k in 0..n {
        let next = (k + 1) % n;
        let (before, after) = (&atlas.regions[k], &atlas.regions[next]);
        let Some([_, ray]) = &before.rays else { continue };
        let Some(p) = (0..before.signs.len()).find(|&p| before.signs[p] != after.signs[p]) else { continue };
        let of = |number: usize| atlas.regimes.iter().filter(move |r| r.region == number);
        let mut crossings = Vec::new();
        if setup.independent_torques() == 1 {
            for a in of(k + 1) {
                for b in of(next + 1).filter(|b| continues(setup, atlas, a, b, p)) {
                    let limit = |r: &RegimeReport| {
                        let inside = &atlas.regions[r.region - 1].point;
                        efficiency_towards(setup, ray, inside, &r.pattern, &r.torques)
                    };
                    let (before, after) = (limit(a), limit(b));
                    crossings.push(Crossing {
                        from: a.id.clone(),
                        to: b.id.clone(),
                        efficiency_before: Some(before.to_f64()),
                        efficiency_before_exact: Some(before),
                        efficiency_after: Some(after.to_f64()),
                        efficiency_after_exact: Some(after),
                        changes: changes(a, b),
                    });
                }
            }
        }
        all.push(BoundaryReport {
            label: atlas.planes[p].label.clone(),
            direction: [ray[0].to_f64(), ray[1].to_f64()],
            speeds: setup.by_terminal(|t| dot(setup.terminal_speed(t), ray).to_f64()),
            between: [k + 1, next + 1],
            crossings,
        });
    }
    atlas.boundaries = all;
}

/// What is different between two regimes, in words.
pub(crate) fn changes(a: &RegimeReport, b: &RegimeReport) -> Vec<String> {
    let word = |r: Role| match r {
        Role::Input => "input",
        Role::Output => "output",
        _ => "idle",
    };
    let mut all = Vec::new();
    for ((name, before), (_, after)) in a.roles.iter().zip(b.roles.iter()) {
        if before != after {
            all.push(format!("{name}: {} becomes {}", word(*before), word(*after)));
        }
    }
    for ((name, before), (_, after)) in a.drivers.iter().zip(b.drivers.iter()) {
        if let (Some(before), Some(after)) = (before, after)
            && before != after
        {
            all.push(format!("{name}: {after} drives instead of {before}"));
        }
    }
    for ((name, before), (_, after)) in a.torque_signs.iter().zip(b.torque_signs.iter()) {
        if before != after {
            all.push(format!("{name}: the torque reverses"));
        }
    }
    all
}

/// Inputs and outputs as people write them: `engine, mg1 -> ring`.
pub(crate) fn arrow(inputs: &[String], outputs: &[String]) -> String {
    match outputs.is_empty() {
        true => format!("{} -> heat", inputs.join(", ")),
        false => format!("{} -> {}", inputs.join(", "), outputs.join(", ")),
    }
}

fn formula_report(
    shape: &Shape<'_, '_>,
    id: String,
    Driven { pattern, powers, .. }: &Driven,
    own: &Formula,
    regimes: Vec<String>,
) -> FormulaReport {
    let setup = shape.setup;
    let of = |sign: i8| names(setup, (0..powers.len()).filter(|&t| powers[t] == sign));
    let mut show = own.names.writer(Notation::Text);
    let driving: Vec<String> = drivers(setup, pattern)
        .into_iter()
        .filter_map(|(e, d)| d.map(|d| if setup.active.len() > 1 { format!("{d} in {e}") } else { d }))
        .collect();
    let loss: Vec<String> = own.losses.iter().map(&mut show).collect();
    FormulaReport {
        id,
        roles: arrow(&of(1), &of(-1)),
        drivers: if driving.is_empty() { "nobody: no loss".into() } else { driving.join(", ") },
        efficiency: show(&own.efficiency),
        efficiency_by_loss: own.by_loss(Notation::Text),
        efficiency_latex: own.names.show(Notation::Latex, &own.efficiency),
        loss: if loss.is_empty() { "0".into() } else { loss.join(" + ") },
        torques: setup.by_terminal(|t| show(&own.torques[t])),
        conditions: own
            .conditions
            .iter()
            .map(|c| ConditionReport { positive: show(&c.function), meaning: c.meaning.clone() })
            .collect(),
        holds_for: thresholds(shape, own),
        regimes,
    }
}

/// For each ratio and efficiency the interval around its value in which every terminal torque keeps
/// its sign over the reference torque (for one independent torque).
fn thresholds(shape: &Shape<'_, '_>, own: &Formula) -> Vec<Threshold> {
    let setup = shape.setup;
    if setup.torques != 1 || setup.link.is_some() {
        return vec![];
    }
    let value = |s: Symbol| own.names.info(s).value.clone().unwrap_or(Rational::ONE);
    let mut all = Vec::new();
    for j in 0..setup.active.len() {
        for s in [own.names.ratio(j), own.names.efficiency(j)] {
            let now = value(s);
            let (mut low, mut high): (Option<Rational>, Option<Rational>) = (None, None);
            let mut occurs = false;
            for f in &own.torques {
                for (p, _) in f.factors().iter().filter(|(p, _)| p.degree(s) == 1) {
                    occurs = true;
                    // Linear in s: at + slope s.
                    let slope = p.derivative(s).evaluate(&value);
                    if slope.is_zero() {
                        continue;
                    }
                    let root = &now - &(&p.evaluate(&value) / &slope);
                    if root < now && low.as_ref().is_none_or(|l| root > *l) {
                        low = Some(root);
                    } else if root > now && high.as_ref().is_none_or(|h| root < *h) {
                        high = Some(root);
                    }
                }
            }
            let efficiency = own.names.info(s).kind == SymbolKind::Efficiency;
            if efficiency {
                // Beyond these bounds there is no efficiency.
                low = Some(low.filter(|l| l.sign() > 0).unwrap_or(Rational::ZERO));
                high = high.filter(|h| *h < Rational::ONE);
            }
            if occurs && (low.is_some() || high.is_some()) {
                all.push(Threshold {
                    symbol: own.names.info(s).name.clone(),
                    value: now.to_f64(),
                    low: low.map(|x| x.to_f64()),
                    high: high.map(|x| x.to_f64()).or(efficiency.then_some(1.0)),
                });
            }
        }
    }
    all
}

/// Signs of power of every assignment of `m` terminals with an input. Three terminals stand in the
/// order of Esmail's Table 1.
pub(crate) fn assignment_order(m: usize) -> Vec<Vec<i8>> {
    let signs = |mask: u32| (0..m).map(|t| if mask >> t & 1 == 1 { 1 } else { -1 }).collect::<Vec<i8>>();
    if m == 3 {
        return [0b011, 0b110, 0b101, 0b100, 0b010, 0b001, 0b111].map(signs).to_vec();
    }
    let mut masks: Vec<u32> = (1..1 << m).collect();
    masks.sort_by_key(|mask| (m as u32 == mask.count_ones(), std::cmp::Reverse(mask.count_ones()), *mask));
    masks.into_iter().map(signs).collect()
}

/// Every assignment of inputs and outputs, and whether it is reached.
fn assignments(atlas: &mut Atlas, setup: &Setup<'_>, frictionless: &BTreeSet<(usize, Vec<i8>)>) {
    let possible_without_friction = |atlas: &Atlas, powers: &[i8]| {
        let runs = |(k, torques): &(usize, Vec<i8>)| power_signs(setup, &atlas.regions[*k].point, torques) == powers;
        frictionless.iter().any(runs)
    };
    let m = setup.terminals.len();
    if m > MOST_ASSIGNED {
        atlas.notes.push(format!("{m} terminals: assignments that cannot be reached are not listed"));
    }
    let idle: Vec<bool> = (0..m).map(|t| atlas.regimes.iter().all(|r| r.power_signs[t] == 0)).collect();
    let mut wanted: Vec<Vec<i8>> = Vec::new();
    if m <= MOST_ASSIGNED && !idle.contains(&true) {
        wanted = assignment_order(m);
    }
    for r in &atlas.regimes {
        if !wanted.contains(&r.power_signs) {
            wanted.push(r.power_signs.clone());
        }
    }
    let mut all = Vec::new();
    for powers in wanted {
        let own: Vec<&RegimeReport> = atlas.regimes.iter().filter(|r| r.power_signs == powers).collect();
        let of = |sign: i8| -> Vec<String> {
            (0..m).filter(|&t| powers[t] == sign).map(|t| atlas.terminals[t].clone()).collect()
        };
        let (inputs, outputs) = (of(1), of(-1));
        let reach = match (own.is_empty(), outputs.is_empty()) {
            (false, false) if own.iter().all(|r| r.by_friction_only) => {
                match possible_without_friction(atlas, &powers) {
                    true => Reach::WhereFrictionTurns,
                    false => Reach::ByFrictionOnly,
                }
            }
            (false, false) => Reach::Reached,
            (false, true) => Reach::Dissipated,
            (true, true) => Reach::NeverDissipated,
            (true, false) if possible_without_friction(atlas, &powers) => Reach::PreventedByFriction,
            (true, false) => Reach::Never,
        };
        all.push(AssignmentReport { inputs, outputs, regimes: own.iter().map(|r| r.id.clone()).collect(), reach });
    }
    atlas.assignments = all;
}
