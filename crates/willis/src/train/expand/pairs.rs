//! The pairs of gears that become the meshes of a set.

use crate::exact::Rational;
use crate::train::MemberId;
use crate::train::described::GivenGear;
use crate::train::specification::PlainTooth;

/// A gear of a mesh to be.
#[derive(Clone)]
pub(super) struct PairGear {
    pub member: MemberId,
    pub teeth: Rational,
    pub internal: bool,
    pub tooth: PlainTooth,
}

/// The two gears of a mesh to be.
pub(super) struct Pair<'s> {
    pub name: String,
    /// The central gear, as it was described; none between two planets.
    pub central: Option<&'s GivenGear>,
    /// First gear first: the efficiency's "forward" is that it drives.
    pub gears: [PairGear; 2],
    pub same_sense: bool,
    pub bevel: bool,
}

impl<'s> Pair<'s> {
    /// A central gear with a planet, whichever is named first.
    pub fn central(name: impl Into<String>, central: &'s GivenGear, first: PairGear, second: PairGear) -> Self {
        Self { central: Some(central), ..Self::planets(name, first, second) }
    }

    /// Two planets.
    pub fn planets(name: impl Into<String>, first: PairGear, second: PairGear) -> Self {
        let same_sense = first.internal || second.internal;
        Self { name: name.into(), central: None, gears: [first, second], same_sense, bevel: false }
    }

    /// The member of the central gear: the one that is not the planet of a pair.
    pub fn central_member(&self) -> Option<MemberId> {
        let internal = self.central?.internal;
        // A sun is written first, a ring second.
        Some(self.gears[usize::from(internal)].member)
    }

    /// The planet that the central gear meshes with.
    pub fn planet_member(&self) -> Option<MemberId> {
        self.gears.iter().find(|g| Some(g.member) != self.central_member()).map(|g| g.member)
    }
}

/// What meshes in a set.
pub(super) struct SetPairs<'s> {
    /// How many planets stand side by side, each with all the pairs, where it is given.
    pub count: Option<u32>,
    pub pairs: Vec<Pair<'s>>,
}
