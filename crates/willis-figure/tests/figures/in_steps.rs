//! Figures that take long: coarse first, then fine, and no longer than they are wanted.

use std::sync::atomic::{AtomicU64, Ordering};

use willis::study::{Axis, UncertaintyPlan, UncertaintyRequest};
use willis::work::{Serial, Work};
use willis_figure::{Figure, FigureKind, FigureRequest};

use crate::trains::model;

/// Work that somebody cancels after so many steps.
struct Until {
    steps: u64,
    done: AtomicU64,
}

impl Work for Until {
    fn advance(&self, steps: u64) {
        self.done.fetch_add(steps, Ordering::Relaxed);
    }

    fn cancelled(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.steps
    }
}

#[test]
fn what_is_cancelled_stops_soon() {
    for kind in ["map", "band"].map(|name| FigureKind::named(name).expect("a kind")) {
        let work = Until { steps: 60, done: AtomicU64::new(0) };
        let wrong = kind.make_within(&model("fva-planetary-stage"), &FigureRequest::default(), &work).unwrap_err();
        assert!(wrong.to_string().contains("stopped"), "{wrong}");
        // At most one row of the map, or one part of the samples, more.
        assert!(work.done.load(Ordering::Relaxed) < 60 + 60, "{}", kind.name());
    }
}

#[test]
fn within_work_and_without_the_figure_is_the_same() {
    let (model, request) = (model("prius-p112"), FigureRequest { samples: 64, ..Default::default() });
    for kind in FigureKind::ALL {
        let (alone, within) = (kind.make(&model, &request), kind.make_within(&model, &request, &Serial));
        match (alone, within) {
            (Ok(alone), Ok(within)) => assert_eq!(alone, within, "{}", kind.name()),
            (alone, within) => assert_eq!(alone.is_err(), within.is_err(), "{}", kind.name()),
        }
    }
}

#[test]
fn a_coarse_figure_has_the_axes_and_the_values_of_the_fine_one() {
    let (model, request) = (model("fva-planetary-stage"), FigureRequest::default());
    let kind = FigureKind::named("map").expect("a kind");
    let coarse = kind.make_coarse(&model, &request, &Serial).expect("it takes long").expect("it applies");
    let (Figure::Map(coarse), Figure::Map(fine)) = (coarse, kind.make(&model, &request).expect("it applies")) else {
        panic!("maps are maps")
    };
    let kind = FigureKind::named("band").expect("a kind");
    let bands = kind.make_coarse(&model, &request, &Serial).expect("it takes long").expect("it applies");
    assert!(matches!(bands, Figure::Band(b) if b.samples <= 32 && b.points.iter().all(|p| p.efficiency.is_some())));
    assert!(coarse.points.len() * 3 < fine.points.len());
    for (a, b) in [(&coarse.x, &fine.x), (&coarse.y, &fine.y)] {
        assert_eq!((&a.name, a.values.first(), a.values.last()), (&b.name, b.values.first(), b.values.last()));
    }
    assert_eq!(coarse.points.last().map(|p| p.efficiency), fine.points.last().map(|p| p.efficiency));
}

/// Work whose parts are done in another order, as threads may do them.
struct LastFirst;

impl Work for LastFirst {
    fn run(&self, parts: usize, job: &(dyn Fn(usize) + Sync)) {
        (0..parts).rev().for_each(job);
    }
}

#[test]
fn a_figure_is_the_same_in_whatever_order_its_parts_are_made() {
    let request = FigureRequest::default();
    for name in ["fva-planetary-stage", "prius-hybrid", "two-mode-split"] {
        let model = model(name);
        for kind in ["map", "band"].map(|kind| FigureKind::named(kind).expect("a kind")) {
            let other = kind.make_within(&model, &request, &LastFirst).expect("it applies");
            assert_eq!(kind.make(&model, &request).expect("it applies"), other, "{} of {name}", kind.name());
        }
    }
}

#[test]
fn a_coarse_map_has_fewer_points_where_each_takes_longer() {
    let (kind, request) = (FigureKind::named("map").expect("a kind"), FigureRequest::default());
    let points = |name: &str| match kind.make_coarse(&model(name), &request, &Serial) {
        Some(Ok(Figure::Map(map))) => map.points.len(),
        _ => panic!("{name} has a map"),
    };
    let [long, short] = [points("wang-herringbone-physical"), points("wolfrom-236")];
    assert!(long >= 36 && long < short, "{long}, {short}");
}

/// The compiled train, which answers most values of a band, says what the long way says.
#[test]
fn regress_bands_are_those_of_every_sample_the_long_way() {
    for name in ["zf-8hp70", "prius-p112", "wolfrom-498-self-locking", "two-efficiencies", "fva-planetary-stage"] {
        let model = model(name);
        let over = FigureRequest { samples: 128, ..Default::default() };
        let kind = FigureKind::named("band").expect("a kind");
        let Ok(Figure::Band(bands)) = kind.make(&model, &over) else { panic!("{name} has bands") };
        let request = UncertaintyRequest { samples: 128, ..Default::default() };
        let plan = UncertaintyPlan::new(&model, &request).unwrap();
        let unit = bands.x.unit.clone();
        let value = |k: usize| format!("{} {unit}", bands.x.values[k]);
        let text = format!("{}={}, {}", bands.x.name, value(0), value(bands.x.values.len() - 1));
        let axis = Axis::parse(&text, &model).unwrap();
        for (k, point) in [(0, bands.points.first()), (1, bands.points.last())] {
            let samples = (0..plan.len()).filter(|p| plan.design().is_sample(*p));
            let answers = samples.map(|p| plan.answer_along(Some(p), &axis, k, &mut Default::default()));
            let mut all: Vec<f64> = answers.filter(|a| a.is_unique()).map(|a| a.efficiency()).collect();
            all.sort_by(f64::total_cmp);
            let point = point.unwrap();
            assert_eq!(all.len(), point.answered, "{name}");
            let Some(told) = point.efficiency else { continue };
            for (p, own) in willis_figure::QUANTILES.into_iter().zip(told) {
                let long = willis::unstable::quantile(&all, p);
                assert!((long - own).abs() <= 1e-11 * long, "{name}, {p}: {long}, {own}");
            }
        }
    }
}
