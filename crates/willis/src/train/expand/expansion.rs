//! A set on its way to meshes, and how the gears that its description names are read.

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::train::MemberId;
use crate::train::assembler::Assembler;
use crate::train::described::{GivenGear, GivenPlanet, GivenSet};
use crate::train::words::clip;

use super::pairs::PairGear;

/// A set of which the meshes are sought.
pub(super) struct Expansion<'s, 'l> {
    pub a: &'s mut Assembler<'l>,
    pub set: &'s GivenSet,
    /// Where it stands in the train file.
    pub place: String,
    /// None where the name is wrong, which was reported.
    pub carrier: Option<MemberId>,
    /// The rotors of its planets, in the order of [`GivenSet::planets`].
    pub planets: &'s [MemberId],
}

impl Expansion<'_, '_> {
    /// A central gear, under its key in the train file.
    pub fn central(&mut self, g: &GivenGear, key: &str) -> Option<PairGear> {
        let place = format!("{}.{key}", self.place);
        let teeth = self.a.teeth(g.teeth, &format_args!("{place}.teeth"));
        let member = self.a.resolve(&g.member, &format_args!("{place}.member"))?;
        if Some(member) == self.carrier {
            let set = clip(&self.set.name);
            let message = format!("`{}` is both the {} and the carrier of set `{set}`", g.member, g.role());
            self.a.report(
                Diagnostic::new(Code::ImpossibleMesh, format!("{place}.member"), message)
                    .hint("a locked set is made with a clutch, not by naming one member twice"),
            );
        }
        Some(PairGear { member, teeth, internal: g.internal, tooth: g.tooth.clone() })
    }

    /// How many planets there are of a kind.
    pub fn count(&mut self, p: &GivenPlanet, key: &str) -> Option<u32> {
        p.count.map(|c| self.a.count(c, &format_args!("{}.{key}.count", self.place)))
    }

    /// How many pairs of planets there are, from either of the two kinds.
    pub fn count_of_pairs(&mut self, first: (&GivenPlanet, &str), second: (&GivenPlanet, &str)) -> Option<u32> {
        let counts = (self.count(first.0, first.1), self.count(second.0, second.1));
        if let (Some(n), Some(other)) = counts
            && n != other
        {
            let message = format!("set `{}`: its planets mesh in pairs, {n} with {other} do not", clip(&self.set.name));
            let place = format!("{}.{}.count", self.place, second.1);
            self.a.report(Diagnostic::new(Code::Conflict, place, message).hint("give one count, or twice the same"));
        }
        counts.0.or(counts.1)
    }

    /// The teeth of a planet, where they are given.
    pub fn planet_teeth(&mut self, p: &GivenPlanet, key: &str) -> Option<Rational> {
        p.teeth.map(|t| self.a.teeth(t, &format_args!("{}.{key}.teeth", self.place)))
    }

    /// A planet with teeth of this number, by its position among those of the set.
    pub fn planet(&self, k: usize, teeth: Rational, p: &GivenPlanet) -> PairGear {
        PairGear { member: self.planets[k], teeth, internal: false, tooth: p.tooth.clone() }
    }
}
