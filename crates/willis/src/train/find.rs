//! What a name means in a train; else which names there are.

use crate::diagnostic::{Code, Diagnostic};

use super::{MemberId, Operation, Scenario, ShiftElementId, State, Train};

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

    /// The member of that name.
    ///
    /// # Errors
    /// There is none; what was meant is suggested.
    ///
    /// ```
    /// use willis::train::{SetSpec, Train};
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["sun", "carrier"])
    ///     .terminals(["sun", "carrier"])
    ///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
    ///     .build()?;
    /// assert!(train.find_member("carrier").is_ok());
    /// assert_eq!(train.find_member("carier").unwrap_err().hints[0], "did you mean `carrier`?");
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn find_member(&self, name: &str) -> Result<MemberId, Box<Diagnostic>> {
        self.member(name).ok_or_else(|| missing("member", name, self.members.iter().map(|m| m.name.as_str())))
    }

    /// The shift element of that name.
    ///
    /// # Errors
    /// There is none; what was meant is suggested.
    ///
    /// ```
    /// use willis::train::Train;
    ///
    /// let text = "format = 1\nname = \"pair\"\nmembers = [\"a\", \"b\"]\nterminals = [\"a\", \"b\"]\n\
    ///             [[shift_element]]\nname = \"lock-up\"\nkind = \"clutch\"\nmembers = [\"a\", \"b\"]\n";
    /// let train = Train::from_toml(text)?;
    /// assert!(train.find_shift_element("lock-up").is_ok());
    /// assert_eq!(train.find_shift_element("lockup").unwrap_err().hints[0], "did you mean `lock-up`?");
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn find_shift_element(&self, name: &str) -> Result<ShiftElementId, Box<Diagnostic>> {
        let known = self.shift_elements.iter().map(|e| e.name.as_str());
        let found = known.clone().position(|own| own == name).map(ShiftElementId);
        found.ok_or_else(|| missing("shift element", name, known))
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
