//! A state that no operation describes, seen per unit of speed and torque at its input.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Ratio};
use crate::train::{AS_DRAWN, Load, MemberId, Operation, Train};
use crate::units::{Dimension, Quantity};

use super::{OperationReport, operate};

/// The operating point of a state in which the input turns at 1 rad/s under 1 N m and nothing else is driven.
pub(crate) struct UnitPoint {
    /// The train without the laws of its losses: units have no temperature, and no film of oil.
    pub train: Train,
    /// The member whose speed and torque are the units.
    pub input: MemberId,
    pub report: OperationReport,
}

impl UnitPoint {
    /// That of a state, or of the train as drawn.
    ///
    /// # Errors
    /// A state without an input and an output, one in which the speed of the input does not settle the others, and one in
    /// which the input cannot turn.
    pub fn new(train: &Train, state: Option<usize>) -> Result<Self, Diagnostics> {
        let own = state.map(|k| &train.states[k]);
        let what = own.map_or(AS_DRAWN.to_owned(), |s| format!("state `{}`", s.name));
        let refuse = |text: String, hint: &str| {
            let all: Diagnostics = Diagnostic::new(Code::Unfit, "", text).hint(hint).into();
            all
        };
        let [Some(input), Some(output)] = train.ends(state) else {
            let text = format!("{what} has no input and output, and no operation says how it turns and what loads it");
            return Err(refuse(text, "name two `terminals`, or `input` and `output`; or add an [[operation]]"));
        };
        let name = train.member_name(input);
        let c = Configuration::new(train, own.map_or(&[][..], |s| &s.engaged), &[], &[]);
        match c.ratio(input, output) {
            Ratio::Undetermined => return Err(refuse(open(&c, &what, name), &missing(&c, state))),
            Ratio::InputLocked => {
                let text = format!("{name} cannot turn in {what}, so nothing can be told per unit of it");
                return Err(refuse(text, "add an [[operation]] in which another member turns"));
            }
            Ratio::Exact(_) | Ratio::OutputAtRest => {}
        }
        let unit = |dimension| Quantity { value: Rational::ONE, pi_power: 0, dimension };
        let none = Quantity { value: Rational::ZERO, ..unit(Dimension::TORQUE) };
        let idle = train.terminals.iter().filter(|m| **m != input && **m != output);
        let mut loads = vec![(input, Load::Torque(unit(Dimension::TORQUE)))];
        loads.extend(idle.map(|m| (*m, Load::Torque(none.clone()))));
        let speeds = vec![(input, unit(Dimension::ANGULAR_SPEED))];
        let operation = Operation { state, speeds, loads, ..Operation::new(format!("{name} at 1 rad/s and 1 N m")) };
        let plain = train.without_laws();
        let (report, _) = operate(&plain, &operation)?;
        Ok(Self { train: plain, input, report })
    }
}

/// What is not settled.
fn open(c: &Configuration<'_>, what: &str, input: &str) -> String {
    let freedoms = c.degrees_of_freedom();
    format!(
        "no operation describes {what}, and with {freedoms} degrees of freedom the speed of {input} alone does not settle \
         the others"
    )
}

/// The operation that would settle it.
fn missing(c: &Configuration<'_>, state: Option<usize>) -> String {
    let train = c.train;
    let freedoms = c.degrees_of_freedom();
    let loads = c.loading(&train.terminals).len().max(1);
    let state = state.map(|k| format!("state = \"{}\", ", train.states[k].name)).unwrap_or_default();
    let loads = if loads == 1 { "1 torque or power".to_owned() } else { format!("{loads} torques or powers") };
    format!("add an [[operation]] with {state}{freedoms} independent speeds and {loads}")
}
