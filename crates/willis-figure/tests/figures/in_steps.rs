//! Figures that take long: coarse first, then fine, and no longer than they are wanted.

use std::sync::atomic::{AtomicU64, Ordering};

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
    assert!(matches!(bands, Figure::Band(b) if b.samples == 32 && b.points.iter().all(|p| p.efficiency.is_some())));
    assert!(coarse.points.len() * 3 < fine.points.len());
    for (a, b) in [(&coarse.x, &fine.x), (&coarse.y, &fine.y)] {
        assert_eq!((&a.name, a.values.first(), a.values.last()), (&b.name, b.values.first(), b.values.last()));
    }
    assert_eq!(coarse.points.last().map(|p| p.efficiency), fine.points.last().map(|p| p.efficiency));
}
