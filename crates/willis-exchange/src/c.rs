//! A train as C: torques and losses at a point, for controllers and for Simulink.
//!
//! The tables come from [`Train::tables`](willis::train::Train::tables). What finds the equilibrium from them is a fixed
//! text of C99 (`c/runtime.c`), written towards MISRA C:2012: no memory from the heap, no recursion, no arrays of variable
//! length, loops with bounds known when it is compiled, one exit from every function. It does what the compiled train
//! does: least-index pivoting where every load has one solution, else all patterns of drivers.

use std::fmt::Write as _;

use willis::analysis::frozen;
use willis::compiled::{CompileRequest, TableOutput, Tables};
use willis::diagnostic::{Code, Diagnostic, Diagnostics, is_printable};
use willis::model::Model;
use willis::study::export::{Export, ExportRequest, ExportedFile, FilesAndNotes, export_with};
use willis::train::{AS_DRAWN, FRAME, MemberId, Operation, Train};

const RUNTIME: &str = include_str!("c/runtime.c");
const DRAG: &str = include_str!("c/drag.c");

/// What begins a comment, and what ends it.
const COMMENT: [&str; 2] = ["// ", ""];

/// Kinds of C: their names and what they are.
pub const KINDS: [(&str, &str); 2] = [
    ("c", "torques and losses at a point for controllers, C99 without allocation (.h and .c)"),
    ("simulink", "the same with a Level-2 C S-function around it"),
];

/// What is prescribed at a point, by names: they are the same in trains with other values.
struct Plan {
    /// States of the shift table; `None` as drawn.
    states: Vec<Option<String>>,
    speeds: Vec<String>,
    torques: Vec<String>,
    fixed: Vec<String>,
    /// Where efficiencies are taken, if they depend on load.
    operation: Option<Operation>,
    notes: Vec<String>,
}

/// Writes a train as C; `kind` is one of [`KINDS`]. Without an operation the speed of the input and the torques of all
/// terminals but the output are prescribed, in every state that allows it; with one, what it prescribes.
///
/// # Errors
/// Ranges and temperatures, which have no meaning here; states, operations and trains that cannot be compiled.
///
/// # Example
/// ```
/// use willis::model::Model;
/// use willis::study::export::ExportRequest;
///
/// let model = Model::from_toml(r#"
///     format = 1
///     name = "reducer"
///     members = ["sun", "carrier"]
///     terminals = ["sun", "carrier"]
///     [[set]]
///     name = "P1"
///     sun = { member = "sun", teeth = 30 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "carrier"
///     mesh_efficiency = 0.99
/// "#)?;
/// let done = willis_exchange::c::write(&model, "c", &ExportRequest::default())?;
/// assert_eq!([&*done.files[0].name, &*done.files[1].name], ["reducer.h", "reducer.c"]);
/// assert!(done.files[0].text.contains("REDUCER_MEMBER_SUN"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn write(model: &Model, kind: &str, request: &ExportRequest) -> Result<Export, Diagnostics> {
    if request.speeds.is_some() || request.torques.is_some() || request.temperatures.is_some() {
        let message = "this format answers at any speed and torque, with constant efficiencies";
        let d = Diagnostic::new(Code::Conflict, "", message);
        return Err(d.hint("leave out ranges and temperatures; an operation says where efficiencies are taken").into());
    }
    let plan = plan(model.train(), request)?;
    export_with(model, COMMENT, &|train, _| files(train, &plan, kind == "simulink"))
}

/// What can be prescribed.
fn plan(train: &Train, request: &ExportRequest) -> Result<Plan, Diagnostics> {
    let name = |m: MemberId| train.member_name(m).to_owned();
    if let Some(own) = &request.operation {
        let operation = train.find_operation(own)?;
        let state = operation.state.map(|k| train.states()[k].name.clone());
        if request.state.as_ref().is_some_and(|s| Some(s) != state.as_ref()) {
            let message =
                format!("the operation `{own}` does not run in state `{}`", request.state.as_deref().unwrap_or(""));
            return Err(Diagnostic::new(Code::UnknownSelection, "", message).hint("leave out one of the two").into());
        }
        return Ok(Plan {
            states: vec![state],
            speeds: operation.speeds.iter().map(|s| name(s.0)).collect(),
            torques: operation.loads.iter().map(|l| name(l.0)).collect(),
            fixed: operation.fixed.iter().map(|m| name(*m)).collect(),
            operation: Some(operation.clone()),
            notes: vec![],
        });
    }
    let all: Vec<Option<usize>> = match &request.state {
        Some(state) => vec![Some(train.find_state(state)?)],
        None if train.states().is_empty() => vec![None],
        None => (0..train.states().len()).map(Some).collect(),
    };
    let mut plan =
        Plan { states: vec![], speeds: vec![], torques: vec![], fixed: vec![], operation: None, notes: vec![] };
    let mut wrong = Diagnostics::default();
    for k in all {
        let state = k.map(|k| train.states()[k].name.clone());
        let title = state.as_ref().map_or_else(|| AS_DRAWN.to_owned(), |s| format!("state {s}"));
        let mut refuse = |why: &str| {
            plan.notes.push(format!("left out: {title}: {why}"));
            wrong.push(
                Diagnostic::new(Code::Unfit, "", format!("{title}: {why}"))
                    .hint("an operation of the file says what is prescribed"),
            );
        };
        let [Some(input), Some(output)] = train.ends(k) else {
            refuse("it has no input and output");
            continue;
        };
        let speeds = vec![name(input)];
        let torques: Vec<String> = train.terminals().iter().filter(|t| **t != output).map(|t| name(*t)).collect();
        if let Err(why) = tables(train, state.as_deref(), &speeds, &torques, &[]) {
            let why: Vec<&str> = why.iter().map(|d| d.message.as_str()).collect();
            refuse(&format!("speed of {} and torques of {}: {}", speeds[0], torques.join(", "), why.join("; ")));
        } else if plan.states.is_empty() {
            (plan.speeds, plan.torques) = (speeds, torques);
            plan.states.push(state);
        } else if plan.speeds == speeds && plan.torques == torques {
            plan.states.push(state);
        } else {
            refuse("its input or output is another than that of the states before it; export it alone");
        }
    }
    if plan.states.is_empty() { Err(wrong) } else { Ok(plan) }
}

fn tables(
    train: &Train,
    state: Option<&str>,
    speeds: &[String],
    torques: &[String],
    fixed: &[String],
) -> Result<Tables, Diagnostics> {
    let mut duty = CompileRequest::new(speeds.iter().map(String::as_str), torques.iter().map(String::as_str));
    if let Some(state) = state {
        duty = duty.state(state);
    }
    for member in fixed {
        duty = duty.fixed(member);
    }
    let between: Vec<[MemberId; 2]> = train.drags().iter().map(|d| d.members).collect();
    let tables = train.tables(&duty, &between)?;
    let loose = train.terminals().iter().find(|t| tables.speeds[t.index()].is_none());
    if let Some(t) = loose {
        let message =
            format!("the speed of terminal `{}` does not follow from those prescribed", train.member_name(*t));
        return Err(Diagnostic::new(Code::Undetermined, "", message).hint("prescribe another speed").into());
    }
    Ok(tables)
}

/// Letters, digits and underscores.
fn identifier(text: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '_' };
    let all: String = text.chars().take(40).map(plain).collect();
    let parts: Vec<&str> = all.split('_').filter(|p| !p.is_empty()).collect();
    if parts.is_empty() { "x".into() } else { parts.join("_") }
}

/// Identifiers that differ from each other.
fn identifiers<'a>(all: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let mut out: Vec<String> = vec![];
    for text in all {
        let wish = identifier(text);
        let own = std::iter::once(wish.clone()).chain((2..).map(|k| format!("{wish}_{k}"))).find(|n| !out.contains(n));
        out.extend(own);
    }
    out
}

/// Text on one line that neither opens a comment nor continues one.
fn line(text: &str) -> String {
    let text: String = text.chars().map(|c| if is_printable(c) { c } else { ' ' }).collect();
    let text = text.replace("/*", "/ *").replace("//", "/ /").replace("*/", "* /").replace('\\', "/");
    text.replace("??", "? ?")
}

/// A number of C.
fn number(x: f64) -> String {
    format!("{:?}", x + 0.0)
}

/// `{1.0, 2.0}`, filled up with zeros.
fn row(values: &[f64], room: usize) -> String {
    let all: Vec<String> =
        values.iter().copied().chain(std::iter::repeat(0.0)).take(room.max(values.len())).map(number).collect();
    format!("{{{}}}", all.join(", "))
}

fn rows(values: &[Vec<f64>], room: [usize; 2]) -> String {
    let none = vec![];
    let all: Vec<String> = (0..room[0]).map(|k| row(values.get(k).unwrap_or(&none), room[1])).collect();
    format!("{{{}}}", all.join(",\n     "))
}

fn integers(values: &[usize], room: usize) -> String {
    let all: Vec<String> = values
        .iter()
        .copied()
        .chain(std::iter::repeat(0))
        .take(room.max(values.len()))
        .map(|x| format!("{x}u"))
        .collect();
    format!("{{{}}}", all.join(", "))
}

/// Names as C has them.
struct Names {
    /// Prefix of functions and types; in capitals that of macros and enumerators.
    own: String,
    states: Vec<String>,
    /// Without the housing.
    members: Vec<String>,
    shift_elements: Vec<String>,
    meshes: Vec<String>,
    drags: Vec<String>,
}

impl Names {
    fn upper(&self) -> String {
        self.own.to_ascii_uppercase()
    }

    fn member(&self, m: MemberId) -> &str {
        &self.members[m.index() - 1]
    }
}

/// All files of an export.
fn files(train: &Train, plan: &Plan, simulink: bool) -> Result<FilesAndNotes, Diagnostics> {
    let mut notes = plan.notes.clone();
    let constant = at_the_load(train, plan, &mut notes)?;
    let train = constant.as_ref().unwrap_or(train);
    let own = identifier(train.name());
    let names = Names {
        own: if own.starts_with(|c: char| c.is_ascii_digit()) { format!("t{own}") } else { own },
        states: identifiers(plan.states.iter().map(|s| s.as_deref().unwrap_or(AS_DRAWN))),
        members: identifiers(train.members()[1..].iter().map(|m| m.name.as_str())),
        shift_elements: identifiers(train.shift_elements().iter().map(|e| e.name.as_str())),
        meshes: identifiers(train.meshes().iter().map(|m| m.name.as_str())),
        drags: identifiers(train.drags().iter().map(|d| d.name.as_str())),
    };
    let mut all = vec![];
    for state in &plan.states {
        all.push(tables(train, state.as_deref(), &plan.speeds, &plan.torques, &plan.fixed)?);
    }
    for (state, t) in plan.states.iter().zip(&all) {
        let title = state.as_ref().map_or_else(|| AS_DRAWN.to_owned(), |s| format!("state {s}"));
        let unknown = train.shift_elements().iter().zip(&t.shift_elements);
        let unknown: Vec<&str> =
            unknown.filter(|(_, o)| **o == Some(TableOutput::Unknown)).map(|(e, _)| e.name.as_str()).collect();
        if !unknown.is_empty() {
            let told = unknown.join(", ");
            notes.push(format!(
                "{title}: the torques of {told} do not follow from statics; shift_torque_known is 0 there"
            ));
        }
        if !t.certified {
            notes.push(format!(
                "{title}: not every load has exactly one equilibrium; the verdict says where there is none (locked) or several, \
                 and of several the first pattern of drivers is answered"
            ));
        }
    }
    notes.push(
        "external torques and speeds count in one sense of rotation, N m and rad/s: power enters where their product is \
         positive; an element at rest relative to its carrier transmits without loss; drags do nothing at rest"
            .into(),
    );
    let origin = format!("// {}: exported by Willis {}\n", line(train.name()), env!("CARGO_PKG_VERSION"));
    let comments: String = notes.iter().map(|n| format!("// {}\n", line(n))).collect();
    let file = identifier(train.name()).replace('_', "-");
    let mut out = vec![
        ExportedFile::new(
            format!("{file}.h"),
            origin.clone() + &comments + &header(train, plan, &names),
            format!("{} states, what is asked and answered", plan.states.len()),
        ),
        ExportedFile::new(
            format!("{file}.c"),
            origin.clone() + &source(train, plan, &names, &all, &file),
            "C99, compiled alone",
        ),
    ];
    if simulink {
        let text = origin + &s_function(train, plan, &names, &file);
        let about = format!("Level-2 S-function: mex {0}_sfun.c {file}.c", names.own);
        out.push(ExportedFile::new(format!("{}_sfun.c", names.own), text, about));
    }
    Ok((out, notes))
}

/// The train with constant efficiencies; none where they are constant already.
fn at_the_load(train: &Train, plan: &Plan, notes: &mut Vec<String>) -> Result<Option<Train>, Diagnostics> {
    let computed: Vec<&str> = train.meshes().iter().filter(|m| m.computed).map(|m| m.name.as_str()).collect();
    let Some(operation) = plan.operation.as_ref().filter(|_| !computed.is_empty()) else {
        if !computed.is_empty() {
            notes.push(format!(
                "the losses of {} are computed from load and speed, which C does not carry: nominal efficiencies stand \
                 for them; an operation says at which load to take them",
                computed.join(", ")
            ));
        }
        return Ok(None);
    };
    let Some(found) = frozen(train, operation) else {
        let message =
            format!("the operation `{}` has no single equilibrium from which to take efficiencies", operation.name);
        return Err(Diagnostic::new(Code::Unfit, "", message).hint("choose another operation, or none").into());
    };
    let told: Vec<String> = (found.meshes().iter().zip(train.meshes()).filter(|(_, m)| m.computed))
        .map(|(f, m)| format!("{} {}", m.name, f.efficiency.forward.to_f64()))
        .collect();
    notes.push(format!(
        "computed losses are those at the load of operation `{}`, constant efficiencies at every other: {}",
        operation.name,
        told.join(", ")
    ));
    Ok(Some(found))
}

fn header(train: &Train, plan: &Plan, names: &Names) -> String {
    let (p, u) = (&names.own, names.upper());
    let mut out = format!(
        "#ifndef {u}_H\n#define {u}_H\n\n#include <stdint.h>\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n"
    );
    let counts = [
        ("STATES", plan.states.len(), "states of the shift table"),
        ("SPEEDS", plan.speeds.len(), "speeds that are given at a point"),
        ("TORQUES", plan.torques.len(), "external torques that are given"),
        ("MEMBERS", names.members.len(), "members, whose speeds are answered"),
        ("TERMINALS", train.terminals().len(), "terminals, whose external torques are answered"),
        ("SHIFT_ELEMENTS", names.shift_elements.len(), "shift elements"),
        ("MESHES", names.meshes.len(), "meshes, whose losses are answered"),
        ("DRAGS", names.drags.len(), "drags, likewise"),
    ];
    for (name, n, about) in counts {
        let _ = writeln!(out, "#define {u}_{name} {n}u /* {about} */");
    }
    let _ = writeln!(out, "#define {u}_ROOM(n) (((n) > 0u) ? (n) : 1u) /* an array has at least one place */");
    let _ = writeln!(out, "#define {u}_LIMIT 1.0e12 /* larger inputs are out of range */\n");
    let mut list = |name: &str, about: &str, values: Vec<String>| {
        if !values.is_empty() {
            let all: Vec<String> = values.iter().enumerate().map(|(k, v)| format!("    {u}_{v} = {k}")).collect();
            let _ = writeln!(out, "/* {about} */\ntypedef enum {{\n{}\n}} {p}_{name}_t;\n", all.join(",\n"));
        }
    };
    let of = |what: &str, all: &[String]| -> Vec<String> {
        all.iter().map(|n| format!("{what}_{}", n.to_ascii_uppercase())).collect()
    };
    let id = |name: &String| train.member(name).map_or(String::new(), |m| names.member(m).to_owned());
    list("state", "States.", of("STATE", &names.states));
    list(
        "speed",
        "Places of the speeds that are given, rad/s.",
        of("SPEED", &plan.speeds.iter().map(id).collect::<Vec<_>>()),
    );
    list(
        "torque",
        "Places of the external torques that are given, N m.",
        of("TORQUE", &plan.torques.iter().map(id).collect::<Vec<_>>()),
    );
    list("member", "Members.", of("MEMBER", &names.members));
    let terminals: Vec<String> = train.terminals().iter().map(|t| names.member(*t).to_owned()).collect();
    list("terminal", "Terminals.", of("TERMINAL", &terminals));
    list("shift_element", "Shift elements.", of("SHIFT", &names.shift_elements));
    list("mesh", "Meshes.", of("MESH", &names.meshes));
    list("drag", "Drags.", of("DRAG", &names.drags));
    list(
        "verdict",
        "What can be said of a point. Unique: one equilibrium. Several: the answer is one of them. Locked: friction locks the \
         train,\n   torques and losses are 0 and mean nothing. Out of range: an input is no finite number, or too large; all is 0.",
        ["UNIQUE", "SEVERAL", "LOCKED", "OUT_OF_RANGE"].map(String::from).to_vec(),
    );
    let _ = write!(
        out,
        "/* An answer. */\ntypedef struct {{\n    \
         {p}_verdict_t verdict;\n    \
         double speed[{u}_MEMBERS]; /* rad/s, by member */\n    \
         uint8_t speed_known[{u}_MEMBERS]; /* 0: the speed does not follow from those given */\n    \
         double torque[{u}_TERMINALS]; /* external torque, N m, by terminal */\n    \
         double shift_torque[{u}_ROOM({u}_SHIFT_ELEMENTS)]; /* on its first member, N m, by shift element; 0 while open */\n    \
         uint8_t shift_torque_known[{u}_ROOM({u}_SHIFT_ELEMENTS)]; /* 0: not determined by statics */\n    \
         double mesh_loss[{u}_ROOM({u}_MESHES)]; /* W, by mesh */\n    \
         double drag_loss[{u}_ROOM({u}_DRAGS)]; /* W, by drag */\n    \
         double loss; /* sum of the external powers, W */\n    \
         double power_in; /* what enters at the terminals, W */\n    \
         double efficiency; /* what leaves over what enters; 0 where nothing enters */\n\
         }} {p}_result_t;\n\n\
         /* Torques and losses at a point. Allocates nothing, keeps nothing, and may be called from several threads. */\n\
         {p}_verdict_t {p}_evaluate({p}_state_t state, const double speeds[{u}_SPEEDS],\n    \
         const double torques[{u}_ROOM({u}_TORQUES)], {p}_result_t *result);\n\n\
         #ifdef __cplusplus\n}}\n#endif\n\n#endif\n"
    );
    out
}

fn source(train: &Train, plan: &Plan, names: &Names, all: &[Tables], file: &str) -> String {
    let (p, u) = (&names.own, names.upper());
    let e = all.iter().map(|t| t.elements.len()).max().unwrap_or(0).max(1);
    let inputs = plan.torques.len() + train.drags().len();
    let (x, s) = (inputs.max(1), plan.speeds.len());
    let terminals = train.terminals().len();
    let outputs = terminals + train.shift_elements().len();
    let meshes = train.meshes().len().max(1);
    let (members, torques, shifts) = (names.members.len(), plan.torques.len(), names.shift_elements.len());
    let mut out = format!("#include \"{file}.h\"\n\n");
    // Loops over nothing compare with a variable that is never less than zero, which compilers complain of.
    let _ = write!(
        out,
        "#define {u}_E {e}u /* most elements of a state */\n#define {u}_X {x}u /* torques given, and those of drags */\n\
         #define {u}_OUTPUTS {outputs}u\n#define {u}_NO_ELEMENT 255u\n\
         #define {u}_KIND_NONE 0u\n#define {u}_KIND_INPUT 1u\n#define {u}_KIND_LINEAR 2u\n#define {u}_KIND_UNKNOWN 3u\n\n\
         typedef struct {{\n    uint8_t elements;\n    uint8_t movings;\n    uint8_t certified; /* every load has one solution */\n    \
         uint8_t moving[{u}_E]; /* elements whose direction of power matters */\n    \
         double rho[{u}_E][2]; /* end p drives; the other end drives */\n    \
         double relative[{u}_E][{u}_SPEEDS];\n    double arm[{u}_E];\n    \
         double constant[{u}_E][{u}_E];\n    double slope[{u}_E][{u}_E];\n    double right[{u}_E][{u}_X];\n    \
         double speed[{u}_MEMBERS][{u}_SPEEDS];\n    uint8_t speed_known[{u}_MEMBERS];\n    \
         uint8_t kind[{u}_OUTPUTS]; /* terminals, then shift elements */\n    uint8_t input[{u}_OUTPUTS];\n    \
         double direct[{u}_OUTPUTS][{u}_X];\n    double at_zero[{u}_OUTPUTS][{u}_E];\n    double at_rho[{u}_OUTPUTS][{u}_E];\n    \
         uint8_t element_of_mesh[{meshes}];\n    double share[{meshes}][2]; /* loss over the power at end p */\n\
         }} {p}_table_t;\n\n"
    );
    let tables: Vec<String> = plan
        .states
        .iter()
        .zip(all)
        .map(|(state, t)| {
            let title = state.as_deref().unwrap_or(AS_DRAWN);
            table(t, title, &Room { e, x, s, meshes, outputs, members, terminals })
        })
        .collect();
    let _ = write!(out, "static const {p}_table_t {p}_tables[{u}_STATES] = {{\n{}\n}};\n\n", tables.join(",\n"));
    let at: Vec<usize> = train.terminals().iter().map(|t| t.index() - 1).collect();
    let _ = write!(out, "static const uint8_t {p}_terminal_member[{u}_TERMINALS] = {};\n\n", integers(&at, 1));
    if !train.drags().is_empty() {
        out += &drag_tables(train, p, &u);
    }
    let mut runtime = RUNTIME.to_owned();
    if train.drags().is_empty() {
        runtime = runtime.replace("@DRAG@\n", "").replace("@DRAG_CALL@", "");
    } else {
        let call = format!("        {p}_drags(inputs, result);\n");
        runtime = runtime.replace("@DRAG@\n", DRAG).replace("@DRAG_CALL@", &call);
    }
    // A loop over nothing is left out.
    for (name, n) in [("SHIFT_ELEMENTS", shifts), ("TORQUES", torques), ("MESHES", train.meshes().len())] {
        let mark = format!("@U@_{name}_N");
        if n == 0 {
            runtime = without_loops(&runtime, &mark);
        }
        runtime = runtime.replace(&mark, &format!("@U@_{name}"));
    }
    out + &runtime.replace("@P@", p).replace("@U@", &u)
}

/// The text without the loops that run up to `bound`: from their first line to the brace in the same column.
fn without_loops(text: &str, bound: &str) -> String {
    let mut out = String::new();
    let mut skipping: Option<usize> = None;
    for l in text.lines() {
        let indent = l.len() - l.trim_start().len();
        match skipping {
            Some(at) if indent == at && l.trim() == "}" => skipping = None,
            Some(_) => {}
            None if l.trim_start().starts_with("for (") && l.contains(bound) => skipping = Some(indent),
            None => {
                out += l;
                out.push('\n');
            }
        }
    }
    out
}

/// Sizes of arrays.
struct Room {
    e: usize,
    x: usize,
    s: usize,
    meshes: usize,
    outputs: usize,
    members: usize,
    terminals: usize,
}

/// The table of a state.
fn table(t: &Tables, title: &str, room: &Room) -> String {
    let Room { e, x, s, meshes, outputs, members, terminals } = *room;
    let n = t.elements.len();
    let moving: Vec<usize> = (0..n)
        .filter(|&j| t.elements[j].rho[0] != t.elements[j].rho[1] && t.elements[j].relative.iter().any(|x| *x != 0.0))
        .collect();
    let mut constant = vec![vec![0.0; n]; n];
    let mut slope = constant.clone();
    for (j, element) in t.elements.iter().enumerate() {
        for &(r, a, b) in &element.entries {
            constant[r][j] += a;
            slope[r][j] += b;
        }
    }
    let right: Vec<Vec<f64>> = (0..n).map(|r| t.right.iter().map(|of| of[r]).collect()).collect();
    let speeds: Vec<Vec<f64>> = t.speeds[1..].iter().map(|r| r.clone().unwrap_or_default()).collect();
    let known: Vec<usize> = t.speeds[1..].iter().map(|r| usize::from(r.is_some())).collect();
    let (mut kind, mut input) = (vec![0; outputs], vec![0; outputs]);
    let [mut direct, mut at_zero, mut at_rho] = [(); 3].map(|()| vec![vec![]; outputs]);
    let shifts = t.shift_elements.iter().enumerate().filter_map(|(k, o)| Some((terminals + k, o.as_ref()?)));
    for (k, output) in t.terminals.iter().enumerate().chain(shifts) {
        match output {
            TableOutput::Input(i) => (kind[k], input[k]) = (1, *i),
            TableOutput::Linear { direct: d, at_zero: z, slope: r } => {
                kind[k] = 2;
                (direct[k], at_zero[k], at_rho[k]) = (d.clone(), z.clone(), r.clone());
            }
            _ => kind[k] = 3,
        }
    }
    let mut element_of = vec![255; meshes];
    let mut share = vec![vec![0.0; 2]; meshes];
    for (j, element) in t.elements.iter().enumerate() {
        for m in &element.meshes {
            element_of[m.mesh] = j;
            share[m.mesh] = m.share.to_vec();
        }
    }
    let of = |f: &dyn Fn(&willis::compiled::TableElement) -> Vec<f64>| t.elements.iter().map(f).collect::<Vec<_>>();
    let arms: Vec<f64> = t.elements.iter().map(|e| e.arm).collect();
    let parts = [
        format!("{n}u, {}u, {}u", moving.len(), u8::from(t.certified)),
        integers(&moving, e),
        rows(&of(&|e| e.rho.to_vec()), [e, 2]),
        rows(&of(&|e| e.relative.clone()), [e, s]),
        row(&arms, e),
        rows(&constant, [e, e]),
        rows(&slope, [e, e]),
        rows(&right, [e, x]),
        rows(&speeds, [members, s]),
        integers(&known, members),
        integers(&kind, outputs),
        integers(&input, outputs),
        rows(&direct, [outputs, x]),
        rows(&at_zero, [outputs, e]),
        rows(&at_rho, [outputs, e]),
        integers(&element_of, meshes),
        rows(&share, [meshes, 2]),
    ];
    format!("    /* {} */\n    {{{}}}", line(title), parts.join(",\n    "))
}

/// Points and members of the drags.
fn drag_tables(train: &Train, p: &str, u: &str) -> String {
    let mut points: Vec<Vec<f64>> = vec![];
    let mut drags: Vec<String> = vec![];
    for d in train.drags() {
        let place = |m: MemberId| if m == FRAME { 255 } else { m.index() - 1 };
        let own = d.torque.points();
        drags.push(format!(
            "    {{{}u, {}u, {}, {}}}",
            points.len(),
            own.len(),
            integers(&d.members.map(place), 2),
            number(d.viscous)
        ));
        points.extend(own.iter().map(|p| p.to_vec()));
    }
    format!(
        "/* Slip, rad/s, and torque, N m. */\nstatic const double {p}_drag_points[{}][2] =\n    {};\n\n\
         typedef struct {{\n    uint16_t first;\n    uint16_t points;\n    uint8_t member[2]; /* 255: the housing */\n    \
         double viscous; /* N m s */\n}} {p}_drag_data_t;\n\n\
         static const {p}_drag_data_t {p}_drag_table[{u}_DRAGS] = {{\n{}\n}};\n\n",
        points.len(),
        rows(&points, [points.len(), 2]),
        drags.join(",\n")
    )
}

/// A Level-2 C MEX S-function: inputs state, speeds, torques; outputs speeds, torques, torques of shift elements, losses of
/// meshes, losses of drags, `[loss, power in, efficiency]`, verdict. Source: the macros of Simulink's `simstruc.h` and the
/// template `sfuntmpl_basic.c`.
fn s_function(train: &Train, plan: &Plan, names: &Names, file: &str) -> String {
    let (p, u) = (&names.own, names.upper());
    let mut inputs = vec![("1", "state"), ("SPEEDS", "speeds")];
    if !plan.torques.is_empty() {
        inputs.push(("TORQUES", "torques"));
    }
    let mut outputs = vec![("MEMBERS", "speed"), ("TERMINALS", "torque")];
    let may = [
        ("SHIFT_ELEMENTS", "shift_torque", names.shift_elements.len()),
        ("MESHES", "mesh_loss", train.meshes().len()),
        ("DRAGS", "drag_loss", train.drags().len()),
    ];
    outputs.extend(may.iter().filter(|o| o.2 > 0).map(|o| (o.0, o.1)));
    let width = |of: &str| if of.parse::<u8>().is_ok() { of.to_owned() } else { format!("(int_T){u}_{of}") };
    let mut sizes = String::new();
    for (k, (n, _)) in inputs.iter().enumerate() {
        let _ = write!(
            sizes,
            "    ssSetInputPortWidth(S, {k}, {});\n    ssSetInputPortRequiredContiguous(S, {k}, 1);\n    \
             ssSetInputPortDirectFeedThrough(S, {k}, 1);\n",
            width(n)
        );
    }
    let (scalars, verdict) = (outputs.len(), outputs.len() + 1);
    let _ = writeln!(sizes, "    if (!ssSetNumOutputPorts(S, {})) {{ return; }}", outputs.len() + 2);
    for (k, (n, _)) in outputs.iter().chain(&[("3", ""), ("1", "")]).enumerate() {
        let _ = writeln!(sizes, "    ssSetOutputPortWidth(S, {k}, {});", width(n));
    }
    let mut copies = String::new();
    for (k, (n, field)) in outputs.iter().enumerate() {
        let _ = write!(
            copies,
            "    y = ssGetOutputPortRealSignal(S, {k});\n    for (k = 0u; k < {u}_{n}; k++) {{ y[k] = result.{field}[k]; }}\n"
        );
    }
    let told: Vec<&str> = inputs.iter().map(|i| i.1).collect();
    let answered: Vec<&str> = outputs.iter().map(|o| o.1).collect();
    let torques = if plan.torques.is_empty() {
        "&none".to_owned()
    } else {
        "(const real_T *)ssGetInputPortSignal(S, 2)".to_owned()
    };
    let none = if plan.torques.is_empty() { "    const real_T none = 0.0;\n" } else { "" };
    format!(
        "// Inputs: {}; outputs: {}, [loss power_in efficiency], verdict. State and verdict are the numbers of {file}.h.\n\
         // Build: mex {p}_sfun.c {file}.c\n\n\
         #define S_FUNCTION_NAME {p}_sfun\n#define S_FUNCTION_LEVEL 2\n\n#include \"simstruc.h\"\n#include \"{file}.h\"\n\n\
         static void mdlInitializeSizes(SimStruct *S)\n{{\n    ssSetNumSFcnParams(S, 0);\n    \
         if (ssGetNumSFcnParams(S) != ssGetSFcnParamsCount(S)) {{ return; }}\n    \
         ssSetNumContStates(S, 0);\n    ssSetNumDiscStates(S, 0);\n    \
         if (!ssSetNumInputPorts(S, {})) {{ return; }}\n{sizes}    ssSetNumSampleTimes(S, 1);\n    \
         ssSetOptions(S, SS_OPTION_EXCEPTION_FREE_CODE);\n}}\n\n\
         static void mdlInitializeSampleTimes(SimStruct *S)\n{{\n    ssSetSampleTime(S, 0, INHERITED_SAMPLE_TIME);\n    \
         ssSetOffsetTime(S, 0, 0.0);\n}}\n\n\
         static void mdlOutputs(SimStruct *S, int_T tid)\n{{\n    {p}_result_t result;\n{none}    \
         const real_T *wished = (const real_T *)ssGetInputPortSignal(S, 0);\n    \
         const real_T *speeds = (const real_T *)ssGetInputPortSignal(S, 1);\n    \
         const real_T *torques = {torques};\n    \
         real_T *y;\n    uint32_t k;\n    uint32_t state = {u}_STATES; /* no state */\n\n    (void)tid;\n    \
         if ((wished[0] >= 0.0) && (wished[0] < (real_T){u}_STATES)) {{ state = (uint32_t)wished[0]; }}\n    \
         (void){p}_evaluate(({p}_state_t)state, speeds, torques, &result);\n\
         {copies}    y = ssGetOutputPortRealSignal(S, {scalars});\n    y[0] = result.loss;\n    y[1] = result.power_in;\n    \
         y[2] = result.efficiency;\n    y = ssGetOutputPortRealSignal(S, {verdict});\n    y[0] = (real_T)result.verdict;\n}}\n\n\
         static void mdlTerminate(SimStruct *S)\n{{\n    (void)S;\n}}\n\n\
         #ifdef MATLAB_MEX_FILE\n#include \"simulink.c\"\n#else\n#include \"cg_sfun.h\"\n#endif\n",
        told.join(", "),
        answered.join(", "),
        inputs.len(),
    )
}
