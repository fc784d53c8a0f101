//! Design files for those who have none: a kind of drive with a ratio, or a train that exists.

use std::fmt::Write as _;
use std::str::FromStr;

use toml_edit::{DocumentMut, Item, TableLike, Value};
use willis::Model;
use willis::analysis::{Selection, analyze};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;

use super::document::{at, nth, paths, planet_tables, set_kind, tables, write};
use super::layout::SetKind;

/// A kind of drive from an input to an output, with every ring at rest that does not move for its purpose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum StartKind {
    /// One set: the sun drives the carrier, the ring rests. Ratios of about 3 to 10.
    Simple,
    /// Two sets in series, each like `Simple`. Ratios of about 9 to 80.
    TwoStage,
    /// A Wolfrom or 3K drive: the sun drives the second ring through stepped planets, the first ring rests. Ratios from
    /// about 20 to some hundreds of both signs.
    Wolfrom,
    /// One set with stepped planets: the sun drives the carrier through both steps, the ring rests. Ratios of about 4 to 20.
    Stepped,
    /// Two rings on stepped planets and no sun: the carrier drives the second ring, the first one rests. Ratios from about 10
    /// to some thousands of both signs.
    TwoRings,
    /// A Ravigneaux set: the small sun drives the ring, the large sun rests. Ratios of about 1.2 to 4.
    Ravigneaux,
}

impl StartKind {
    /// All of them with the names under which they are asked for.
    pub const ALL: [(&'static str, Self); 6] = [
        ("simple", Self::Simple),
        ("two-stage", Self::TwoStage),
        ("3k", Self::Wolfrom),
        ("stepped", Self::Stepped),
        ("two-rings", Self::TwoRings),
        ("ravigneaux", Self::Ravigneaux),
    ];
}

impl FromStr for StartKind {
    type Err = Box<Diagnostic>;

    fn from_str(name: &str) -> Result<Self, Box<Diagnostic>> {
        let names = Self::ALL.map(|k| k.0);
        Self::ALL.into_iter().find(|k| k.0 == name).map(|k| k.1).ok_or_else(|| {
            Diagnostic::new(Code::UnknownName, "kind", format!("there is no kind of drive `{name}`"))
                .suggest(name, names)
                .hint(format!("the kinds are: {}; any other train is designed from a file", names.join(", ")))
                .into()
        })
    }
}

/// What a design file begins with: a kind of drive and the wishes that nearly everybody has. Values are texts as in the
/// file, so that the file is what its user would have written.
///
/// # Example
/// ```
/// use willis::work::Serial;
/// use willis_synthesis::teeth::{Design, Request, Start, StartKind};
///
/// let start = Start { ratio: Some("100".into()), ring: Some("90mm".into()), ..Start::new(StartKind::Wolfrom) };
/// let design = Design::from_toml(&start.to_toml())?;
/// assert!(design.count().trains > 100);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Start {
    /// The kind of drive.
    pub kind: StartKind,
    /// The ratio, a number or `low..high`; of either sign for a Wolfrom drive and one of two rings.
    pub ratio: Option<String>,
    /// Relative tolerance of the ratio: `0.01`.
    pub tolerance: Option<String>,
    /// The largest reference diameter of a ring, with its unit.
    pub ring: Option<String>,
    /// Modules that are allowed, with their units.
    pub modules: Vec<String>,
    /// Numbers of planets: `3..5`.
    pub planets: Option<String>,
    /// Least efficiency from input to output.
    pub forward: Option<String>,
    /// Least efficiency from output to input.
    pub backward: Option<String>,
}

/// Modules below 1 mm and above, m x 1e3: series I of DIN 780.
const MODULES: [&str; 17] = [
    "0.3 mm", "0.4 mm", "0.5 mm", "0.6 mm", "0.7 mm", "0.8 mm", "0.9 mm", "1 mm", "1.25 mm", "1.5 mm", "2 mm",
    "2.5 mm", "3 mm", "4 mm", "5 mm", "6 mm", "8 mm",
];

/// The largest mismatch that profile shift closes, in teeth.
const MOST_MISMATCH: i64 = 4;

fn text(value: &str) -> String {
    Value::from(value).to_string().trim().to_owned()
}

/// A number as it stands, anything else as a text: what is wrong is told with the file.
fn number(value: &str) -> String {
    match value.trim().parse::<f64>() {
        Ok(x) if x.is_finite() && !value.trim().starts_with(['+', '.']) && !value.trim().ends_with('.') => {
            value.trim().to_owned()
        }
        _ => text(value),
    }
}

impl Start {
    /// A kind of drive with no wish yet.
    pub fn new(kind: StartKind) -> Self {
        let (ratio, tolerance, ring, planets, forward, backward) = Default::default();
        Self { kind, ratio, tolerance, ring, modules: vec![], planets, forward, backward }
    }

    /// The design file. Teeth from 12 to 60, rings to 120; planets assemble and clear each other by half a module; meshes
    /// have the efficiencies 0.98 (external) and 0.99 (internal), which is what published designs of such drives take.
    pub fn to_toml(&self) -> String {
        let mut out = String::from("format = 1\n");
        let (name, members, last) = match self.kind {
            StartKind::Simple => ("planetary reducer", &["sun", "carrier"][..], "carrier"),
            StartKind::TwoStage => ("two planetary stages", &["sun", "middle", "carrier"][..], "carrier"),
            StartKind::Wolfrom => ("Wolfrom drive", &["sun", "carrier", "ring"][..], "ring"),
            StartKind::Stepped => ("reducer with stepped planets", &["sun", "carrier"][..], "carrier"),
            StartKind::TwoRings => ("drive of two rings", &["carrier", "ring"][..], "ring"),
            StartKind::Ravigneaux => ("Ravigneaux set", &["sun", "carrier", "ring"][..], "ring"),
        };
        let list = |all: &[&str]| format!("[{}]", all.iter().map(|t| text(t)).collect::<Vec<_>>().join(", "));
        let _ = writeln!(
            out,
            "name = {}\nmembers = {}\nterminals = {}",
            text(name),
            list(members),
            list(&[members[0], last])
        );
        out += "\n[design]\n";
        let _ = writeln!(out, "planets = {}", text(self.planets.as_deref().unwrap_or("3..5")));
        out += "mismatch = [-1, 0, 1]\nrules = [\"assembly\", \"clearance\"]\ngap = 0.5\n";
        let own: Vec<&str> = self.modules.iter().map(String::as_str).collect();
        if !own.is_empty() || self.ring.is_some() {
            let _ = writeln!(out, "module = {}", list(if own.is_empty() { &MODULES } else { &own }));
        }
        if let Some(ring) = &self.ring {
            let _ = writeln!(out, "limits = {{ ring_diameter = {} }}", text(ring));
        }
        let demands = [("forward", &self.forward), ("backward", &self.backward)];
        let demands: Vec<String> =
            demands.iter().filter_map(|(k, v)| v.as_ref().map(|v| format!("{k} = {}", number(v)))).collect();
        if !demands.is_empty() {
            let _ = writeln!(out, "require = {{ {} }}", demands.join(", "));
        }
        // With many modules the smallest ring is always that of the smallest module.
        let small = if own.len() == 1 || self.ring.is_none() { "\"ring_diameter\", " } else { "" };
        let _ = writeln!(out, "minimize = [{small}\"error\"]\nmaximize = [\"forward\", \"backward\"]");
        let mut target = match self.ratio.as_deref().and_then(|r| r.split_once("..")) {
            Some((low, high)) => format!("ratio = [{}, {}]", number(low), number(high)),
            None => format!("ratio = {}", number(self.ratio.as_deref().unwrap_or(""))),
        };
        if let Some(tolerance) = &self.tolerance {
            let _ = write!(target, ", tolerance = {}", number(tolerance));
        }
        if matches!(self.kind, StartKind::Wolfrom | StartKind::TwoRings) {
            target += ", any_sign = true";
        }
        let _ = writeln!(out, "target = [{{ {target} }}]");
        let mesh = "mesh_efficiency = { external = 0.98, internal = 0.99 }";
        let mut simple = |name: &str, sun: &str, carrier: &str| {
            let _ = writeln!(
                out,
                "\n[[set]]\nname = \"{name}\"\nsun = {{ member = \"{sun}\", teeth = \"12..60\" }}\nplanet = {{ teeth = \
                 \"12..60\" }}\nring = {{ member = \"frame\", teeth = \"..120\" }}\ncarrier = \"{carrier}\"\n{mesh}"
            );
        };
        match self.kind {
            StartKind::Simple => simple("P1", "sun", "carrier"),
            StartKind::TwoStage => {
                simple("P1", "sun", "middle");
                simple("P2", "middle", "carrier");
            }
            StartKind::Stepped | StartKind::TwoRings => {
                let first = match self.kind {
                    StartKind::Stepped => {
                        "suns = [{ member = \"sun\", teeth = \"12..60\", planet_teeth = \"12..60\" }]"
                    }
                    _ => "",
                };
                let ring = |member: &str| {
                    format!("    {{ member = \"{member}\", teeth = \"..120\", planet_teeth = \"12..60\" }},")
                };
                let mut rings = vec![ring("frame")];
                if self.kind == StartKind::TwoRings {
                    rings.push(ring("ring"));
                }
                let lines: Vec<String> = ["[[set]]", "name = \"P1\"", "type = \"stepped\"", first, "rings = ["]
                    .into_iter()
                    .filter(|l| !l.is_empty())
                    .map(str::to_owned)
                    .chain(rings)
                    .chain(["]", "carrier = \"carrier\"", mesh].map(str::to_owned))
                    .collect();
                out += &format!("\n{}\n", lines.join("\n"));
            }
            StartKind::Ravigneaux => {
                let _ = writeln!(
                    out,
                    "\n[[set]]\nname = \"P1\"\ntype = \"ravigneaux\"\nsmall_sun = {{ member = \"sun\", teeth = \"12..60\" \
                     }}\nlarge_sun = {{ member = \"frame\", teeth = \"12..60\" }}\nshort_planet = {{ teeth = \"12..60\" \
                     }}\nlong_planet = {{ teeth = \"12..60\" }}\nring = {{ member = \"ring\", teeth = \"..120\" }}\ncarrier = \
                     \"carrier\"\n{mesh}"
                );
            }
            StartKind::Wolfrom => {
                let _ = writeln!(
                    out,
                    "\n[[set]]\nname = \"P1\"\ntype = \"stepped\"\nsuns = [{{ member = \"sun\", teeth = \"12..60\", \
                     planet_teeth = \"12..60\" }}]\nrings = [\n    {{ member = \"frame\", teeth = \"..120\", planet_teeth = \
                     \"12..60\" }},\n    {{ member = \"ring\", teeth = \"..120\", planet_teeth = \"12..60\" }},\n]\ncarrier = \
                     \"carrier\"\n{mesh}"
                );
            }
        }
        out
    }
}

/// What a train must do that shall stand where another one stands. Values are texts as in [`Start`].
///
/// # Example
/// ```
/// use willis_synthesis::teeth::{Around, Design};
///
/// let train = "format = 1\nname = \"p\"\nmembers = [\"s\", \"c\"]\nterminals = [\"s\", \"c\"]\n\
///     [[set]]\nname = \"P\"\nsun = { member = \"s\", teeth = 20 }\nring = { member = \"frame\", teeth = 70 }\ncarrier = \"c\"\n";
/// let around = Around { backward: Some("0.95".into()), ..Around::new("0.02") };
/// assert!(Design::from_toml(&around.to_toml(train)?)?.count().trains > 10);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Around {
    /// Relative tolerance of its ratios.
    pub tolerance: String,
    /// The largest reference diameter of a ring, with its unit.
    pub ring: Option<String>,
    /// Least efficiency from input to output.
    pub forward: Option<String>,
    /// Least efficiency from output to input.
    pub backward: Option<String>,
}

impl Around {
    /// The ratios within a tolerance, and no other wish.
    pub fn new(tolerance: &str) -> Self {
        Self { tolerance: tolerance.to_owned(), ring: None, forward: None, backward: None }
    }

    /// The design file: the same connections and ratios, with other teeth. No ring becomes larger
    /// than it is; numbers of planets stay, or are 3 to 6 where none is given; mesh efficiencies and
    /// geometry stay too; profile shifts and centre distances are found anew.
    ///
    /// # Errors
    /// It is no train, has no set whose teeth can be found, or no ratio that teeth can change.
    pub fn to_toml(&self, train: &str) -> Result<String, Diagnostics> {
        let model = Model::from_toml(train)?;
        let alone = willis::unstable::without_operations(model.train());
        let ratios = analyze(&alone, &Selection::default())?.ratios;
        let mut document: DocumentMut =
            train.parse().map_err(|_| Diagnostic::new(Code::Syntax, "", "is not valid TOML"))?;
        let (mut designed, mut most) = (0, 1);
        for k in 0..tables(document.get("set")) {
            let Some(set) = document.get("set").and_then(|s| nth(s, k)) else { continue };
            let Some(kind) = set_kind(&set) else { continue };
            if kind == SetKind::Wolfrom && (tables(set.get("suns")), tables(set.get("rings"))) != (1, 2) {
                continue;
            }
            let own: Vec<Option<i64>> = paths(kind).iter().map(|p| at(&set, p).and_then(Item::as_integer)).collect();
            let Some(ring) = own.iter().flatten().max().copied() else { continue };
            let mismatch = match (kind, &own[..]) {
                (SetKind::Simple, [Some(s), Some(p), Some(r)]) => (r - s - 2 * p).abs(),
                (SetKind::Stepped, [Some(s), Some(p1), Some(p2), Some(r)]) => (r - p2 - s - p1).abs(),
                (SetKind::Rings, [Some(r1), Some(p1), Some(p2), Some(r2)]) => (r2 - p2 - r1 + p1).abs(),
                _ => 0,
            };
            // Steps of two modules lie on one axis, but not by their teeth: such a set keeps the teeth that it has.
            if mismatch > MOST_MISMATCH && kind != SetKind::Simple {
                continue;
            }
            most = most.max(mismatch);
            designed += 1;
            for (path, z) in paths(kind).iter().zip(&own) {
                // What is not given is left to be found.
                let is_ring = path.contains("ring") && !path.contains("planet");
                let range = match z {
                    _ if is_ring => format!("..{ring}"),
                    z => format!("{}..{ring}", z.unwrap_or(12).min(12)),
                };
                write(&mut document, k, path, range.into());
            }
            if kind == SetKind::Wolfrom {
                let same = at(&set, "suns.0.planet_teeth").and_then(Item::as_integer).unwrap_or(12).min(12);
                write(&mut document, k, "rings.0.planet_teeth", format!("{same}..{ring}").into());
            }
            if !planet_tables(kind).iter().any(|p| at(&set, &format!("{p}.count")).is_some()) {
                write(&mut document, k, &format!("{}.count", planet_tables(kind)[0]), "3..6".into());
            }
        }
        if designed == 0 {
            let message = "no set of this train is one whose teeth can be found";
            let d = Diagnostic::new(Code::Unfit, "set", message);
            return Err(d
                .hint(
                    "these are sets with sun and ring, 3K drives, other stepped sets with a ring, and Ravigneaux sets",
                )
                .into());
        }
        if let Some(sets) = document.get_mut("set") {
            forget(sets);
        }
        let mut targets = toml_edit::Array::new();
        for (state, row) in ratios.iter() {
            let Some(exact) = &row.exact else { continue };
            if exact.is_zero() || *exact == Rational::ONE {
                continue;
            }
            let mut target = toml_edit::InlineTable::new();
            if ratios.0.len() > 1 {
                target.insert("state", state.as_str().into());
            }
            target.insert("ratio", exact.to_fraction().into());
            targets.push(target);
        }
        if targets.is_empty() {
            let message = match ratios.iter().any(|(_, r)| r.exact.is_some()) {
                true => "the ratios of this train are 1, whatever its teeth are",
                false => "no state of this train has a ratio of its own: speeds or a variator settle it",
            };
            let d = Diagnostic::new(Code::Unfit, "", message);
            return Err(d.hint("write a design file with the ratios that are wanted").into());
        }
        let mut wish = toml_edit::Table::new();
        let written = |v: &String| number(v).parse::<Value>().unwrap_or_else(|_| Value::from(v.as_str()));
        wish.insert("tolerance", toml_edit::value(written(&self.tolerance)));
        wish.insert("mismatch", toml_edit::value(format!("-{0}..{0}", most.min(MOST_MISMATCH))));
        wish.insert("rules", toml_edit::value(["assembly", "clearance"].into_iter().collect::<toml_edit::Array>()));
        if let Some(ring) = &self.ring {
            let limit: toml_edit::InlineTable = [("ring_diameter", Value::from(ring.as_str()))].into_iter().collect();
            wish.insert("limits", toml_edit::value(limit));
        }
        let least = [("forward", &self.forward), ("backward", &self.backward)];
        let least: toml_edit::InlineTable =
            least.iter().filter_map(|(k, v)| Some((*k, written(v.as_ref()?)))).collect();
        if !least.is_empty() {
            wish.insert("require", toml_edit::value(least));
        }
        wish.insert("minimize", toml_edit::value(["ring_diameter"].into_iter().collect::<toml_edit::Array>()));
        wish.insert("maximize", toml_edit::value(["forward", "backward"].into_iter().collect::<toml_edit::Array>()));
        wish.insert("target", toml_edit::value(targets));
        document.insert("design", Item::Table(wish));
        Ok(document.to_string())
    }
}

/// Takes away what belongs to the teeth that were: profile shifts, diameters and centre distances.
fn forget(item: &mut Item) {
    fn table(t: &mut dyn TableLike) {
        for key in ["shift", "centre_distance", "tip_diameter", "root_diameter"] {
            t.remove(key);
        }
        let keys: Vec<String> = t.iter().map(|(k, _)| k.to_owned()).collect();
        for key in keys {
            if let Some(inner) = t.get_mut(&key) {
                forget(inner);
            }
        }
    }
    match item {
        Item::ArrayOfTables(all) => all.iter_mut().for_each(|t| table(t)),
        Item::Value(Value::Array(all)) => {
            for value in all.iter_mut() {
                if let Value::InlineTable(t) = value {
                    table(t);
                }
            }
        }
        other => {
            if let Some(t) = other.as_table_like_mut() {
                table(t);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::teeth::{Design, Request};
    use willis::work::Serial;

    #[test]
    fn every_kind_starts() {
        for (name, kind) in StartKind::ALL {
            assert_eq!(name.parse::<StartKind>().unwrap(), kind);
            let ratio = match kind {
                StartKind::Simple => "4.2",
                StartKind::TwoStage => "20..21",
                StartKind::Wolfrom => "100",
                StartKind::Stepped => "9.5",
                StartKind::TwoRings => "60",
                StartKind::Ravigneaux => "1.5",
            };
            let start = Start { ratio: Some(ratio.into()), ..Start::new(kind) };
            let design = Design::from_toml(&start.to_toml()).unwrap();
            let answer = design.answer(&Request { top: Some(2), ..Request::default() }, &Serial).unwrap();
            assert!(answer.completeness.complete && answer.rows.len() == 2, "{name}");
        }
        let wrong = "3kk".parse::<StartKind>().unwrap_err();
        assert_eq!(wrong.replacement.as_deref(), Some("3k"));
    }

    #[test]
    fn values_that_are_no_numbers_are_told_by_the_file() {
        for ratio in ["", "ten", "1e400", "nan", "4..", "..", "\"", "5..4"] {
            let start = Start { ratio: Some(ratio.into()), ..Start::new(StartKind::Simple) };
            let wrong = Design::from_toml(&start.to_toml()).unwrap_err();
            assert!(wrong.iter().any(|d| d.place.starts_with("design.target")), "{ratio}: {wrong:?}");
        }
    }
}
