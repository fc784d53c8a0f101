//! A scheme as a train file.

use willis::exact::Rational;
use willis::train::ShiftElementKind;

use super::scheme::Scheme;
use super::wish::{SetRatio, decimal};

/// Teeth of sun and ring: those that were given, or the fewest that have the ratio, a sun of 20 teeth or more, and a
/// planet of whole teeth between them; fewer where willis reads no tooth number so large.
fn teeth(set: &SetRatio) -> [i64; 2] {
    if let Some(own) = set.teeth() {
        return own.map(i64::from);
    }
    let text = set.ratio().to_fraction();
    let part = |text: &str| text.parse::<i64>().unwrap_or(i64::MAX);
    let (ring, sun) = text.split_once('/').map_or((i64::MAX, i64::MAX), |(a, b)| (part(a), part(b)));
    let is_odd = (ring - sun) % 2 != 0;
    let mut times = if is_odd { 2 } else { 1 };
    while sun.saturating_mul(times) < 20 {
        times += if is_odd { 2 } else { 1 };
    }
    [sun.saturating_mul(times), ring.saturating_mul(times)]
}

pub(super) fn quoted(names: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let all: Vec<String> = names.into_iter().map(|n| format!("\"{}\"", n.as_ref())).collect();
    format!("[{}]", all.join(", "))
}

/// A set of a train file: its number, its teeth, the members of sun, ring and carrier, the efficiencies of its meshes.
pub(super) fn set_lines(n: usize, set: &SetRatio, on: &[String], meshes: &[Rational; 2]) -> String {
    let [sun, ring] = teeth(set);
    let member = |k: usize| on.get(k).map_or("", String::as_str);
    format!(
        "\n[[set]]\nname = \"P{n}\"\nsun = {{ member = \"{}\", teeth = {sun} }}\nring = {{ member = \"{}\", teeth = \
         {ring} }}\ncarrier = \"{}\"\nmesh_efficiency = \
         {{ external = {}, internal = {} }}\n",
        member(0),
        member(1),
        member(2),
        decimal(&meshes[0]),
        decimal(&meshes[1]),
    )
}

impl Scheme {
    /// The scheme as a complete train file: sets, shift elements, one state for every gear and reverse gear. Its teeth
    /// are those of the wish, or small numbers with the same ratios; mesh efficiencies are
    /// those of the wish.
    pub fn to_toml(&self) -> String {
        let mut text = self.head();
        for (n, set) in self.sets.iter().enumerate() {
            text += &set_lines(n + 1, set, &self.members(n), &self.mesh_efficiencies);
        }
        text + &self.elements_and_states()
    }

    /// What a file of the scheme begins with.
    pub(super) fn head(&self) -> String {
        let mut text = String::new();
        let name = self.known.clone().unwrap_or_else(|| format!("scheme {}", self.id));
        let ratios: Vec<String> = self.gears.iter().chain(&self.reverse).map(|g| format!("{:.3}", g.value)).collect();
        let turning: Vec<&str> = self.shafts.iter().filter(|s| s.name != "housing").map(|s| s.name.as_str()).collect();
        text += &format!("# {} gears, spread {:.3}: {}\n\n", self.gears.len(), self.spread, ratios.join("  "));
        text += &format!("format = 1\nname = \"{name}\"\n");
        text += &format!(
            "source = \"Found by a search over all shift schemes: layout {}. Mesh efficiencies assumed.\"\n\n",
            self.id
        );
        text + &format!("members = {}\nterminals = [\"input\", \"output\"]\n", quoted(turning))
    }

    /// The members of sun, ring and carrier of a set, counted from 0.
    pub(super) fn members(&self, set: usize) -> [String; 3] {
        ["s", "r", "c"].map(|part| {
            let member = format!("{part}{}", set + 1);
            match self.shafts.iter().find(|s| s.members.contains(&member)) {
                Some(shaft) if shaft.name != "housing" => shaft.name.clone(),
                _ => "frame".to_owned(),
            }
        })
    }

    /// Clutches and brakes, and what is closed in each gear.
    pub(super) fn elements_and_states(&self) -> String {
        let mut text = String::new();
        for element in &self.elements {
            let kind = if element.kind == ShiftElementKind::Brake { "brake" } else { "clutch" };
            let members = quoted(element.joins.iter().filter(|s| *s != "housing"));
            text +=
                &format!("\n[[shift_element]]\nname = \"{}\"\nkind = \"{kind}\"\nmembers = {members}\n", element.name);
        }
        for gear in self.gears.iter().chain(&self.reverse) {
            text += &format!("\n[[state]]\nname = \"{}\"\nengaged = {}\n", gear.name, quoted(&gear.closed));
        }
        text
    }

    /// The tooth ratios of the sets as the train file has them.
    pub fn written_ratios(&self) -> Vec<Rational> {
        self.sets
            .iter()
            .map(|set| {
                let [sun, ring] = teeth(set);
                Rational::new(ring, sun.max(1))
            })
            .collect()
    }
}
