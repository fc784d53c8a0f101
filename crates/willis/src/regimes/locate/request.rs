//! What is asked: an operating point by names, and what they stand for in the train.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::regimes::{RegimeSelection, SelectedConfiguration, selected_at};
use crate::train::{AS_DRAWN, Load, MemberId, Operation, Train};
use crate::units::Quantity;

/// An operating point to place.
#[derive(Clone, Debug, Default)]
pub struct LocateRequest {
    /// State of the shift table, or `as drawn`; `None` for as drawn, or the operation's state.
    pub state: Option<String>,
    /// Members on which torque may act; `None` for the train's terminals.
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero.
    pub balance: Option<[String; 2]>,
    /// An operation of the file that gives speeds and torques.
    pub operation: Option<String>,
    /// Speeds by member, as many as are independent.
    pub speeds: Vec<(String, Quantity)>,
    /// Torques by terminal, as many as are independent.
    pub torques: Vec<(String, Quantity)>,
    /// Powers into the train by terminal, in place of torques.
    pub powers: Vec<(String, Quantity)>,
}

/// What is prescribed, by members of the train.
#[derive(Default)]
pub(super) struct Given {
    pub speeds: Vec<(MemberId, Quantity)>,
    pub torques: Vec<(MemberId, Quantity)>,
    pub powers: Vec<(MemberId, Quantity)>,
    /// Members held from outside.
    pub held: Vec<MemberId>,
    /// Oil temperature of the operation, K, where it has one of its own.
    pub temperature: Option<f64>,
}

impl Given {
    /// The same as an operating point of a state, nameless.
    pub fn operation(&self, state: Option<usize>) -> Operation {
        let load = |(m, q): &(MemberId, Quantity), load: fn(Quantity) -> Load| (*m, load(q.clone()));
        let torques = self.torques.iter().map(|x| load(x, Load::Torque));
        Operation {
            state,
            speeds: self.speeds.clone(),
            fixed: self.held.clone(),
            loads: torques.chain(self.powers.iter().map(|x| load(x, Load::Power))).collect(),
            temperature: self.temperature,
            ..Operation::new("")
        }
    }
}

/// What a request and its operation prescribe, and the configuration that they name.
pub(super) fn read<'t>(
    train: &'t Train,
    request: &LocateRequest,
) -> Result<(Given, SelectedConfiguration<'t>), Diagnostics> {
    let mut errors = Diagnostics::default();
    let mut given = Given::default();
    let mut state = request.state.clone();
    if let Some(name) = &request.operation {
        let own = operation(train, name, &mut given, &mut errors);
        state = state.or(own);
    }
    typed(train, &request.speeds, &mut given.speeds, &mut errors);
    // A torque in place of a power that the operation prescribes, and the other way round.
    let named =
        |list: &[(String, Quantity)]| list.iter().filter_map(|(name, _)| train.member(name)).collect::<Vec<_>>();
    let (of_torques, of_powers) = (named(&request.torques), named(&request.powers));
    given.powers.retain(|(m, _)| !of_torques.contains(m));
    given.torques.retain(|(m, _)| !of_powers.contains(m));
    typed(train, &request.torques, &mut given.torques, &mut errors);
    typed(train, &request.powers, &mut given.powers, &mut errors);
    if let Some(m) = of_torques.iter().find(|m| of_powers.contains(m)) {
        let text = format!("both a torque and a power are given for {}", train.member_name(*m));
        errors.push(Diagnostic::new(Code::TooManyTorques, "", text).hint("at its speed one follows from the other"));
    }
    let selection = RegimeSelection {
        state: Some(state.unwrap_or_else(|| AS_DRAWN.to_owned())),
        terminals: request.terminals.clone(),
        balance: request.balance.clone(),
    };
    let choice = match selected_at(train, &selection, &|state| Some(given.operation(state))) {
        Ok(mut all) => all.pop(),
        Err(wrong) => {
            errors.extend(wrong);
            None
        }
    };
    match choice.filter(|_| !errors.has_errors()) {
        Some(choice) => Ok((given, choice)),
        None => Err(errors),
    }
}

/// Takes over what an operation of the file prescribes, and tells its state.
fn operation(train: &Train, name: &str, given: &mut Given, errors: &mut Diagnostics) -> Option<String> {
    let o = match train.find_operation(name) {
        Ok(operation) => operation,
        Err(d) => {
            errors.push(*d);
            return None;
        }
    };
    given.speeds.extend(o.speeds.iter().cloned());
    given.held.extend(&o.fixed);
    given.temperature = o.temperature;
    for (m, load) in &o.loads {
        match load {
            Load::Torque(q) => given.torques.push((*m, q.clone())),
            Load::Power(q) => given.powers.push((*m, q.clone())),
        }
    }
    o.state.map(|k| train.states[k].name.clone())
}

/// Adds quantities that the request itself names.
fn typed(train: &Train, given: &[(String, Quantity)], list: &mut Vec<(MemberId, Quantity)>, errors: &mut Diagnostics) {
    for (name, quantity) in given {
        match train.member(name) {
            Some(id) => {
                // What is typed wins over what the operation says.
                list.retain(|(m, _)| *m != id);
                list.push((id, quantity.clone()));
            }
            None => {
                let known: Vec<&str> = train.members.iter().skip(1).map(|m| m.name.as_str()).collect();
                let d = Diagnostic::new(Code::UnknownName, "", format!("the train has no member `{name}`"));
                errors.push(
                    d.suggest(name, known.iter().copied()).hint(format!("its members are: {}", known.join(", "))),
                );
            }
        }
    }
}
