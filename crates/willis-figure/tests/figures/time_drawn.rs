//! Figures of runs: no label on another, nothing beyond the page, no chart empty.

use serde_json::{Value, json};
use willis::dynamics::{Column, ColumnKind, Event, Outcome, Recorder, RunReport, Sample};
use willis::train::{SetSpec, ShiftElementSpec, Train};
use willis_figure::{Figure, FigureKind, FigureRequest, TimePlot, TimePlotBuilder};

type Label = (String, [f64; 4]);

fn attribute(tag: &str, name: &str) -> Option<f64> {
    tag.split(&format!(" {name}=\"")).nth(1)?.split('"').next()?.parse().ok()
}

/// Every text of a figure, as left, right, top and bottom.
fn labels(svg: &str) -> (Vec<Label>, [f64; 2]) {
    let mut all = Vec::new();
    let mut page = [0.0; 2];
    for piece in svg.split('<').skip(1) {
        let (tag, content) = piece.split_once('>').expect("tags are closed");
        if tag.starts_with("svg") {
            page = ["width", "height"].map(|n| attribute(&format!(" {tag}"), n).expect("a size"));
        } else if tag.starts_with("text ") {
            let get = |n: &str| attribute(tag, n).expect("an attribute");
            let content = content.trim();
            let (x, y, size) = (get("x"), get("y"), get("font-size"));
            let width = 0.55 * size * content.chars().count() as f64;
            let left = match tag {
                t if t.contains("\"middle\"") => x - width / 2.0,
                t if t.contains("\"end\"") => x - width,
                _ => x,
            };
            all.push((content.to_owned(), [left, left + width, y - 0.75 * size, y + 0.15 * size]));
        }
    }
    (all, page)
}

fn check(name: &str, plot: &TimePlot) -> String {
    let svg = willis_figure::draw_time(plot);
    assert_eq!(svg, willis_figure::draw_time(plot), "{name}: not the same twice");
    apart(name, &svg)
}

fn apart(name: &str, svg: &str) -> String {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    std::fs::write(folder.join(format!("time-plot-{name}.svg")), svg).expect("written");
    let (labels, [width, height]) = labels(svg);
    for (k, (a, [left, right, top, bottom])) in labels.iter().enumerate() {
        assert!(*left >= 0.0 && *right <= width && *top >= 0.0 && *bottom <= height, "{name}: `{a}` is off the page");
        for (b, [l, r, t, u]) in &labels[..k] {
            let apart = left >= r || l >= right || top >= u || t >= bottom;
            assert!(apart, "{name}: `{a}` lies on `{b}`: {:?} {:?}", [left, right, top, bottom], [l, r, t, u]);
        }
    }
    assert!(svg.contains("<title>") && svg.contains("<desc>") && !svg.contains("NaN") && !svg.contains("inf "));
    svg.to_owned()
}

fn train() -> Train {
    Train::builder("Reducer with a brake")
        .members(["sun", "ring", "carrier"])
        .terminals(["sun", "ring", "carrier"])
        .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
        .shift_element(ShiftElementSpec::brake("B", "ring"))
        .build()
        .expect("a train")
}

fn column(name: &str, kind: ColumnKind) -> Column {
    let of = name.rsplit_once('.').map_or("", |n| n.0);
    serde_json::from_value(json!({ "name": name, "unit": kind.unit(), "kind": kind, "of": of })).expect("a column")
}

fn event(time: f64, cause: &str, modes: Value) -> Event {
    let happenings = if cause == "start" { json!([{ "kind": "start", "of": [] }]) } else { json!([]) };
    serde_json::from_value(json!({ "time_s": time, "cause": cause, "happenings": happenings, "modes": modes }))
        .expect("an event")
}

fn columns() -> Vec<Column> {
    let mut all = vec![column("time_s", ColumnKind::Time)];
    all.extend(
        ["sun", "ring", "carrier", "P1.planet", "out"].map(|m| column(&format!("{m}.speed_rad_s"), ColumnKind::Speed)),
    );
    all.extend(
        ["motor", "vehicle", "B", "P1.sun-planet"].map(|m| column(&format!("{m}.torque_n_m"), ColumnKind::Torque)),
    );
    all.extend(["motor", "vehicle", "B"].map(|m| column(&format!("{m}.power_w"), ColumnKind::Power)));
    all.extend(["P1.sun-planet", "P1.planet-ring", "B"].map(|m| column(&format!("{m}.mode"), ColumnKind::Mode)));
    all
}

fn report(outcome: Outcome, end: f64) -> RunReport {
    let mut report: RunReport = serde_json::from_value(json!({
        "format": "willis-simulation-1",
        "train": "Reducer with a brake",
        "scenario": "launch and reversal",
        "outcome": { "verdict": "finished" },
        "start_s": 0.0,
        "end_s": end,
        "coordinates": ["sun", "ring"],
        "unique_for_every_load": true,
        "steps": 2000,
        "events": [],
        "final_speeds_rad_s": {},
        "energy": null,
        "assumptions": [],
        "notes": [],
        "scenario_end_s": 3.0,
        "event_count": 3,
    }))
    .expect("a report");
    report.outcome = outcome;
    report
}

/// A launch in which the brake slips, sticks, and the direction of drive reverses.
fn launch(plot: &mut TimePlotBuilder, end: f64, rows: usize) {
    let _ = plot.columns(&columns());
    let mut causes = [
        (0.0, "start"),
        (0.8, "brake B comes to rest"),
        (2.1, "drive reverses in P1.sun-planet"),
        (2.13, "P1 comes to rest"),
    ]
    .iter()
    .peekable();
    for k in 0..=rows {
        let t = end * k as f64 / rows as f64;
        while let Some((at, cause)) = causes.next_if(|c| c.0 <= t) {
            let _ = plot.event(&event(*at, cause, json!({ "B": "stuck" })));
        }
        let slip = t < 0.8;
        let ring = if slip { 80.0 * (1.0 - t / 0.8) } else { 0.0 };
        let sun = 300.0 * (1.0 - (-t).exp()) - if t > 2.1 { 150.0 * (t - 2.1) } else { 0.0 };
        let carrier = (30.0 * sun + 70.0 * ring) / 100.0;
        let motor = if t > 2.1 { -40.0 } else { 120.0 } + 6.0 * (40.0 * t).sin();
        let brake = if slip {
            -200.0
        } else if t > 2.1 {
            f64::NAN
        } else {
            -2.33 * motor
        };
        let values = [
            t,
            sun,
            ring,
            carrier,
            2.0 * carrier - sun,
            carrier,
            motor,
            -3.2 * motor,
            brake,
            motor * 0.5,
            motor * sun,
            -3.2 * motor * carrier,
            brake * ring,
            if t < 2.1 { 1.0 } else { -1.0 },
            if t < 2.1 {
                -1.0
            } else if t < 2.13 {
                0.0
            } else {
                1.0
            },
            if slip { 1.0 } else { 0.0 },
        ];
        let _ = plot.sample(Sample { time_s: t, values: &values });
    }
}

#[test]
fn a_run_has_its_panels_names_and_events() {
    let mut plot = TimePlotBuilder::new(&train(), [0.0, 3.0]);
    launch(&mut plot, 3.0, 20_000);
    let plot = plot.finish(&report(Outcome::Finished, 3.0));
    assert_eq!(plot.panels.iter().map(|p| p.quantity.as_str()).collect::<Vec<_>>(), ["Speed", "Torque", "Power"]);
    // Planets and meshes give way; what turns together has one curve.
    let names: Vec<_> = plot.panels[0].lines.iter().map(|l| l.names.join("=")).collect();
    assert_eq!(names, ["sun", "ring", "carrier=out"]);
    assert_eq!(plot.panels[1].lines.len(), 3);
    let svg = check("launch", &plot);
    for word in
        ["Speed, rpm", "Torque, N m", "Power, kW", "Time, s", "carrier = out", "brake B comes to rest", "locked"]
    {
        assert!(svg.contains(word), "{word}");
    }
    assert!(svg.len() < 400_000, "{}", svg.len());
}

#[test]
fn a_run_that_ends_early_says_so() {
    let mut plot = TimePlotBuilder::new(&train(), [0.0, 3.0]);
    launch(&mut plot, 1.9, 500);
    let why = "P1.sun-planet and P1.planet-ring both would have to drive".to_owned();
    let plot = plot.finish(&report(Outcome::NoSolution(why), 1.9));
    assert_eq!(plot.axis, [0.0, 3.0]);
    let svg = check("early", &plot);
    assert!(svg.contains("not reached") && svg.contains("jammed"));
    let mut plot = TimePlotBuilder::new(&train(), [0.0, 300.0]);
    launch(&mut plot, 1.9, 500);
    let plot = plot.finish(&report(Outcome::Interrupted, 1.9));
    assert_eq!(plot.axis, [0.0, 1.9]);
    check("interrupted", &plot);
}

#[test]
fn many_members_many_events_and_tiny_times() {
    let names: Vec<String> = (1..=14).map(|k| format!("a rather long member {k}")).collect();
    let mut all = vec![column("time_s", ColumnKind::Time)];
    all.extend(names.iter().map(|n| column(&format!("{n}.speed_rad_s"), ColumnKind::Speed)));
    all.extend(names.iter().take(9).map(|n| column(&format!("{n}.twist_rad"), ColumnKind::Twist)));
    all.extend((1..=30).map(|k| column(&format!("element {k}.mode"), ColumnKind::Mode)));
    let mut plot = TimePlotBuilder::new(&train(), [0.0, 2e-3]);
    let _ = plot.columns(&all);
    for k in 0..=20_000 {
        let t = 1e-7 * f64::from(k);
        let mut values = vec![t];
        values.extend(
            (0..14)
                .map(|m| 100.0 + 0.01 * f64::from(m) * (t * 1e4).sin() + if k == 7777 && m == 13 { 0.5 } else { 0.0 }),
        );
        values.extend((0..9).map(|m| 1e-5 * (t * 1e4 + f64::from(m)).sin()));
        values.extend((0..30).map(|m| if m < 8 { f64::from((k / 50 * (m + 1)) % 4 - 1) } else { 0.0 }));
        let _ = plot.sample(Sample { time_s: t, values: &values });
        if k % 7 == 1 {
            let _ = plot.event(&event(t, &format!("brake B breaks away & sticks < {k}"), json!({})));
        }
    }
    let plot = plot.finish(&report(Outcome::TooManyEvents("1001 within 2 µs".into()), 2e-3));
    assert_eq!((plot.panels[0].left_out, plot.modes_left_out), (6, 6));
    let peak = plot.panels[0].lines.iter().flat_map(|l| l.pieces.iter().flatten()).map(|p| p[1]).fold(0.0, f64::max);
    assert!(peak > 100.5, "the spike is lost: {peak}");
    let svg = check("many", &plot);
    assert!(svg.contains("Time, ms") && svg.contains("Twist, µrad") && svg.contains("&amp; sticks &lt;"));
}

#[test]
fn nothing_at_all_is_said() {
    let plot = TimePlotBuilder::new(&train(), [0.0, 3.0]).finish(&report(Outcome::Interrupted, 0.0));
    assert!(check("empty", &plot).contains("no rows"));
    // A train at rest.
    let mut plot = TimePlotBuilder::new(&train(), [0.0, 3.0]);
    let _ = plot.columns(&columns());
    for t in [0.0, 3.0] {
        let mut values = [0.0; 16];
        values[0] = t;
        let _ = plot.sample(Sample { time_s: t, values: &values });
    }
    check("rest", &plot.finish(&report(Outcome::Finished, 3.0)));
}

#[test]
fn shapes_of_vibration_keep_apart() {
    let part = |k: usize, value: f64| json!({ "name": format!("a rather long rotor {k}"), "value": value });
    let shape = |m: usize| (0..9).map(|k| part(k, ((k * m) as f64 * 0.7).cos())).collect::<Vec<_>>();
    let mode = |m: usize| {
        json!({
            "frequency_hz": 7.0 * 3f64.powi(m as i32),
            "angular_frequency_rad_s": 44.0 * 3f64.powi(m as i32),
            "damping_ratio": (m != 2).then_some(0.0123 * m as f64),
            "damped_frequency_hz": null,
            "shape": shape(m),
            "kinetic_energy": [],
            "strain_energy": (0..4).map(|k| part(k, 0.25)).collect::<Vec<_>>(),
        })
    };
    let all = serde_json::from_value(json!({
        "format": "willis-modes-1",
        "train": "A driveline",
        "state": "as drawn",
        "fixed": ["ring"],
        "coordinates": [],
        "rigid_body_modes": [{ "shape": shape(0), "kinetic_energy": [] }],
        "modes": (1..12).map(mode).collect::<Vec<_>>(),
        "assumptions": [],
        "notes": [],
    }))
    .expect("a report");
    let svg = apart("modes", &willis_figure::draw_modes(&all));
    assert!(svg.contains("2 more modes are not drawn") && svg.contains("21 Hz"));
}

/// A window shows what the whole picture has there, from edge to edge, and nothing else.
#[test]
fn a_window_is_a_part_of_the_run() {
    let mut whole = TimePlotBuilder::new(&train(), [0.0, 3.0]);
    launch(&mut whole, 3.0, 3000);
    let whole = whole.finish(&report(Outcome::Finished, 3.0));
    let value = |plot: &TimePlot, panel: usize, line: usize, t: f64| {
        let pieces = plot.panels[panel].lines[line].pieces.iter();
        let inside = |w: &&[[f64; 2]]| w[0][0] <= t && t <= w[1][0];
        let w = pieces.flat_map(|p| p.windows(2)).find(inside)?;
        let part = if w[1][0] > w[0][0] { (t - w[0][0]) / (w[1][0] - w[0][0]) } else { 0.0 };
        Some(w[0][1] + part * (w[1][1] - w[0][1]))
    };
    for [from, to] in [[0.5, 1.0], [0.70005, 0.81], [2.0, 3.0], [2.05, 2.2]] {
        let mut part = TimePlotBuilder::new(&train(), [0.0, 3.0]).within([from, to]);
        launch(&mut part, 3.0, 3000);
        let part = part.finish(&report(Outcome::Finished, 3.0));
        assert_eq!(part.axis, [from, to]);
        let times = || part.panels.iter().flat_map(|p| &p.lines).flat_map(|l| l.pieces.iter().flatten()).map(|p| p[0]);
        assert!(times().all(|t| (from..=to).contains(&t)));
        assert!(times().fold(f64::INFINITY, f64::min) == from && times().fold(0.0, f64::max) == to);
        let ends = |r: &willis_figure::ModeRow| (r.segments[0].from, r.segments[r.segments.len() - 1].to);
        assert!(part.modes.iter().all(|r| ends(r) == (from, to)), "{:?}", part.modes);
        assert!(part.marks.iter().all(|m| (from..=to).contains(&m.time)) && part.event_count == part.marks.len());
        // The speeds are the first panel of both.
        for line in 0..part.panels[0].lines.len() {
            assert_eq!(part.panels[0].lines[line].names, whole.panels[0].lines[line].names);
            for k in 1..50 {
                let t = from + (to - from) * f64::from(k) / 50.0;
                let (Some(a), Some(b)) = (value(&part, 0, line, t), value(&whole, 0, line, t)) else { panic!("{t}") };
                assert!((a - b).abs() < 0.5, "{t}: {a} {b}");
            }
        }
    }
}

#[test]
fn only_a_window_that_cuts_a_run_ends_it() {
    let model = crate::trains::model("launch");
    let end = model.train().scenarios()[0].end;
    for (window, cut) in [(None, false), (Some([0.0, 0.2]), true), (Some([0.5, 1.0]), true), (Some([0.5, end]), false)]
    {
        let request = willis_figure::FigureRequest { window, ..Default::default() };
        let figure = willis_figure::FigureKind::Time.make(&model, &request).unwrap();
        let svg = willis_figure::draw(&figure, Default::default());
        let willis_figure::Figure::Time(plot) = figure else { panic!("a run") };
        assert_eq!((plot.cut, plot.run[1]), (cut, if cut { window.unwrap()[1] } else { end }));
        assert_eq!(svg.matches("was ended there").count(), if cut { 2 } else { 0 }, "{window:?}");
    }
}

/// Seven shifts of an automatic: each in a window of the same length, with the values of the whole run.
#[test]
fn each_shift_is_shown_closely_with_the_same_values() {
    let kind = FigureKind::named("time").expect("a kind");
    let figure = kind.make(&crate::trains::model("shift-8hp70"), &FigureRequest::default()).expect("it runs");
    let Figure::Time(plot) = figure else { panic!("a run over time") };
    assert_eq!(plot.shifts.len(), 7);
    let mut compared = 0;
    for shift in &plot.shifts {
        let [from, to] = shift.window;
        assert!((to - from - (plot.shifts[0].window[1] - plot.shifts[0].window[0])).abs() < 1e-9);
        assert!(from <= shift.events[0] && shift.events[1] <= to);
        for (whole, closely) in plot.panels.iter().zip(&shift.panels) {
            assert_eq!(whole.quantity, closely.quantity);
            for (line, close) in whole.lines.iter().zip(&closely.lines) {
                assert_eq!(line.names, close.names);
                assert!(close.pieces.iter().flatten().all(|p| (from..=to).contains(&p[0])));
                // The finer curve passes every point of the coarser one.
                for p in line.pieces.iter().flatten().filter(|p| (from..=to).contains(&p[0])) {
                    let size = 1e-6 * p[1].abs().max(1.0);
                    let passes = |w: &[[f64; 2]]| {
                        let (low, high) = (w[0][1].min(w[1][1]) - size, w[0][1].max(w[1][1]) + size);
                        w[0][0] <= p[0] && p[0] <= w[1][0] && low <= p[1] && p[1] <= high
                    };
                    let on = close.pieces.iter().any(|piece| piece.windows(2).any(passes) || piece.contains(p));
                    assert!(on, "{} at {} s", line.names[0], p[0]);
                    compared += 1;
                }
            }
        }
    }
    assert!(compared > 100, "{compared}");
    // One change in a run is no row of shifts.
    let figure = kind.make(&crate::trains::model("ivt-drive-away"), &FigureRequest::default()).expect("it runs");
    assert!(matches!(figure, Figure::Time(plot) if plot.shifts.is_empty()));
}
