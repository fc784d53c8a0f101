//! Closed formulas to take away: in words, typeset, or as code that refuses to answer outside its
//! regime.

use std::sync::Arc;

use crate::analysis::NameMap;
use crate::diagnostic::{Code, Diagnostic, Diagnostics, through_diagnostic};
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::symbolic::{Notation, RationalFunction, Symbol};
use crate::train::{AS_DRAWN, MemberId, Train};

use super::atlas::{arrow, atlas, drivers};
use super::basis::EfficiencyBasis;
use super::cells::{enumerate, power_signs};
use super::formula::{Efficiencies, Formula, Names, Ratios, Shape, SymbolKind, identifier};
use super::report::RegimeReport;
use super::setup::{Linked, Pattern, Setup};
use super::{RegimeSelection, selected};

/// Which formulas.
#[derive(Clone, Debug, Default)]
pub struct FormulaRequest {
    /// State of the shift table, or `as drawn`; `None` for all.
    pub state: Option<String>,
    /// Terminals where power enters; empty for the state's input.
    pub from: Vec<String>,
    /// Terminals where power leaves; empty for the state's output.
    pub to: Vec<String>,
    /// Members on which torque may act (two or more freedoms); `None` for the train's terminals.
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero; see [`RegimeSelection::balance`].
    pub balance: Option<[String; 2]>,
    /// Only the regime of this name.
    pub regime: Option<String>,
    /// How ratios are written.
    pub ratios: Ratios,
    /// How efficiencies are written.
    pub efficiencies: Efficiencies,
}

/// What was asked for, state by state.
#[derive(Clone, Debug)]
pub struct FormulaSheet {
    /// Name of the train.
    pub train: String,
    /// The formulas.
    pub formulas: Vec<ClosedFormula>,
    /// States (and directions) without one, and why.
    pub without: Vec<(String, String)>,
}

/// A quantity that a formula takes.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Argument {
    /// Its identifier.
    pub name: String,
    /// In LaTeX.
    pub latex: String,
    /// What it stands for, in words.
    pub meaning: String,
    /// What it is.
    pub kind: SymbolKind,
    /// Of a speed or torque: the terminal.
    pub terminal: Option<String>,
    /// Its value in this train; a speed or torque inside the regime otherwise.
    pub value: f64,
    /// The same, exactly.
    pub exact: Rational,
    /// Whether it is an efficiency, to be above 0 and at most 1.
    pub efficiency: bool,
    /// Whether the train fixes it (a ratio, a tooth number, an efficiency).
    pub fixed: bool,
    /// Of a basic ratio the speeds that it is made of, as LaTeX.
    pub made_of: Option<String>,
    pub(crate) symbol: Symbol,
}

impl Argument {
    /// What is wrong with a value that it can never have; `None` if it can have every value.
    pub(crate) fn range(&self) -> Option<FormulaError> {
        match self.kind {
            SymbolKind::Efficiency => Some(FormulaError::NoEfficiency(self.name.clone())),
            SymbolKind::Teeth => Some(FormulaError::NoTeeth(self.name.clone())),
            SymbolKind::Ratio => Some(FormulaError::NoRatio(self.name.clone())),
            SymbolKind::Torque | SymbolKind::Speed => None,
        }
    }

    fn allows(&self, value: &Rational) -> bool {
        match self.kind {
            SymbolKind::Efficiency => value.sign() > 0 && *value <= Rational::ONE,
            SymbolKind::Teeth => value.sign() > 0,
            SymbolKind::Ratio => !value.is_zero(),
            SymbolKind::Torque | SymbolKind::Speed => true,
        }
    }
}

/// The closed formula of one regime, or of several that share it.
///
/// With one degree of freedom it gives efficiency, speed ratio and torque ratio; with more, all
/// terminal speeds and torques and the efficiency, from as many of them as are independent.
#[derive(Clone, Debug)]
pub struct ClosedFormula {
    /// An identifier: train, state, direction.
    pub name: String,
    /// What it is, in words.
    pub title: String,
    /// The state.
    pub state: String,
    /// Regimes in which it holds (two or more freedoms).
    pub regimes: Vec<String>,
    /// Terminals where power enters.
    pub inputs: Vec<String>,
    /// Terminals where power leaves.
    pub outputs: Vec<String>,
    /// Which end drives each element.
    pub drivers: NameMap<Option<String>>,
    /// What it takes.
    pub arguments: Vec<Argument>,
    pub(crate) efficiency: RationalFunction,
    /// One freedom: `ω_from/ω_to` and `T_to/T_from`.
    pub(crate) ratios: Option<[RationalFunction; 2]>,
    /// More freedoms: every terminal's (speed symbol, speed, torque symbol, torque).
    pub(crate) terminals: Vec<TerminalFormula>,
    pub(crate) conditions: Vec<(RationalFunction, String)>,
    pub(crate) names: Names,
    /// More freedoms: all formulas of the state, this one among them.
    pub(crate) together: Option<Arc<Together>>,
    /// More freedoms and one independent torque: regimes that hold at the same speeds and under the same torque as some
    /// regime of this formula, in this train. There the equilibrium of this formula is not the only one.
    pub beside: Vec<String>,
    /// Where mesh efficiencies come from whose losses laws compute; `None` where all are given.
    pub basis: Option<EfficiencyBasis>,
}

/// All formulas of a state with several freedoms: at any speeds and torques as many equilibria exist as of them hold.
#[derive(Clone, Debug)]
pub(crate) struct Together {
    /// An identifier.
    pub name: String,
    /// What their conditions take.
    pub arguments: Vec<Argument>,
    /// Speeds that follow from those: name and, by notation, expression.
    pub speeds: Vec<(Symbol, RationalFunction, Names)>,
    pub all: Vec<Holds>,
}

/// Where a formula of a state holds.
#[derive(Clone, Debug)]
pub(crate) struct Holds {
    /// Name of the formula as regimes list it, `f1`.
    pub id: String,
    /// The regimes in which it holds.
    pub regimes: Vec<String>,
    /// Inputs and outputs, in words.
    pub title: String,
    pub conditions: Vec<RationalFunction>,
    pub names: Names,
}

#[derive(Clone, Debug)]
pub(crate) struct TerminalFormula {
    pub speed_symbol: Symbol,
    pub speed: RationalFunction,
    pub torque_symbol: Symbol,
    pub torque: RationalFunction,
    pub given_speed: bool,
    pub given_torque: bool,
}

/// Why a formula gives no number.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum FormulaError {
    /// An argument has no value.
    Missing(String),
    /// An efficiency is not above 0 and at most 1.
    NoEfficiency(String),
    /// A number of teeth is not above 0.
    NoTeeth(String),
    /// A basic ratio is 0.
    NoRatio(String),
    /// A condition of the regime does not hold.
    Condition(String),
    /// A denominator is zero.
    Pole,
}

impl std::fmt::Display for FormulaError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Missing(name) => write!(f, "no value for {name}"),
            Self::NoEfficiency(name) => write!(f, "{name} is not above 0 and at most 1"),
            Self::NoTeeth(name) => write!(f, "{name} is not above 0"),
            Self::NoRatio(name) => write!(f, "{name} is 0"),
            Self::Condition(text) => write!(f, "outside the regime: not true that {text}"),
            Self::Pole => f.write_str("a denominator is zero"),
        }
    }
}

impl std::error::Error for FormulaError {}

impl From<FormulaError> for Diagnostic {
    fn from(outside: FormulaError) -> Self {
        Self::new(Code::Unfit, "", outside.to_string())
    }
}

through_diagnostic!(FormulaError);

/// A derivative of the efficiency.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Derivative {
    /// The efficiency symbol.
    pub of: String,
    /// The derivative in text.
    pub formula: String,
    /// The derivative in LaTeX.
    pub latex: String,
    /// Its value in this train (with more freedoms: at the speeds listed as arguments).
    pub value: f64,
    /// How much of the whole loss this element or mesh causes, to first order:
    /// `(1 − η_j) ∂η/∂η_j`.
    pub share: f64,
}

impl ClosedFormula {
    /// The efficiency in a notation.
    pub fn efficiency(&self, notation: Notation) -> String {
        self.names.show(notation, &self.efficiency)
    }

    /// `ω_from/ω_to` and `T_to/T_from` in a notation (one degree of freedom).
    pub fn ratios(&self, notation: Notation) -> Option<[String; 2]> {
        self.ratios.as_ref().map(|r| [0, 1].map(|k| self.names.show(notation, &r[k])))
    }

    /// Expressions that are positive in the regime and nowhere else, with what each ensures.
    pub fn conditions(&self, notation: Notation) -> Vec<(String, String)> {
        self.conditions.iter().map(|(f, text)| (self.names.show(notation, f), text.clone())).collect()
    }

    /// The efficiency for given arguments, exactly.
    ///
    /// # Errors
    /// Outside the regime, and for arguments without a value.
    ///
    /// # Example
    /// ```
    /// use willis::exact::Rational;
    /// use willis::regimes::{FormulaRequest, formulas};
    /// use willis::train::{SetSpec, Train};
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["s", "c"])
    ///     .terminals(["s", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).basic_efficiency(0.98))
    ///     .build()?;
    /// let sheet = formulas(&train, &FormulaRequest::default())?;
    /// let formula = &sheet.formulas[0];
    /// assert_eq!(formula.efficiency(willis::symbolic::Notation::Text), "(1 - i0*eta0)/(1 - i0)");
    /// let at = |i0: Rational| {
    ///     formula.evaluate(&|name| match name {
    ///         "i0" => Some(i0.clone()),
    ///         _ => Some(Rational::new(98, 100)),
    ///     })
    /// };
    /// // (1 + 7/3 · 0.98)/(1 + 7/3)
    /// assert_eq!(at(Rational::new(-7, 3)), Ok(Rational::new(493, 500)));
    /// // With a basic ratio of 1/2 another end would drive: no number.
    /// assert!(at(Rational::new(1, 2)).is_err());
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn evaluate(&self, value: &dyn Fn(&str) -> Option<Rational>) -> Result<Rational, FormulaError> {
        let mut values: Vec<(Symbol, Rational)> = Vec::new();
        for a in &self.arguments {
            let v = value(&a.name).ok_or_else(|| FormulaError::Missing(a.name.clone()))?;
            if let (false, Some(outside)) = (a.allows(&v), a.range()) {
                return Err(outside);
            }
            values.push((a.symbol, v));
        }
        // Dependent speeds and torques from the given ones.
        for (symbol, function) in self.dependent() {
            let v = function.evaluate(&lookup(&values)).ok_or(FormulaError::Pole)?;
            values.push((symbol, v));
        }
        let of = lookup(&values);
        for (f, text) in &self.conditions {
            if f.evaluate(&of).is_none_or(|v| v.sign() <= 0) {
                return Err(FormulaError::Condition(text.clone()));
            }
        }
        self.efficiency.evaluate(&of).ok_or(FormulaError::Pole)
    }

    /// Derivatives of the efficiency with respect to every efficiency in it, the one that costs
    /// most first.
    pub fn derivatives(&self) -> Vec<Derivative> {
        let values: Vec<(Symbol, Rational)> = self.values();
        let mut all: Vec<Derivative> = self
            .arguments
            .iter()
            .filter(|a| a.efficiency)
            .map(|a| {
                let d = self.efficiency.derivative(a.symbol);
                let value = d.evaluate(&lookup(&values)).map_or(f64::NAN, |v| v.to_f64());
                Derivative {
                    of: a.name.clone(),
                    formula: self.names.show(Notation::Text, &d),
                    latex: self.names.show(Notation::Latex, &d),
                    value,
                    share: (1.0 - a.value) * value,
                }
            })
            .collect();
        all.sort_by(|a, b| b.share.total_cmp(&a.share));
        all
    }

    /// The arguments' own values and what follows from them.
    fn values(&self) -> Vec<(Symbol, Rational)> {
        let mut values: Vec<(Symbol, Rational)> = self.arguments.iter().map(|a| (a.symbol, a.exact.clone())).collect();
        for (symbol, function) in self.dependent() {
            let known = function.evaluate(&lookup(&values));
            values.extend(known.map(|v| (symbol, v)));
        }
        values
    }

    /// Speeds and then torques that follow from those given, in an order in which they can be
    /// evaluated: with balanced powers a torque depends on dependent speeds.
    pub(crate) fn dependent(&self) -> impl Iterator<Item = (Symbol, &RationalFunction)> {
        let speeds = self.terminals.iter().filter(|t| !t.given_speed).map(|t| (t.speed_symbol, &t.speed));
        let torques = self.terminals.iter().filter(|t| !t.given_torque).map(|t| (t.torque_symbol, &t.torque));
        speeds.chain(torques)
    }

    /// `ω_from/ω_to` and `T_to/T_from` with the arguments' own values (one degree of freedom).
    pub fn ratio_values(&self) -> Option<[f64; 2]> {
        let values = self.values();
        let [speed, torque] = self.ratios.as_ref()?;
        Some([speed.evaluate(&lookup(&values))?.to_f64(), torque.evaluate(&lookup(&values))?.to_f64()])
    }

    /// Efficiency with the arguments' own values.
    pub fn value(&self) -> Option<Rational> {
        self.efficiency.evaluate(&lookup(&self.values()))
    }
}

fn lookup(values: &[(Symbol, Rational)]) -> impl Fn(Symbol) -> Rational {
    |s| values.iter().find(|(t, _)| *t == s).map_or(Rational::ONE, |(_, v)| v.clone())
}

/// The closed formulas of a train.
///
/// # Errors
/// A state, terminal or regime that the train does not have, and requests that contradict each
/// other.
pub fn formulas(train: &Train, request: &FormulaRequest) -> Result<FormulaSheet, Diagnostics> {
    let selection = RegimeSelection {
        state: request.state.clone(),
        terminals: request.terminals.clone(),
        balance: request.balance.clone(),
    };
    let mut sheet = FormulaSheet { train: train.name.clone(), formulas: vec![], without: vec![] };
    let mut errors = Diagnostics::default();
    let mut ends = |names: &[String]| -> Vec<MemberId> {
        names
            .iter()
            .filter_map(|name| {
                let found = train.member(name);
                if found.is_none() {
                    let known: Vec<&str> = train.members.iter().skip(1).map(|m| m.name.as_str()).collect();
                    let d = Diagnostic::new(Code::UnknownName, "", format!("the train has no member `{name}`"));
                    errors.push(
                        d.suggest(name, known.iter().copied()).hint(format!("its members are: {}", known.join(", "))),
                    );
                }
                found
            })
            .collect()
    };
    let (from, to) = (ends(&request.from), ends(&request.to));
    for m in from.iter().filter(|m| to.contains(m)) {
        let text = format!("`{}` cannot be both input and output", train.member_name(*m));
        errors.push(Diagnostic::new(Code::Conflict, "", text));
    }
    let states = match selected(train, &selection) {
        Ok(states) => states,
        Err(wrong) => {
            errors.extend(wrong);
            return Err(errors);
        }
    };
    if errors.has_errors() {
        return Err(errors);
    }
    let several = states.len() > 1;
    for super::SelectedConfiguration { state, configuration: c, terminals: members, balance, basis } in states {
        let [input, output] = train.ends(train.states.iter().position(|s| s.name == state));
        // As drawn is left out when a shift table says how the train is used.
        let unasked = several && state == AS_DRAWN;
        let found = if c.degrees_of_freedom() == 1 && request.regime.is_some() {
            Err("one degree of freedom: name the direction (`from` and `to`), not a regime".to_owned())
        } else if c.degrees_of_freedom() == 1 {
            let from = if from.is_empty() { input.into_iter().collect() } else { from.clone() };
            let to = if to.is_empty() { output.into_iter().collect() } else { to.clone() };
            one_freedom(&state, c, &from, &to, request)
        } else {
            several_freedoms(&state, c, (&members, balance), (&from, &to), request)
        };
        match found {
            Ok(list) => sheet.formulas.extend(list.into_iter().map(|f| ClosedFormula { basis: basis.clone(), ..f })),
            Err(_) if unasked => {}
            Err(why) => sheet.without.push((state, why)),
        }
    }
    number_names(&mut sheet.formulas);
    if let Some(regime) = &request.regime
        && sheet.formulas.is_empty()
    {
        let text = format!("no state asked for has a regime `{regime}`");
        errors.push(Diagnostic::new(Code::UnknownSelection, "", text).hint("`willis regimes` lists them"));
        return Err(errors);
    }
    Ok(sheet)
}

/// From one terminal to another: what the numeric solver finds for driving.
fn one_freedom(
    state: &str,
    c: Configuration<'_>,
    from: &[MemberId],
    to: &[MemberId],
    request: &FormulaRequest,
) -> Result<Vec<ClosedFormula>, String> {
    let ([from], [to]) = (from, to) else {
        return Err(
            "with one degree of freedom a formula needs one input and one output; name them (`from` and `to`)".into()
        );
    };
    let train = c.train;
    let (from, to) = (*from, *to);
    let [a, b] = [from, to].map(|m| train.member_name(m).to_owned());
    let c = Configuration::new(train, &c.engaged, &c.held, &[from, to]).with_efficiencies(c.efficiencies);
    if c.node(from).is_some() && c.node(from) == c.node(to) {
        return Err(format!("direct drive: {a} and {b} turn as one, no mesh is loaded and the efficiency is 1"));
    }
    for (m, name) in [(from, &a), (to, &b)] {
        if c.node(m).is_none() {
            return Err(format!("{name} is held"));
        }
    }
    let setup = Setup::new(c, &[from, to], Linked::Nothing)?;
    if setup.terminals.len() < 2 {
        return Err(format!("no load passes from {a} to {b}"));
    }
    let cells = enumerate(&setup)?;
    // The input turns forward; the mirror image has the same formulas.
    let k = (0..cells.regions.len())
        .find(|&k| super::arrangement::dot(setup.terminal_speed(0), &cells.regions[k].point).sign() > 0)
        .ok_or_else(|| format!("{a} cannot turn"))?;
    let base = &cells.regions[k].point;
    let shape = Shape::new(&setup, &[0])?;
    let mut all = Vec::new();
    for cell in &cells.torques[k] {
        let powers = power_signs(&setup, base, &cell.signs);
        if powers != [1, -1] {
            continue;
        }
        let own = shape.formula(&cell.pattern, &powers, request.ratios, request.efficiencies)?;
        let speed_ratio = own.speeds[0].over(&own.speeds[1]);
        let torque_ratio = own.torques[1].over(&own.torques[0]);
        let mut formula = closed(train, &setup, state, &own, &powers, &cell.pattern, base, &cell.torques);
        formula.title = format!("{a} drives {b}");
        formula.name = format!("{}_{}_to_{}", formula.name, short(&a), short(&b));
        formula.ratios = Some([speed_ratio, torque_ratio]);
        formula.keep_used();
        all.push(formula);
    }
    if all.is_empty() {
        return Err(format!("locked: friction lets {a} drive no load at {b}"));
    }
    if all.len() > 1 {
        for (n, f) in all.iter_mut().enumerate() {
            f.title += &format!(" (equilibrium {} of several)", n + 1);
            f.name += &format!("_{}", n + 1);
        }
    }
    Ok(all)
}

/// The formulas of all regimes with the roles asked for.
fn several_freedoms(
    state: &str,
    c: Configuration<'_>,
    (members, balance): (&[MemberId], Option<[MemberId; 2]>),
    (from, to): (&[MemberId], &[MemberId]),
    request: &FormulaRequest,
) -> Result<Vec<ClosedFormula>, String> {
    let train = c.train;
    let atlas = atlas(state.to_owned(), c.clone(), members, balance);
    if let Some(why) = atlas.reason {
        return Err(why);
    }
    let setup = Setup::new(c, members, Linked::of(balance))?;
    let shape = Shape::new(&setup, &[])?;
    let names = |ids: &[MemberId]| ids.iter().map(|m| train.member_name(*m).to_owned()).collect::<Vec<_>>();
    let (from, to) = (names(from), names(to));
    let wanted = |r: &&RegimeReport| {
        from.iter().all(|f| r.inputs.contains(f))
            && to.iter().all(|t| r.outputs.contains(t))
            && request.regime.as_ref().is_none_or(|id| *id == r.id)
    };
    let made = |r: &RegimeReport, efficiencies: Efficiencies| -> Result<Made, String> {
        let own = shape.formula(&r.pattern, &r.power_signs, request.ratios, efficiencies)?;
        let region = &atlas.regions[r.region - 1];
        let mut f = closed(train, &setup, state, &own, &r.power_signs, &r.pattern, &region.point, &r.torques);
        f.title = arrow(&f.inputs, &f.outputs);
        f.name = format!("{}_{}", f.name, r.formula.to_lowercase());
        f.regimes = atlas.regimes.iter().filter(|o| o.formula == r.formula).map(|o| o.id.clone()).collect();
        f.terminals = (0..setup.terminals.len())
            .map(|t| TerminalFormula {
                speed_symbol: own.names.speed(t),
                speed: own.speeds[t].clone(),
                torque_symbol: own.names.torque(t),
                torque: own.torques[t].clone(),
                given_speed: setup.base.contains(&t),
                given_torque: shape.reference[..setup.independent_torques()].contains(&t),
            })
            .collect();
        f.keep_used();
        f.beside = beside(&atlas.regimes, &setup, shape.reference[0], &f.regimes);
        Ok(Made { id: r.formula.to_lowercase(), own, formula: f })
    };
    let mut distinct: Vec<&RegimeReport> = Vec::new();
    for r in &atlas.regimes {
        if distinct.iter().all(|own| own.formula != r.formula) {
            distinct.push(r);
        }
    }
    let every = |efficiencies| distinct.iter().map(|r| made(r, efficiencies)).collect::<Vec<Result<Made, String>>>();
    let own = every(request.efficiencies);
    let mut all: Vec<ClosedFormula> = Vec::new();
    for (r, own) in distinct.iter().zip(&own) {
        if atlas.regimes.iter().any(|o| o.formula == r.formula && wanted(&o)) {
            all.push(own.as_ref().map_err(Clone::clone)?.formula.clone());
        }
    }
    if all.is_empty() {
        return Err(format!("no regime has the roles {}; `willis regimes` lists those there are", arrow(&from, &to)));
    }
    let name = format!("{}_equilibria", closed_name(train, state));
    let together =
        |own: Vec<Result<Made, String>>| together(&name, &own.into_iter().collect::<Result<Vec<_>, _>>().ok()?);
    // A symbol that stands for one number here and another there makes way for the numbers.
    let together = together(own).or_else(|| together(every(Efficiencies::Numbers)));
    let together = together.map(Arc::new);
    all.iter_mut().for_each(|f| f.together.clone_from(&together));
    Ok(all)
}

/// A formula of a state with several freedoms, as it is made and as it is shown.
struct Made {
    id: String,
    own: Formula,
    formula: ClosedFormula,
}

/// Regimes, other than those of a formula, in which the same speeds and the same torque on a terminal are answered.
fn beside(regimes: &[RegimeReport], setup: &Setup<'_>, reference: usize, own: &[String]) -> Vec<String> {
    if setup.independent_torques() != 1 {
        return vec![];
    }
    let place = |r: &RegimeReport| (r.region, r.torque_signs.0[reference].1);
    let places: Vec<_> = regimes.iter().filter(|r| own.contains(&r.id)).map(place).collect();
    let others = regimes.iter().filter(|r| !own.contains(&r.id) && places.contains(&place(r)));
    others.map(|r| r.id.clone()).collect()
}

/// All formulas of a state; `None` where one name stands for different numbers.
fn together(name: &str, all: &[Made]) -> Option<Together> {
    let mut arguments: Vec<Argument> = Vec::new();
    for a in all.iter().flat_map(|m| &m.formula.arguments) {
        match arguments.iter().find(|own| own.name == a.name) {
            // Speeds and torques are those of a point of each regime.
            Some(own) if own.fixed && own.exact != a.exact => return None,
            Some(_) => {}
            None => arguments.push(a.clone()),
        }
    }
    let first = &all.first()?.formula;
    let speeds = first.terminals.iter().filter(|t| !t.given_speed);
    Some(Together {
        name: name.to_owned(),
        speeds: speeds.map(|t| (t.speed_symbol, t.speed.clone(), first.names.clone())).collect(),
        all: (all.iter())
            .map(|Made { id, own, formula }| Holds {
                id: id.clone(),
                regimes: formula.regimes.clone(),
                title: formula.title.clone(),
                conditions: own.conditions.iter().map(|c| c.function.clone()).collect(),
                names: own.names.clone(),
            })
            .collect(),
        arguments,
    })
}

#[allow(clippy::too_many_arguments)]
fn closed(
    train: &Train,
    setup: &Setup<'_>,
    state: &str,
    own: &Formula,
    powers: &[i8],
    pattern: &Pattern,
    base: &[Rational],
    torques: &[Rational],
) -> ClosedFormula {
    let of = |sign: i8| -> Vec<String> {
        let chosen = (0..powers.len()).filter(|&t| powers[t] == sign);
        chosen.map(|t| setup.terminal_name(t).to_owned()).collect()
    };
    let arguments = (0..own.names.infos.len())
        .map(|k| {
            let info = &own.names.infos[k];
            let s = Symbol(k);
            let terminal = (0..setup.terminals.len()).find(|&t| own.names.speed(t) == s || own.names.torque(t) == s);
            let number = match (info.kind, terminal) {
                (SymbolKind::Speed, Some(t)) => super::arrangement::dot(setup.terminal_speed(t), base),
                (SymbolKind::Torque, Some(t)) => torques[t].clone(),
                _ => info.value.clone().unwrap_or(Rational::ONE),
            };
            Argument {
                name: info.name.clone(),
                latex: info.latex.clone(),
                meaning: info.meaning.clone(),
                made_of: info.made_of.clone(),
                value: number.to_f64(),
                exact: number,
                efficiency: info.kind == SymbolKind::Efficiency,
                fixed: info.value.is_some(),
                kind: info.kind,
                terminal: terminal.map(|t| setup.terminal_name(t).to_owned()),
                symbol: s,
            }
        })
        .collect();
    ClosedFormula {
        name: closed_name(train, state),
        title: String::new(),
        state: state.to_owned(),
        regimes: vec![],
        inputs: of(1),
        outputs: of(-1),
        drivers: NameMap(drivers(setup, pattern)),
        arguments,
        efficiency: own.efficiency.clone(),
        ratios: None,
        terminals: vec![],
        conditions: own.conditions.iter().map(|c| (c.function.clone(), c.meaning.clone())).collect(),
        names: own.names.clone(),
        together: None,
        beside: vec![],
        basis: None,
    }
}

/// What the names of all formulas of a state begin with.
fn closed_name(train: &Train, state: &str) -> String {
    let label = if state == AS_DRAWN { String::new() } else { format!("_state_{}", short(state)) };
    let name = short(&train.name) + &label;
    // Something compilers accept.
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("train_{name}") } else { name }
}

impl ClosedFormula {
    /// Leaves only arguments that occur, and those that are given.
    fn keep_used(&mut self) {
        let mut used: Vec<Symbol> = self.efficiency.symbols();
        used.extend(self.ratios.iter().flatten().flat_map(RationalFunction::symbols));
        used.extend(self.conditions.iter().flat_map(|(f, _)| f.symbols()));
        for t in &self.terminals {
            used.extend(t.speed.symbols());
            used.extend(t.torque.symbols());
        }
        for t in &self.terminals {
            // Dependent quantities are results, not arguments.
            used.retain(|s| (t.given_speed || *s != t.speed_symbol) && (t.given_torque || *s != t.torque_symbol));
        }
        for t in &self.terminals {
            used.extend(t.given_speed.then_some(t.speed_symbol));
            used.extend(t.given_torque.then_some(t.torque_symbol));
        }
        self.arguments.retain(|a| used.contains(&a.symbol));
    }
}

/// A name as a part of a function's name: words of small letters and digits, cut after a word.
fn short(name: &str) -> String {
    const LONGEST: usize = 24;
    let text = identifier(name).to_lowercase();
    let words: Vec<&str> = text.split('_').filter(|word| !word.is_empty()).collect();
    let Some(first) = words.first() else { return "x".to_owned() };
    let mut all = first[..first.len().min(LONGEST)].to_owned();
    for word in &words[1..] {
        if all.len() + 1 + word.len() > LONGEST {
            break;
        }
        all = format!("{all}_{word}");
    }
    all
}

/// Numbers the names that would be the same in a language, be it without underlines.
fn number_names(formulas: &mut [ClosedFormula]) {
    let mut used: Vec<String> = Vec::new();
    for f in formulas.iter_mut() {
        let plain = f.name.clone();
        let mut n = 2;
        while used.contains(&f.name.replace('_', "")) {
            f.name = format!("{plain}_{n}");
            n += 1;
        }
        used.push(f.name.replace('_', ""));
    }
    let mut renamed: Vec<(String, Arc<Together>)> = Vec::new();
    for f in formulas {
        let Some(together) = &f.together else { continue };
        let known = renamed.iter().find(|(state, _)| *state == f.state).map(|(_, own)| own.clone());
        f.together = Some(known.unwrap_or_else(|| {
            let mut own = Together::clone(together);
            let plain = own.name.clone();
            let mut n = 2;
            while used.contains(&own.name.replace('_', "")) {
                own.name = format!("{plain}_{n}");
                n += 1;
            }
            used.push(own.name.replace('_', ""));
            let own = Arc::new(own);
            renamed.push((f.state.clone(), own.clone()));
            own
        }));
    }
}
