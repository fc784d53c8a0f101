//! Every way in which a train can run, and the closed formula for each.
//!
//! The speeds of a train with `d` freedoms are a `d`-dimensional space. The planes on which a
//! terminal is at rest, or a mesh has no relative motion, cut it into *regions*; within a region no
//! power changes its sign by speed and no relative speed does. In each region every choice of
//! drivers leaves a space of torques in equilibrium, cut in turn by the planes on which a tooth
//! force or a terminal torque is zero. A *regime* is one cell of both: its inputs, its outputs, its
//! drivers and so its efficiency formula are fixed throughout. The cells are enumerated exactly.
//!
//! Source: the method of Esmail 2018 (two freedoms, one set, his Table 1) made general and
//! completed by the cases between self-locking limits, where friction turns a torque round.

pub(crate) mod arrangement;
mod atlas;
mod basis;
mod cells;
mod closed;
mod emit;
mod family;
mod hub;
mod locate;
mod report;
pub(crate) mod formula;
pub(crate) mod setup;

use crate::contract::Format;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::kinematics::Configuration;
use crate::train::{AS_DRAWN, FRAME, MemberId, Operation, State, Train};

use atlas::atlas;
use setup::{Linked, Setup};

pub(crate) use atlas::arrow;
pub use basis::{EfficiencyBasis, NoBasis};
pub(crate) use cells::efficiency_at;
pub use closed::{Argument, ClosedFormula, Derivative, FormulaError, FormulaRequest, FormulaSheet, formulas};
pub use family::{Family, FamilyCase, FamilyRange, Group, Row, family};
pub use formula::{Efficiencies, Ratios, SymbolKind};
pub use locate::{Edge, LocateRequest, Located, Location, PrescribedRange, Prescribes, locate};
pub use report::{
    AssignmentReport, Atlas, BoundaryReport, ConditionReport, Crossing, ExamplePoint, FormulaReport, LinkReport,
    Neighbour, PlaneReport, Prescribed, RatioRange, Reach, RegimeReport, Regimes, RegionReport, SymbolReport,
    Threshold,
};

/// Which part of a train, and from which terminals.
#[derive(Clone, Debug, Default)]
pub struct RegimeSelection {
    /// A state of the shift table, or `as drawn`; `None` for all that have regimes.
    pub state: Option<String>,
    /// Members on which torque may act; `None` for the train's terminals.
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero, such as the two machines of a hybrid whose battery
    /// neither gives nor takes: a link within the train, without loss, so they are neither inputs nor outputs.
    pub balance: Option<[String; 2]>,
}

/// Enumerates the regimes of a train.
///
/// # Errors
/// A state or terminal that the train does not have.
///
/// # Example
/// ```
/// use willis::regimes::{RegimeSelection, regimes};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("power split")
///     .members(["engine", "generator", "wheels"])
///     .terminals(["engine", "generator", "wheels"])
///     .set(SetSpec::simple("P1", ("generator", 30), ("wheels", 78), "engine").planet(23, 4).mesh_efficiency(0.99))
///     .build()?;
/// let all = regimes(&train, &RegimeSelection::default())?;
/// assert_eq!(all.states[0].regimes.len(), 16);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn regimes(train: &Train, selection: &RegimeSelection) -> Result<Regimes, Diagnostics> {
    let mut states = Vec::new();
    for SelectedConfiguration { state, configuration, terminals, balance, basis } in selected(train, selection)? {
        let own = atlas(state, configuration, &terminals, balance);
        states.push(Atlas { efficiency_basis: basis, ..own });
    }
    // Unasked for, a train as drawn without regimes is no news when its states have some.
    if selection.state.is_none() && states.iter().any(|a: &Atlas| a.reason.is_none()) {
        states.retain(|a| a.reason.is_none() || a.state != AS_DRAWN);
    }
    Ok(Regimes { format: Format::new(), train: train.name.clone(), states })
}

/// A configuration that a selection names, with its terminals.
pub(crate) struct SelectedConfiguration<'t> {
    pub state: String,
    pub configuration: Configuration<'t>,
    pub terminals: Vec<MemberId>,
    pub balance: Option<[MemberId; 2]>,
    /// Where efficiencies come from that laws compute: they are in the configuration.
    pub basis: Option<EfficiencyBasis>,
}

/// The configurations that a selection names.
pub(crate) fn selected<'t>(
    train: &'t Train,
    selection: &RegimeSelection,
) -> Result<Vec<SelectedConfiguration<'t>>, Diagnostics> {
    selected_at(train, selection, &|_| None)
}

/// The same, with the losses of a point `here` in a state, where it has one.
fn selected_at<'t>(
    train: &'t Train,
    selection: &RegimeSelection,
    here: &dyn Fn(Option<usize>) -> Option<Operation>,
) -> Result<Vec<SelectedConfiguration<'t>>, Diagnostics> {
    let mut errors = Diagnostics::default();
    let mut members = |names: &[String]| {
        let mut all: Vec<MemberId> = Vec::new();
        for name in names {
            match train.member(name) {
                Some(FRAME) => errors.push(
                    Diagnostic::new(Code::NotATerminal, "", "the frame is at rest and no terminal")
                        .hint("name members that turn"),
                ),
                Some(id) if all.contains(&id) => {
                    errors.push(Diagnostic::new(Code::DuplicateName, "", format!("terminal `{name}` is named twice")));
                }
                Some(id) => all.push(id),
                None => {
                    let known = train.members.iter().skip(1).map(|m| m.name.as_str());
                    errors.push(Diagnostic::missing(Code::UnknownName, "member", name, known));
                }
            }
        }
        all
    };
    let named: Option<Vec<MemberId>> = selection.terminals.as_ref().map(|names| members(names));
    let balance: Option<Vec<MemberId>> = selection.balance.as_ref().map(|pair| members(pair));
    let balance = balance.and_then(|pair| <[MemberId; 2]>::try_from(pair).ok());
    let mut chosen: Vec<Option<&State>> = vec![];
    match &selection.state {
        None => {
            chosen.push(None);
            chosen.extend(train.states.iter().map(Some));
        }
        Some(name) => match train.find_configuration(Some(name)) {
            Ok(state) => chosen.push(state),
            Err(d) => errors.push(*d),
        },
    }
    if errors.has_errors() {
        return Err(errors);
    }
    Ok(chosen
        .into_iter()
        .map(|state| {
            let engaged = state.map_or(&[][..], |s| &s.engaged);
            let members = named.clone().unwrap_or_else(|| {
                // What a machine of a variator drives is driven from within.
                let within: Vec<MemberId> = train.variators.iter().flat_map(|v| v.members()).collect();
                let own = state.map(|s| [s.input, s.output]).into_iter().flatten().flatten();
                let own = own.filter(|m| !within.contains(m));
                let mut all = train.terminals.clone();
                all.extend(own.chain(train.input).chain(train.output));
                let mut distinct: Vec<MemberId> = Vec::new();
                all.into_iter().filter(|m| *m != FRAME).for_each(|m| {
                    if !distinct.contains(&m) {
                        distinct.push(m);
                    }
                });
                distinct
            });
            let configuration =
                Configuration::new(train, engaged, &[], &members).with_terminals_apart(&members, &members);
            let position = state.and_then(|s| train.states.iter().position(|own| own.name == s.name));
            let state = state.map_or(AS_DRAWN.to_owned(), |s| s.name.clone());
            let (configuration, basis) = match basis::basis(train, position, here(position).as_ref()) {
                Some((efficiencies, basis)) => (configuration.with_efficiencies(efficiencies), Some(basis)),
                None => (configuration, None),
            };
            SelectedConfiguration { state, configuration, terminals: members, balance, basis }
        })
        .collect())
}

/// The first state of a selection that has a wheel: two freedoms and one independent torque. `Err`
/// with diagnostics for unknown names, with words for a train of another kind.
pub(crate) fn choice_of_two<'t>(
    train: &'t Train,
    selection: &RegimeSelection,
) -> Result<(Atlas, Setup<'t>), Result<Diagnostics, String>> {
    let mut reason = None;
    for SelectedConfiguration { state, configuration, terminals, balance, basis } in
        selected(train, selection).map_err(Ok)?
    {
        let label = state.clone();
        let own = atlas(state, configuration.clone(), &terminals, balance);
        let own = Atlas { efficiency_basis: basis, ..own };
        match &own.reason {
            Some(why) => reason = reason.or(Some(format!("{label}: {why}"))),
            None if own.base_speeds.len() == 2 && own.independent_torques == 1 => {
                let setup = Setup::new(configuration, &terminals, Linked::of(balance)).map_err(Err)?;
                return Ok((own, setup));
            }
            None => {
                reason = reason.or(Some(format!(
                    "{label}: independent speeds {}, independent torques {}",
                    own.base_speeds.len(),
                    own.independent_torques
                )));
            }
        }
    }
    Err(Err(reason.unwrap_or_else(|| "the train has no state".to_owned())))
}
