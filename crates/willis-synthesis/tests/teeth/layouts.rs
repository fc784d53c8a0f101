//! Design files of the tests.

/// A train file of the repository with other teeth and a table of wishes: every `set` gets the ranges of its gears.
pub fn example(text: &str, design: &str, teeth: &[(&str, &str)]) -> String {
    let mut document: toml_edit::DocumentMut = text.parse().unwrap();
    for (path, range) in teeth {
        let (set, path) = path.split_once('.').unwrap();
        let sets = document["set"].as_array_of_tables_mut().unwrap();
        let table = sets.iter_mut().find(|t| t["name"].as_str() == Some(set)).unwrap();
        let (gear, key) = path.split_once('.').unwrap();
        if table.get(gear).is_none() {
            table[gear] = toml_edit::Item::Value(toml_edit::InlineTable::new().into());
        }
        table[gear][key] = toml_edit::value(*range);
    }
    let wishes: toml_edit::DocumentMut = design.parse().unwrap();
    document["design"] = wishes["design"].clone();
    document.to_string()
}

/// A Wolfrom drive: sun in, first ring held, second ring out.
pub fn wolfrom(gear: &str, ring: &str, efficiency: &str, design: &str) -> String {
    format!(
        r#"
format = 1
name = "Wolfrom drive"
members = ["sun", "carrier", "ring"]
terminals = ["sun", "ring"]

[design]
{design}

[[set]]
name = "P1"
type = "stepped"
suns = [{{ member = "sun", teeth = "{gear}", planet_teeth = "{gear}" }}]
rings = [
    {{ member = "frame", teeth = "{ring}", planet_teeth = "{gear}" }},
    {{ member = "ring", teeth = "{ring}", planet_teeth = "{gear}" }},
]
carrier = "carrier"
mesh_efficiency = {efficiency}
"#
    )
}

/// A sun that drives a carrier in a held ring.
pub fn simple(gear: &str, ring: &str, design: &str) -> String {
    format!(
        r#"
format = 1
name = "reducer"
members = ["sun", "carrier"]
terminals = ["sun", "carrier"]

[design]
{design}

[[set]]
name = "P1"
sun = {{ member = "sun", teeth = "{gear}" }}
planet = {{ teeth = "{gear}" }}
ring = {{ member = "frame", teeth = "{ring}" }}
carrier = "carrier"
mesh_efficiency = 0.99
"#
    )
}
