//! Exported C, compiled by the C compiler of the machine, beside the library at many points.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use willis::analysis::operate;
use willis::compiled::{CompileRequest, CompiledOutput, PointVerdict};
use willis::model::Model;
use willis::study::export::{Export, ExportRequest};
use willis::train::{Operation, Train};
use willis::units::{AngularSpeed, Torque};
use willis_exchange::c;

/// Strict: what a reviewer of a controller would ask for.
const FLAGS: &[&str] =
    &["-std=c99", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Wshadow", "-Wfloat-equal", "-Werror"];

fn model(name: &str) -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples").join(format!("{name}.toml"));
    Model::from_toml(&fs::read_to_string(path).unwrap()).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn exported(model: &Model, kind: &str, request: &ExportRequest) -> Export {
    c::write(model, kind, request).unwrap_or_else(|e| panic!("{e}"))
}

fn operation(name: &str) -> ExportRequest {
    ExportRequest { operation: Some(name.into()), ..ExportRequest::default() }
}

/// A folder of a test with the files in it.
fn folder(name: &str, out: &Export) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("c-{name}"));
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    for f in &out.files {
        fs::write(folder.join(&f.name), &f.text).unwrap();
    }
    folder
}

/// The program, or `None` where there is no C compiler.
fn compiled(folder: &Path, arguments: &[String]) -> Option<PathBuf> {
    let program = folder.join("program");
    let done = Command::new("cc").args(FLAGS).args(arguments).arg("-o").arg(&program).current_dir(folder).output();
    match done {
        Err(e) => {
            eprintln!("skipped: there is no C compiler `cc` here ({e})");
            None
        }
        Ok(done) => {
            assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
            Some(program)
        }
    }
}

/// What the program answers.
fn answers(program: &Path, input: &[f64]) -> Vec<f64> {
    let mut child = Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let bytes: Vec<u8> = input.iter().flat_map(|x| x.to_le_bytes()).collect();
    let mut stdin = child.stdin.take().unwrap();
    let writer = std::thread::spawn(move || stdin.write_all(&bytes));
    let done = child.wait_with_output().unwrap();
    writer.join().unwrap().unwrap();
    assert!(done.status.success());
    done.stdout.chunks_exact(8).map(|b| f64::from_le_bytes(b.try_into().unwrap())).collect()
}

/// Number of a macro of the header.
fn count(header: &str, name: &str) -> usize {
    let line = header.lines().find(|l| l.starts_with("#define") && l.contains(&format!("_{name} "))).unwrap();
    line.split(&format!("_{name} ")).nth(1).unwrap().split('u').next().unwrap().parse().unwrap()
}

/// An exported train that answers points.
struct Program {
    path: PathBuf,
    /// Members, terminals, shift elements, meshes, drags; the last three with one place at least.
    sizes: [usize; 5],
}

/// An answer of it.
#[derive(Debug)]
struct Point {
    verdict: usize,
    speeds: Vec<f64>,
    torques: Vec<f64>,
    shift: Vec<f64>,
    mesh: Vec<f64>,
    drag: Vec<f64>,
    loss: f64,
    efficiency: f64,
}

impl Program {
    fn new(name: &str, out: &Export) -> Option<Self> {
        let folder = folder(name, out);
        let [h, c] = [0, 1].map(|k| out.files[k].name.clone());
        let header = &out.files[0].text;
        let own = h.trim_end_matches(".h").replace('-', "_");
        let n = |name: &str| count(header, name);
        let main = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c/points.c");
        let arguments = [
            format!("-DHEADER=\"{h}\""),
            format!("-DP(x)={own}_##x"),
            format!("-DN_SPEEDS={}", n("SPEEDS")),
            format!("-DN_TORQUES={}", n("TORQUES").max(1)),
            format!("-I{}", folder.display()),
            main.display().to_string(),
            c,
        ];
        let path = compiled(&folder, &arguments)?;
        let sizes = ["MEMBERS", "TERMINALS", "SHIFT_ELEMENTS", "MESHES", "DRAGS"];
        let mut sizes = sizes.map(n);
        sizes[2..].iter_mut().for_each(|s| *s = (*s).max(1));
        Some(Self { path, sizes })
    }

    fn ask(&self, points: &[Vec<f64>]) -> Vec<Point> {
        let all = answers(&self.path, &points.concat());
        let [m, t, s, g, d] = self.sizes;
        let each = 1 + m + t + s + g + d + 3;
        assert_eq!(all.len(), each * points.len());
        let point = |of: &[f64]| {
            let mut rest = of;
            let mut take = |n: usize| {
                let (own, more) = rest.split_at(n);
                rest = more;
                own.to_vec()
            };
            let verdict = take(1)[0] as usize;
            let [speeds, torques, shift, mesh, drag] = [m, t, s, g, d].map(&mut take);
            let last = take(3);
            Point { verdict, speeds, torques, shift, mesh, drag, loss: last[0], efficiency: last[2] }
        };
        all.chunks_exact(each).map(point).collect()
    }
}

/// Numbers from -1 to 1, the same in every run.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

fn close(a: f64, b: f64, scale: f64) -> bool {
    (a - b).abs() <= 1e-9 * scale.max(a.abs()).max(1e-9)
}

/// The same points in C and in the compiled train: every torque, the loss, the efficiency, the verdict; the losses of the
/// meshes sum up to the loss. Returns how many were unique, several, locked.
fn beside(
    name: &str,
    model: &Model,
    request: &ExportRequest,
    speeds: &[&str],
    torques: &[&str],
    states: &[Option<&str>],
    n: usize,
) -> Option<[usize; 3]> {
    let out = exported(model, "c", request);
    let program = Program::new(name, &out)?;
    let train = model.train();
    let mut random = Random(1841);
    let mut found = [0; 3];
    for (k, state) in states.iter().enumerate() {
        let mut points: Vec<Vec<f64>> = vec![];
        for i in 0..n {
            let mut point = vec![k as f64];
            point.extend(speeds.iter().map(|_| 300.0 * random.next()));
            point.extend(torques.iter().map(|_| 500.0 * random.next()));
            if torques.is_empty() {
                point.push(0.0);
            }
            // Standstill and no load, too.
            if i % 97 == 0 {
                point[1 + (i / 97) % (speeds.len() + torques.len())] = 0.0;
            }
            points.push(point);
        }
        let mut duty = CompileRequest::new(speeds.iter().copied(), torques.iter().copied());
        if let Some(state) = state {
            duty = duty.state(state);
        }
        let terminals: Vec<&str> = train.terminals().iter().map(|t| train.member_name(*t)).collect();
        for t in &terminals {
            duty = duty.output(CompiledOutput::Torque((*t).into()));
        }
        let compiled = train.compile(&duty.output(CompiledOutput::Loss).output(CompiledOutput::Efficiency)).unwrap();
        let mut work = compiled.workspace();
        let mut own = vec![0.0; terminals.len() + 2];
        for (point, c) in points.iter().zip(program.ask(&points)) {
            let (w, t) = point[1..].split_at(speeds.len());
            let verdict = compiled.evaluate(w, &t[..torques.len()], &mut work, &mut own);
            let wanted = match verdict {
                PointVerdict::Unique => 0,
                PointVerdict::Multiple => 1,
                PointVerdict::Locked => 2,
                other => panic!("{other:?}"),
            };
            assert_eq!(c.verdict, wanted, "{state:?} {point:?} {c:?}");
            found[wanted] += 1;
            if wanted == 2 {
                continue;
            }
            let most = own[..terminals.len()].iter().fold(0.0f64, |m, x| m.max(x.abs()));
            for (a, b) in c.torques.iter().zip(&own) {
                assert!(close(*a, *b, most), "{state:?} {point:?}: {a} {b}");
            }
            let power = most * c.speeds.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            let [loss, efficiency] = own[terminals.len()..] else { panic!() };
            assert!(close(c.loss, loss, power), "{state:?} {point:?}: loss {} {loss}", c.loss);
            let entering = (power * 1e-3 / c.loss.abs().max(1e-30)).max(1.0);
            assert!((c.efficiency - efficiency).abs() < 1e-6 * entering.max(1.0), "{state:?} {point:?}");
            let meshes: f64 = c.mesh.iter().sum();
            assert!(close(meshes, c.loss, power), "{state:?} {point:?}: {meshes} {}", c.loss);
        }
    }
    Some(found)
}

#[test]
fn val_c_answers_as_the_library_at_a_hundred_thousand_points() {
    let zf = model("zf-8hp70");
    let names: Vec<String> = zf.train().states().iter().map(|s| s.name.clone()).collect();
    let states: Vec<Option<&str>> = names.iter().map(|n| Some(n.as_str())).collect();
    let Some(found) = beside("8hp", &zf, &ExportRequest::default(), &["input"], &["input"], &states, 6000) else {
        return;
    };
    assert_eq!(found, [6000 * states.len(), 0, 0]);
    // No certificate: locked, or several.
    let wolfrom = model("wolfrom-498-self-locking");
    let found = beside("wolfrom", &wolfrom, &ExportRequest::default(), &["sun"], &["sun"], &[None], 30_000).unwrap();
    assert!(found.iter().all(|n| *n > 0) || found[2] > 0, "{found:?}");
    let text = "format = 1\nname = \"split\"\nmembers = [\"s\", \"r\", \"c\"]\nterminals = [\"s\", \"r\", \"c\"]\n\
        [[set]]\nname = \"P1\"\nsun = { member = \"s\", teeth = 30 }\nring = { member = \"r\", teeth = 78 }\ncarrier = \"c\"\n\
        mesh_efficiency = 0.97\n[[operation]]\nname = \"both\"\nspeeds = { s = \"100 rpm\", c = \"50 rpm\" }\n\
        torques = { s = \"10 N m\" }\n";
    let split = Model::from_toml(text).unwrap();
    let found = beside("split", &split, &operation("both"), &["c", "s"], &["s"], &[None], 30_000).unwrap();
    assert_eq!(found, [30_000, 0, 0]);
}

/// Drags between any two members: beside `operate`, point by point.
#[test]
fn val_c_has_drags_and_losses_by_their_names() {
    let text = "format = 1\nname = \"with drags\"\nmembers = [\"s\", \"c\", \"r\"]\nterminals = [\"s\", \"c\"]\n\
        [[set]]\nname = \"P1\"\nsun = { member = \"s\", teeth = 30 }\nring = { member = \"r\", teeth = 78 }\ncarrier = \"c\"\n\
        mesh_efficiency = 0.97\n[[shift_element]]\nname = \"B\"\nkind = \"brake\"\nmembers = [\"r\"]\n\
        [[drag]]\nname = \"seal\"\nmembers = [\"s\", \"frame\"]\ncoulomb = \"0.4 N m\"\nviscous = \"0.002 N m s/rad\"\n\
        [[drag]]\nname = \"ring\"\nmembers = [\"c\", \"s\"]\ntable = [[\"0 rad/s\", \"0.1 N m\"], [\"20 rad/s\", \"0.5 N m\"], [\"90 rad/s\", \"0.2 N m\"]]\n\
        [[state]]\nname = \"1\"\nengaged = [\"B\"]\n";
    let model = match Model::from_toml(text) {
        Ok(model) => model,
        Err(e) => panic!("{e}"),
    };
    let out = exported(&model, "c", &ExportRequest::default());
    let Some(program) = Program::new("drags", &out) else { return };
    let train = model.train();
    let mut random = Random(7);
    let points: Vec<Vec<f64>> = (0..300).map(|_| vec![0.0, 100.0 * random.next(), 60.0 * random.next()]).collect();
    let sun = train.member("s").unwrap();
    let carrier = train.member("c").unwrap();
    for (point, c) in points.iter().zip(program.ask(&points)) {
        let at = at_point(train, "1", sun, point[1], point[2]);
        let (report, _) = operate(train, &at).unwrap();
        let [s] = &report.solutions[..] else { panic!("{:?}", report.verdict) };
        let torque = s.members.get("c").unwrap().torque_n_m.unwrap();
        assert!(close(c.torques[1], torque, torque.abs()), "{point:?}: {} {torque}", c.torques[1]);
        assert!(close(c.loss, s.loss_w, s.loss_w), "{point:?}: {} {}", c.loss, s.loss_w);
        let parts: f64 = c.mesh.iter().chain(&c.drag).sum();
        assert!(close(parts, c.loss, c.loss), "{parts} {}", c.loss);
        assert!(c.drag.iter().all(|x| *x >= 0.0) && c.shift.len() == 1);
        assert!((c.speeds[carrier.index() - 1] - point[1] * 30.0 / 108.0).abs() < 1e-12 * point[1].abs());
    }
    // What a controller may get wrong is told, and nothing is read beyond a table.
    let odd = [vec![1.0, 10.0, 1.0], vec![-1.0, 10.0, 1.0], vec![0.0, f64::NAN, 1.0], vec![0.0, 1.0, f64::INFINITY]];
    assert!(program.ask(&odd).iter().all(|p| p.verdict == 3 && p.loss == 0.0));
}

fn at_point(train: &Train, state: &str, sun: willis::train::MemberId, speed: f64, torque: f64) -> Operation {
    let mut at = Operation::new("here").speed(sun, AngularSpeed::rad_s(speed)).load(sun, Torque::n_m(torque));
    at.state = Some(train.find_state(state).unwrap());
    at
}

#[test]
fn the_s_function_compiles_and_answers() {
    let zf = model("zf-8hp70");
    let out = exported(&zf, "simulink", &ExportRequest::default());
    let folder = folder("simulink", &out);
    let stubs = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/c");
    let [_, c, s] = [0, 1, 2].map(|k| out.files[k].name.clone());
    let Some(program) = compiled(&folder, &[format!("-I{}", stubs.display()), s, c]) else { return };
    let all = answers(&program, &[0.0, 100.0, 50.0]);
    // 8HP70, first gear: 4.696 : 1, output speed and torque.
    let train = zf.train();
    let output = train.member("output").unwrap();
    let ratio = 100.0 / all[output.index() - 1];
    assert!((ratio - 4.696).abs() < 0.02, "{ratio}");
    assert_eq!(*all.last().unwrap(), 0.0, "unique");
}

#[test]
fn what_c_does_not_carry_is_told() {
    let fva = model("fva-planetary-stage");
    let out = exported(&fva, "c", &ExportRequest::default());
    assert!(out.notes.iter().any(|n| n.contains("nominal efficiencies stand")), "{:?}", out.notes);
    assert!(out.not_carried.iter().any(|n| n.key.starts_with("oil")), "{:?}", out.not_carried);
    assert!(out.files[0].text.lines().nth(1).unwrap().starts_with("// not carried over"));
    let name = &fva.train().operations()[0].name;
    let out = exported(&fva, "c", &operation(name));
    assert!(out.notes.iter().any(|n| n.contains("at the load of operation")), "{:?}", out.notes);
    let ranges = ExportRequest { speeds: Some("1 rpm".into()), ..ExportRequest::default() };
    assert!(c::write(&fva, "c", &ranges).unwrap_err().to_string().contains("any speed"));
}

#[test]
fn every_example_is_c_or_told_why_not() {
    let at = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut sources = vec![];
    for entry in fs::read_dir(at).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|e| e != "toml") {
            continue;
        }
        let Ok(model) = Model::from_toml(&fs::read_to_string(&path).unwrap()) else { continue };
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        match c::write(&model, "c", &ExportRequest::default()) {
            Ok(out) => sources.push((name, out)),
            Err(e) => assert!(!e.to_string().is_empty(), "{name}"),
        }
    }
    assert!(sources.len() > 20, "{}", sources.len());
    for (name, out) in sources {
        let folder = folder(&format!("example-{name}"), &out);
        let program = compiled(&folder, &["-fsyntax-only".into(), out.files[1].name.clone()]);
        if program.is_none() {
            return;
        }
    }
}
