//! How long figures take: every kind of every example train, and a kept layout with new values.
//!
//! ```text
//! cargo run --release -p willis-figure --example speed
//! cargo run --release -p willis-figure --example speed -- zf-8hp70 prius-hybrid
//! ```

use std::path::Path;
use std::time::Instant;

use willis::analysis::Selection;
use willis::hypergraph::flows;
use willis::model::Model;
use willis::train::Train;
use willis::work::Serial;
use willis_figure::{
    Drawing, Figure, FigureKind, FigureRequest, LeverLayout, LeverRequest, SankeyLayout, SankeyPaper, StickLayout, draw,
};

/// The least time of a few runs, ms: what else a machine does only adds to it.
fn least(mut run: impl FnMut()) -> f64 {
    let mut least = f64::INFINITY;
    let mut spent = 0.0;
    for _ in 0..20 {
        let start = Instant::now();
        run();
        let ms = 1e3 * start.elapsed().as_secs_f64();
        least = least.min(ms);
        spent += ms;
        if spent > 600.0 {
            break;
        }
    }
    least
}

/// Name and model of an example, with the files that it names.
fn read(folder: &Path, name: &str) -> Model {
    let text = std::fs::read_to_string(folder.join(name).with_extension("toml")).expect("an example of that name");
    let mut load = |file: &str| std::fs::read_to_string(folder.join(file)).map_err(|e| e.to_string());
    Model::read(&text, &mut load).unwrap_or_else(|wrong| panic!("{name}: {wrong}"))
}

/// What a program does that keeps the layout of stick diagram, levers and Sankey diagram: one state after the other.
fn kept(name: &str, train: &Train) {
    let states: Vec<&str> = train.states().iter().map(|s| s.name.as_str()).collect();
    let [Some(first), Some(last)] = [states.first(), states.last()] else { return };
    let mut told = vec![];
    if let Ok(layout) = StickLayout::new(train) {
        let mut k = 0;
        let show = least(|| {
            k += 1;
            let _ = layout.show(train, Some(if k % 2 == 0 { first } else { last }));
        });
        told.push(format!("stick {show:.2} ms"));
        if let Ok(stick) = layout.show(train, Some(first)) {
            let figure = Figure::Stick(stick);
            told.push(format!("its drawing {:.2} ms", least(|| drop(draw(&figure, Drawing::default())))));
        }
    }
    if let Ok(layout) = LeverLayout::new(train) {
        let mut k = 0;
        let show = least(|| {
            k += 1;
            let state = if k % 2 == 0 { first } else { last };
            let _ = layout.show(train, &LeverRequest::State(state.to_string()));
        });
        told.push(format!("lever {show:.2} ms"));
    }
    if let Ok(layout) = SankeyLayout::new(train)
        && let Ok(report) = flows(train, &Selection { state: Some(first.to_string()), operation: None })
        && !report.operations.is_empty()
    {
        told.push(format!("sankey {:.2} ms", least(|| drop(layout.show(&report)))));
        let figure = layout.show(&report);
        let mut paper = SankeyPaper::new([&figure], Drawing::default());
        told.push(format!("its drawing on kept paper {:.2} ms", least(|| drop(paper.draw(&figure)))));
        told.push(format!("its layout once {:.2} ms", least(|| drop(SankeyLayout::new(train)))));
    }
    println!("{name:28} {}", told.join(", "));
}

fn main() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut names: Vec<String> = std::env::args().collect::<Vec<_>>().split_off(1);
    if names.is_empty() {
        let all = std::fs::read_dir(&folder).expect("the folder of examples").flatten().map(|e| e.path());
        let trains = all.filter(|p| p.extension().is_some_and(|e| e == "toml"));
        let stem = |p: std::path::PathBuf| p.file_stem().map(|s| s.to_string_lossy().into_owned());
        // Duty cycles and the like are no trains.
        let is_train = |name: &String| {
            let text = std::fs::read_to_string(folder.join(name).with_extension("toml")).unwrap_or_default();
            text.lines().any(|l| l.starts_with("members"))
        };
        names = trains.filter_map(stem).filter(is_train).collect();
        names.sort();
    }
    let models: Vec<(String, Model)> = names.into_iter().map(|n| (n.clone(), read(&folder, &n))).collect();
    println!("data and drawing, ms: median, most and where; how many of the trains take more than 50 ms");
    for kind in FigureKind::ALL {
        let mut times: Vec<(f64, &str)> = vec![];
        let mut coarse: Vec<f64> = vec![];
        let request = FigureRequest::default();
        for (name, model) in &models {
            if kind.make(model, &request).is_err() {
                continue;
            }
            let whole = least(|| {
                if let Ok(figure) = kind.make(model, &request) {
                    draw(&figure, Drawing::default());
                }
            });
            times.push((whole, name));
            if kind.make_coarse(model, &request, &Serial).is_some() {
                coarse.push(least(|| {
                    if let Some(Ok(figure)) = kind.make_coarse(model, &request, &Serial) {
                        draw(&figure, Drawing::default());
                    }
                }));
            }
        }
        times.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((most, at)) = times.last() else { continue };
        let slow = times.iter().filter(|t| t.0 > 50.0).count();
        let middle = times[times.len() / 2].0;
        let mut line = format!("{:8} {middle:8.1} {most:8.1}  {at:28} {slow} of {}", kind.name(), times.len());
        coarse.sort_by(f64::total_cmp);
        if let Some(most) = coarse.last() {
            line += &format!("; coarse {:.1}, at most {most:.1}", coarse[coarse.len() / 2]);
        }
        println!("{line}");
    }
    println!("a kept layout with new values");
    for (name, model) in &models {
        kept(name, model.train());
    }
}
