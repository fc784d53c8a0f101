//! A hybrid as a train file.

use super::hybrid::{HybridDesign, HybridMode};
use super::train_file::{quoted, set_lines};
use super::wish::Wish;

/// Efficiency of a machine in the file, a usual one of motor and inverter together.
const MACHINE: &str = "0.93";
/// Speed of the engine in the operating points of the file, and where they lie: at this part of the ratio of a mechanical
/// point.
const ENGINE_RPM: f64 = 2000.0;
const BESIDE: f64 = 0.8;

impl HybridMode {
    /// What its state is called in a train file: what it is, and what is closed.
    pub fn state(&self) -> String {
        match self.closed.is_empty() {
            true => format!("{}, all open", self.kind),
            false => format!("{}, {}", self.kind, self.closed.join(" ")),
        }
    }
}

impl HybridDesign {
    /// The hybrid as a complete train file: sets, the motors as machines of an electric variator, clutches and brakes, a
    /// state for every mode in which something drives the output, an operating point in every split mode near a mechanical
    /// point. Its teeth are those of the wish, or small numbers with the
    /// same ratios; mesh efficiencies are 0.98 of sun and planet and 0.99 of planet and ring, machines have 0.93.
    pub fn to_toml(&self) -> String {
        let shaft =
            |digit: char| digit.to_digit(36).and_then(|s| self.shafts.get(s as usize)).map_or("", String::as_str);
        let name = |shaft: &str| if shaft == "housing" { "frame".to_owned() } else { shaft.to_owned() };
        let turning: Vec<&String> = self.shafts.iter().filter(|s| *s != "housing").collect();
        let mut text = String::new();
        let kinds: Vec<String> = self.modes.iter().map(|m| m.state()).collect();
        text += &format!("# {}\n\nformat = 1\nname = \"hybrid {}\"\n", kinds.join("; "), self.id);
        text += &format!(
            "source = \"Found by a search over all hybrids: layout {}. Efficiencies of meshes and machines assumed.\"\n\n",
            self.id
        );
        text += &format!("members = {}\nterminals = [\"engine\", \"output\"]\n", quoted(turning));
        let members: Vec<String> = self.layout.chars().map(|digit| name(shaft(digit))).collect();
        for (n, (set, three)) in self.sets.iter().zip(members.chunks(3)).enumerate() {
            text += &set_lines(n + 1, set, three, &Wish::usual_meshes());
        }
        let machine = |m: &str| format!("    {{ name = \"motor {m}\", member = \"{m}\", efficiency = {MACHINE} }},\n");
        text += "\n[[variator]]\nname = \"electric path\"\nkind = \"electric\"\nmachines = [\n";
        text += &(machine("A") + &machine("B") + "]\n");
        for (n, joins) in self.clutches.iter().enumerate() {
            let kind = if joins.iter().any(|s| s == "housing") { "brake" } else { "clutch" };
            let members = quoted(joins.iter().filter(|s| *s != "housing"));
            let n = n + 1;
            text += &format!("\n[[shift_element]]\nname = \"C{n}\"\nkind = \"{kind}\"\nmembers = {members}\n");
        }
        for mode in self.modes.iter().filter(|m| m.drives()) {
            text += &format!(
                "\n[[state]]\nname = \"{}\"\nengaged = {}\ninput = \"{}\"\noutput = \"output\"\n",
                mode.state(),
                quoted(&mode.closed),
                mode.input(),
            );
        }
        for mode in &self.modes {
            // Beside the mechanical point both motors turn.
            let Some(point) = mode.mechanical_points.last() else { continue };
            let output = ENGINE_RPM / (BESIDE * point.to_f64());
            text += &format!(
                "\n[[operation]]\nname = \"{0}\"\nstate = \"{0}\"\nspeeds = {{ engine = \"{ENGINE_RPM} rpm\", output = \
                 \"{output:.1} rpm\" }}\ntorques = {{ engine = \"100 N m\" }}\n",
                mode.state(),
            );
        }
        text
    }
}

impl HybridMode {
    /// What drives: the engine where it turns, else the first motor that does.
    fn input(&self) -> &str {
        let turns = |name: &&&str| self.turning.iter().any(|t| t == **name);
        ["engine", "A", "B"].iter().find(turns).copied().unwrap_or("engine")
    }

    /// Whether the output turns with something that drives it.
    fn drives(&self) -> bool {
        let turns = |name: &str| self.turning.iter().any(|t| t == name);
        turns("output") && self.turning.len() > 1
    }
}
