//! Between which values the laws of loss put an efficiency: each law of a kind of loss in the place of the one in force.

use serde::{Deserialize, Serialize};

use crate::losses::{self, FAMILIES, LawSummary, Tag};
use crate::operating_point::Physics;
use crate::train::{LossPart, MemberId, Operation, Train};

use super::operation::{Settled, settle_at};
use super::{LossSource, NameMap, Verdict};

/// Kinds of loss below this part of all losses keep their law: ten times as much of one would still be a hundredth of the
/// loss, far less than friction is uncertain by.
const WORTH_VARYING: f64 = 1e-3;

/// What an efficiency would be with other laws of loss: how far it is known.
///
/// Every law of each kind of loss is put in the place of the law in force, then the costliest and the cheapest law of all
/// kinds together. Laws outside their ranges count only where fewer than two are inside. Laws that reproduce a published
/// error, and those that leave a loss out, do not count. The oil temperature is held, and so are film, loss factor and load
/// sharing, which belong to the law of friction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LawBand {
    /// The lowest efficiency.
    pub low: BandEnd,
    /// The highest efficiency.
    pub high: BandEnd,
    /// By family, what its laws give while the other families keep theirs.
    pub families: NameMap<FamilyBand>,
}

/// An end of a band, which `--law` reproduces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BandEnd {
    /// Output over input power.
    pub efficiency: f64,
    /// All losses, W.
    pub loss_w: f64,
    /// The law of each family in the band.
    pub laws: NameMap<String>,
}

/// The laws of one family.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FamilyBand {
    /// The law in force.
    pub law: String,
    /// Whether that is inside its range here.
    pub in_range: bool,
    /// The efficiency with each law that counts.
    pub efficiencies: NameMap<f64>,
    /// Whether these are counted although fewer than two laws are inside their ranges.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub beyond_ranges: bool,
    /// Laws that do not count: outside their ranges, or without one answer.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<String>,
}

impl LawBand {
    /// That of an operating point at its oil temperature. `None` where it has no one efficiency, and where no law changes it.
    pub(super) fn of(train: &Train, operation: &Operation) -> Option<Self> {
        if !train.depends_on_load() {
            return None;
        }
        let settled = settle_at(train, operation, false).ok()?;
        let ([only], Verdict::Unique) = (&settled.report.solutions[..], settled.report.verdict) else { return None };
        let own = Seen { efficiency: only.efficiency?, loss_w: only.loss_w, outside: outside(&settled) };
        let entries = losses::entries();
        let varied = varied(train, &only.sources, only.loss_w, &entries);
        let visible = Physics::new(train, operation).visible();
        let base = Base { train, operation, settled, visible };
        let families: Vec<Family> = varied.into_iter().filter_map(|f| Family::of(f, &base, &own, &entries)).collect();
        let alone = |f: &Family| -> Vec<Candidate> {
            let of = |(law, seen): &(&'static str, Seen)| Candidate::new(vec![(f.name, *law)], seen);
            f.counted.iter().map(of).collect()
        };
        let mut found: Vec<Candidate> = families.iter().flat_map(alone).collect();
        if families.len() > 1 {
            for costly in [true, false] {
                let laws: Vec<_> = families.iter().map(|f| (f.name, f.extreme(costly))).collect();
                found.extend(base.seen(&laws).map(|seen| Candidate::new(laws, &seen)));
            }
        }
        let end = |c: &Candidate| {
            let law = |f: &Family| {
                let put = c.laws.iter().find(|l| l.0 == f.name).map_or(f.in_force, |l| l.1);
                (f.name.to_owned(), put.to_owned())
            };
            let laws = NameMap(families.iter().map(law).collect());
            BandEnd { efficiency: c.efficiency, loss_w: c.loss_w, laws }
        };
        let by = |a: &&Candidate, b: &&Candidate| a.efficiency.total_cmp(&b.efficiency);
        let (low, high) = (end(found.iter().min_by(by)?), end(found.iter().max_by(by)?));
        (low.efficiency < high.efficiency).then(|| Self {
            low,
            high,
            families: NameMap(families.into_iter().map(|f| (f.name.to_owned(), f.told())).collect()),
        })
    }

    /// So many decimals of a percentage the band supports: two digits of its width.
    ///
    /// # Example
    /// ```
    /// use willis::analysis::{Selection, analyze};
    /// use willis::train::Train;
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "one set"
    ///     members = ["s", "c"]
    ///     terminals = ["s", "c"]
    ///     [oil]
    ///     name = "ISO VG 220"
    ///     temperature = "70 degC"
    ///     [[set]]
    ///     name = "P1"
    ///     sun = { member = "s", teeth = 30 }
    ///     planet = { teeth = 20, count = 4 }
    ///     ring = { member = "frame", teeth = 70 }
    ///     carrier = "c"
    ///     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }
    ///     [[operation]]
    ///     name = "full load"
    ///     speeds = { s = "1000 rpm" }
    ///     torques = { s = "200 N m" }
    /// "#)?;
    /// let analysis = analyze(&train, &Selection::default())?.with_bands(&train);
    /// let band = analysis.operations[0].band.as_ref().unwrap();
    /// assert!(band.low.efficiency < band.high.efficiency);
    /// // Laws of friction disagree by more than a tenth of a percent.
    /// assert!(band.decimals() < 3);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn decimals(&self) -> usize {
        let width = 100.0 * (self.high.efficiency - self.low.efficiency);
        // As a cast of what is no number gives zero, so does a width of none.
        (1.0 - width.log10().floor()).clamp(0.0, 6.0) as usize
    }

    /// Whether only laws outside their ranges were left to compare in a family.
    pub fn beyond_ranges(&self) -> bool {
        self.families.iter().any(|(_, f)| f.beyond_ranges)
    }
}

/// What may be an end of a band.
struct Candidate {
    /// Family and law of what was put in force.
    laws: Vec<(&'static str, &'static str)>,
    efficiency: f64,
    loss_w: f64,
}

impl Candidate {
    fn new(laws: Vec<(&'static str, &'static str)>, seen: &Seen) -> Self {
        Self { laws, efficiency: seen.efficiency, loss_w: seen.loss_w }
    }
}

/// What is known of a point with some laws in force.
struct Seen {
    efficiency: f64,
    loss_w: f64,
    /// Family and law of what was outside its range.
    outside: Vec<(String, String)>,
}

fn outside(settled: &Settled<'_>) -> Vec<(String, String)> {
    settled.report.outside_laws.iter().map(|o| (o.family.clone(), o.law.clone())).collect()
}

/// The families whose laws make a loss that is worth varying, and that no test has settled.
fn varied(train: &Train, sources: &[LossSource], loss_w: f64, entries: &[LawSummary]) -> Vec<&'static str> {
    let family = |s: &LossSource| {
        let own = |f: &&&'static str| entries.iter().any(|e| e.family == **f && e.id == s.law);
        s.kind.families().iter().find(own).copied()
    };
    let share = |f: &str| sources.iter().filter(|s| family(s) == Some(f)).map(|s| s.loss_w).sum::<f64>();
    let tested = |f: &str| {
        let parts: &[LossPart] = match f {
            "mesh_friction" | "rolling" => &[LossPart::Teeth],
            "bearing" | "plain_bearing" => &[LossPart::BearingLoad, LossPart::BearingNoLoad],
            "seal" => &[LossPart::Seal],
            "churning" => &[LossPart::Churning],
            "windage" => &[LossPart::Windage],
            "rotor_drag" => &[LossPart::Rotor],
            _ => &[],
        };
        parts.iter().any(|p| train.loss_factors.spreads[*p as usize].is_some())
    };
    FAMILIES.iter().copied().filter(|f| share(f) > WORTH_VARYING * loss_w && !tested(f)).collect()
}

/// A family of laws at a point.
struct Family {
    name: &'static str,
    in_force: &'static str,
    in_range: bool,
    counted: Vec<(&'static str, Seen)>,
    beyond_ranges: bool,
    left_out: Vec<&'static str>,
}

impl Family {
    /// `None` where there is no choice.
    fn of(name: &'static str, base: &Base<'_>, own: &Seen, entries: &[LawSummary]) -> Option<Self> {
        let in_force = base.train.law_in_force(name)?;
        let is_outside = |law: &str, seen: &Seen| seen.outside.iter().any(|(f, l)| f == name && l == law);
        let chosen = entries.iter().filter(|e| {
            e.family == name && e.id != "none" && (e.id == in_force || !e.tags.contains(&Tag::Compatibility))
        });
        let mut left_out = vec![];
        let (mut inside, mut beyond) = (vec![], vec![]);
        for law in chosen.map(|e| e.id) {
            let seen = match law == in_force {
                true => Some(Seen { efficiency: own.efficiency, loss_w: own.loss_w, outside: own.outside.clone() }),
                false => base.seen(&[(name, law)]),
            };
            match seen {
                None => left_out.push(law),
                Some(seen) if is_outside(law, &seen) => beyond.push((law, seen)),
                Some(seen) => inside.push((law, seen)),
            }
        }
        let in_range = !is_outside(in_force, own);
        let beyond_ranges = inside.len() < 2 && !beyond.is_empty();
        let counted = match beyond_ranges {
            true => inside.into_iter().chain(beyond).collect(),
            false => {
                left_out.extend(beyond.into_iter().map(|b| b.0));
                inside
            }
        };
        let changes = counted.iter().any(|(_, seen): &(_, Seen)| seen.efficiency != own.efficiency);
        changes.then_some(Self { name, in_force, in_range, counted, beyond_ranges, left_out })
    }

    /// The law with the largest loss, or the smallest.
    fn extreme(&self, costly: bool) -> &'static str {
        let by = |a: &&(&str, Seen), b: &&(&str, Seen)| a.1.loss_w.total_cmp(&b.1.loss_w);
        let found = if costly { self.counted.iter().max_by(by) } else { self.counted.iter().min_by(by) };
        found.map_or(self.in_force, |(law, _)| law)
    }

    fn told(self) -> FamilyBand {
        FamilyBand {
            law: self.in_force.to_owned(),
            in_range: self.in_range,
            efficiencies: NameMap(self.counted.iter().map(|(law, s)| ((*law).to_owned(), s.efficiency)).collect()),
            beyond_ranges: self.beyond_ranges,
            left_out: self.left_out.into_iter().map(str::to_owned).collect(),
        }
    }
}

/// An operating point with the laws of the train, from which those with other laws are looked for.
struct Base<'a> {
    train: &'a Train,
    operation: &'a Operation,
    settled: Settled<'a>,
    /// Members that its statics sees apart because drags act on them.
    visible: Vec<MemberId>,
}

impl Base<'_> {
    /// The point with these laws; `None` where a law does not suit the train, or there is no one answer with it.
    fn seen(&self, laws: &[(&'static str, &str)]) -> Option<Seen> {
        let mut train = self.train.clone();
        for (family, law) in laws {
            train = train.with_law(family, law).ok()?;
        }
        self.near(&train).or_else(|| {
            let settled = settle_at(&train, self.operation, false).ok()?;
            let ([only], Verdict::Unique) = (&settled.report.solutions[..], settled.report.verdict) else {
                return None;
            };
            Some(Seen { efficiency: only.efficiency?, loss_w: only.loss_w, outside: outside(&settled) })
        })
    }

    /// The same in floating point from the equilibrium of the laws in force; `None` where that is not beyond doubt.
    fn near(&self, train: &Train) -> Option<Seen> {
        let (point, origin) = (self.settled.point.as_ref()?, self.settled.origin.as_ref()?);
        let physics = Physics::new(train, self.operation);
        if !physics.visible().iter().all(|m| self.visible.contains(m)) {
            return None;
        }
        let agreed = origin.again(point, self.operation, &physics)?;
        let (mut given, mut taken) = (0.0, 0.0);
        for x in &agreed.acting {
            let power = x.torque * agreed.flow.speeds[x.member.0];
            *(if power > 0.0 { &mut given } else { &mut taken }) += power.abs();
        }
        let strains = physics.strains(&agreed.step, &agreed.flow);
        let outside = strains.extrapolations.iter().map(|x| (x.family.to_owned(), x.law.to_owned())).collect();
        let loss_w = given - taken;
        (given > 0.0).then(|| Seen { efficiency: (taken / given).clamp(0.0, 1.0), loss_w, outside })
    }
}
