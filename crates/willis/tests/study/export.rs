//! Exports: every format read back by its own grammar, and its numbers beside those of the analysis.

use std::collections::BTreeMap;

use willis::analysis::{Analysis, Selection, Verdict, analyze};
use willis::exact::Rational;
use willis::model::Model;
use willis::study::export::{Export, ExportRequest, KINDS, export};
use willis::train::Train;

use crate::common::{example, examples};

fn train(name: &str) -> Model {
    Model::from_toml(&example(name)).unwrap_or_else(|e| panic!("{name}: {e}"))
}

fn list(all: &[&str]) -> Option<String> {
    Some(all.join(", "))
}

fn state(name: &str) -> ExportRequest {
    ExportRequest { state: Some(name.into()), ..ExportRequest::default() }
}

fn all_states() -> ExportRequest {
    ExportRequest { all_states: true, ..ExportRequest::default() }
}

/// A small grid, for trains whose losses are computed.
fn small(request: ExportRequest) -> ExportRequest {
    ExportRequest {
        speeds: list(&["300 rpm", "900 rpm", "1500 rpm"]),
        torques: list(&["-1200 N m", "-600 N m", "-200 N m", "200 N m", "600 N m", "1200 N m"]),
        ..request
    }
}

fn made(train: &Model, kind: &str, request: &ExportRequest) -> Export {
    export(train, kind, request).unwrap_or_else(|e| panic!("{kind}: {e}"))
}

/// An operation put into the text of a train, analysed: torque on the output, loss, efficiency.
fn analysed(file: &str, of: Option<&str>, input: &str, output: &str, rpm: &str, torque: &str) -> [Option<f64>; 3] {
    let place = of.map_or(String::new(), |s| format!("state = \"{s}\"\n"));
    let text = format!(
        "{}\n[[operation]]\nname = \"here\"\n{place}speeds = {{ {input} = \"{rpm} rpm\" }}\ntorques = {{ {input} = \
         \"{torque} N m\" }}\n",
        example(file)
    );
    let train = Train::from_toml(&text).unwrap();
    let selection = Selection { operation: Some("here".into()), ..Selection::default() };
    let a: Analysis = analyze(&train, &selection).unwrap();
    let o = a.operations.iter().find(|o| o.name == "here").unwrap();
    if !matches!(o.verdict, Verdict::Unique | Verdict::Unloaded) {
        return [None; 3];
    }
    let s = &o.solutions[0];
    [s.members.get(output).unwrap().torque_n_m, Some(s.loss_w), s.efficiency]
}

// ---- csv -----------------------------------------------------------------------------------

#[derive(Debug)]
struct CsvRow {
    speed: String,
    torque: String,
    numbers: [Option<f64>; 3],
    verdict: String,
}

fn csv_rows(text: &str) -> Vec<CsvRow> {
    let mut lines = text.lines();
    let header = "state,input_speed_rpm,torque_on_input_n_m,torque_on_output_n_m,loss_w,efficiency,verdict,reason";
    assert_eq!(lines.next(), Some(header));
    let row = |l: &str| {
        let f: Vec<&str> = l.splitn(8, ',').collect();
        assert_eq!(f.len(), 8, "{l}");
        let number = |s: &str| (!s.is_empty()).then(|| s.parse::<f64>().unwrap());
        let numbers = [f[3], f[4], f[5]].map(number);
        let [speed, torque, verdict] = [f[1], f[2], f[6]].map(str::to_owned);
        CsvRow { speed, torque, numbers, verdict }
    };
    lines.map(row).collect()
}

#[test]
fn csv_is_the_analysis_bit_for_bit() {
    let cases: [(&str, Option<&str>, &str, &str, &str); 6] = [
        ("zf-8hp70", Some("1"), "input", "output", "1"),
        ("zf-8hp70", Some("R"), "input", "output", "1"),
        ("fva-planetary-stage", None, "sun", "carrier", "1"),
        ("wolfrom-236", None, "sun", "ring", "1"),
        ("nrel-5mw-stage-1", None, "carrier", "sun", "0.01"),
        ("prius-p112", Some("mg1 held"), "engine", "ring", "1"),
    ];
    for (file, of, input, output, factor) in cases {
        let factor: f64 = factor.parse().unwrap();
        let at = |x: f64| format!("{} rpm", x * factor);
        let request = ExportRequest {
            state: of.map(str::to_owned),
            speeds: list(&[&at(500.0), &at(1200.0)]),
            torques: list(&["-700 N m", "-100 N m", "150 N m", "900 N m"]),
            ..ExportRequest::default()
        };
        let out = made(&train(file), "csv", &request);
        let rows = csv_rows(&out.files[0].text);
        assert_eq!(rows.len(), 8);
        for r in rows {
            let theirs = analysed(file, of, input, output, &r.speed, &r.torque);
            assert_eq!(r.verdict, "unique", "{file} {r:?}");
            assert_eq!(r.numbers.map(|x| x.map(f64::to_bits)), theirs.map(|x| x.map(f64::to_bits)), "{file} {r:?}");
        }
    }
}

#[test]
fn csv_tells_a_lock_and_leaves_its_numbers_empty() {
    let out = made(&train("wolfrom-498-self-locking"), "csv", &ExportRequest::default());
    let rows = csv_rows(&out.files[0].text);
    let sign = |r: &CsvRow| r.torque.parse::<f64>().unwrap();
    assert!(rows.iter().filter(|r| sign(r) < 0.0).all(|r| r.verdict == "locked" && r.numbers == [None; 3]));
    let driving: Vec<_> = rows.iter().filter(|r| sign(r) > 0.0).collect();
    assert!(!driving.is_empty());
    let a = analyze(train("wolfrom-498-self-locking").train(), &Selection::default()).unwrap();
    let eta = a.ratios.0[0].1.drive.efficiency.unwrap();
    for r in &driving {
        assert!((r.numbers[2].unwrap() - eta).abs() < 1e-12, "{r:?} {eta}");
        // The same input torque also balances a load that helps: both feed power in.
        assert_eq!(r.verdict, "multiple");
    }
    assert!(out.notes.iter().any(|n| n.contains("coasting: locked")), "{:?}", out.notes);
    assert!(out.notes.iter().any(|n| n.contains("left empty")), "{:?}", out.notes);
}

// ---- VECTO ---------------------------------------------------------------------------------

/// Rows of a loss map, read and checked by the rules of VECTO's manual and reader.
fn vtlm(text: &str) -> Vec<[f64; 3]> {
    let mut lines = text.lines();
    assert_eq!(lines.next(), Some("Input Speed [rpm],Input Torque [Nm],Torque Loss [Nm]"), "one header line, first");
    let mut rows = Vec::new();
    for line in lines {
        let data = line.split('#').next().unwrap().trim();
        if data.is_empty() {
            continue;
        }
        let fields: Vec<f64> = data.split(',').map(|f| f.trim().parse().unwrap()).collect();
        rows.push(<[f64; 3]>::try_from(fields).expect("three columns"));
    }
    assert!(rows.len() >= 4, "at least four rows");
    assert!(rows.iter().any(|r| r[1] < 0.0) && rows.iter().any(|r| r[1] > 0.0), "negative torque must be there");
    for [n, t, loss] in &rows {
        assert!((0.0..=10_000.0).contains(n) && t.abs() <= 1e5 && (0.0..=1e5).contains(loss), "{n} {t} {loss}");
    }
    assert_eq!(rows[0][0], 0.0, "from standstill on");
    for w in rows.windows(2).filter(|w| w[0][0] == w[1][0]) {
        assert!(w[1][1] > w[0][1], "torques rise");
        assert!(w[1][1] - w[1][2] > w[0][1] - w[0][2], "input torque less loss rises: VECTO triangulates over it");
    }
    assert!(rows.windows(2).all(|w| w[1][0] >= w[0][0]), "speeds rise");
    rows
}

#[test]
fn vecto_maps_give_the_output_torque_back() {
    let zf = train("zf-8hp70");
    let out = made(&zf, "vecto", &all_states());
    // Eight forward gears; reverse is none that VECTO has.
    assert_eq!(out.files.len(), 8);
    assert!(out.notes.iter().any(|n| n.contains("left out: state R")), "{:?}", out.notes);
    let table = analyze(zf.train(), &Selection::default()).unwrap().ratios;
    for (f, (name, row)) in out.files.iter().zip(table.iter()) {
        assert_eq!(f.name, format!("zf-8hp70-{name}.vtlm"));
        let rows = vtlm(&f.text);
        let i = row.value.unwrap();
        assert!(f.about.contains(&format!("gear ratio {}", if i == 1.0 { "1".into() } else { format!("{i:?}") })));
        for [n, t, loss] in rows.iter().filter(|r| r[0] > 0.0 && (r[0] as i64) % 1100 == 0) {
            let [out, ..] = analysed("zf-8hp70", Some(name), "input", "output", &n.to_string(), &t.to_string());
            let out = out.unwrap();
            // T_output = (T_input - T_loss) r_gear, driving and braking.
            assert!(((t - loss) * i + out).abs() <= 1e-9 * out.abs().max(1.0), "{name}: {n} {t} {loss} {out}");
        }
    }
    let fva = train("fva-planetary-stage");
    let out = made(&fva, "vecto", &small(ExportRequest::default()));
    let rows = vtlm(&out.files[0].text);
    for [n, t, loss] in rows.iter().filter(|r| r[0] > 0.0) {
        let [tau, watts, _] = analysed("fva-planetary-stage", None, "sun", "carrier", &n.to_string(), &t.to_string());
        let (tau, watts) = (tau.unwrap(), watts.unwrap());
        assert!(((t - loss) * (78.0 / 17.0) + tau).abs() < 1e-6 * tau.abs().max(1.0));
        assert_eq!(*loss, watts / (n * std::f64::consts::PI / 30.0).abs(), "bit for bit");
    }
    assert_eq!(rows[0][1..], rows[6][1..], "0 rpm repeats the lowest speed");
    assert!(out.notes.iter().any(|n| n.contains("0 rpm repeats")), "{:?}", out.notes);
}

#[test]
fn vecto_refuses_what_it_cannot_hold() {
    let fails = |file: &str, request: &ExportRequest, part: &str| {
        let wrong = export(&train(file), "vecto", request).unwrap_err().to_string();
        assert!(wrong.contains(part), "{wrong}");
    };
    fails("wolfrom-498-self-locking", &ExportRequest::default(), "coasting: friction lets ring drive no load at sun");
    fails("zf-8hp70", &state("R"), "forward gears only");
    let only = |t: &[&str]| ExportRequest { torques: list(t), ..state("1") };
    fails("zf-8hp70", &only(&["10 N m", "20 N m"]), "needs driving and coasting");
    fails("zf-8hp70", &only(&["-200000 N m", "20 N m"]), "from -100000 to 100000");
    fails("zf-8hp70", &ExportRequest { speeds: list(&["12000 rpm"]), ..state("1") }, "from 0 to 10000 rpm");
    fails("zf-8hp70", &ExportRequest { speeds: list(&["0 rpm"]), ..state("1") }, "standing gear");
    // 0 rpm among others is filled from the lowest that moves.
    let out = made(&train("zf-8hp70"), "vecto", &ExportRequest { speeds: list(&["0 rpm", "500 rpm"]), ..state("1") });
    assert_eq!(vtlm(&out.files[0].text).iter().map(|r| r[0]).filter(|n| *n == 0.0).count(), 21);
}

// ---- Modelica ------------------------------------------------------------------------------

fn parsed(source: &str) {
    let read = moparse::parse("train", source, moparse::SyntaxKind::StoredDefinition);
    assert!(read.errors.is_empty(), "{:?}\n{source}", read.errors);
}

/// A fraction or a decimal.
fn rational(text: &str) -> Rational {
    text.trim().parse().unwrap_or_else(|_| Rational::from_f64(text.trim().parse().unwrap()).unwrap())
}

/// `(ratio, rows)` by suffix.
fn loss_tables(source: &str) -> BTreeMap<String, (f64, Vec<[f64; 5]>)> {
    parsed(source);
    let mut all = BTreeMap::new();
    // What stands before the first is no table.
    for piece in source.split("constant Real ratio").skip(1) {
        let (suffix, rest) = piece.split_once(" = ").unwrap();
        let ratio = rational(rest.split(' ').next().unwrap()).to_f64();
        let matrix = rest.split("[:, 5] = [").nth(1).unwrap().split(']').next().unwrap();
        let row = |r: &str| -> [f64; 5] {
            let all: Vec<f64> = r.split(',').map(|x| x.trim().parse().unwrap()).collect();
            all.try_into().unwrap()
        };
        all.insert(suffix.to_owned(), (ratio, matrix.split(';').map(row).collect()));
    }
    all
}

/// LossyGear, equation by equation as in LossyGear.mo: `-flange_b.tau` at a speed and torque of flange_a. Linear
/// interpolation, the last two rows continued; one row is constant.
fn lossy_gear(ratio: f64, table: &[[f64; 5]], w: f64, tau: f64) -> f64 {
    let at = |column: usize| {
        if table.len() == 1 {
            return table[0][column];
        }
        let k = table[..table.len() - 1].iter().rposition(|r| r[0] <= w.abs()).unwrap_or(0);
        let ([a, b], x) = ([&table[k], &table[k + 1]], w.abs());
        a[column] + (b[column] - a[column]) * (x - a[0]) / (b[0] - a[0])
    };
    let [eta1, eta2, b1, b2] = [at(1), at(2), at(3).abs(), at(4).abs()];
    assert!(eta1 > 0.0 && eta1 <= 1.0 && eta2 > 0.0 && eta2 <= 1.0, "{table:?}");
    let tau_bf_a = if eta1 == 1.0 && eta2 == 1.0 { b1 / 2.0 } else { (b1 - b2) / (eta1 - 1.0 / eta2) };
    let [quadrant1, quadrant2] = [(1.0 - eta1) * tau + b1, (1.0 - 1.0 / eta2) * tau + b2];
    let [quadrant4, quadrant3] = [(1.0 - 1.0 / eta2) * tau - b2, (1.0 - eta1) * tau - b1];
    let tau_eta = if w > 0.0 { tau - tau_bf_a } else { tau + tau_bf_a };
    let loss = match (w > 0.0, tau_eta >= 0.0) {
        (true, true) => quadrant1,
        (true, false) => quadrant2,
        (false, true) => quadrant4,
        (false, false) => quadrant3,
    };
    ratio * (tau - loss)
}

#[test]
fn the_loss_table_gives_the_output_torque_back() {
    let zf = made(&train("zf-8hp70"), "modelica-loss-table", &all_states());
    let tables = loss_tables(&zf.files[0].text);
    assert_eq!(tables.len(), 9);
    let mut seen = 0;
    for (suffix, (ratio, table)) in &tables {
        let name = suffix.trim_start_matches('_');
        for (rpm, torque) in [("800", "350"), ("1500", "-120"), ("-900", "40")] {
            let [out, ..] = analysed("zf-8hp70", Some(name), "input", "output", rpm, torque);
            let Some(out) = out else { continue };
            let w = rpm.parse::<f64>().unwrap() * std::f64::consts::PI / 30.0;
            let theirs = lossy_gear(*ratio, table, w, torque.parse().unwrap());
            assert!((theirs + out).abs() < 1e-9 * out.abs(), "{name}: {rpm} {torque}: {theirs} {out}");
            seen += 1;
        }
    }
    assert_eq!(seen, 27);
    for file in ["wolfrom-236", "textbook-reverted"] {
        let out = made(&train(file), "modelica-loss-table", &ExportRequest::default());
        assert_eq!(loss_tables(&out.files[0].text).len(), 1);
    }
    // Computed losses: two lines a speed, and the miss is told.
    let request = small(ExportRequest::default());
    let out = made(&train("fva-planetary-stage"), "modelica-loss-table", &request);
    let (ratio, table) = &loss_tables(&out.files[0].text)[""];
    assert_eq!((table.len(), table[0][0]), (4, 0.0));
    assert_eq!(table[0][1..], table[1][1..]);
    assert!(table.iter().all(|r| r[3] > 0.0 && r[4] > 0.0), "drag without load: {table:?}");
    let note = out.notes.iter().find(|n| n.contains("two lines")).unwrap();
    let told: f64 = note.split("at most ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
    let (mut worst, mut most) = (0.0f64, 0.0f64);
    for n in ["300", "900", "1500"] {
        for t in ["-1200", "-600", "-200", "200", "600", "1200"] {
            let [out, ..] = analysed("fva-planetary-stage", None, "sun", "carrier", n, t);
            let w = n.parse::<f64>().unwrap() * std::f64::consts::PI / 30.0;
            worst = worst.max((lossy_gear(*ratio, table, w, t.parse().unwrap()) + out.unwrap()).abs());
            most = most.max(out.unwrap().abs());
        }
    }
    assert!((100.0 * worst / most - told).abs() < 0.006, "told {told} %, is {} %", 100.0 * worst / most);
    assert!(told < 1.0, "{told}");
}

#[test]
fn a_gear_that_locks_has_no_loss_table() {
    let lock = train("wolfrom-498-self-locking");
    let wrong = export(&lock, "modelica-loss-table", &ExportRequest::default()).unwrap_err().to_string();
    assert!(wrong.contains("coasting: friction lets ring drive no load at sun"), "{wrong}");
}

/// A Modelica model read back as a train: its lossy gears as pairs on carriers, its clutches and brakes.
fn train_of(source: &str, states: &[(&str, Vec<&str>)], ends: [&str; 2]) -> Model {
    parsed(source);
    let mut at: BTreeMap<String, String> = BTreeMap::new();
    for line in source.lines().filter_map(|l| l.trim().strip_prefix("connect(")) {
        let (a, b) = line.trim_end_matches(");").split_once(", ").unwrap();
        let node = b.trim_start_matches("node_").replace("frame.flange", "frame");
        assert!(at.insert(a.to_owned(), node).is_none(), "{a} is connected twice");
    }
    let mut members: Vec<String> = at.values().filter(|n| *n != "frame" && !n.contains('.')).cloned().collect();
    members.sort();
    members.dedup();
    let mut text = format!(
        "format = 1\nname = \"read back\"\nmembers = {members:?}\nterminals = {ends:?}\ninput = \"{}\"\noutput = \"{}\"\n",
        ends[0], ends[1]
    );
    let joined = source.replace("\n    lossTable", " lossTable");
    for line in joined.lines().filter(|l| l.contains("Components.LossyGear ")) {
        let name = line.split("LossyGear ").nth(1).unwrap().split('(').next().unwrap();
        let ratio = rational(line.split("ratio=").nth(1).unwrap().split(',').next().unwrap());
        let row: Vec<&str> = line.split("then [").nth(1).unwrap().split(']').next().unwrap().split(", ").collect();
        assert_eq!([row[0], row[3], row[4]], ["0"; 3]);
        let [a, b, c] = ["flange_a", "flange_b", "support"].map(|f| &at[&format!("{name}.{f}")]);
        // (w_a - w_c) = ratio (w_b - w_c): teeth in the ratio 1 : |ratio|, times the denominator.
        let fraction = ratio.abs().to_fraction();
        let (p, q) = fraction.split_once('/').unwrap();
        let sense = if ratio.sign() > 0 { "same" } else { "opposite" };
        text += &format!(
            "[[mesh]]\nname = \"{name}\"\ngears = [{{ member = \"{a}\", teeth = {q} }}, {{ member = \"{b}\", teeth = {p} }}]\n\
             carrier = \"{c}\"\nsense = \"{sense}\"\nefficiency = {{ forward = {}, backward = {} }}\n",
            rational(row[1]).to_f64(),
            rational(row[2]).to_f64()
        );
    }
    for (kind, own) in [("clutch", "clutch_"), ("brake", "brake_")] {
        for line in source.lines().filter(|l| l.contains(&format!(" {own}")) && !l.contains("connect(")) {
            let name = line.split(&format!(" {own}")).nth(1).unwrap().split('(').next().unwrap();
            let a = &at[&format!("{own}{name}.flange_a")];
            let b = at.get(&format!("{own}{name}.flange_b"));
            let members: Vec<&String> = [Some(a), b].into_iter().flatten().collect();
            text += &format!("[[shift_element]]\nname = \"{name}\"\nkind = \"{kind}\"\nmembers = {members:?}\n");
        }
    }
    for (name, engaged) in states {
        text += &format!("[[state]]\nname = \"{name}\"\nengaged = {engaged:?}\n");
    }
    Model::from_toml(&text).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

#[test]
fn the_model_read_back_is_the_train() {
    for (file, ends) in [
        ("zf-8hp70", ["input", "output"]),
        ("wolfrom-236", ["sun", "ring"]),
        ("wolfrom-498-self-locking", ["sun", "ring"]),
        ("aisin-ab80", ["input", "output"]),
        ("zf-6hp26", ["input", "output"]),
        ("humpage", ["", ""]),
    ] {
        let own = train(file);
        let ends = match ends {
            ["", ""] => [own.train().input().unwrap(), own.train().output().unwrap()]
                .map(|m| own.train().member_name(m).to_owned()),
            [a, b] => [a, b].map(str::to_owned),
        };
        let source = made(&own, "modelica", &ExportRequest::default()).files[0].text.clone();
        // Words of the language get an underscore.
        let word =
            |n: &str| if ["input", "output"].contains(&n) { format!("{n}_") } else { n.replace([' ', '-'], "_") };
        let names: Vec<(&str, Vec<&str>)> = own
            .train()
            .states()
            .iter()
            .map(|s| {
                let engaged = s.engaged.iter().map(|e| own.train().shift_elements()[e.index()].name.as_str());
                (s.name.as_str(), engaged.collect())
            })
            .collect();
        let back = train_of(&source, &names, [&word(&ends[0]), &word(&ends[1])]);
        let [a, b] = [&own, &back].map(|t| analyze(t.train(), &Selection { operation: None, state: None }));
        let (a, b) = (a.unwrap(), b.unwrap());
        assert_eq!(a.ratios.0.len(), b.ratios.0.len(), "{file}");
        for ((name, x), (_, y)) in a.ratios.iter().zip(b.ratios.iter()) {
            assert_eq!(x.exact, y.exact, "{file} {name}");
            for (x, y) in [(&x.drive, &y.drive), (&x.coast, &y.coast)] {
                assert_eq!(x.verdict, y.verdict, "{file} {name}");
                let close = |(x, y): (&f64, &f64)| (x - y).abs() < 1e-9;
                assert!(x.efficiencies.iter().zip(&y.efficiencies).all(close), "{file} {name} {x:?} {y:?}");
            }
        }
    }
}

/// With an operation, computed losses are constant efficiencies at its load; without one, nominal ones, and that is told.
#[test]
fn a_modelica_model_takes_the_efficiencies_of_an_operation() {
    let stage = train("fva-planetary-stage");
    let asked = |operation: Option<&str>| {
        made(&stage, "modelica", &ExportRequest { operation: operation.map(str::to_owned), ..ExportRequest::default() })
    };
    let efficiencies = |out: &Export| -> Vec<f64> {
        let (_, row) = out.files[0].text.split_once("withLosses then [0, ").unwrap();
        row.split(", ").take(2).map(|eta| eta.parse::<Rational>().unwrap().to_f64()).collect()
    };
    let (rated, nominal) = (asked(Some("rated")), asked(None));
    let train = stage.train();
    let frozen = willis::analysis::frozen(train, &train.operations()[0]).unwrap();
    let product = |forward: bool| -> f64 {
        let own = frozen.meshes().iter().map(|m| if forward { &m.efficiency.forward } else { &m.efficiency.backward });
        own.map(|eta| eta.to_f64()).product()
    };
    let found = efficiencies(&rated);
    assert!((found[0] - product(true)).abs() < 1e-12, "{found:?}");
    assert!((found[1] - product(false)).abs() < 1e-12 && found != efficiencies(&nominal), "{found:?}");
    assert!(rated.notes.iter().any(|n| n.contains("`rated`")) && nominal.notes.iter().any(|n| n.contains("nominal")));
    // What friction depends on is in the file now.
    let tells = |out: &Export, key: &str| out.not_carried.iter().any(|n| n.key == key);
    assert!(tells(&nominal, "oil.temperature") && !tells(&rated, "oil.temperature"), "{:?}", rated.not_carried);
}

#[test]
fn models_of_every_example_are_read_by_a_parser() {
    let mut count = 0;
    for (name, _) in examples() {
        let text = made(&train(&name), "modelica", &ExportRequest::default()).files[0].text.clone();
        parsed(&text);
        // A name is declared once.
        let parts = text.lines().filter(|l| l.starts_with("  Modelica."));
        let mut declared: Vec<&str> =
            parts.filter_map(|l| l.split_whitespace().nth(1)?.split(['(', ';']).next()).collect();
        assert!(declared.len() > 2, "{name}: {text}");
        declared.sort_unstable();
        assert!(declared.windows(2).all(|two| two[0] != two[1]), "{name}: {declared:?}");
        count += 1;
    }
    assert!(count > 30);
    let galvagno = made(&train("galvagno"), "modelica", &ExportRequest::default()).files[0].text.clone();
    assert!(galvagno.contains("Inertia inertia_ring(J=0.008)"), "{galvagno}");
    // 0.006 of the carrier itself, and 0.00195075 of the masses of its planets.
    assert!(galvagno.contains("Inertia inertia_carrier(J=0.00795075)"), "{galvagno}");
    let lossy = made(&train("lossy-gear"), "modelica", &ExportRequest::default()).files[0].text.clone();
    assert!(
        lossy.contains("[0, 0.9, 0.88, 0.3, 0.35; 50, 0.95, 0.94, 0.2, 0.2; 300, 0.97, 0.96, 0.25, 0.25]"),
        "{lossy}"
    );
}

// ---- XML -----------------------------------------------------------------------------------

/// Elements in order, `(depth, name, attributes)`; panics where the text is not well-formed.
fn xml(text: &str) -> Vec<(usize, String, BTreeMap<String, String>)> {
    let mut all = Vec::new();
    let mut open: Vec<String> = Vec::new();
    let mut rest = text;
    let mut roots = 0;
    while let Some(start) = rest.find('<') {
        // Text stands in the innermost element only.
        let leaf = rest[start..].starts_with("</") && !open.is_empty();
        assert!(rest[..start].trim().is_empty() || leaf, "text outside elements: {}", &rest[..start]);
        rest = &rest[start..];
        if let Some(comment) = rest.strip_prefix("<!--") {
            let end = comment.find("--").expect("a comment ends");
            assert!(comment[end..].starts_with("-->"), "two hyphens inside a comment");
            rest = &comment[end + 3..];
            continue;
        }
        let end = rest.find('>').expect("a tag ends");
        let tag = &rest[1..end];
        rest = &rest[end + 1..];
        if let Some(name) = tag.strip_prefix('/') {
            assert_eq!(open.pop().as_deref(), Some(name), "closed in order");
            continue;
        }
        let (tag, empty) = tag.strip_suffix('/').map_or((tag, false), |t| (t, true));
        let (name, mut attributes) = tag.split_once(' ').unwrap_or((tag, ""));
        let mut map = BTreeMap::new();
        while !attributes.trim().is_empty() {
            let (key, value) = attributes.trim().split_once("=\"").expect("name=\"value\"");
            let (value, more) = value.split_once('"').expect("a quote closes");
            assert!(map.insert(key.to_owned(), value.to_owned()).is_none(), "twice {key}");
            attributes = more;
        }
        roots += usize::from(open.is_empty());
        all.push((open.len(), name.to_owned(), map));
        if !empty {
            open.push(name.to_owned());
        }
    }
    assert!(open.is_empty() && rest.trim().is_empty() && roots == 1);
    all
}

#[test]
fn mujoco_and_drake_say_ratio_inertia_and_both_efficiencies() {
    let wolfrom = train("wolfrom-236");
    let row = analyze(wolfrom.train(), &Selection::default()).unwrap().ratios.0[0].1.clone();
    let (eta, back) = (row.drive.efficiency.unwrap(), row.coast.efficiency.unwrap());
    let mjcf = xml(&made(&wolfrom, "mujoco", &ExportRequest::default()).files[0].text);
    assert_eq!(mjcf[0].1, "mujocoinclude");
    let motor = &mjcf.iter().find(|e| e.1 == "motor").unwrap().2;
    assert_eq!((motor["gear"].parse().ok(), motor["joint"].as_str()), (row.value, "ring"));
    let user: BTreeMap<&str, f64> = (mjcf.iter().filter(|e| e.1 == "numeric"))
        .map(|e| (e.2["name"].rsplit('/').next().unwrap(), e.2["data"].parse().unwrap()))
        .collect();
    assert_eq!((user["efficiency_forward"], user["efficiency_backward"]), (eta, back));
    // The friction of the open issue gives both efficiencies back: driving, and driven back.
    let (avg, dif) = (user["mu_avg"], user["mu_dif"]);
    assert!((1.0 - (avg + dif) - eta).abs() < 1e-12 && (1.0 / (1.0 + avg - dif) - back).abs() < 1e-12);

    let lock = made(&train("wolfrom-498-self-locking"), "mujoco", &ExportRequest::default());
    let mjcf = xml(&lock.files[0].text);
    let word = mjcf.iter().find(|e| e.1 == "text").unwrap();
    assert!(word.2["name"].ends_with("/efficiency_backward") && word.2["data"].starts_with("none: friction lets ring"));
    assert!(!mjcf.iter().any(|e| e.2.get("name").is_some_and(|n| n.ends_with("mu_avg"))), "no number is made up");
    assert!(lock.notes.iter().any(|n| n.contains("MuJoCo's joint would drive the motor")), "{:?}", lock.notes);

    let urdf = xml(&made(&wolfrom, "drake", &ExportRequest::default()).files[0].text);
    assert_eq!((urdf[0].1.as_str(), urdf[0].2["xmlns:drake"].as_str()), ("robot", "http://drake.mit.edu"));
    let ratio = urdf.iter().find(|e| e.1 == "drake:gear_ratio").unwrap();
    assert_eq!(ratio.2["value"].parse().ok(), row.value);
    let order: Vec<&str> = urdf.iter().map(|e| e.1.as_str()).collect();
    assert_eq!(order, ["robot", "transmission", "type", "joint", "hardwareInterface", "actuator", "drake:gear_ratio"]);
}

#[test]
fn inertias_are_reflected() {
    // Galvagno's set with its ring held: sun in, carrier out, 1 + 72/30 = 3.4. Planets 0.25 kg at 51 mm.
    let text = example("galvagno").replace(
        "[[operation]]",
        "[[shift_element]]\nname = \"B\"\nkind = \"brake\"\nmembers = [\"ring\"]\n[[state]]\nname = \"1\"\nengaged = [\"B\"]\n\
         input = \"sun\"\noutput = \"carrier\"\n[[operation]]",
    );
    let heavy = Model::from_toml(&text).unwrap();
    let spin = 1.0 - 72.0 / 21.0;
    let carrier = 0.006 + 3.0 * 0.25 * 0.051f64.powi(2);
    let at_output = 0.002 * 3.4f64.powi(2) + carrier + 3.0 * 6e-5 * spin * spin;
    let mjcf = xml(&made(&heavy, "mujoco", &ExportRequest::default()).files[0].text);
    let joint = &mjcf.iter().find(|e| e.1 == "joint").unwrap().2;
    assert!((joint["armature"].parse::<f64>().unwrap() / at_output - 1.0).abs() < 1e-12, "{joint:?} {at_output}");
    let urdf = xml(&made(&heavy, "drake", &ExportRequest::default()).files[0].text);
    let rotor: f64 = urdf.iter().find(|e| e.1 == "drake:rotor_inertia").unwrap().2["value"].parse().unwrap();
    assert!((rotor * 3.4 * 3.4 / at_output - 1.0).abs() < 1e-12);
    // As drawn it has two freedoms.
    let wrong = export(&train("galvagno"), "mujoco", &ExportRequest::default()).unwrap_err().to_string();
    assert!(wrong.contains("no single ratio") && wrong.contains("2 degrees of freedom"), "{wrong}");
}

// ---- OpenFAST ------------------------------------------------------------------------------

/// Value and name of a line `value  NAME  - comment`.
fn openfast(text: &str) -> BTreeMap<&str, f64> {
    let mut all = BTreeMap::new();
    for line in text.lines().filter(|l| !l.starts_with('!')) {
        let words: Vec<&str> = line.split_whitespace().collect();
        assert!(words.len() > 3 && words[2] == "-", "{line}");
        assert!(all.insert(words[1], words[0].parse().expect("a number first")).is_none());
    }
    all
}

#[test]
fn openfast_has_the_side_and_the_sign() {
    let nrel = train("nrel-5mw-stage-1");
    let request = ExportRequest { operation: Some("5 MW".into()), ..ExportRequest::default() };
    let out = made(&nrel, "openfast", &request);
    let read = openfast(&out.files[0].text);
    assert_eq!(read.len(), 2);
    // Carrier in, sun out: 75/19, the carrier is the slow shaft.
    assert!((read["GBRatio"] - 75.0 / 19.0).abs() < 1e-12);
    assert!(out.files[0].text.contains("from carrier (LSS, rotor) to sun (HSS, generator)"), "{}", out.files[0].text);
    // One number: that of the operation.
    let a = analyze(nrel.train(), &Selection::default()).unwrap();
    let eta = a.operations[0].solutions[0].efficiency.unwrap();
    assert!((read["GBoxEff"] - 100.0 * eta).abs() < 1e-7, "{} {eta}", read["GBoxEff"]);
    assert!(out.notes.iter().any(|n| n.contains("at 12.1 rpm and 3945990 N m")), "{:?}", out.notes);

    // The Wolfrom drive is driven at its fast end: its slow end is the ring, and what counts is backward.
    let wolfrom = train("wolfrom-236");
    let row = analyze(wolfrom.train(), &Selection::default()).unwrap().ratios.0[0].1.clone();
    let text = made(&wolfrom, "openfast", &ExportRequest::default()).files[0].text.clone();
    let read = openfast(&text);
    assert_eq!(read["GBoxEff"], 100.0 * row.coast.efficiency.unwrap());
    assert_eq!(read["GBRatio"], row.value.unwrap().abs());
    assert!(text.contains("generator motors; there the gear has"), "{text}");
    let lock = export(&train("wolfrom-498-self-locking"), "openfast", &ExportRequest::default());
    assert!(lock.unwrap_err().to_string().contains("ring (low-speed shaft) cannot drive sun"));
}

// ---- MATLAB --------------------------------------------------------------------------------

/// Assignments of a script; panics on anything that is no assignment of numbers, vectors, matrices, booleans.
fn matlab(text: &str) -> BTreeMap<String, Vec<Vec<f64>>> {
    let mut all = BTreeMap::new();
    for line in text.lines() {
        let code = line.split('%').next().unwrap().trim();
        if code.is_empty() {
            continue;
        }
        let (name, value) = code.split_once(" = ").unwrap_or_else(|| panic!("no assignment: {line}"));
        let value = value.strip_suffix(';').expect("a semicolon ends it");
        let fine = |c: char| c.is_ascii_alphanumeric() || "_.(:,)".contains(c);
        assert!(name.chars().all(fine) && name.starts_with(|c: char| c.is_ascii_alphabetic()), "{name}");
        if ["struct()", "true", "false"].contains(&value) {
            continue;
        }
        let rows = value.trim_start_matches('[').trim_end_matches(']');
        let row = |r: &str| r.split_whitespace().map(|x| x.parse().unwrap()).collect::<Vec<f64>>();
        let matrix: Vec<Vec<f64>> = rows.split(';').map(row).collect();
        assert!(matrix.iter().all(|r| r.len() == matrix[0].len()), "{line}");
        assert!(all.insert(name.to_owned(), matrix).is_none(), "{name} twice");
    }
    all
}

#[test]
fn simscape_has_the_efficiencies_of_gear_and_sets() {
    let out = made(&train("zf-8hp70"), "simscape", &all_states());
    let m = matlab(&out.files[0].text);
    let table = analyze(train("zf-8hp70").train(), &Selection::default()).unwrap().ratios;
    for (name, row) in table.iter() {
        let own = |f: &str| m[&format!("zf_8hp70.state_{name}.{f}")][0][0];
        assert_eq!(own("ratio"), row.value.unwrap());
        assert_eq!(own("efficiency_base_follower"), row.drive.efficiency.unwrap());
        assert_eq!(own("efficiency_follower_base"), row.coast.efficiency.unwrap());
    }
    assert_eq!(m["zf_8hp70.state_1.sets.P4.efficiency"], [[0.98, 0.99]]);
    assert_eq!(m["zf_8hp70.state_1.sets.P4.ring_sun_ratio"], [[85.0 / 23.0]]);

    let request = ExportRequest {
        temperatures: list(&["313.15 K", "353.15 K"]),
        speeds: list(&["500 rpm", "1500 rpm"]),
        torques: list(&["-900 N m", "300 N m", "900 N m"]),
        ..ExportRequest::default()
    };
    let fva = made(&train("fva-planetary-stage"), "simscape", &request);
    let text = &fva.files[0].text;
    let m = matlab(text);
    let root = text.lines().find_map(|l| l.strip_suffix(" = struct();")).unwrap();
    let warm = &m[&format!("{root}.table.efficiency(:,:,2)")];
    for (j, torque) in ["-900", "300", "900"].iter().enumerate() {
        for (k, rpm) in ["500", "1500"].iter().enumerate() {
            let [_, _, eta] = analysed("fva-planetary-stage", None, "sun", "carrier", rpm, torque);
            assert_eq!(warm[j][k], eta.unwrap());
        }
    }
    assert_eq!(m[&format!("{root}.efficiency_base_follower")][0][1], warm[2][1]);
    assert_eq!(m[&format!("{root}.efficiency_follower_base")][0][1], warm[0][1]);
    // The load-dependent law through its three numbers: T_B = T_idle + (k + 1) T_F/g.
    let one = |f: &str| m[&format!("{root}.{f}")][0][0];
    let (g, nominal, eta, idle) =
        (one("follower_base_ratio"), one("nominal_output_torque"), one("efficiency_nominal"), one("no_load_torque"));
    let k1 = 1.0 / eta - g * idle / nominal;
    assert!(idle >= 0.0 && (idle + k1 * nominal / g - 900.0).abs() < 0.01 * 900.0);

    let lock = made(&train("wolfrom-498-self-locking"), "simscape", &ExportRequest::default());
    assert!(!matlab(&lock.files[0].text).keys().any(|k| k.ends_with("efficiency_follower_base")));
    assert!(lock.notes.iter().any(|n| n.contains("no efficiency_follower_base: friction lets ring")));
}

// ---- questions that have no answer -----------------------------------------------------------

#[test]
fn two_freedoms_have_no_ratio_and_states_that_have_one_are_named() {
    let prius = train("prius-p112");
    for kind in KINDS.iter().map(|k| k.id).filter(|k| !k.starts_with("modelica") || *k == "modelica-loss-table") {
        let wrong = export(&prius, kind, &ExportRequest::default()).unwrap_err().to_string();
        assert!(wrong.contains("the train has 3 states"), "{kind}: {wrong}");
    }
    // An operation with two freedoms.
    let text = example("prius-p112").replace("engaged = [\"hold-mg1\"]", "engaged = []");
    let free = Model::from_toml(&text).unwrap();
    let wrong = export(&free, "csv", &state("mg1 held")).unwrap_err().to_string();
    assert!(wrong.contains("state mg1 held has no single ratio"), "{wrong}");
    assert!(wrong.contains("states that can be exported: engine stopped, car held"), "{wrong}");
    let out = made(&free, "csv", &all_states());
    assert!(out.notes.iter().any(|n| n.starts_with("left out: state mg1 held")), "{:?}", out.notes);
}

#[test]
fn wrong_questions() {
    let zf = train("zf-8hp70");
    let fails = |kind: &str, request: &ExportRequest, part: &str| {
        let wrong = export(&zf, kind, request).unwrap_err().to_string();
        assert!(wrong.contains(part), "{wrong}");
    };
    fails("vektor", &all_states(), "there is no export `vektor`");
    fails("vekto", &all_states(), "did you mean `vecto`?");
    fails("csv", &ExportRequest::default(), "none is chosen");
    fails("csv", &state("9"), "its states are: 1, 2, 3");
    fails("csv", &ExportRequest { operation: Some("cruise".into()), ..ExportRequest::default() }, "its operations are");
    let both = ExportRequest { operation: Some("coasting".into()), ..state("1") };
    fails("csv", &both, "does not run in state `1`");
    fails("csv", &ExportRequest { speeds: list(&["2 rpm", "1 rpm"]), ..state("1") }, "do not rise");
    fails("csv", &ExportRequest { temperatures: list(&["330 K"]), ..state("1") }, "the train has no oil");
    let hot = ExportRequest { temperatures: list(&["313 K", "330 K"]), ..small(ExportRequest::default()) };
    for kind in ["vecto", "modelica-loss-table", "mujoco", "drake", "openfast"] {
        let wrong = export(&train("fva-planetary-stage"), kind, &hot).unwrap_err().to_string();
        assert!(wrong.contains("one oil temperature") || wrong.contains("one number has"), "{kind}: {wrong}");
    }
}
