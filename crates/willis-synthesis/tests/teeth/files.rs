//! Rows as train files, and what is said of files that ask for the impossible.

use willis::Model;
use willis::work::{Serial, Work};
use willis_synthesis::teeth::{Design, Progress, Request};

use crate::counts::read;
use crate::layouts::{simple, wolfrom};

#[test]
fn every_row_is_a_train_file() {
    let design = "planets = \"3..5\"\nmismatch = [-1, 0, 1]\ntarget = [{ ratio = 4.2 }]";
    let text = simple("14..30", "..90", design).replace(
        "mesh_efficiency = 0.99",
        "mesh_efficiency = 0.99\ngeometry = { module = \"2 mm\", width = \"20 mm\" }",
    );
    let design = read(&text);
    let answer = design.answer(&Request { top: Some(100), ..Request::default() }, &Serial).unwrap();
    assert!(!answer.rows.is_empty());
    let mut good = 0;
    for row in &answer.rows {
        let text = design.train_file(row);
        let model = Model::from_toml(&text).unwrap_or_else(|e| panic!("{text}\n{}", e.render("row", &text, false)));
        assert!(text.contains("Tooth numbers for this wish: state as drawn: ratio 4.158 to 4.242"), "{text}");
        let [s, p, r] = ["sun", "planet", "ring"].map(|g| *row.sets.get("P1").unwrap().teeth.get(g).unwrap());
        assert_eq!(model.get("P1.sun.teeth").unwrap(), Some(s.to_string()));
        assert_eq!(model.get("P1.ring.teeth").unwrap(), Some(r.to_string()));
        assert_eq!(row.ring_diameter_m, Some(2e-3 * r as f64));
        let set = row.sets.get("P1").unwrap();
        let shifts = set.shifts.as_ref().unwrap_or_else(|| panic!("{s} {p} {r}"));
        assert_eq!(model.get("P1.ring.shift").unwrap().unwrap().parse::<f64>().unwrap(), *shifts.get("ring").unwrap());
        // Nothing is odd about its teeth, but for tips that are too long where nothing else closes.
        let odd = |w: &willis::diagnostic::Diagnostic| {
            ["W314", "W301", "W302", "W303"].contains(&w.code.as_str()) && !w.message.contains("tip")
        };
        assert!(!model.warnings().iter().any(odd), "{:?}\n{text}", model.warnings());
        good += usize::from(!model.warnings().iter().any(|w| w.code.as_str() == "W314"));
    }
    assert!(good > 0, "{good} of {}", answer.rows.len());
    let json = serde_json::to_string(&answer).unwrap();
    assert_eq!(serde_json::from_str::<willis_synthesis::teeth::DesignAnswer>(&json).unwrap(), answer);
}

#[test]
fn an_empty_result_says_what_must_give() {
    let design = "planets = 3\ntarget = [{ ratio = [99, 101], any_sign = true }]\nrules = [\"assembly\", \"clearance\"]\n\
                  limits = { ring_diameter = 40 }\nrequire = { backward = 0.3 }";
    let text = wolfrom("12..60", "..120", "{ external = 0.98, internal = 0.99 }", design);
    let answer = read(&text).answer(&Request::default(), &Serial).unwrap();
    assert!(answer.rows.is_empty() && answer.completeness.complete);
    let ring = answer.relaxations.iter().find(|r| r.wish == "ring_diameter").unwrap();
    assert_eq!((ring.now, ring.needed), (Some(40.0), Some(58.0)));
    assert!(answer.relaxations.iter().all(|r| r.wish != "backward"), "{:?}", answer.relaxations);
    // That is exact: with a ring of 58 teeth there is a train, with 57 there is none.
    for (limit, some) in [("57", false), ("58", true)] {
        let text = text.replace("ring_diameter = 40", &format!("ring_diameter = {limit}"));
        let answer = read(&text).answer(&Request::default(), &Serial).unwrap();
        assert_eq!(answer.waterfall.last().unwrap().trains > 0, some);
    }
}

#[test]
fn demands_on_efficiency_count() {
    let wish =
        "planets = 3\ntarget = [{ ratio = [99, 101], any_sign = true }]\nrequire = { backward = 0.8, lock_margin = 4 }";
    let text = wolfrom("12..60", "..120", "{ external = 0.98, internal = 0.99 }", wish);
    let answer = read(&text).answer(&Request::default(), &Serial).unwrap();
    let names: Vec<&str> = answer.waterfall.iter().map(|s| s.condition.as_str()).collect();
    assert_eq!(names, ["ratio", "assembly", "clearance", "backward", "lock_margin"]);
    assert!(answer.rows.iter().all(|r| r.backward.unwrap() >= 0.8 && r.lock_margin.unwrap() >= 4.0));
    assert!(answer.waterfall.windows(2).all(|w| w[0].trains >= w[1].trains));
    // Self-locking trains are kept and marked unless that is excluded.
    let wish = "planets = 3\ntarget = [{ ratio = [480, 520], any_sign = true }]\nmaximize = [\"forward\"]";
    let text = wolfrom("12..40", "..90", "{ external = 0.98, internal = 0.99 }", wish);
    let answer = read(&text).answer(&Request::default(), &Serial).unwrap();
    for row in &answer.rows {
        assert_eq!(row.self_locking, row.lock_margin.unwrap() <= 1.0);
        assert!(row.forward.unwrap() <= 1.0);
    }
}

#[test]
fn what_is_wrong_is_said_with_its_place() {
    let wrong = |text: &str| {
        let e = Design::from_toml(text).unwrap_err();
        let d = e.iter().next().unwrap();
        (d.code.as_str().to_owned(), d.place.clone(), d.message.clone())
    };
    let text = |design: &str| simple("12..40", "..90", design);
    let target = "target = [{ ratio = 4 }]";
    let (code, place, message) = wrong(&simple("40..12", "..90", target));
    assert_eq!((code.as_str(), place.as_str()), ("E008", "set[0].sun.teeth"));
    assert_eq!(message, "`40..12` contains no number: 40 is above 12");
    assert_eq!(wrong(&text("")).1, "design.target");
    assert_eq!(wrong(&text(&format!("{target}\nrules = [\"asembly\"]"))).2, "there is no rule `asembly`");
    assert_eq!(wrong(&text("target = [{ state = \"7\", ratio = 4 }]")).2, "the train has no state `7`");
    assert_eq!(wrong(&text(&format!("{target}\ntolerence = 0.1"))).1, "design.tolerence");
    assert_eq!(wrong(&text("target = [{ ratio = [5, 4] }]")).2, "the window from 5 to 4 is empty");
    assert_eq!(wrong(&text(&format!("{target}\nlimits = {{ ring_diameter = \"90 mm\" }}"))).1, "design.module");
    assert_eq!(wrong(&text(&format!("{target}\nmaximize = [\"error\"]"))).2, "`error` belongs under `minimize`");
    assert_eq!(wrong(&text(&format!("{target}\nrequire = {{ forward = 1.2 }}"))).2, "no efficiency is above 1: 1.2");
    assert_eq!(wrong(&simple("12..14", "..20", target)).0, "E106");
    let e = Design::from_toml(&text(&format!("{target}\nrules = [\"asembly\"]"))).unwrap_err();
    assert_eq!(e.iter().next().unwrap().replacement.as_deref(), Some("\"assembly\""));
    assert!(e.iter().next().unwrap().span.is_some_and(|s| s.lines.is_some()));
    // Too large a space is refused before anything is done.
    let wish = "planets = 3\ntarget = [{ ratio = 100 }]";
    let huge = wolfrom("12..9000", "..10000", "0.99", wish);
    let e = read(&huge).answer(&Request::default(), &Serial).unwrap_err();
    assert_eq!(e.iter().next().unwrap().code.as_str(), "E212");
}

/// Whatever the form in which a number is written, the same is refused.
#[test]
fn forms_of_writing_have_the_same_bounds() {
    let said = |text: &str| -> Vec<[String; 3]> {
        let e = Design::from_toml(text).err().unwrap_or_else(|| panic!("{text}"));
        e.iter()
            .map(|d| {
                assert!(d.span.is_some(), "{d:?}");
                [d.code.as_str().to_owned(), d.place.clone(), d.message.clone()]
            })
            .collect()
    };
    let target = "target = [{ ratio = 4 }]";
    let sun =
        |value: &str| simple("12..40", "..90", target).replacen("teeth = \"12..40\"", &format!("teeth = {value}"), 1);
    for number in ["9000000000000000000", "-9223372036854775808", "10001", "-10001"] {
        for form in
            [format!("[{number}]"), format!("\"{number}\""), format!("[20, {number}]"), format!("\"20, {number}\"")]
        {
            let [code, place, message] = &said(&sun(&form))[0];
            assert_eq!((code.as_str(), place.as_str()), ("E008", "set[0].sun.teeth"), "{form}");
            assert_eq!(*message, format!("{number} is beyond ±10000"), "{form}");
        }
    }
    // A bare number in a set in which other gears have ranges.
    for number in ["9000000000000000000", "-9223372036854775808", "10001"] {
        assert_eq!(said(&sun(number))[0][2], format!("{number} is beyond ±10000"));
    }
    for form in ["-5", "0", "[-5]", "[-5, 0]", "\"-5\"", "\"-9..0\"", "\"..0\""] {
        let [code, place, message] = &said(&sun(form))[0];
        assert_eq!((code.as_str(), place.as_str()), ("E008", "set[0].sun.teeth"), "{form}");
        assert!(message.ends_with("contains no number of teeth: a gear has at least 1"), "{message}");
    }
    assert!(!said(&sun("[]"))[0][2].is_empty());
    let wish = |line: &str| simple("12..40", "..90", &format!("{target}\n{line}"));
    for form in ["[200]", "200", "\"200\"", "[-5]", "[0, 5]", "\"..2\"", "\"0..\"", "[101, 0]"] {
        let [code, place, message] = &said(&wish(&format!("mismatch = {form}")))[0];
        assert_eq!((code.as_str(), place.as_str()), ("E008", "design.mismatch"), "{form}");
        assert!(message.contains("beyond ±4"), "{message}");
    }
    for number in ["0.1234567", "2000000", "-1", "-0.5", "1000000.5"] {
        for form in [number.to_owned(), format!("\"{number}\""), format!("\"{number} modules\"")] {
            let [code, place, message] = &said(&wish(&format!("gap = {form}")))[0];
            assert_eq!((code.as_str(), place.as_str()), ("E008", "design.gap"), "{form}");
            assert!(message.contains("at least 0, with a numerator and denominator of at most a million"), "{message}");
        }
    }
    // What is allowed counts, in every form.
    for [gap, same] in [["2", "\"2 modules\""], ["1.5", "\"3/2\""]] {
        let count = |gap: &str| read(&wish(&format!("planets = 5\ngap = {gap}"))).count();
        assert_eq!(count(gap), count(same));
        assert!(count(gap).trains < count("0").trains);
    }
    let alone = |wish: &str| said(&simple("12..40", "..90", wish))[0].clone();
    for value in ["\"yes\"", "1"] {
        let [code, place, _] = alone(&format!("target = [{{ ratio = 4, any_sign = {value} }}]"));
        assert_eq!((code, place.as_str()), ("E006".into(), "design.target[0].any_sign"));
    }
    for value in ["5", "{ ratio = 4 }", "\"4\""] {
        let [_, place, message] = alone(&format!("target = {value}"));
        assert_eq!(place, "design.target");
        assert!(message.contains("a list of tables"), "{message}");
    }
}

/// Relaxations are searches: they end when the work does, and a ratio that cannot be widened holds up no other.
#[test]
fn relaxations_can_be_cancelled_and_widen_what_they_can() {
    struct Stops(std::sync::atomic::AtomicUsize);
    impl Work for Stops {
        fn cancelled(&self) -> bool {
            self.0.fetch_add(1, std::sync::atomic::Ordering::Relaxed) > 0
        }
    }
    struct Hurry;
    impl Work for Hurry {
        fn patience(&self) -> f64 {
            0.0
        }
    }
    // The first window reaches so far that any wider one would contain 0; the second must give.
    let wish = "[design]\ntarget = [{ state = \"1\", ratio = [0.01, 4.8] }, { state = \"R\", ratio = -2.1, tolerance = 0.001 }]";
    let gears =
        [("small_sun", "30"), ("large_sun", "36"), ("long_planet", "18"), ("ring", "72"), ("short_planet", "12..30")];
    let ranges = gears.map(|(g, t)| (format!("P1.{g}.teeth"), t));
    let ranges: Vec<(&str, &str)> = ranges.iter().map(|(p, r)| (p.as_str(), *r)).collect();
    let design = read(&crate::layouts::example(crate::counts::AOD, wish, &ranges));
    let progress = design.search(Progress::default(), None, &Serial).unwrap();
    let answer = |work: &dyn Work| design.answer_of(progress.clone(), &Request::default(), work).unwrap();
    let found = answer(&Serial);
    assert!(found.rows.is_empty() && found.completeness.complete);
    assert!(found.relaxations.iter().any(|r| r.wish == "tolerance"), "{:?}", found.relaxations);
    assert!(answer(&Stops(std::sync::atomic::AtomicUsize::new(1))).relaxations.is_empty());
    assert!(answer(&Stops(std::sync::atomic::AtomicUsize::new(0))).relaxations.is_empty());
    assert!(answer(&Hurry).relaxations.is_empty());
}

#[test]
fn contradicting_ratios_are_named_at_once() {
    // Four ratios of a Ravigneaux set come from two numbers.
    let wish = "[design]\ntarget = [{ state = \"1\", ratio = 2.4 }, { state = \"O\", ratio = 0.6667 }, \
                { state = \"R\", ratio = -3.0 }]";
    let ranges = ["small_sun", "large_sun", "long_planet", "ring"].map(|g| (format!("P1.{g}.teeth"), "15..100"));
    let ranges: Vec<(&str, &str)> = ranges.iter().map(|(p, r)| (p.as_str(), *r)).collect();
    let text = crate::layouts::example(crate::counts::AOD, wish, &ranges);
    let answer = read(&text).answer(&Request::default(), &Serial).unwrap();
    assert!(answer.rows.is_empty());
    assert!(
        answer.diagnostics.iter().any(|d| d.message.contains("states `O`, `R` contradict each other")),
        "{:?}",
        answer.diagnostics
    );
    assert!(answer.relaxations.iter().any(|r| r.wish == "ratio of state R"), "{:?}", answer.relaxations);
    // A state that no teeth can change.
    let text = simple("12..30", "..90", "target = [{ state = \"direct\", ratio = 1.2 }]").replace(
        "[[set]]",
        "[[shift_element]]\nname = \"L\"\nkind = \"clutch\"\nmembers = [\"sun\", \"carrier\"]\n\
         [[state]]\nname = \"direct\"\nengaged = [\"L\"]\n[[set]]",
    );
    let text = text
        .replace("member = \"frame\"", "member = \"ring\"")
        .replace("[\"sun\", \"carrier\"]\nterm", "[\"sun\", \"carrier\", \"ring\"]\nterm");
    let answer = read(&text).answer(&Request::default(), &Serial).unwrap();
    let said = &answer.diagnostics[0].message;
    assert_eq!(said, "state `direct` has the ratio 1 whatever the teeth are; 6/5 cannot be reached");
}
