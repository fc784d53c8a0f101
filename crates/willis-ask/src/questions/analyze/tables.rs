//! An analysis as tables: SI units in the column names, one row a thing.

use willis::analysis::{Analysis, Direction, MachineReport, SolutionReport, VariatorReport};

use crate::table::Kind::{Flag, Integer, Number, Text};
use crate::table::{Cell, Table, word};

/// All tables. Those of computed losses are there when there are any.
pub fn tables(a: &Analysis) -> Vec<Table> {
    let physical = a.operations.iter().any(|o| o.solutions.iter().any(|s| s.convergence.is_some()));
    let mut all = vec![states(a), operations(a), members(a), meshes(a), shift_elements(a)];
    if a.operations.iter().any(|o| o.solutions.iter().any(|s| !s.variators.is_empty())) {
        all.push(variators(a));
    }
    if physical {
        all.extend([losses(a), contacts(a), bearings(a)]);
    }
    all.push(diagnostics(a));
    all
}

fn states(a: &Analysis) -> Table {
    let mut t = Table::new(
        "states",
        [
            ("state", Text),
            ("engaged", Text),
            ("input", Text),
            ("output", Text),
            ("degrees_of_freedom", Integer),
            ("ratio_exact", Text),
            ("ratio", Number),
            ("step", Number),
            ("efficiency_driving", Number),
            ("verdict_driving", Text),
            ("efficiency_coasting", Number),
            ("verdict_coasting", Text),
            ("certified_driving", Flag),
            ("certified_coasting", Flag),
            ("operation", Text),
            ("speed_rad_s", Number),
            ("torque_n_m", Number),
            ("temperature_k", Number),
            ("efficiency_at_load", Number),
            ("loss_at_load_w", Number),
            ("spin_loss_w", Number),
        ],
    );
    for (name, s) in a.ratios.iter() {
        let certified = |d: &Direction| d.certificate.is_some_and(|c| c.unique_for_every_load);
        t.row([
            name.into(),
            s.engaged.join(" ").into(),
            (&s.input).into(),
            (&s.output).into(),
            s.degrees_of_freedom.into(),
            s.exact.as_ref().map(word).into(),
            s.value.into(),
            s.step.into(),
            s.drive.efficiency.into(),
            word(&s.drive.verdict).into(),
            s.coast.efficiency.into(),
            word(&s.coast.verdict).into(),
            certified(&s.drive).into(),
            certified(&s.coast).into(),
            s.at_load.as_ref().and_then(|a| a.operation.clone()).into(),
            s.at_load.as_ref().map(|a| a.speed_rad_s).into(),
            s.at_load.as_ref().map(|a| a.torque_n_m).into(),
            s.at_load.as_ref().and_then(|a| a.temperature_k).into(),
            s.at_load.as_ref().and_then(|a| a.efficiency).into(),
            s.at_load.as_ref().and_then(|a| a.loss_w).into(),
            s.at_load.as_ref().and_then(|a| a.spin_loss_w).into(),
        ]);
    }
    t
}

fn operations(a: &Analysis) -> Table {
    let mut t = Table::new(
        "operations",
        [
            ("operation", Text),
            ("state", Text),
            ("solution", Integer),
            ("verdict", Text),
            ("certificate", Text),
            ("efficiency", Number),
            ("input_power_w", Number),
            ("output_power_w", Number),
            ("loss_w", Number),
            ("power_residual_w", Number),
            ("recirculating_power_w", Number),
        ],
    );
    for o in &a.operations {
        let head = |solution: Option<usize>| -> [Cell; 5] {
            [
                (&o.name).into(),
                o.state.clone().into(),
                solution.into(),
                word(&o.verdict).into(),
                o.certificate.map(|c| word(&c.method)).into(),
            ]
        };
        if o.solutions.is_empty() {
            t.row(head(None).into_iter().chain(std::iter::repeat_n(Cell::Empty, 6)));
        }
        for (k, s) in o.solutions.iter().enumerate() {
            let circulating: f64 = s.recirculation.iter().map(|r| r.power_w).sum();
            let powers = [s.input_power_w, s.output_power_w, s.loss_w, s.power_residual_w, circulating];
            t.row(head(Some(k + 1)).into_iter().chain([s.efficiency.into()]).chain(powers.map(Cell::from)));
        }
    }
    t
}

/// A table with operation, state and number of the solution in front of the columns given, filled for each solution.
fn of_solutions(
    a: &Analysis,
    name: &str,
    columns: &[(&str, crate::table::Kind)],
    mut rows: impl FnMut(&SolutionReport) -> Vec<Vec<Cell>>,
) -> Table {
    let head = [("operation", Text), ("state", Text), ("solution", Integer)];
    let mut t = Table::new(name, head.into_iter().chain(columns.iter().copied()));
    for o in &a.operations {
        for (k, s) in o.solutions.iter().enumerate() {
            for row in rows(s) {
                let head: [Cell; 3] = [(&o.name).into(), o.state.clone().into(), (k + 1).into()];
                t.row(head.into_iter().chain(row));
            }
        }
    }
    t
}

fn members(a: &Analysis) -> Table {
    let columns = [
        ("member", Text),
        ("role", Text),
        ("speed_rad_s", Number),
        ("carrier", Text),
        ("relative_speed_rad_s", Number),
        ("torque_n_m", Number),
        ("power_w", Number),
    ];
    of_solutions(a, "members", &columns, |s| {
        let row = |(name, m): &(String, willis::analysis::MemberReport)| {
            vec![
                name.into(),
                word(&m.role).into(),
                m.speed_rad_s.into(),
                m.carrier.clone().into(),
                m.relative_speed_rad_s.into(),
                m.torque_n_m.into(),
                m.power_w.into(),
            ]
        };
        s.members.iter().map(row).collect()
    })
}

fn variators(a: &Analysis) -> Table {
    let columns = [
        ("variator", Text),
        ("kind", Text),
        ("variator_power_w", Number),
        ("share", Number),
        ("loss_w", Number),
        ("store_w", Number),
        ("ratio", Number),
        ("machine", Text),
        ("member", Text),
        ("torque_n_m", Number),
        ("speed_rad_s", Number),
        ("power_w", Number),
        ("efficiency", Number),
    ];
    of_solutions(a, "variators", &columns, |s| {
        let machines = s.variators.iter().flat_map(|(name, v)| v.machines.iter().map(move |m| (name, v, m)));
        let row = |(name, v, (machine, m)): (&String, &VariatorReport, &(String, MachineReport))| {
            vec![
                name.into(),
                word(&v.kind).into(),
                v.power_w.into(),
                v.share.into(),
                v.loss_w.into(),
                v.store_w.into(),
                v.ratio.into(),
                machine.into(),
                (&m.member).into(),
                m.torque_n_m.into(),
                m.speed_rad_s.into(),
                m.power_w.into(),
                m.efficiency.into(),
            ]
        };
        machines.map(row).collect()
    })
}

fn meshes(a: &Analysis) -> Table {
    let columns = [
        ("mesh", Text),
        ("driver", Text),
        ("relative_speed_rad_s", Number),
        ("potential_power_w", Number),
        ("efficiency", Number),
        ("loss_w", Number),
        ("first_torque_n_m", Number),
        ("second_torque_n_m", Number),
        ("carrier_torque_n_m", Number),
        ("count", Integer),
    ];
    of_solutions(a, "meshes", &columns, |s| {
        let row = |(name, m): &(String, willis::analysis::MeshReport)| {
            vec![
                name.into(),
                m.driver.clone().into(),
                m.relative_speed_rad_s.into(),
                m.potential_power_w.into(),
                m.efficiency.into(),
                m.loss_w.into(),
                m.first_torque_n_m.into(),
                m.second_torque_n_m.into(),
                m.carrier_torque_n_m.into(),
                m.count.into(),
            ]
        };
        s.meshes.iter().map(row).collect()
    })
}

fn shift_elements(a: &Analysis) -> Table {
    let columns = [("shift_element", Text), ("kind", Text), ("member", Text), ("other", Text), ("torque_n_m", Number)];
    of_solutions(a, "shift-elements", &columns, |s| {
        let row = |(name, e): &(String, willis::analysis::ShiftElementReport)| {
            let [member, other] = &e.members;
            vec![name.into(), e.kind.to_string().into(), member.into(), other.into(), e.torque_n_m.into()]
        };
        s.shift_elements.iter().map(row).collect()
    })
}

fn losses(a: &Analysis) -> Table {
    let columns = [("source", Text), ("kind", Text), ("law", Text), ("loss_w", Number), ("share", Number)];
    of_solutions(a, "losses", &columns, |s| {
        let row = |x: &willis::operating_point::LossSource| {
            vec![(&x.name).into(), word(&x.kind).into(), x.law.to_string().into(), x.loss_w.into(), x.share.into()]
        };
        s.sources.iter().map(row).collect()
    })
}

fn contacts(a: &Analysis) -> Table {
    let columns = [
        ("mesh", Text),
        ("friction", Number),
        ("loss_factor", Number),
        ("contact_ratio", Number),
        ("overlap_ratio", Number),
        ("tangential_force_n", Number),
        ("line_load_n_per_m", Number),
        ("pitch_line_speed_m_s", Number),
        ("sum_speed_m_s", Number),
        ("sliding_speed_m_s", Number),
        ("pitch_pressure_pa", Number),
        ("pressure_pa", Number),
        ("film_m", Number),
        ("film_ratio", Number),
        ("regime", Text),
        ("sliding_loss_w", Number),
        ("rolling_loss_w", Number),
    ];
    of_solutions(a, "contacts", &columns, |s| {
        let row = |(name, c): &(String, willis::operating_point::ContactReport)| {
            vec![
                name.into(),
                c.friction.into(),
                c.loss_factor.into(),
                c.contact_ratio.into(),
                c.overlap_ratio.into(),
                c.tangential_force_n.into(),
                c.line_load_n_per_m.into(),
                c.pitch_line_speed_m_s.into(),
                c.sum_speed_m_s.into(),
                c.sliding_speed_m_s.into(),
                c.pitch_pressure_pa.into(),
                c.pressure_pa.into(),
                c.film_m.into(),
                c.film_ratio.into(),
                c.regime.map(|r| word(&r)).into(),
                c.sliding_loss_w.into(),
                c.rolling_loss_w.into(),
            ]
        };
        s.contacts.iter().map(row).collect()
    })
}

fn bearings(a: &Analysis) -> Table {
    let columns = [
        ("bearing", Text),
        ("designation", Text),
        ("member", Text),
        ("other", Text),
        ("number", Integer),
        ("speed_rad_s", Number),
        ("radial_load_n", Number),
        ("axial_load_n", Number),
        ("torque_n_m", Number),
        ("law", Text),
        ("loss_w", Number),
    ];
    of_solutions(a, "bearings", &columns, |s| {
        let row = |(name, b): &(String, willis::operating_point::BearingReport)| {
            let [member, other] = &b.members;
            vec![
                name.into(),
                (&b.designation).into(),
                member.into(),
                other.into(),
                b.bearings.into(),
                b.speed_rad_s.into(),
                b.radial_load_n.into(),
                b.axial_load_n.into(),
                b.torque_n_m.into(),
                b.law.to_string().into(),
                b.loss_w.into(),
            ]
        };
        s.bearings.iter().map(row).collect()
    })
}

fn diagnostics(a: &Analysis) -> Table {
    let columns = [("code", Text), ("severity", Text), ("place", Text), ("message", Text), ("hints", Text)];
    let mut t = Table::new("diagnostics", columns);
    for d in &a.diagnostics {
        t.row([
            d.code.as_str().into(),
            word(&d.severity).into(),
            (&d.place).into(),
            (&d.message).into(),
            d.hints.join("; ").into(),
        ]);
    }
    t
}
