//! Groups: friction and mesh elements that stick and slip together.

use crate::dynamics::element::{Element, element_name};
use crate::exact::Rational;
use crate::kinematics::Configuration;

use super::coordinates::Coordinates;
use super::frictions::{Friction, Rubs};

/// Elements whose relative speeds are always proportional: they stick and slip together.
#[derive(Clone)]
pub(in crate::dynamics) struct Group {
    /// Of its friction and mesh elements.
    pub names: Vec<String>,
    /// Its slip over the coordinates.
    pub row: Vec<f64>,
    /// The same, exactly.
    pub exact: Vec<Rational>,
    pub frictions: Vec<usize>,
    pub elements: Vec<usize>,
    /// Only prescribed speeds move it: it cannot be held.
    pub driven: bool,
    /// Port of the element that carries the holding torque, and the slip of the group that a unit of it
    /// gives power to.
    pub lead: (usize, f64),
}

/// Groups over so many free coordinates.
struct Joined {
    free: usize,
    groups: Vec<Group>,
}

impl Joined {
    /// Takes in an element of slip `row`: its group and its slip over that of the group; `None` if it never slips.
    /// `lead` is what holds its group if it is the first of it.
    fn join(&mut self, row: Vec<Rational>, name: &str, lead: (usize, f64)) -> Option<(usize, f64)> {
        let first = row.iter().position(|x| !x.is_zero())?;
        for (g, other) in self.groups.iter().map(|g| &g.exact).enumerate() {
            if other[first].is_zero() {
                continue;
            }
            let factor = &row[first] / &other[first];
            if row.iter().zip(other).all(|(x, y)| *x == &factor * y) {
                let factor = factor.to_f64();
                self.groups[g].names.push(name.to_owned());
                return Some((g, factor));
            }
        }
        self.groups.push(Group {
            names: vec![name.to_owned()],
            row: row.iter().map(Rational::to_f64).collect(),
            frictions: vec![],
            elements: vec![],
            driven: row[..self.free].iter().all(Rational::is_zero),
            lead,
            exact: row,
        });
        Some((self.groups.len() - 1, 1.0))
    }
}

/// What always slips together, decided exactly. Each element that rubs or loses is told its group.
pub(super) fn slip_together(
    c: &Configuration<'_>,
    coordinates: &Coordinates,
    frictions: &mut [Friction],
    elements: &mut [Element],
) -> Vec<Group> {
    let mut joined = Joined { free: coordinates.free, groups: Vec::new() };
    for f in frictions.iter_mut() {
        let rubs = f.rigid
            || matches!(f.what, Rubs::Law(_) | Rubs::Variator(_))
            || f.torque.points().iter().any(|p| p[1] > 0.0);
        if rubs && !f.open {
            f.group = joined.join(coordinates.exact_slip(f.members), &f.name, (f.port, 1.0));
        }
    }
    for (of, e) in c.elements.iter().zip(elements.iter_mut()) {
        if !e.is_lossless() {
            let name = element_name(c.train, &e.links);
            e.group = joined.join(coordinates.exact_slip([of.p, of.carrier]), &name, (e.port, -1.0));
        }
    }
    let mut groups = joined.groups;
    for (k, f) in frictions.iter().enumerate() {
        if let Some((g, _)) = f.group {
            groups[g].frictions.push(k);
        }
    }
    for (j, e) in elements.iter().enumerate() {
        if let Some((g, factor)) = e.group {
            groups[g].elements.push(j);
            // The loss of a mesh acts against its speed.
            if groups[g].lead.0 == e.port {
                groups[g].lead.1 = -factor;
            }
        }
    }
    groups
}
