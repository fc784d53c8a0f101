//! A compiled train as numbers, for programs in other languages: what they need to find the equilibrium of a point
//! themselves.

use crate::diagnostic::Diagnostics;
use crate::train::{MemberId, ShiftElementId, Train};

use super::{Column, CompileRequest, CompiledOutput, Compiler};

/// The equilibrium of a train for a [`CompileRequest`], as plain tables.
///
/// A point prescribes the speeds `n` of the request, its torques, and the torques between two members that were named:
/// the inputs `x`, torques first. Every element carries one force `f_j`, and `ρ_j` is `rho[0]` where its end p drives and
/// `rho[1]` where its other end does:
///
/// ```text
/// Σ_j (constant_rj + ρ_j slope_rj) f_j = Σ_i right_ir x_i        every row r
/// p drives where f_j Σ_k relative_jk n_k > 0
/// ```
///
/// An element without relative motion has `ρ = 1`. The powers of the pattern that was assumed must come out; where
/// [`certified`](Self::certified), exactly one pattern fits every load, and turning the first element that does not fit
/// leads to it from any start. Elsewhere all patterns are tried.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tables {
    /// Whether every load has exactly one solution.
    pub certified: bool,
    /// The elements; there are as many rows.
    pub elements: Vec<TableElement>,
    /// Right-hand side by input, then row.
    pub right: Vec<Vec<f64>>,
    /// Speeds of all members over those prescribed; `None` where they do not follow.
    pub speeds: Vec<Option<Vec<f64>>>,
    /// External torques on the terminals, in the order of [`Train::terminals`].
    pub terminals: Vec<TableOutput>,
    /// Torques that shift elements exert on their first member, in the order of [`Train::shift_elements`]; `None` where
    /// one is open.
    pub shift_elements: Vec<Option<TableOutput>>,
}

/// An element: meshes that share one power.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TableElement {
    /// Where end p drives, where the other end does.
    pub rho: [f64; 2],
    /// Relative speed of end p, with the sign of its coefficient, over the prescribed speeds.
    pub relative: Vec<f64>,
    /// Row, constant part, part times ρ.
    pub entries: Vec<(usize, f64, f64)>,
    /// Its power at end p is the force times the relative speed times this.
    pub arm: f64,
    /// Its meshes.
    pub meshes: Vec<TableMesh>,
}

/// What a mesh of an element loses.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct TableMesh {
    /// Its position in [`Train::meshes`].
    pub mesh: usize,
    /// Loss over the power at end p of the element: where p drives, where the other end does.
    pub share: [f64; 2],
}

/// Where a torque comes from.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum TableOutput {
    /// A prescribed torque, by its position.
    Input(usize),
    /// `Σ_i direct_i x_i + Σ_j f_j (at_zero_j + ρ_j slope_j)`.
    Linear {
        /// By input.
        direct: Vec<f64>,
        /// By element.
        at_zero: Vec<f64>,
        /// By element.
        slope: Vec<f64>,
    },
    /// It does not follow from statics.
    Unknown,
}

impl Train {
    /// The tables of a request without drag and without losses that depend on load. `between` names pairs of members
    /// between which further torques act: on the first, and against the second.
    ///
    /// # Errors
    /// What [`compile`](Self::compile) refuses.
    ///
    /// # Example
    /// ```
    /// use willis::compiled::{CompileRequest, TableOutput};
    /// use willis::train::{SetSpec, Train};
    ///
    /// let train = Train::builder("reducer")
    ///     .members(["sun", "carrier"])
    ///     .terminals(["sun", "carrier"])
    ///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").mesh_efficiency(0.99))
    ///     .build()?;
    /// let tables = train.tables(&CompileRequest::new(["sun"], ["sun"]), &[])?;
    /// let [e] = &tables.elements[..] else { panic!() };
    /// // A force of one in the only row: f = T/constant.
    /// let f = tables.right[0][0] * 10.0 / (e.entries[0].1 + e.rho[0] * e.entries[0].2);
    /// let TableOutput::Linear { at_zero, slope, .. } = &tables.terminals[1] else { panic!() };
    /// let carrier = f * (at_zero[0] + e.rho[0] * slope[0]);
    /// assert!((carrier + 10.0 * (1.0 + 0.9801 * 7.0 / 3.0)).abs() < 1e-12);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    pub fn tables(&self, duty: &CompileRequest, between: &[[MemberId; 2]]) -> Result<Tables, Diagnostics> {
        let mut own =
            CompileRequest { drag: vec![], losses: vec![], outputs: vec![], between: between.to_vec(), ..duty.clone() };
        let first = Compiler::new(self, &own)?;
        let name = |m: &MemberId| self.member_name(*m).to_owned();
        own.outputs = self.terminals().iter().map(|m| CompiledOutput::Torque(name(m))).collect();
        let closed: Vec<bool> =
            (0..self.shift_elements.len()).map(|k| first.c.engaged.contains(&ShiftElementId(k))).collect();
        let engaged = self.shift_elements.iter().zip(&closed).filter(|(_, closed)| **closed);
        own.outputs.extend(engaged.map(|(e, _)| CompiledOutput::ShiftElementTorque(e.name.clone())));
        let transfer = first.c.transfer(&first.speeds);
        let speeds = transfer.speeds.iter();
        let speeds = speeds.map(|row| Some(row.as_ref()?.iter().map(|x| x.to_f64()).collect())).collect();
        let compiled = self.compile(&own)?;
        let parts = compiled.general.parts();
        // Prescribed speeds are no inputs of statics: without drag nothing depends on them.
        let inputs: Vec<usize> =
            (0..parts.right.len()).filter(|i| !(parts.torques..parts.torques + parts.speeds).contains(i)).collect();
        let output = |column: &Column| match *column {
            Column::Input(i) => TableOutput::Input(i),
            Column::Linear(o) => {
                let direct: Vec<f64> = inputs.iter().map(|i| parts.direct[*i][o]).collect();
                let [at_zero, slope] = [0, 1].map(|k| parts.per_force.iter().map(|f| f[k][o]).collect::<Vec<_>>());
                let known = direct.iter().chain(&at_zero).chain(&slope).all(|x| x.is_finite());
                if known { TableOutput::Linear { direct, at_zero, slope } } else { TableOutput::Unknown }
            }
            _ => TableOutput::Unknown,
        };
        let mut outputs = compiled.outputs.iter().map(output);
        let terminals = outputs.by_ref().take(self.terminals.len()).collect();
        let shift_elements = closed.iter().map(|closed| if *closed { outputs.next() } else { None }).collect();
        let elements = parts.columns.iter().map(|e| TableElement {
            rho: e.rho,
            relative: e.relative.clone(),
            entries: e.entries.clone(),
            arm: e.arm,
            meshes: e.meshes.iter().map(|(mesh, share)| TableMesh { mesh: mesh.0, share: *share }).collect(),
        });
        Ok(Tables {
            certified: parts.certified,
            elements: elements.collect(),
            right: inputs.iter().map(|i| parts.right[*i].clone()).collect(),
            speeds,
            terminals,
            shift_elements,
        })
    }
}
