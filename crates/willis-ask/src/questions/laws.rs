//! `laws`: the laws of losses, and the catalogues.

mod text;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use willis::catalogue::{bearing, oil};
use willis::contract::Contract;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::losses::{self, LawList};
use willis::work::Work;

use super::names;
#[cfg(feature = "clap")]
use super::names::Known;
use crate::table::Kind::{Flag, Number, Text};
use crate::table::Table;
use crate::{Given, Of, Question, Refusal};

/// List every loss law with its range, source and how far it was checked.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[cfg_attr(feature = "clap", derive(clap::Args))]
#[serde(default, deny_unknown_fields)]
pub struct Laws {
    /// Only this family.
    #[cfg_attr(feature = "clap", arg(long, value_parser = Known(names::families), hide_possible_values = true))]
    #[schemars(extend("enum" = names::or_none(names::families())))]
    pub family: Option<String>,
    /// List the catalogue of oils instead.
    #[cfg_attr(feature = "clap", arg(long, conflicts_with_all = ["family", "bearings"]))]
    pub oils: bool,
    /// List the catalogue of bearings instead.
    #[cfg_attr(feature = "clap", arg(long, conflicts_with = "family"))]
    pub bearings: bool,
}

/// Laws, or a catalogue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct LawsAnswer {
    /// The laws; none where a catalogue was asked for.
    #[serde(flatten)]
    pub list: LawList,
    /// The catalogue of oils, where it was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub oils: Vec<OneOil>,
    /// The catalogue of bearings, where it was asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bearings: Vec<OneBearing>,
}

impl Contract for LawsAnswer {
    const FORMAT: &'static str = LawList::FORMAT;
}

/// An oil of the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneOil {
    /// Its designation.
    pub name: String,
    /// Its base.
    pub base: String,
    /// Kinematic viscosity at 40 °C, m²/s; absent where it is not known there.
    pub viscosity_40_m2_s: Option<f64>,
    /// Kinematic viscosity at 100 °C, m²/s; absent where it is not known there.
    pub viscosity_100_m2_s: Option<f64>,
    /// Density at 15 °C, kg/m³.
    pub density_15_kg_m3: f64,
    /// How far its data were checked.
    pub trust: String,
}

/// A bearing of the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[non_exhaustive]
pub struct OneBearing {
    /// Its designation.
    pub designation: String,
    /// Its kind.
    pub kind: String,
    /// Bore, m.
    pub bore_m: f64,
    /// Outside diameter, m.
    pub outside_diameter_m: f64,
    /// Width, m.
    pub width_m: f64,
    /// Static load rating, N, where it is known.
    pub static_rating_n: Option<f64>,
    /// Whether the constants of the SKF friction model are known.
    pub skf: bool,
    /// How far its data were checked.
    pub trust: String,
}

/// The word under which a datum of the catalogue is written.
fn word(datum: &impl Serialize) -> String {
    serde_json::to_value(datum).ok().and_then(|v| v.as_str().map(str::to_owned)).unwrap_or_default()
}

fn one_oil(o: &oil::Oil) -> OneOil {
    let fixed = matches!(o.viscosity, oil::Viscosity::Fixed { .. });
    let nu = |t: f64| (o.covers(t) && !fixed).then(|| o.kinematic_viscosity(t));
    OneOil {
        name: o.name.clone(),
        base: word(&o.base),
        viscosity_40_m2_s: nu(313.15),
        viscosity_100_m2_s: nu(373.15),
        density_15_kg_m3: o.density_15,
        trust: word(&o.trust),
    }
}

fn one_bearing(b: &bearing::Bearing) -> OneBearing {
    OneBearing {
        designation: b.designation.clone(),
        kind: b.kind.to_string(),
        bore_m: b.bore,
        outside_diameter_m: b.outside_diameter,
        width_m: b.width,
        static_rating_n: b.static_rating,
        skf: b.skf.is_some(),
        trust: word(&b.trust),
    }
}

impl Question for Laws {
    const NAME: &'static str = "laws";
    const OF: Of = Of::Nothing;
    const TABLES: &'static [&'static str] = &["laws", "oils", "bearings"];
    type Answer = LawsAnswer;

    fn check(&self) -> Result<(), Diagnostics> {
        names::apart(&[
            [("oils", self.oils), ("bearings", self.bearings)],
            [("oils", self.oils), ("family", self.family.is_some())],
            [("bearings", self.bearings), ("family", self.family.is_some())],
        ])
    }

    fn ask(&self, _: &[Given], _: &dyn Work) -> Result<LawsAnswer, Refusal> {
        let mut list = losses::list(self.family.as_deref());
        if let (Some(family), true) = (&self.family, list.laws.is_empty()) {
            let known = || losses::FAMILIES.iter().copied();
            let all = known().collect::<Vec<_>>().join(", ");
            return Err(Diagnostic::new(Code::UnknownSelection, "", format!("there is no family of laws `{family}`"))
                .suggest(family, known())
                .hint(format!("the families are: {all}"))
                .into());
        }
        let mut answer = LawsAnswer { list: list.clone(), oils: vec![], bearings: vec![] };
        if self.oils || self.bearings {
            list.laws.clear();
            answer.list = list;
        }
        if self.oils {
            answer.oils = oil::all().iter().map(one_oil).collect();
        }
        if self.bearings {
            answer.bearings = bearing::all().iter().map(one_bearing).collect();
        }
        Ok(answer)
    }

    fn text(&self, answer: &LawsAnswer, _: &[Given]) -> String {
        match (self.oils, self.bearings) {
            (true, _) => text::oils(&answer.oils),
            (_, true) => text::bearings(&answer.bearings),
            _ => text::laws(&answer.list),
        }
    }

    fn tables(&self, answer: &LawsAnswer) -> Vec<Table> {
        if self.oils {
            let mut t = Table::new(
                "oils",
                [
                    ("oil", Text),
                    ("base", Text),
                    ("viscosity_40_m2_s", Number),
                    ("viscosity_100_m2_s", Number),
                    ("density_15_kg_m3", Number),
                    ("trust", Text),
                ],
            );
            for o in &answer.oils {
                t.row([
                    (&o.name).into(),
                    (&o.base).into(),
                    o.viscosity_40_m2_s.into(),
                    o.viscosity_100_m2_s.into(),
                    o.density_15_kg_m3.into(),
                    (&o.trust).into(),
                ]);
            }
            return vec![t];
        }
        if self.bearings {
            let mut t = Table::new(
                "bearings",
                [
                    ("bearing", Text),
                    ("kind", Text),
                    ("bore_m", Number),
                    ("outside_diameter_m", Number),
                    ("width_m", Number),
                    ("static_rating_n", Number),
                    ("skf_constants", Flag),
                    ("trust", Text),
                ],
            );
            for b in &answer.bearings {
                t.row([
                    (&b.designation).into(),
                    (&b.kind).into(),
                    b.bore_m.into(),
                    b.outside_diameter_m.into(),
                    b.width_m.into(),
                    b.static_rating_n.into(),
                    b.skf.into(),
                    (&b.trust).into(),
                ]);
            }
            return vec![t];
        }
        let columns = ["family", "law", "default", "title", "gives", "unit", "source", "place", "trust", "range"]
            .map(|name| (name, if name == "default" { Flag } else { Text }));
        let mut t = Table::new("laws", columns);
        for l in &answer.list.laws {
            t.row([
                (&l.family).into(),
                (&l.law).into(),
                l.default.into(),
                (&l.title).into(),
                (&l.gives.symbol).into(),
                (&l.gives.unit).into(),
                (&l.source).into(),
                (&l.place).into(),
                l.trust.to_string().into(),
                text::range(l).into(),
            ]);
        }
        vec![t]
    }
}
