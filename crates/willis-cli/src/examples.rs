//! An example of every command, which its help shows.

/// Command, its example, and what that answers.
pub const EXAMPLES: &[(&str, &str, &str)] = &[
    ("analyze", "willis analyze examples/zf-8hp70.toml --state 3", "the third gear: ratio, efficiency, torques"),
    ("table", "willis table examples/zf-8hp70.toml --speed 2000rpm", "speeds of all shafts at 2000 rpm of the input"),
    ("new", "willis new set -o reducer.toml", "a commented file of a simple set"),
    ("check", "willis check examples/zf-8hp70.toml", "whether the file is right"),
    ("flow", "willis flow examples/compound-split.toml", "where power recirculates"),
    (
        "losses",
        "willis losses examples/fva-planetary-stage.toml --operation rated --compare mesh_friction",
        "the losses by every law of tooth friction",
    ),
    ("heat", "willis heat examples/industrial-planetary-heat.toml --operation rated", "the oil temperature that holds"),
    ("sensitivity", "willis sensitivity examples/fva-planetary-stage.toml --operation rated", "what to change first"),
    (
        "uncertainty",
        "willis uncertainty examples/fva-planetary-stage.toml --vary oil.temperature=60..80degC",
        "the efficiency if the oil has 60 to 80 °C",
    ),
    (
        "calibrate",
        "willis calibrate examples/fva-planetary-stage.toml --data examples/tests-fva-planetary-stage.csv",
        "factors that fit the laws to a test",
    ),
    (
        "sweep",
        "willis sweep examples/zf-8hp70.toml --over state=all --over \"input.torque=50..300 N m:6\" -o map.csv",
        "six torques in every gear",
    ),
    ("merge", "willis merge part-1.csv part-2.csv -o map.csv", "one table of two shards"),
    (
        "cycle",
        "willis cycle examples/zf-8hp70.toml --profile examples/cycle-8hp70.csv",
        "the energy lost over a measured drive",
    ),
    ("compare", "willis compare examples/zf-8hp70.toml examples/zf-8hp-gen4.toml", "two generations side by side"),
    ("regimes", "willis regimes examples/prius-p112.toml", "every way that a power split can run"),
    (
        "formula",
        "willis formula examples/zf-8hp70.toml --state 2 --lang python",
        "the efficiency of second gear as a function in Python",
    ),
    (
        "locate",
        "willis locate examples/prius-p112.toml --speeds engine=2000rpm,ring=3000rpm --torques \"engine=100 N m\"",
        "the regime of this point and its boundaries",
    ),
    (
        "simulate",
        "willis simulate examples/galvagno-coast-down.toml --scenario \"coast down\" -o run.csv",
        "speeds and torques over time",
    ),
    ("modes", "willis modes examples/launch.toml --state \"clutch closed\"", "natural frequencies of a driveline"),
    (
        "design",
        "willis design --kind 3k --ratio 100 --ring 90mm --backward 0.8",
        "Wolfrom drives that can be driven back",
    ),
    (
        "schemes",
        "willis schemes --k 62/26,74/42 --elements 5 --closed 2 --forward 4",
        "all four-speed trains of two sets",
    ),
    ("draw", "willis draw stick examples/zf-8hp70.toml -o scheme.svg", "the stick diagram"),
    ("report", "willis report examples/zf-8hp70.toml -o 8hp70.html", "a report for a browser"),
    ("export", "willis export modelica examples/zf-8hp70.toml -o gearbox.mo", "a model for Modelica"),
    ("import", "willis import examples/planetary-stage.rexs -o stage.toml", "a train file of a REXS file"),
    ("laws", "willis laws --family mesh_friction", "the laws of tooth friction"),
    ("validate", "willis validate galvagno", "numbers of a paper beside ours"),
    ("explain", "willis explain E106", "what this diagnostic means and what to do"),
    ("studio", "willis studio examples/zf-8hp70.toml", "the train in the browser, at an address that is printed"),
    ("schema", "willis schema analyze", "the JSON Schema of an analysis"),
    ("completions", "willis completions bash > willis.bash", "completions for Bash"),
    ("man", "willis man man1", "a manual page for every command"),
];

/// The lines of a command below its options.
pub fn example(name: &str) -> Option<String> {
    let (_, line, about) = EXAMPLES.iter().find(|e| e.0 == name)?;
    Some(format!("Example: {about}\n{}", broken(line)))
}

/// A command within the width of help texts, broken before an option so that a shell reads it as one.
fn broken(line: &str) -> String {
    const WIDTH: usize = 96;
    let (mut lines, mut rest) = (String::from("  "), line);
    while rest.len() > WIDTH {
        let Some(at) = rest[..WIDTH].rfind(" -") else { break };
        lines += &format!("{} \\\n    ", &rest[..at]);
        rest = &rest[at + 1..];
    }
    lines + rest
}
