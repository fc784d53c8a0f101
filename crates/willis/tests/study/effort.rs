//! Work that is told before it begins, and work that grows no faster than the file.

use willis::analysis::{Selection, analyze};
use willis::diagnostic::Code;
use willis::model::Model;
use willis::statics::Certificate;
use willis::study::{CompareRequest, SweepRequest, UncertaintyRequest, compare, sweep, uncertainty};
use willis::train::Train;
use willis::work::{Effort, Serial, Work};

/// Sets in series, the ring on the frame, the carrier of one the sun of the next; with so many operations.
fn series(sets: usize, operations: usize) -> String {
    let member = |k: usize| if k == sets { "out".to_owned() } else { format!("c{k}") };
    let members: Vec<String> = (0..=sets).map(|k| format!("{:?}", member(k))).collect();
    let mut text =
        format!("format = 1\nname = \"series\"\nmembers = [{}]\nterminals = [\"c0\", \"out\"]\n", members.join(", "));
    for k in 0..sets {
        text += &format!(
            "[[set]]\nname = \"P{k}\"\nsun = {{ member = {:?}, teeth = 30 }}\nring = {{ member = \"frame\", teeth = 70 }}\n\
             carrier = {:?}\nmesh_efficiency = 0.98\n",
            member(k),
            member(k + 1)
        );
    }
    for k in 0..operations {
        text += &format!(
            "[[operation]]\nname = \"o{k}\"\nspeeds = {{ c0 = \"{} rpm\" }}\ntorques = {{ c0 = \"10 N m\" }}\n",
            1000 + k
        );
    }
    text
}

/// Nobody allowed anything.
struct Hasty;

impl Work for Hasty {
    fn patience(&self) -> f64 {
        0.0
    }

    fn run(&self, _: usize, _: &(dyn Fn(usize) + Sync)) {
        panic!("it has begun");
    }
}

#[test]
fn what_would_take_long_is_refused_before_it_begins() {
    let model = Model::from_toml(&series(2, 1)).unwrap();
    let over = vec!["c0.speed=100..1000 rpm:10".to_owned()];
    let refused = [
        uncertainty(&model, &UncertaintyRequest::default(), &Hasty).unwrap_err(),
        sweep(&model, &SweepRequest { over: over.clone(), ..Default::default() }, &Hasty).unwrap_err(),
        compare(&[("a", &model), ("b", &model)], &CompareRequest { over, ..Default::default() }, &Hasty).unwrap_err(),
    ];
    for wrong in refused {
        let all: Vec<Code> = wrong.iter().map(|d| d.code).collect();
        assert_eq!(all, [Code::TooLong], "{wrong}");
        assert!(wrong.to_string().contains("operating points, about 1 second of one core"), "{wrong}");
    }
    // Sixty sets with 120 uncertain efficiencies are hours; one set is nothing.
    let long = Model::from_toml(&series(60, 1)).unwrap();
    let wrong = uncertainty(&long, &UncertaintyRequest::default(), &Serial).unwrap_err();
    assert!(wrong.iter().any(|d| d.code == Code::TooLong), "{wrong}");
    assert!(Serial.afford(&Effort::of_analysis(long.train(), &Selection::default())).is_ok());
}

/// What a longer file costs: allocations of one answer.
fn allocations(mut answer: impl FnMut()) -> u64 {
    allocation_counter::measure(&mut answer).count_total
}

#[test]
fn a_study_of_one_operation_does_not_pay_for_the_others() {
    let cost = |operations| {
        let model = Model::from_toml(&series(1, operations)).unwrap();
        let request = UncertaintyRequest { samples: 128, ..Default::default() };
        allocations(|| drop(uncertainty(&model, &request, &Serial).unwrap()))
    };
    // The file is read once more; its operations are not, at each of the samples.
    let (few, many) = (cost(1), cost(1001));
    assert!(many < few + 1000 * 300, "{few} allocations with one operation, {many} with 1001");
}

/// Sets in series load one another and do not interact: each is certified by itself, and the certificate is that of one.
#[test]
fn a_long_train_is_as_certain_as_a_short_one() {
    for sets in [1, 15, 60] {
        let train = Train::from_toml(&series(sets, 1)).unwrap();
        let found = analyze(&train, &Selection::default()).unwrap().operations[0].certificate.unwrap();
        assert_eq!((found.method, found.unique_for_every_load), (Certificate::SpectralRadius, true), "{sets} sets");
    }
}
