//! Which wish keeps a result empty, and how far it must give.

use willis::exact::Rational;
use willis::work::Work;

use super::answer::Relaxation;
use super::document::Design;
use super::search::Progress;
use super::wish::{Objective, Ratio};

/// Doublings of a tolerance that are tried.
const MOST_DOUBLINGS: i32 = 12;

/// Searches changed designs, all of them together within the patience of the work.
struct Asker<'w> {
    work: &'w dyn Work,
    /// Seconds that are left, by the estimates of the searches.
    left: f64,
}

impl Asker<'_> {
    /// Whether the search of a design may be begun.
    fn may(&mut self, design: &Design) -> bool {
        let Ok(effort) = design.effort() else { return false };
        let may = effort.seconds <= self.left && !self.work.cancelled();
        self.left -= if may { effort.seconds } else { 0.0 };
        may
    }

    /// How many trains a changed design has, and the best value of an objective among them; none where there are none or
    /// the search was not finished.
    fn best(&mut self, design: &Design, objective: Objective) -> Option<(u64, f64)> {
        if !self.may(design) {
            return None;
        }
        let mut asking = design.clone();
        asking.objectives = vec![objective];
        let progress = asking.search(Progress::default(), None, self.work).ok()?;
        if !progress.is_complete() {
            return None;
        }
        let trains = progress.waterfall.last()?.trains;
        let teeth = progress.front.first()?;
        let judged = asking.judge(teeth, asking.needs())?;
        Some((trains, asking.value(objective, &judged, teeth)))
    }

    /// The ratio of a state nearest to the target of this number, where only the other targets are windows.
    fn nearest(&mut self, design: &Design, target: usize) -> Option<f64> {
        let mut open = design.clone();
        let (state, own) = &mut open.targets[target];
        let state = *state;
        let aim = own.ratio.clone();
        own.ratio = Ratio::any();
        if !self.may(&open) {
            return None;
        }
        let mut best: Option<(f64, f64)> = None;
        let whole = open.for_each_ratio(self.work, &mut |teeth| {
            let ratio = open.layout.states[state].ratio.at(&open.variables(teeth));
            let off = aim.deviation(ratio);
            if best.is_none_or(|b| off < b.0) {
                best = Some((off, ratio));
            }
        });
        best.filter(|_| whole).map(|b| b.1)
    }
}

/// Every wish whose dropping alone makes an empty result non-empty. Those that would take longer than the patience of the
/// work, and those that come after it was cancelled, are left out.
pub(crate) fn relaxations(design: &Design, work: &dyn Work) -> Vec<Relaxation> {
    let mut asker = Asker { work, left: work.patience() };
    let mut found = vec![];
    let plural = |n: u64| if n == 1 { "1 train satisfies".to_owned() } else { format!("{n} trains satisfy") };
    // Tolerances: all ratios together, wider and wider, until something is found.
    let mut wider = design.clone();
    for doubling in 1..=MOST_DOUBLINGS {
        if !widen(design, &mut wider, &Rational::from(1 << doubling)) {
            break;
        }
        if let Some((trains, error)) = asker.best(&wider, Objective::Error) {
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
        for k in (0..design.targets.len()).filter(|k| !design.targets[*k].1.ratio.is_any()) {
            let mut without = design.clone();
            let target = without.targets[k].1.clone();
            // Steps still need its state.
            without.targets[k].1.ratio = Ratio::any();
            if let Some((trains, _)) = asker.best(&without, Objective::Error) {
                let near = asker.nearest(design, k);
                let mut words = format!("without the ratio of state {}, {} the rest", target.state, plural(trains));
                if let Some(near) = near {
                    words += &format!("; the nearest one there is {near:.4}");
                }
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
    if !design.steps.is_empty() {
        let mut without = design.clone();
        without.steps.clear();
        if let Some((trains, _)) = asker.best(&without, Objective::Error) {
            let words = format!("without the steps, {} the wish", plural(trains));
            found.push(Relaxation { wish: "step".into(), now: None, needed: None, trains, words });
        }
    }
    for rule in &design.rules {
        let mut without = design.clone();
        without.rules.retain(|r| r != rule);
        for s in &mut without.sets {
            s.space.rules.retain(|r| r != rule);
        }
        if let Some((trains, _)) = asker.best(&without, Objective::Error) {
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
        if let Some((trains, needed)) = asker.best(&without, objective) {
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

/// Widens the windows of a design by a factor, of every target where that leaves out the ratio 0; the others keep what they
/// have. Whether any was widened.
fn widen(design: &Design, wider: &mut Design, factor: &Rational) -> bool {
    let mut some = false;
    for ((_, t), (_, wide)) in design.targets.iter().zip(&mut wider.targets) {
        let (aim, windows) = (&t.ratio.aim, &t.ratio.windows);
        if t.ratio.is_any() {
            continue;
        }
        let [low, high] = &windows[if aim.sign() >= 0 { windows.len() - 1 } else { 0 }];
        let half = &(high - low) / &Rational::from(2);
        let half = if half.is_zero() { &aim.abs() * &Rational::new(1, 1000) } else { half };
        let width = &half * factor;
        if width < aim.abs() {
            let widened = Ratio::within([aim - &width, aim + &width], windows.len() > 1);
            wide.ratio = Ratio { aim: aim.clone(), ..widened };
            some = true;
        }
    }
    some
}
