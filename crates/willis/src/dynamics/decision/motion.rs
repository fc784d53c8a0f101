//! What is answered: accelerations and forces, and what each contact does.

/// A force or an acceleration: its value, the bound of its rounding error, and its rate.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::dynamics) struct Amount {
    pub value: f64,
    pub error: f64,
    pub rate: f64,
    pub rate_error: f64,
}

impl Amount {
    /// Sign just after the instant; 0 if value and rate are within their bounds.
    pub fn sign(&self) -> i8 {
        let sign = |x: f64, error: f64| if x > error { 1 } else { -i8::from(x < -error) };
        match sign(self.value, self.error) {
            0 => sign(self.rate, self.rate_error),
            sign => sign,
        }
    }
}

/// What a mesh does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::dynamics) struct MeshMotion {
    /// `f` and `e`.
    pub forces: [Amount; 2],
    /// Sign of its slip just after the instant; 0: it stays at rest.
    pub slip: i8,
    /// Whether gear 1 drives, the sign of its slip given.
    pub first_drives: bool,
}

/// What an element does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::dynamics) struct ElementMotion {
    /// On its first member.
    pub torque: Amount,
    /// Sign of its slip just after the instant; 0: it holds.
    pub slip: i8,
}

/// A motion.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in crate::dynamics) struct Motion {
    pub accelerations: Vec<Amount>,
    pub meshes: Vec<MeshMotion>,
    pub elements: Vec<ElementMotion>,
}

/// What was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::dynamics) enum Verdict {
    /// A motion. Whether it is proved that there is no other one.
    One { proved: bool },
    /// Two of different accelerations.
    Two,
    /// No motion agrees with the state.
    None,
    /// Holds prescribe what contradicts itself.
    Contradiction,
    /// The search was too long.
    Undecided,
}
