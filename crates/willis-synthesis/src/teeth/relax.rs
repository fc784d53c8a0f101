//! Which wish keeps a result empty, and how far it must give.

use willis::exact::Rational;
use willis::work::Serial;

use super::answer::Relaxation;
use super::document::Design;
use super::search::Progress;
use super::wish::{Objective, Ratio};

/// Doublings of a tolerance that are tried.
const MOST_DOUBLINGS: i32 = 12;

/// How many trains a changed design has, and the best value of an objective among them.
fn best(design: &Design, objective: Objective) -> Option<(u64, f64)> {
    let mut asking = design.clone();
    asking.objectives = vec![objective];
    let progress = asking.search(Progress::default(), None, &Serial).ok()?;
    let trains = progress.waterfall.last()?.trains;
    let teeth = progress.front.first()?;
    let judged = asking.judge(teeth, asking.needs())?;
    Some((trains, asking.value(objective, &judged, teeth)))
}

/// Every wish whose dropping alone makes an empty result non-empty.
pub(crate) fn relaxations(design: &Design) -> Vec<Relaxation> {
    let mut found = vec![];
    let plural = |n: u64| if n == 1 { "1 train satisfies".to_owned() } else { format!("{n} trains satisfy") };
    // Tolerances: all ratios together, wider and wider, until something is found.
    for doubling in 1..=MOST_DOUBLINGS {
        let mut wider = design.clone();
        let factor = Rational::from(1 << doubling);
        for (_, t) in &mut wider.targets {
            let aim = &t.ratio.aim;
            let [a, b] = [&t.ratio.windows[0], &t.ratio.windows[t.ratio.windows.len() - 1]].map(|w| w.clone());
            let own = if aim.sign() >= 0 { b } else { a };
            let half = &(&own[1] - &own[0]) / &Rational::from(2);
            let half = if half.is_zero() { &aim.abs() * &Rational::new(1, 1000) } else { half };
            let width = &half * &factor;
            if width >= aim.abs() {
                break;
            }
            let any_sign = t.ratio.windows.len() > 1;
            let widened = Ratio::within([aim - &width, aim + &width], any_sign);
            t.ratio = Ratio { aim: aim.clone(), ..widened };
        }
        if let Some((trains, error)) = best(&wider, Objective::Error) {
            let words = format!(
                "with every other wish the nearest ratios are off by {:.3} %; a tolerance of {:.3} % finds the first train",
                100.0 * error,
                100.0 * error * 1.000_001
            );
            found.push(Relaxation { wish: "tolerance".into(), now: None, needed: Some(error), trains, words });
            break;
        }
    }
    // One target after the other.
    if design.targets.len() > 1 {
        for k in 0..design.targets.len() {
            let mut without = design.clone();
            let (state, target) = without.targets.remove(k);
            if let Some((trains, _)) = best(&without, Objective::Error) {
                let mut nearest = design.clone();
                // Nothing excludes any ratio of this state.
                let wide = Rational::from(1_000_000);
                nearest.targets[k].1.ratio =
                    Ratio { aim: target.ratio.aim.clone(), windows: vec![[-wide.clone(), wide]] };
                let others = nearest.targets.clone();
                let near = best_ratio(&nearest, k, state);
                debug_assert_eq!(others.len(), design.targets.len());
                let words = format!(
                    "without the ratio of state {}, {} the rest; the nearest one there is {:.4}",
                    target.state,
                    plural(trains),
                    near.unwrap_or(f64::NAN)
                );
                found.push(Relaxation {
                    wish: format!("ratio of state {}", target.state),
                    now: Some(target.ratio.aim.to_f64()),
                    needed: near,
                    trains,
                    words,
                });
            }
        }
    }
    for rule in &design.rules {
        let mut without = design.clone();
        without.rules.retain(|r| r != rule);
        for s in &mut without.sets {
            s.space.rules.retain(|r| r != rule);
        }
        if let Some((trains, _)) = best(&without, Objective::Error) {
            let words = format!("without the rule `{rule}`, {} the wish", plural(trains));
            found.push(Relaxation { wish: rule.name().into(), now: None, needed: None, trains, words });
        }
    }
    type Limit = (&'static str, Objective, fn(&mut Design) -> &mut Option<f64>);
    let limits: [Limit; 7] = [
        ("ring_diameter", Objective::RingDiameter, |d| &mut d.limits.ring_diameter),
        ("planet_spin", Objective::PlanetSpin, |d| &mut d.limits.planet_spin),
        ("member_speed", Objective::MemberSpeed, |d| &mut d.limits.member_speed),
        ("element_torque", Objective::ElementTorque, |d| &mut d.limits.element_torque),
        ("forward", Objective::Forward, |d| &mut d.require.forward),
        ("backward", Objective::Backward, |d| &mut d.require.backward),
        ("lock_margin", Objective::LockMargin, |d| &mut d.require.lock_margin),
    ];
    for (name, objective, of) in limits {
        let mut without = design.clone();
        let Some(now) = of(&mut without).take() else { continue };
        if name == "ring_diameter" {
            for s in &mut without.sets {
                s.space.ring_limit = None;
            }
        }
        if let Some((trains, needed)) = best(&without, objective) {
            let (scale, unit) = if name == "ring_diameter" && design.metric { (1e3, " mm") } else { (1.0, "") };
            let verb = if objective.is_better_high() { "at most" } else { "at least" };
            let words = format!(
                "`{name}` is {}{unit}; the other wishes leave {verb} {:.4}{unit}, and {} them",
                now * scale,
                needed * scale,
                plural(trains)
            );
            found.push(Relaxation { wish: name.into(), now: Some(now), needed: Some(needed), trains, words });
        }
    }
    found
}

/// The ratio of a state nearest to its target, where only the other targets are windows.
fn best_ratio(design: &Design, target: usize, state: usize) -> Option<f64> {
    let mut asking = design.clone();
    // Only the deviation of this state counts.
    asking.objectives = vec![Objective::Error];
    for (k, (_, t)) in asking.targets.iter_mut().enumerate() {
        if k != target {
            // Every ratio in the window is as good: the deviation is measured at the target asked for alone.
            let windows = t.ratio.windows.clone();
            t.ratio = Ratio { aim: t.ratio.aim.clone(), windows };
        }
    }
    let mut best: Option<(f64, f64)> = None;
    let aim = asking.targets[target].1.ratio.clone();
    asking.for_each(|teeth| {
        let teeth: Vec<Vec<i64>> = teeth.iter().map(|t| t.to_vec()).collect();
        let ratio = asking.layout.states[state].ratio.at(&asking.variables(&teeth));
        let off = aim.deviation(ratio);
        if best.is_none_or(|b| off < b.0) {
            best = Some((off, ratio));
        }
    });
    best.map(|b| b.1)
}
