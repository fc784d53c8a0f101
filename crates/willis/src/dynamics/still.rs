//! What stands still in a mode, exactly: the speeds of what is held follow from the others by exact ratios.
//!
//! An integrator adds rates up, and what it adds leaves round-off: members held together would creep apart. So each
//! relation that a hold makes is solved for one coordinate, by exact elimination, and that coordinate is never read
//! but from the others. Members that turn alike then have the same row, and to the last bit the same speed; what
//! is held to the frame has a row of zeros.

use crate::exact::Rational;

use super::mode::dot;
use super::system::System;

/// The speeds of a mode.
#[derive(Debug)]
pub(super) struct Still {
    /// Which groups are held.
    pub held: Vec<bool>,
    /// Free coordinates that follow from the others, each with its row over all of them; the entries of all that
    /// follow are zero.
    follow: Vec<(usize, Vec<f64>)>,
    /// The speed of each member, likewise.
    pub members: Vec<Vec<f64>>,
}

impl Still {
    pub fn of(system: &System, held: Vec<bool>) -> Self {
        // Solved rows: the coordinate, and what it is made of.
        let mut solved: Vec<(usize, Vec<Rational>)> = vec![];
        let insert = |row: &mut [Rational], k: usize, of: &[Rational]| {
            let factor = std::mem::replace(&mut row[k], Rational::ZERO);
            if !factor.is_zero() {
                row.iter_mut().zip(of).filter(|(_, y)| !y.is_zero()).for_each(|(x, y)| *x += &factor * y);
            }
        };
        for (group, _) in system.groups.iter().zip(&held).filter(|(_, held)| **held) {
            let mut row = group.exact.clone();
            solved.iter().for_each(|(k, of)| insert(&mut row, *k, of));
            // The largest entry: no error of the others grows.
            let Some(k) = (0..system.free).filter(|k| !row[*k].is_zero()).max_by_key(|k| row[*k].abs()) else {
                continue;
            };
            let pivot = -std::mem::replace(&mut row[k], Rational::ZERO);
            row.iter_mut().filter(|x| !x.is_zero()).for_each(|x| *x = &*x / &pivot);
            solved.iter_mut().for_each(|(_, of)| insert(of, k, &row));
            solved.push((k, row));
        }
        let floats = |row: &[Rational]| row.iter().map(Rational::to_f64).collect();
        let member = |(row, speeds): (&Vec<Rational>, &Vec<f64>)| {
            if solved.iter().all(|(k, _)| row[*k].is_zero()) {
                return speeds.clone();
            }
            let mut row = row.clone();
            solved.iter().for_each(|(k, of)| insert(&mut row, *k, of));
            floats(&row)
        };
        Self {
            held,
            members: system.exact_speeds.iter().zip(&system.speeds).map(member).collect(),
            follow: solved.iter().map(|(k, row)| (*k, floats(row))).collect(),
        }
    }

    pub fn holds(&self, group: usize) -> bool {
        self.held[group]
    }

    /// Speeds or accelerations of all coordinates, those that follow made so.
    pub fn settle(&self, coordinates: &mut [f64]) {
        for (k, row) in &self.follow {
            coordinates[*k] = dot(row, coordinates);
        }
    }
}
