//! The mesh efficiencies that laws give at an operating point, for what has no load of its own.

use crate::exact::Rational;
use crate::train::{Efficiency, Operation, Train};

use super::{OperationReport, Verdict, at_its_temperature};

/// The efficiency of every mesh in the only equilibrium of an operation; `None` where there is none, or another. A mesh
/// with a given efficiency keeps it. Of the others the loss is one fraction whichever gear drives, of hypoid teeth one for
/// each, with what the bearings lose by the load of the mesh, and at most 99 % as nominal ones; to six decimals, so that
/// fractions made of it stay short.
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

/// The train with the mesh efficiencies that its laws give in the only equilibrium of an operation, as given ones; `None`
/// where there is no such equilibrium. Drags that are given as torques stay; what else is computed from the load is gone.
///
/// # Example
/// ```
/// use willis::train::{Operation, SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// let train = Train::builder("reducer")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .build()?;
/// let sun = train.member("s").unwrap();
/// let point = Operation::new("20 N m").speed(sun, AngularSpeed::rpm(1000.0)).load(sun, Torque::n_m(20.0));
/// let frozen = willis::analysis::frozen(&train, &point).unwrap();
/// assert_eq!(frozen.meshes()[0].efficiency, train.meshes()[0].efficiency);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn frozen(train: &Train, operation: &Operation) -> Option<Train> {
    let (all, _) = in_force(train, operation)?;
    let mut own = Train { drags: train.drags.clone(), ..train.without_laws() };
    own.meshes.iter_mut().zip(all).for_each(|(mesh, efficiency)| mesh.efficiency = efficiency);
    Some(own)
}

fn rounded(eta: &Rational) -> Rational {
    Rational::new((eta.to_f64().clamp(0.01, 1.0) * 1e6).round() as i64, 1_000_000)
}
