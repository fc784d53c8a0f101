//! The state of an instance as bytes: a head as JSON, and the run as the library writes it.

use serde::{Deserialize, Serialize};

use crate::instance::{Fail, Given, Instance, Phase, error};
use crate::layout::Value;

/// What such bytes begin with.
const MARK: &[u8; 8] = b"fmustate";

/// Numbers are written by their bits.
#[derive(Serialize, Deserialize)]
struct Head {
    token: String,
    exchanges: bool,
    phase: u8,
    offset: u64,
    reals: Vec<(usize, u64)>,
    integers: Vec<(usize, i64)>,
    inputs: Vec<(Option<u64>, u64, bool)>,
    runs: bool,
}

const PHASES: [Phase; 6] =
    [Phase::Instantiated, Phase::Initialization, Phase::Step, Phase::Event, Phase::Continuous, Phase::Terminated];

impl Instance {
    /// The whole state as bytes.
    pub fn bytes(&mut self) -> Vec<u8> {
        let phase = PHASES.iter().position(|p| *p == self.phase).unwrap_or_default();
        let mut head = Head {
            token: self.token.to_string(),
            exchanges: self.exchanges(),
            phase: phase as u8,
            offset: self.offset.to_bits(),
            reals: vec![],
            integers: vec![],
            inputs: self.inputs.iter().map(|g| (g.value.map(f64::to_bits), g.rate.to_bits(), g.pending)).collect(),
            runs: self.run.is_some(),
        };
        for (place, value) in &self.changed {
            match value {
                Value::Real(x) => head.reals.push((*place, x.to_bits())),
                Value::Integer(x) => head.integers.push((*place, *x)),
            }
        }
        let head = serde_json::to_vec(&head).expect("plain data");
        let run = self.run.as_mut().map_or(vec![], |run| run.save());
        let mut bytes = MARK.to_vec();
        bytes.extend((head.len() as u64).to_le_bytes());
        bytes.extend(head);
        bytes.extend(run);
        bytes
    }

    /// The state that bytes hold, as an instance like this one.
    ///
    /// # Errors
    /// They are none of this unit.
    pub fn of_bytes(&self, bytes: &[u8]) -> Result<Self, Fail> {
        let wrong = || error("these bytes are no state that was serialized by this unit");
        let (mark, rest) = bytes.split_at_checked(MARK.len()).ok_or_else(wrong)?;
        let (size, rest) = rest.split_at_checked(8).ok_or_else(wrong)?;
        let size = u64::from_le_bytes(size.try_into().map_err(|_| wrong())?);
        let size = usize::try_from(size).map_err(|_| wrong())?;
        let (head, run) = rest.split_at_checked(size).ok_or_else(wrong)?;
        let head: Head = serde_json::from_slice(head).map_err(|_| wrong())?;
        let places = head.reals.iter().map(|r| r.0).chain(head.integers.iter().map(|i| i.0));
        let own = mark == MARK
            && head.token == *self.token
            && head.exchanges == self.exchanges()
            && head.inputs.len() == self.inputs.len()
            && places.clone().all(|place| self.layout.variables.get(place).is_some_and(|v| v.role.is_parameter()));
        let phase = *PHASES.get(usize::from(head.phase)).filter(|_| own).ok_or_else(wrong)?;
        let mut new = self.clone();
        new.phase = phase;
        new.offset = f64::from_bits(head.offset);
        let reals = head.reals.iter().map(|(place, bits)| (*place, Value::Real(f64::from_bits(*bits))));
        new.changed = reals.chain(head.integers.iter().map(|(place, x)| (*place, Value::Integer(*x)))).collect();
        let given = |(value, rate, pending): &(Option<u64>, u64, bool)| Given {
            value: value.map(f64::from_bits),
            rate: f64::from_bits(*rate),
            pending: *pending,
        };
        let inputs: Vec<Given> = head.inputs.iter().map(given).collect();
        // The inputs of the start are of no matter: the run brings its own.
        new.inputs.fill(Given::default());
        let restored = match head.runs {
            false => None,
            true => {
                let mut blank = new.blank()?;
                blank.restore(run).map_err(|e| error(e.to_string()))?;
                Some(blank)
            }
        };
        new.inputs = inputs;
        new.take(restored);
        Ok(new)
    }
}
