//! Laws of friction rank where the file has teeth with a geometry and operations, and the answer says so.

use willis::Model;
use willis::analysis::{Selection, analyze};
use willis::work::Serial;
use willis_synthesis::teeth::{Design, DesignAnswer, DesignRow, RankedBy, Recomputed, Request};

fn lawful(design: &str, operations: &str) -> Design {
    let text = format!(
        r#"
        format = 1
        name = "lawful"
        members = ["sun", "carrier"]
        terminals = ["sun", "carrier"]

        [design]
        planets = "3..4"
        mismatch = [-1, 0, 1]
        target = [{{ ratio = [4.4, 4.8] }}]
        minimize = ["ring_diameter", "error"]
        maximize = ["forward", "backward"]
        {design}

        [oil]
        viscosity_40 = "100 mm^2/s"
        viscosity_100 = "11 mm^2/s"
        density_15 = "880 kg/m^3"
        temperature = "80 degC"

        [[set]]
        name = "P1"
        sun = {{ member = "sun", teeth = "15..30" }}
        planet = {{ teeth = "15..40" }}
        ring = {{ member = "frame", teeth = "..90" }}
        carrier = "carrier"
        geometry = {{ module = "2 mm", width = "20 mm", roughness = "0.8 um" }}
        {operations}
        "#
    );
    Design::from_toml(&text).unwrap_or_else(|e| panic!("{}", e.render("design", &text, false)))
}

const BOTH: &str = r#"
    [[operation]]
    name = "lift"
    speeds = { sun = "1500 rpm" }
    torques = { sun = "50 N m" }

    [[operation]]
    name = "lift slowly"
    speeds = { sun = "150 rpm" }
    torques = { carrier = "-100 N m" }

    [[operation]]
    name = "lower"
    speeds = { sun = "1500 rpm" }
    torques = { carrier = "200 N m" }
"#;

fn ask(design: &Design, request: Request) -> DesignAnswer {
    design.answer(&request, &Serial).unwrap()
}

fn teeth(r: &DesignRow) -> Vec<i64> {
    r.sets.iter().flat_map(|(_, s)| s.teeth.iter().map(|(_, z)| *z)).collect()
}

fn point(r: &DesignRow) -> [f64; 4] {
    let laws = r.laws.as_ref().unwrap();
    [r.ring_diameter_m.unwrap(), r.error, -laws.forward.unwrap_or(0.0), -laws.backward.unwrap_or(0.0)]
}

/// The front under the laws is that of every train by itself, and its efficiencies are those of the train files.
#[test]
fn laws_rank_every_train_where_there_are_few() {
    let design = lawful("", BOTH);
    let every = Request { all: true, top: Some(10_000), ..Request::default() };
    let (front, all) = (ask(&design, Request { top: Some(10_000), ..Request::default() }), ask(&design, every));
    let ranking = &front.ranked_by;
    assert_eq!((ranking.by, ranking.recomputed), (RankedBy::Laws, Recomputed::All));
    assert_eq!(
        (&ranking.forward[..], &ranking.backward[..]),
        (&["lift", "lift slowly"].map(String::from)[..], &["lower".to_owned()][..])
    );
    let left = front.waterfall.last().unwrap().trains;
    assert!(left > 10 && ranking.trains == left && ranking.satisfy == Some(left) && ranking.open == 0);
    assert!(ranking.words.contains("best under the laws") && front.completeness.statement.contains("Under the laws"));
    assert!(all.of_all && all.rows.len() as u64 == left);
    let beats = |a: &[f64; 4], b: &[f64; 4]| a != b && a.iter().zip(b).all(|(x, y)| x <= y);
    let mut best: Vec<Vec<i64>> =
        all.rows.iter().filter(|r| !all.rows.iter().any(|o| beats(&point(o), &point(r)))).map(teeth).collect();
    let mut found: Vec<Vec<i64>> = front.rows.iter().map(teeth).collect();
    best.sort();
    found.sort();
    assert_eq!(found, best);
    assert_eq!(front.front, found.len() as u64);
    // It is another front than that of the mesh efficiencies, and its numbers are those of the files.
    let mesh = ask(&design, Request { recompute: Some(0), top: Some(10_000), ..Request::default() });
    assert_eq!((mesh.ranked_by.by, mesh.ranked_by.recomputed), (RankedBy::MeshEfficiencies, Recomputed::None));
    assert_ne!(mesh.rows.iter().map(teeth).collect::<Vec<_>>(), front.rows.iter().map(teeth).collect::<Vec<_>>());
    for row in &front.rows {
        let model = Model::from_toml(&design.train_file(row)).unwrap();
        let analysis = analyze(model.train(), &Selection::default()).unwrap();
        let of =
            |name: &str| analysis.operations.iter().find(|o| o.name == name).unwrap().solutions[0].efficiency.unwrap();
        let laws = row.laws.as_ref().unwrap();
        assert_eq!(laws.forward, Some(of("lift").min(of("lift slowly"))));
        assert_eq!(laws.backward, Some(of("lower")));
        assert_eq!(row.operations.get("lower").unwrap().efficiency, Some(of("lower")));
    }
}

/// Demands are judged by the laws, too, and not by mesh efficiencies before; nothing left says how far they must give.
#[test]
fn laws_judge_demands_on_efficiency() {
    let open = lawful("", BOTH);
    let all = ask(&open, Request { all: true, top: Some(10_000), ..Request::default() });
    let mut values: Vec<f64> = all.rows.iter().map(|r| r.laws.as_ref().unwrap().backward.unwrap_or(0.0)).collect();
    values.sort_by(f64::total_cmp);
    let (middle, most) = (values[values.len() / 2], values[values.len() - 1]);
    let asked = ask(&lawful(&format!("require = {{ backward = {middle} }}"), BOTH), Request::default());
    let expected = values.iter().filter(|v| **v >= middle).count() as u64;
    assert_eq!((asked.ranked_by.trains, asked.ranked_by.satisfy), (values.len() as u64, Some(expected)));
    assert!(asked.rows.iter().all(|r| r.laws.as_ref().unwrap().backward.unwrap() >= middle));
    // Every count of the answer is that under the laws.
    let last = asked.waterfall.last().unwrap();
    assert_eq!((last.condition.as_str(), last.trains), ("backward", expected));
    let said = format!("{expected} set{} of tooth numbers satisf", if expected == 1 { "" } else { "s" });
    assert!(asked.completeness.statement.contains(&said), "{}", asked.completeness.statement);
    let above = (most + 1.0) / 2.0;
    let empty = ask(&lawful(&format!("require = {{ backward = {above} }}"), BOTH), Request::default());
    assert!(empty.rows.is_empty() && empty.front == 0);
    let [only] = &empty.relaxations[..] else { panic!("{:?}", empty.relaxations) };
    assert_eq!((only.wish.as_str(), only.needed, only.trains), ("backward", Some(most), values.len() as u64));
}

/// Where too many trains are left to ask the laws, a demand is judged by mesh efficiencies: then nothing is said to exist or not
/// to exist under the laws, and no other wish is asked to give.
#[test]
fn a_demand_that_mesh_efficiencies_judged_is_said_to_be_so() {
    let all =
        ask(&lawful("", BOTH), Request { recompute: Some(0), all: true, top: Some(10_000), ..Request::default() });
    let trains = all.rows.len() as u64;
    let demand = lawful("require = { forward = 0.995 }", BOTH);
    let answer = ask(&demand, Request { recompute: Some(trains - 1), ..Request::default() });
    let said = &answer.completeness.statement;
    assert!(answer.rows.is_empty() && !said.contains("nothing else exists"), "{said}");
    assert!(said.contains(&format!("{trains} satisfy all other wishes")), "{said}");
    assert!(answer.relaxations.iter().all(|r| r.wish == "forward"), "{:?}", answer.relaxations);
    // One more, and the laws judge.
    let judged = ask(&demand, Request { recompute: Some(trains), ..Request::default() });
    assert_eq!(judged.ranked_by.recomputed, Recomputed::All);
    assert!(judged.completeness.statement.contains("nothing else exists"));
}

/// Teeth that are given and do not keep the wish are a row all the same, with what they do not keep.
#[test]
fn given_teeth_that_miss_the_wish_are_named() {
    let design = lawful("limits = { ring_diameter = \"140 mm\" }", BOTH);
    let told = |teeth: &str| {
        let answer = design.answer_for(&[teeth.to_owned()]).unwrap();
        answer.diagnostics.iter().map(|d| d.message.clone()).collect::<Vec<_>>()
    };
    let kept = design.answer(&Request::default(), &Serial).unwrap();
    let numbers = teeth(&kept.rows[0]).iter().map(i64::to_string).collect::<Vec<_>>().join("/");
    assert!(told(&numbers).is_empty(), "{:?}", told(&numbers));
    // 1 + 90/30 = 4, and 90 teeth of 2 mm.
    let [missed] = &told("30/30/90")[..] else { panic!() };
    assert!(missed.contains("ratio of state") && missed.contains("ring_diameter"), "{missed}");
}

/// Where there are too many trains the front of the mesh efficiencies is computed, or what is shown of it, and the words say
/// that there may be others.
#[test]
fn what_was_not_computed_with_the_laws_is_said() {
    let design = lawful("", BOTH);
    let front = ask(&design, Request { recompute: Some(0), ..Request::default() }).front;
    let some = ask(&design, Request { recompute: Some(front), ..Request::default() });
    let ranking = &some.ranked_by;
    assert_eq!((ranking.by, ranking.recomputed, ranking.trains), (RankedBy::Laws, Recomputed::Front, front));
    assert!(ranking.words.contains("may be better"), "{}", ranking.words);
    assert!(!some.completeness.statement.contains("Under the laws"));
    let few = ask(&design, Request { recompute: Some(1), top: Some(2), ..Request::default() });
    assert_eq!((few.ranked_by.by, few.ranked_by.recomputed), (RankedBy::MeshEfficiencies, Recomputed::Shown));
    assert!(few.ranked_by.words.contains("rank nothing") && few.rows.iter().all(|r| r.laws.is_some()));
    // Without an operation there is nothing that a law could be asked.
    let none = ask(&lawful("", ""), Request::default());
    assert_eq!((none.ranked_by.by, none.ranked_by.recomputed), (RankedBy::MeshEfficiencies, Recomputed::None));
    assert!(none.rows.iter().all(|r| r.laws.is_none()));
    // Only one direction has an operation: the other remains that of the meshes.
    let one = ask(&lawful("", BOTH.split("[[operation]]\n    name = \"lower\"").next().unwrap()), Request::default());
    assert!(one.ranked_by.backward.is_empty() && one.ranked_by.words.contains("backward efficiencies remain"));
}

/// A train that exists is ranked by the same laws.
#[test]
fn a_train_that_exists_is_ranked_by_the_laws() {
    let design = lawful("", BOTH);
    let front = ask(&design, Request { top: Some(10_000), ..Request::default() });
    let worst = ask(&design, Request { all: true, top: Some(10_000), ..Request::default() });
    for row in [&front.rows[0], worst.rows.last().unwrap()] {
        let own = Some(("mine".to_owned(), design.train_file(row)));
        let answer = ask(&design, Request { own, ..Request::default() });
        let own = answer.own.unwrap();
        assert!(own.fails.is_empty(), "{:?}", own.fails);
        assert_eq!(own.row.laws, row.laws);
        let is_on_front = front.rows.iter().any(|r| teeth(r) == teeth(row));
        assert_eq!(own.better == 0, is_on_front);
    }
}
