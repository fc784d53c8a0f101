//! `modelDescription.xml`: the variables and abilities of a unit, as version 2.0.4 or 3.0 of the interface writes them.

use std::fmt::Write as _;

use crate::LIBRARY;
use crate::layout::{Interface, Kind, Layout, MODES, Role, TOLERANCE, Unit, VERDICTS, Value, Variable};

/// A version of the Functional Mock-up Interface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 2.0
    Two,
    /// 3.0
    Three,
}

/// Text as a value of an attribute.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out += "&amp;",
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '"' => out += "&quot;",
            // What XML cannot hold at all.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => out.push(' '),
            c => out.push(c),
        }
    }
    out
}

/// The description.
pub(crate) fn describe(
    layout: &Layout,
    train: &str,
    scenario: &str,
    token: &str,
    version: Version,
    interface: Interface,
) -> String {
    let two = version == Version::Two;
    let (number, identity) = if two { ("2.0", "guid") } else { ("3.0", "instantiationToken") };
    let mut x = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let name = escaped(&format!("{train}: {scenario}"));
    let indicators = match two && interface.exchanges() {
        true => format!(" numberOfEventIndicators=\"{}\"", layout.indicators),
        false => String::new(),
    };
    let _ = writeln!(
        x,
        "<fmiModelDescription fmiVersion=\"{number}\" modelName=\"{name}\" {identity}=\"{token}\" \
         description=\"Planetary gear train in motion\" generationTool=\"Willis {}\" variableNamingConvention=\"flat\"\
         {indicators}>",
        env!("CARGO_PKG_VERSION")
    );
    interfaces(&mut x, version, interface);
    unit_definitions(&mut x, layout);
    if !two {
        type_definitions(&mut x);
    }
    x += "  <LogCategories>\n";
    for (name, about) in [
        ("logStatusWarning", "What the reader of the results must know"),
        ("logStatusError", "What is wrong, and what to do"),
        ("logEvents", "Changes of mode"),
    ] {
        let _ = writeln!(x, "    <Category name=\"{name}\" description=\"{about}\"/>");
    }
    x += "  </LogCategories>\n";
    let [start, end] = layout.span;
    let _ = writeln!(
        x,
        "  <DefaultExperiment startTime=\"{start:?}\" stopTime=\"{end:?}\" tolerance=\"{TOLERANCE:?}\" stepSize=\"{:?}\"/>",
        (end - start) / 1000.0
    );
    x += "  <ModelVariables>\n";
    // The time, the first of them, is not to be listed in version 2.
    for (k, variable) in layout.variables.iter().enumerate().skip(usize::from(two)) {
        if two { variable_two(&mut x, layout, k, variable) } else { variable_three(&mut x, layout, k, variable) }
    }
    x += "  </ModelVariables>\n  <ModelStructure>\n";
    structure(&mut x, layout, two);
    x += "  </ModelStructure>\n</fmiModelDescription>\n";
    x
}

fn interfaces(x: &mut String, version: Version, interface: Interface) {
    let common = match version {
        Version::Two => format!(
            "modelIdentifier=\"{LIBRARY}\" canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" \
             canSerializeFMUstate=\"true\""
        ),
        Version::Three => {
            format!("modelIdentifier=\"{LIBRARY}\" canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"")
        }
    };
    if interface.exchanges() {
        let more = match version {
            Version::Two => "completedIntegratorStepNotNeeded=\"false\" providesDirectionalDerivative=\"true\"",
            Version::Three => "needsCompletedIntegratorStep=\"true\" providesDirectionalDerivatives=\"true\"",
        };
        let _ = writeln!(x, "  <ModelExchange {common} {more}/>");
    }
    if interface.steps() {
        let more = match version {
            Version::Two => "canHandleVariableCommunicationStepSize=\"true\"",
            Version::Three => {
                "canHandleVariableCommunicationStepSize=\"true\" hasEventMode=\"true\" canReturnEarlyAfterIntermediateUpdate=\"false\""
            }
        };
        let _ = writeln!(x, "  <CoSimulation {common} {more}/>");
    }
}

fn unit_definitions(x: &mut String, layout: &Layout) {
    let mut units: Vec<Unit> = vec![];
    for variable in &layout.variables {
        if let Kind::Real(Some(unit)) = variable.kind
            && !units.iter().any(|u| u.name == unit.name)
        {
            units.push(unit);
        }
    }
    x.push_str("  <UnitDefinitions>\n");
    for unit in units {
        let [m, kg, s, rad, kelvin] = unit.exponents;
        let base = [("kg", kg), ("m", m), ("s", s), ("K", kelvin), ("rad", rad)];
        let base = base.iter().filter(|(_, n)| *n != 0).map(|(name, n)| format!(" {name}=\"{n}\""));
        let base: String = base.collect();
        let _ = writeln!(x, "    <Unit name=\"{}\"><BaseUnit{base}/></Unit>", escaped(unit.name));
    }
    x.push_str("  </UnitDefinitions>\n");
}

fn type_definitions(x: &mut String) {
    let item = |x: &mut String, name: &str, value: i64| {
        let _ = writeln!(x, "      <Item name=\"{name}\" value=\"{value}\"/>");
    };
    x.push_str("  <TypeDefinitions>\n    <EnumerationType name=\"Mode\">\n");
    MODES.iter().for_each(|(name, value)| item(x, name, *value));
    x.push_str("    </EnumerationType>\n    <EnumerationType name=\"Verdict\">\n");
    VERDICTS.iter().enumerate().for_each(|(k, name)| item(x, name, k as i64));
    x.push_str("    </EnumerationType>\n  </TypeDefinitions>\n");
}

/// Causality, variability, and what is known at the start.
fn nature(variable: &Variable) -> (&'static str, &'static str, &'static str) {
    let moves = match variable.kind {
        Kind::Real(_) => "continuous",
        _ => "discrete",
    };
    match variable.role {
        Role::Time => ("independent", "continuous", ""),
        Role::Input(_) | Role::InputRate(_) => ("input", moves, ""),
        Role::Parameter(_) | Role::Tolerance => ("parameter", "fixed", "exact"),
        Role::State(_) | Role::Rate(_) | Role::Indicator(_) => ("local", "continuous", "calculated"),
        _ => ("output", moves, "calculated"),
    }
}

fn start(variable: &Variable) -> String {
    match &variable.start {
        None => String::new(),
        Some(Value::Real(value)) => format!(" start=\"{value:?}\""),
        Some(Value::Integer(value)) => format!(" start=\"{value}\""),
    }
}

fn variable_two(x: &mut String, layout: &Layout, reference: usize, variable: &Variable) {
    let (causality, variability, initial) = nature(variable);
    let initial = if initial.is_empty() { String::new() } else { format!(" initial=\"{initial}\"") };
    let _ = write!(
        x,
        "    <ScalarVariable name=\"{}\" valueReference=\"{reference}\" description=\"{}\" causality=\"{causality}\" \
         variability=\"{variability}\"{initial}>",
        escaped(&variable.name),
        escaped(&variable.about)
    );
    let unit = match variable.kind {
        Kind::Real(Some(unit)) => format!(" unit=\"{}\"", escaped(unit.name)),
        _ => String::new(),
    };
    // Counted from 1, without the time.
    let derivative = match variable.role {
        Role::Rate(k) => layout.state(k).map_or(String::new(), |k| format!(" derivative=\"{k}\"")),
        _ => String::new(),
    };
    let start = start(variable);
    let _ = match variable.kind {
        Kind::Real(_) => write!(x, "<Real{unit}{derivative}{start}/>"),
        // Hosts of this version often leave out enumerations.
        Kind::Integer | Kind::Mode | Kind::Verdict => write!(x, "<Integer{start}/>"),
        Kind::Text => write!(x, "<String{start}/>"),
    };
    x.push_str("</ScalarVariable>\n");
}

fn variable_three(x: &mut String, layout: &Layout, reference: usize, variable: &Variable) {
    let (causality, variability, initial) = nature(variable);
    let initial = if initial.is_empty() { String::new() } else { format!(" initial=\"{initial}\"") };
    let (tag, more) = match variable.kind {
        Kind::Real(unit) => ("Float64", unit.map_or(String::new(), |unit| format!(" unit=\"{}\"", escaped(unit.name)))),
        Kind::Integer => ("Int64", String::new()),
        Kind::Mode => ("Enumeration", " declaredType=\"Mode\"".to_owned()),
        Kind::Verdict => ("Enumeration", " declaredType=\"Verdict\"".to_owned()),
        Kind::Text => ("String", String::new()),
    };
    let derivative = match variable.role {
        Role::Rate(k) => layout.state(k).map_or(String::new(), |k| format!(" derivative=\"{k}\"")),
        _ => String::new(),
    };
    let _ = writeln!(
        x,
        "    <{tag} name=\"{}\" valueReference=\"{reference}\" description=\"{}\" causality=\"{causality}\" \
         variability=\"{variability}\"{initial}{more}{derivative}{}/>",
        escaped(&variable.name),
        escaped(&variable.about),
        start(variable)
    );
}

/// Which variables are outputs, rates of states, indicators, and unknown at the start.
fn structure(x: &mut String, layout: &Layout, two: bool) {
    let outputs = layout.places(Role::is_output);
    let rates: Vec<usize> = (0..layout.states.len()).filter_map(|k| layout.rate(k)).collect();
    let indicators = layout.places(|role| matches!(role, Role::Indicator(_)));
    let states = layout.places(|role| matches!(role, Role::State(_)));
    if two {
        let mut list = |name: &str, of: &[usize]| {
            if of.is_empty() {
                return;
            }
            let _ = writeln!(x, "    <{name}>");
            for k in of {
                let _ = writeln!(x, "      <Unknown index=\"{k}\"/>");
            }
            let _ = writeln!(x, "    </{name}>");
        };
        list("Outputs", &outputs);
        list("Derivatives", &rates);
        let mut unknown = [&outputs[..], &states, &rates].concat();
        unknown.sort_unstable();
        list("InitialUnknowns", &unknown);
        return;
    }
    let mut list = |name: &str, of: &[usize]| {
        for k in of {
            let _ = writeln!(x, "    <{name} valueReference=\"{k}\"/>");
        }
    };
    list("Output", &outputs);
    list("ContinuousStateDerivative", &rates);
    let mut unknown = [&outputs[..], &states, &rates].concat();
    unknown.sort_unstable();
    list("InitialUnknown", &unknown);
    list("EventIndicator", &indicators);
}
