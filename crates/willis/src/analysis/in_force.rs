//! The mesh efficiencies that laws give at an operating point, for what has no load of its own.

use crate::exact::Rational;
use crate::train::{Efficiency, Operation, Train};

use super::{OperationReport, Verdict, at_its_temperature};

/// The efficiency of every mesh in the only equilibrium of an operation; `None` where there is none, or another. A mesh
/// with a given efficiency keeps it. Of the others the loss is one fraction whichever gear drives, of hypoid teeth one for each, with what the bearings
/// lose by the load of the mesh, and at most 99 % as nominal ones; to six decimals, so that fractions made of it stay short.
pub(crate) fn in_force(train: &Train, operation: &Operation) -> Option<(Vec<Efficiency>, OperationReport)> {
    let settled = at_its_temperature(train, operation, false).ok()?;
    let point = settled.point.filter(|_| settled.report.verdict == Verdict::Unique)?;
    let own = point.c.efficiencies.iter().zip(&train.meshes);
    let all = own.map(|(own, mesh)| match mesh.computed {
        true => Efficiency { forward: rounded(&own.forward), backward: rounded(&own.backward) },
        false => mesh.efficiency.clone(),
    });
    Some((all.collect(), settled.report))
}

fn rounded(eta: &Rational) -> Rational {
    Rational::new((eta.to_f64().clamp(0.01, 1.0) * 1e6).round() as i64, 1_000_000)
}
