//! Speeds and torques of every shaft, planet and shift element in every state, as one picture. The data are the answer of
//! `willis table`, so that picture and numbers cannot differ.

pub mod draw;

use willis::analysis::{AskedLoad, ShaftTable, ShaftTableRequest, shaft_table};

use crate::kind::{self, Ask, Kind};

pub(crate) const KIND: Kind<ShaftTable> = Kind {
    title: "Speeds and torques",
    takes: &[Ask::State],
    effort: kind::of_file,
    applies: None,
    make: |s, r| {
        shaft_table(
            s.train(),
            &ShaftTableRequest { state: r.state.clone(), lossless: false, load: Some(AskedLoad::default()) },
        )
    },
    steps: None,
    draw: |data, _| draw::draw(data),
};
