//! What a name means in a train; else which names there are.

use crate::diagnostic::{Code, Diagnostic};

use super::{Operation, Scenario, State, Train};

/// Name of the train with nothing engaged, beside the states of its shift table.
pub const AS_DRAWN: &str = "as drawn";

impl Train {
    /// Position in [`Train::states`] of the state of that name.
    ///
    /// # Errors
    /// There is none: the diagnostic names the nearest one and lists all.
    pub fn find_state(&self, name: &str) -> Result<usize, Box<Diagnostic>> {
        let known = self.states.iter().map(|s| s.name.as_str());
        known.clone().position(|s| s == name).ok_or_else(|| missing("state", name, known))
    }

    /// The state of that name, or none for [`AS_DRAWN`] and where nothing is named.
    ///
    /// # Errors
    /// See [`Train::find_state`].
    pub fn find_configuration(&self, name: Option<&str>) -> Result<Option<&State>, Box<Diagnostic>> {
        match name {
            None | Some(AS_DRAWN) => Ok(None),
            Some(name) => match self.state(name) {
                Some(state) => Ok(Some(state)),
                None => Err(missing("state", name, self.states.iter().map(|s| s.name.as_str()).chain([AS_DRAWN]))),
            },
        }
    }

    /// The operation of that name; the first one where several have it.
    ///
    /// # Errors
    /// See [`Train::find_state`].
    pub fn find_operation(&self, name: &str) -> Result<&Operation, Box<Diagnostic>> {
        let found = self.operations.iter().find(|o| o.name == name);
        found.ok_or_else(|| missing("operation", name, self.operations.iter().map(|o| o.name.as_str())))
    }

    /// The scenario of that name.
    ///
    /// # Errors
    /// See [`Train::find_state`].
    pub fn find_scenario(&self, name: &str) -> Result<&Scenario, Box<Diagnostic>> {
        let known = self.scenarios.iter().map(|s| s.name.as_str());
        self.scenario(name).ok_or_else(|| missing("scenario", name, known))
    }
}

fn missing<'a>(what: &str, name: &str, known: impl Iterator<Item = &'a str> + Clone) -> Box<Diagnostic> {
    Box::new(Diagnostic::missing(Code::UnknownSelection, what, name, known))
}
