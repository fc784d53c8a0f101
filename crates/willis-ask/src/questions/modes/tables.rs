//! Natural frequencies as a table.

use willis::dynamics::{ModesReport, Part};

use crate::table::Kind::{Integer, Number, Text};
use crate::table::{Cell, Table};

/// One row a number: the mode, what the number is and whose it is; motions without strain come first and are numbered
/// by themselves.
pub fn table_of(all: &ModesReport) -> Table {
    let mut t = Table::new(
        "modes",
        [
            ("mode", Integer),
            ("kind", Text),
            ("frequency_hz", Number),
            ("angular_frequency_rad_s", Number),
            ("damping_ratio", Number),
            ("damped_frequency_hz", Number),
            ("quantity", Text),
            ("name", Text),
            ("value", Number),
        ],
    );
    let mut rows = |head: [Cell; 6], quantity: &str, parts: &[Part]| {
        for p in parts {
            t.row(head.iter().cloned().chain([quantity.into(), (&p.name).into(), p.value.into()]));
        }
    };
    for (k, m) in all.rigid_body_modes.iter().enumerate() {
        let head = || [(k + 1).into(), "rigid".into(), 0.0.into(), 0.0.into(), Cell::Empty, Cell::Empty];
        rows(head(), "shape", &m.shape);
        rows(head(), "kinetic_energy", &m.kinetic_energy);
    }
    for (k, m) in all.modes.iter().enumerate() {
        let head = || {
            [
                (k + 1).into(),
                "elastic".into(),
                m.frequency_hz.into(),
                m.angular_frequency_rad_s.into(),
                m.damping_ratio.into(),
                m.damped_frequency_hz.into(),
            ]
        };
        rows(head(), "shape", &m.shape);
        rows(head(), "kinetic_energy", &m.kinetic_energy);
        rows(head(), "strain_energy", &m.strain_energy);
    }
    t
}
