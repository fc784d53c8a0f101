//! What swings in a train: inertias, elastic shafts, viscous dampers.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::train::{FRAME, Inertia, MemberId, Mesh, Train};

/// A shaft or a drag with viscous damping.
pub(super) struct Damper<'t> {
    pub name: &'t str,
    pub members: [MemberId; 2],
    /// c, N m s/rad.
    pub coefficient: f64,
}

/// A shaft, or a mesh that does not tie its gears.
pub(super) struct Spring<'t> {
    pub name: &'t str,
    /// Its strain over the angles of members.
    pub strain: Vec<(MemberId, Rational)>,
    /// Torque over strain, N m/rad.
    pub stiffness: f64,
}

/// What swings in a train.
pub(super) struct Oscillator<'t> {
    pub train: &'t Train,
    pub rotors: Vec<&'t Inertia>,
    pub springs: Vec<Spring<'t>>,
    pub dampers: Vec<Damper<'t>>,
    /// Whether a shaft that may part is among the springs.
    has_backlash: bool,
}

impl<'t> Oscillator<'t> {
    /// # Errors
    /// No inertia at all.
    pub fn of(train: &'t Train) -> Result<Self, Diagnostics> {
        let shafts = || train.shafts.iter().filter(|s| s.stiffness > 0.0);
        let has_backlash = shafts().any(|s| s.backlash > 0.0);
        let twisted = |[a, b]: [MemberId; 2]| vec![(a, Rational::ONE), (b, -Rational::ONE)];
        let springs = shafts()
            .map(|s| Spring { name: &s.name, strain: twisted(s.members), stiffness: s.stiffness })
            .chain(train.meshes.iter().filter_map(spring))
            .collect();
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
        Ok(Self { train, rotors, springs, dampers, has_backlash })
    }

    /// Members between which inertias and shafts act, those of inertias first; the frame is none.
    pub fn swinging(&self) -> impl Iterator<Item = MemberId> + '_ {
        let rotors = self.rotors.iter().map(|j| [j.member, j.reference]);
        let strained = self.springs.iter().flat_map(|s| s.strain.iter().map(|(m, _)| *m));
        rotors.flatten().chain(strained).filter(|m| *m != FRAME)
    }

    /// Members whose motion is asked for; of all others it does not matter.
    pub fn members(&self) -> Vec<MemberId> {
        self.swinging().chain(self.dampers.iter().flat_map(|d| d.members)).collect()
    }

    /// What stands in for data that were not given.
    pub fn assumptions(&self) -> Vec<String> {
        let elastic = self.train.meshes.iter().filter(|m| spring(m).is_some()).count();
        let meshes = match elastic {
            0 => "meshes are rigid",
            n if n == self.train.meshes.len() => "meshes have their mean stiffness",
            _ => "meshes have their mean stiffness where one is given, and are rigid elsewhere",
        };
        let mut assumptions = vec![format!("{meshes}; friction other than viscous is left out")];
        if elastic > 0 {
            assumptions.push("the planets of a set are alike and evenly spaced; axes of gears do not move".to_owned());
        }
        if self.train.meshes.iter().filter_map(|m| m.teeth.as_ref()).any(|t| t.stiffness_by_standard) {
            let what = "stiffness that is not given follows from the teeth (ISO 6336-1, method B)";
            assumptions.push(format!("{what}: solid discs, more than 100 N per mm of face width"));
        }
        if self.has_backlash {
            assumptions.push("shafts with backlash are taken as in contact".to_owned());
        }
        if self.train.shift_elements.iter().any(|e| e.blocks != 0) {
            assumptions.push("one-way clutches are open unless the state engages them".to_owned());
        }
        assumptions
    }
}

/// The spring of a mesh that does not tie its gears: how far the flanks of all its pairs approach along the line of
/// action, over `r_b1/z_1 = r_b2/z_2`, so that its coefficients are tooth counts.
pub(super) fn spring(mesh: &Mesh) -> Option<Spring<'_>> {
    let teeth = mesh.teeth.as_ref()?;
    let [first, second] = &mesh.gears;
    let other = if mesh.same_sense { -second.teeth.clone() } else { second.teeth.clone() };
    let carried = -(&first.teeth + &other);
    let arm = teeth.pair.gears[0].base_radius / first.teeth.to_f64();
    Some(Spring {
        name: &mesh.name,
        strain: vec![(first.member, first.teeth.clone()), (second.member, other), (mesh.carrier, carried)],
        stiffness: teeth.stiffness? * f64::from(mesh.count) * arm * arm,
    })
}
