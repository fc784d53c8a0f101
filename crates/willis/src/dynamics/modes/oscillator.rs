//! What swings in a train: inertias, elastic shafts, viscous dampers.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::{FRAME, Inertia, MemberId, Shaft, Train};

/// A shaft or a drag with viscous damping.
pub(super) struct Damper<'t> {
    pub name: &'t str,
    pub members: [MemberId; 2],
    /// c, N m s/rad.
    pub coefficient: f64,
}

/// What swings in a train.
pub(super) struct Oscillator<'t> {
    pub train: &'t Train,
    pub rotors: Vec<&'t Inertia>,
    pub springs: Vec<&'t Shaft>,
    pub dampers: Vec<Damper<'t>>,
}

impl<'t> Oscillator<'t> {
    /// # Errors
    /// No inertia at all.
    pub fn of(train: &'t Train) -> Result<Self, Diagnostics> {
        let springs: Vec<_> = train.shafts.iter().filter(|s| s.stiffness > 0.0).collect();
        let rotors: Vec<_> = train.inertias.iter().filter(|j| j.value > 0.0).collect();
        if rotors.is_empty() {
            let d = Diagnostic::new(Code::MissingKey, "", "no member has a moment of inertia, so nothing can vibrate");
            return Err(d.hint("give the moments of inertia of the members in `inertias`").into());
        }
        let damping = train.shafts.iter().map(|s| (s.name.as_str(), s.members, s.damping));
        let drags = train.drags.iter().map(|d| (d.name.as_str(), d.members, d.viscous));
        let dampers = (damping.chain(drags))
            .map(|(name, members, coefficient)| Damper { name, members, coefficient })
            .filter(|d| d.coefficient > 0.0)
            .collect();
        Ok(Self { train, rotors, springs, dampers })
    }

    /// Members between which inertias and shafts act, those of inertias first; the frame is none.
    pub fn swinging(&self) -> impl Iterator<Item = MemberId> + '_ {
        let rotors = self.rotors.iter().map(|j| [j.member, j.reference]);
        rotors.chain(self.springs.iter().map(|s| s.members)).flatten().filter(|m| *m != FRAME)
    }

    /// Members whose motion is asked for; of all others it does not matter.
    pub fn members(&self) -> Vec<MemberId> {
        self.swinging().chain(self.dampers.iter().flat_map(|d| d.members)).collect()
    }

    /// What stands in for data that were not given.
    pub fn assumptions(&self) -> Vec<String> {
        let mut assumptions = vec!["meshes are rigid; friction other than viscous is left out".to_owned()];
        if self.springs.iter().any(|s| s.backlash > 0.0) {
            assumptions.push("shafts with backlash are taken as in contact".to_owned());
        }
        if self.train.shift_elements.iter().any(|e| e.blocks != 0) {
            assumptions.push("one-way clutches are open unless the state engages them".to_owned());
        }
        assumptions
    }
}
