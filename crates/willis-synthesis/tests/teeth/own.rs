//! Trains that exist: designs around them, and their row.

use willis::Model;
use willis::analysis::{Selection, Verdict, analyze};
use willis::work::Serial;
use willis_synthesis::teeth::{Around, Design, Objective, RankedBy, Request, Start, StartKind};

/// All trains of the repository, which are no part of the package.
fn examples() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples");
    let mut all: Vec<(String, String)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .filter(|p| p.extension().is_some_and(|e| e == "toml"))
        .map(|p| (p.file_name().unwrap().to_string_lossy().into_owned(), std::fs::read_to_string(&p).unwrap()))
        .collect();
    all.sort();
    all
}

/// What a train is found to be as a row is what the certified solver says of its file, and its own space contains it.
#[test]
fn every_train_is_a_row_of_the_design_around_it() {
    let mut seen = 0;
    for (name, text) in examples() {
        // Some read tables, which belong to their folder.
        if Model::from_toml(&text).is_err() {
            continue;
        }
        let around = match Around::new("0.002").to_toml(&text) {
            Ok(around) => around,
            Err(wrong) => {
                assert!(wrong.iter().all(|d| d.code.as_str() == "E208" && !d.hints.is_empty()), "{name}: {wrong:?}");
                continue;
            }
        };
        let design = Design::from_toml(&around).unwrap_or_else(|e| panic!("{}", e.render(&name, &around, false)));
        let own = Some((name.clone(), text.clone()));
        let request = Request { top: Some(2), own, ..Request::default() };
        let answer = design.answer(&request, &Serial).unwrap_or_else(|e| panic!("{name}: {e:?}"));
        assert!(answer.completeness.complete, "{name}");
        let own = answer.own.unwrap();
        // Production trains may be unequally spaced; nothing else can be wrong with a train in its own space.
        let physical = |f: &String| f.starts_with("assembly of") || f.starts_with("clearance of");
        assert!(own.fails.iter().all(physical), "{name}: {:?}", own.fails);
        if own.fails.is_empty() {
            assert!(answer.waterfall.last().unwrap().trains > 0, "{name}");
            // Where it is on the front, nothing of the front beats it; but under the laws the same teeth with other profile
            // shifts may.
            let most = u64::from(answer.ranked_by.by == RankedBy::Laws);
            let is_row = answer
                .rows
                .iter()
                .any(|r| r.sets.iter().map(|s| &s.1.teeth).eq(own.row.sets.iter().map(|s| &s.1.teeth)));
            assert!(!is_row || own.better <= most, "{name}");
        }
        let train = Model::from_toml(&text).unwrap();
        let alone = willis::unstable::without_laws(&willis::unstable::without_operations(train.train()));
        let ratios = analyze(&alone, &Selection::default()).unwrap().ratios;
        for (state, row) in own.row.states.iter() {
            let report = ratios.get(state).unwrap();
            assert_eq!(row.ratio, report.exact, "{name} {state}");
            assert!(row.error < 1e-9, "{name} {state}");
            if report.drive.verdict == Verdict::Unique && own.row.certified {
                let (mine, its) = (row.forward.unwrap(), report.drive.efficiency.unwrap());
                // Geometry sets nominal efficiencies, and its shifts are found anew.
                let same = if text.contains("geometry") { 5e-3 } else { 1e-12 };
                assert!((mine - its).abs() < same, "{name} {state}: {mine} {its}");
            }
        }
        seen += 1;
    }
    assert!(seen >= 20, "{seen}");
}

/// Every row that is written is read by everything else, with the ratio and the efficiencies of the row.
#[test]
fn rows_are_trains_with_what_the_row_says() {
    for (_, kind) in StartKind::ALL {
        let ratio = match kind {
            StartKind::Simple => "4.2",
            StartKind::TwoStage => "20..20.5",
            StartKind::Stepped => "9..9.2",
            StartKind::TwoRings => "60..62",
            StartKind::Ravigneaux => "1.5..1.52",
            _ => "95..105",
        };
        let start = Start { ratio: Some(ratio.into()), ring: Some("80 mm".into()), ..Start::new(kind) };
        let design = Design::from_toml(&start.to_toml()).unwrap();
        let answer = design.answer(&Request { top: Some(12), all: true, ..Request::default() }, &Serial).unwrap();
        assert_eq!(answer.rows.len(), 12);
        let mut with_teeth = 0;
        for row in &answer.rows {
            let text = design.train_file(row);
            let model = Model::from_toml(&text).unwrap_or_else(|e| panic!("{}\n{text}", e.render("row", &text, false)));
            let analysis = analyze(model.train(), &Selection::default()).unwrap();
            let (found, said) = (analysis.ratios.get("as drawn").unwrap(), row.states.get("as drawn").unwrap());
            assert_eq!(found.exact, said.ratio);
            assert_eq!(found.drive.efficiency_exact, said.forward_exact);
            assert_eq!(found.coast.efficiency, said.backward);
            // The ring is in its room, and teeth that are written are sound.
            assert!(row.ring_diameter_m.unwrap() <= 0.08 * (1.0 + 1e-9));
            let has_shifts = row.sets.iter().all(|(_, s)| s.shifts.is_some());
            assert_eq!(text.contains("geometry"), row.sets.iter().any(|(_, s)| s.shifts.is_some()));
            if has_shifts {
                with_teeth += 1;
                let odd = |c: &str| ["W301", "W302", "W303", "E110"].contains(&c);
                assert!(!model.warnings().iter().any(|w| odd(w.code.as_str())), "{:?}\n{text}", model.warnings());
            }
        }
        assert!(with_teeth > 0);
    }
}

/// All trains, sorted by any objective, are those of a search that keeps everything.
#[test]
fn the_best_of_all_are_the_best() {
    let start = Start { ratio: Some("100".into()), ..Start::new(StartKind::Wolfrom) };
    let text = start.to_toml().replace("[\"assembly\", \"clearance\"]", "[\"assembly\", \"clearance\", \"hunting\"]");
    let design = Design::from_toml(&text).unwrap();
    let mut everything = 0;
    design.for_each(|_| everything += 1);
    for sort in [Objective::Error, Objective::Forward, Objective::Backward, Objective::PlanetSpin] {
        let of = |top| {
            let request = Request { top: Some(top), sort: Some(sort), all: true, ..Request::default() };
            design.answer(&request, &Serial).unwrap()
        };
        let all = of(10_000);
        assert_eq!(all.rows.len(), everything);
        let few = of(5);
        assert!(few.of_all && few.rows.iter().eq(&all.rows[..5]));
        let value = |r: &willis_synthesis::teeth::DesignRow| match sort {
            Objective::Error => r.error,
            Objective::Forward => -r.forward.unwrap_or(0.0),
            Objective::Backward => -r.backward.unwrap_or(0.0),
            _ => r.planet_spin,
        };
        assert!(all.rows.windows(2).all(|w| value(&w[0]) <= value(&w[1]) + 1e-12), "{sort}");
    }
}

/// Of several modules a ring gets the largest that its room allows, or the smallest where it shall be small.
#[test]
fn modules_are_chosen_for_the_room_there_is() {
    let modules = vec!["0.8 mm".to_owned(), "0.5 mm".into(), "0.6 mm".into()];
    let start =
        Start { ratio: Some("4.2".into()), ring: Some("36 mm".into()), modules, ..Start::new(StartKind::Simple) };
    let text = start.to_toml();
    let design = Design::from_toml(&text).unwrap();
    let answer = design.answer(&Request { top: Some(1000), all: true, ..Request::default() }, &Serial).unwrap();
    assert!(answer.rows.len() > 3);
    for r in &answer.rows {
        let module = r.sets.get("P1").unwrap().module_m.unwrap();
        let fits = |m: f64| r.ring_teeth as f64 * m <= 0.036 * (1.0 + 1e-12);
        let largest = [0.5e-3, 0.6e-3, 0.8e-3].into_iter().rfind(|m| fits(*m)).unwrap();
        assert_eq!((module, r.ring_diameter_m), (largest, Some(largest * r.ring_teeth as f64)));
    }
    // As many as with the smallest alone, which all the others have too.
    let smallest = text.replace("[\"0.8 mm\", \"0.5 mm\", \"0.6 mm\"]", "\"0.5 mm\"");
    assert_eq!(Design::from_toml(&smallest).unwrap().count(), design.count());
    let small = Design::from_toml(&text.replace("minimize = [", "minimize = [\"ring_diameter\", ")).unwrap();
    let answer = small.answer(&Request::default(), &Serial).unwrap();
    assert!(answer.rows.iter().all(|r| r.sets.get("P1").unwrap().module_m == Some(0.5e-3)));
}

#[test]
fn a_train_with_other_sets_is_refused() {
    let design =
        Design::from_toml(&Start { ratio: Some("100".into()), ..Start::new(StartKind::Wolfrom) }.to_toml()).unwrap();
    let (_, other) = examples().into_iter().find(|e| e.0 == "zf-8hp70.toml").unwrap();
    let request = Request { own: Some(("mine".into(), other)), ..Request::default() };
    let wrong = design.answer(&request, &Serial).unwrap_err();
    assert!(wrong.iter().any(|d| d.message.contains("no set like `P1`")), "{wrong:?}");
    let request = Request { own: Some(("mine".into(), "format = 2".into())), ..Request::default() };
    assert!(design.answer(&request, &Serial).is_err());
}
