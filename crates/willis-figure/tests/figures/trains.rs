//! Trains of which figures are made.

use willis::model::Model;
use willis::train::{OperationSpec, SetSpec, Train};
use willis::units::{AngularSpeed, Torque};

use crate::common::{Dice, example, folder};

/// An example with the files that it names.
pub fn model(name: &str) -> Model {
    let mut load = |file: &str| std::fs::read_to_string(folder().join(file)).map_err(|e| e.to_string());
    Model::read(&example(name), &mut load).unwrap_or_else(|wrong| panic!("{name}: {wrong}"))
}

/// Name and train of every example, with the files that it names.
pub fn examples() -> Vec<(String, Train)> {
    let all = crate::common::examples().into_iter().map(|(name, _)| name);
    all.map(|name| (name.clone(), model(&name).train().clone())).collect()
}

/// Up to four stepped sets on a few shafts under one load, the same for the same seed; many of them recirculate. None
/// where chance puts together what is no train.
pub fn stepped(seed: u64) -> Option<Train> {
    let mut dice = Dice(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(1));
    let k = 1 + dice.below(4) as usize;
    let all: Vec<String> = (0..k + 2).map(|m| format!("shaft {m}")).collect();
    let mut b = Train::builder("random").members(all.iter().map(String::as_str)).terminals([&*all[0], &*all[1]]);
    for j in 0..k {
        let mut own: Vec<usize> = (0..k + 2).collect();
        let [x, y, c] = [0; 3].map(|_| own.remove(dice.below(own.len() as u64) as usize));
        let [zx, zy, p, q] = [90, 90, 60, 60].map(|high| dice.whole(12, high - 1));
        let set = SetSpec::stepped(format!("P{j}"), &all[c]).sun(&all[x], zx, p);
        let set = if dice.below(2) == 0 { set.ring(&all[y], zy + q, q) } else { set.sun(&all[y], zy, q) };
        b = b.set(set.mesh_efficiency(0.9 + dice.below(100) as f64 / 1000.0));
    }
    let load = OperationSpec::new("load").speed(&all[0], AngularSpeed::rpm(1000.0)).torque(&all[0], Torque::n_m(100.0));
    b.operation(load.fixed(&all[k + 1])).build().ok()
}
