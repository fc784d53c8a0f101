//! The temperatures of a gearbox while it moves.
//!
//! What is lost is integrated along with the motion, source by source. Whenever a place would have warmed or cooled by a
//! step of [`STEP`] since the last time, what was lost since then is the heat that was made there, the thermal network is
//! integrated over that time, and the laws go on with the oil as warm as it is then. So heat and loss are the same number,
//! joule by joule, and the laws see an oil that is at most that step behind.
//!
//! ```text
//! C_i dT_i/dt = ΔE_i/Δt − Σ flow out of i        ΔE_i: lost at the place since the last time, J
//! ```

use std::convert::Infallible;
use std::sync::Arc;

use crate::heat::balance::Failed;
use crate::heat::network::{Unsolved, imbalance};
use crate::heat::{Run, warm_up};
use crate::train::MemberId;
use crate::train::heat::{Heat, HeatPart, OIL};

use super::report::MotionHeat;
use super::system::{Rubs, System};

/// By how much a place may have warmed or cooled until the network follows, K.
pub(super) const STEP: f64 = 0.05;

/// Part of a scenario after which the network follows for the first time.
const FIRST: f64 = 1e-4;

/// Error of a temperature that a step of the network leaves, over the rise.
const TOLERANCE: f64 = 1e-8;

/// The thermal network of a train in motion.
#[derive(Clone)]
pub(super) struct Warming {
    heat: Arc<Heat>,
    /// Of each energy that is lost, after those of the sources: the places where each half of it becomes heat.
    places: Arc<[Option<[usize; 2]>]>,
    /// Where the losses begin among the energies.
    first: usize,
    /// When the temperatures are known, s, and the losses then, J.
    since: f64,
    counted: Vec<f64>,
    temperatures: Vec<f64>,
    start: Vec<f64>,
    /// Heat that leaves each place at these temperatures if nothing is made there, W.
    leaving: Vec<f64>,
    /// Heat made at each place in the time before them, W, and how long that was, s.
    making: Vec<f64>,
    span: f64,
    made: f64,
    carried: f64,
    highest: f64,
    beyond: Option<f64>,
}

impl Warming {
    /// The network of a train whose oil stores heat.
    ///
    /// # Errors
    /// The network has no temperatures at the start.
    pub fn of(s: &System, start: f64) -> Result<Option<Self>, Unsolved> {
        let train = &s.train;
        let Some(heat) = train.heat().filter(|h| h.is_stored()) else { return Ok(None) };
        let oil = train.lubrication.as_ref().map_or(heat.start, |l| l.temperature);
        // Parts are as warm as they become in that oil with nothing made anywhere.
        let temperatures = heat.at(oil, &vec![0.0; heat.nodes.len()])?.temperatures;
        let places: Vec<_> = places(s, heat);
        Ok(Some(Self {
            counted: vec![0.0; places.len()],
            places: places.into(),
            first: s.accounts(),
            since: start,
            start: temperatures.clone(),
            leaving: imbalance(heat, &temperatures, &vec![0.0; heat.nodes.len()]),
            making: vec![0.0; heat.nodes.len()],
            // Nothing is known of the heat yet.
            span: FIRST * (s.scenario.end - start),
            temperatures,
            made: 0.0,
            carried: 0.0,
            highest: oil,
            beyond: (oil > heat.limit).then_some(start),
            heat: Arc::new(heat.clone()),
        }))
    }

    /// The places whose temperatures follow.
    pub fn places(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.heat.nodes.len()).filter(|k| self.heat.nodes[*k].fixed.is_none())
    }

    /// Temperature of the oil, K.
    pub fn oil(&self) -> f64 {
        self.temperatures[OIL]
    }

    /// Heat made at each place since the temperatures were known, J, by the energies at present.
    fn made_since(&self, energies: &[f64]) -> Vec<f64> {
        let mut made = vec![0.0; self.heat.nodes.len()];
        let lost = energies[self.first..].iter().zip(&self.counted).map(|(now, then)| now - then);
        for (lost, places) in lost.zip(&*self.places) {
            for place in places.iter().flatten() {
                made[*place] += 0.5 * lost;
            }
        }
        made
    }

    /// Until when no place warms or cools by more than a step, as far as the last heats tell; at most twice as far as they
    /// were looked at.
    pub fn horizon(&self) -> f64 {
        let storing = self.heat.nodes.iter().enumerate().filter(|(_, n)| n.capacity > 0.0);
        let times = storing.map(|(k, n)| STEP * n.capacity / (self.making[k] - self.leaving[k]).abs());
        self.since + times.fold(2.0 * self.span, f64::min)
    }

    /// Whether a place has warmed or cooled enough since the temperatures were known.
    pub fn is_due(&self, t: f64, energies: &[f64]) -> bool {
        let made = self.made_since(energies);
        let mut storing = self.heat.nodes.iter().enumerate().filter(|(_, n)| n.capacity > 0.0);
        storing.any(|(k, n)| (made[k] - self.leaving[k] * (t - self.since)).abs() >= 0.5 * STEP * n.capacity)
            || t >= self.since + self.span
    }

    /// The network over a time from when its temperatures were known, s, with the heats made at each place, W.
    fn run(&self, span: f64, making: &[f64]) -> Result<Run, Failed<Infallible>> {
        warm_up(&self.heat, &|_: f64| Ok(making.to_vec()), &self.temperatures, &[0.0, span], TOLERANCE)
    }

    /// Mean heat made at each place since the temperatures were known, W.
    fn making(&self, t: f64, energies: &[f64]) -> Vec<f64> {
        self.made_since(energies).iter().map(|e| e / (t - self.since)).collect()
    }

    /// The temperatures at a state, K; NaN where the network has none.
    pub fn at(&self, t: f64, energies: &[f64]) -> Vec<f64> {
        if t <= self.since {
            return self.temperatures.clone();
        }
        let run = self.run(t - self.since, &self.making(t, energies));
        run.map_or_else(|_| vec![f64::NAN; self.temperatures.len()], |run| run.end)
    }

    /// Goes on to a time.
    ///
    /// # Errors
    /// The network has no temperatures; nothing has changed then.
    pub fn follow(&mut self, t: f64, energies: &[f64]) -> Result<(), Failed<Infallible>> {
        if t <= self.since {
            return Ok(());
        }
        let (span, making) = (t - self.since, self.making(t, energies));
        let run = self.run(span, &making)?;
        if self.beyond.is_none() && run.oil_range[1] > self.heat.limit {
            self.beyond = Some(self.since + self.passes_limit(span, &making));
        }
        self.made += run.made;
        self.carried += run.carried;
        self.highest = self.highest.max(run.oil_range[1]);
        self.temperatures = run.end;
        self.leaving = imbalance(&self.heat, &self.temperatures, &vec![0.0; self.heat.nodes.len()]);
        (self.making, self.span) = (making, span);
        self.counted.copy_from_slice(&energies[self.first..]);
        self.since = t;
        Ok(())
    }

    /// How far into a span the oil passes its limit, s.
    fn passes_limit(&self, span: f64, making: &[f64]) -> f64 {
        let (mut below, mut above) = (0.0, span);
        while above - below > 1e-6 * span {
            let middle = 0.5 * (below + above);
            match self.run(middle, making).is_ok_and(|run| run.oil_range[1] <= self.heat.limit) {
                true => below = middle,
                false => above = middle,
            }
        }
        above
    }

    /// Everything that changes in a run, as numbers.
    pub fn saved(&self) -> Vec<f64> {
        let times = [self.since, self.span, self.made, self.carried, self.highest, self.beyond.unwrap_or(f64::NAN)];
        let lists = [&self.counted, &self.temperatures, &self.start, &self.leaving, &self.making];
        times.into_iter().chain(lists.into_iter().flatten().copied()).collect()
    }

    /// Goes back to what was saved. False where these are not as many numbers; nothing has changed then.
    pub fn restore(&mut self, numbers: &[f64]) -> bool {
        if numbers.len() != self.saved().len() {
            return false;
        }
        let mut all = numbers.iter().copied();
        let mut next = || all.next().expect("as many");
        [self.since, self.span, self.made, self.carried, self.highest] = [next(), next(), next(), next(), next()];
        self.beyond = Some(next()).filter(|t| !t.is_nan());
        let lists = [&mut self.counted, &mut self.temperatures, &mut self.start, &mut self.leaving, &mut self.making];
        lists.into_iter().flatten().for_each(|x| *x = next());
        true
    }

    /// What there is to say at a time; none where the network has no temperatures there.
    pub fn report(&self, t: f64, energies: &[f64]) -> Option<MotionHeat> {
        let mut end = self.clone();
        end.follow(t, energies).ok()?;
        let heat = &self.heat;
        let named = |t: &[f64]| heat.nodes.iter().zip(t).map(|(n, t)| (n.name.clone(), *t)).collect();
        let storing = heat.nodes.iter().enumerate().filter(|(_, n)| n.capacity > 0.0);
        let stored: f64 = storing.map(|(k, n)| n.capacity * (end.temperatures[k] - end.start[k])).sum();
        let size = end.made.abs().max(end.carried.abs()).max(stored.abs());
        let elsewhere = energies[self.first..].iter().zip(&*self.places).filter(|(_, places)| places.is_none());
        Some(MotionHeat {
            start_k: named(&end.start),
            end_k: named(&end.temperatures),
            highest_oil_k: end.highest,
            limit_k: heat.limit,
            beyond_limit_s: end.beyond,
            made_j: end.made,
            carried_j: end.carried,
            stored_j: stored,
            elsewhere_j: elsewhere.map(|(e, _)| e).sum(),
            residual: if size > 0.0 { (end.made - end.carried - stored) / size } else { 0.0 },
        })
    }
}

/// Where each loss becomes heat, in the order of the energies. What no place names is made in the oil, half of tooth
/// friction at each gear; what is lost outside the gearbox warms nothing.
fn places(s: &System, heat: &Heat) -> Vec<Option<[usize; 2]>> {
    let train = &s.train;
    let both = |place: usize| Some([place; 2]);
    let within = |members: [MemberId; 2]| members.iter().all(|m| train.is_within(*m)).then_some([OIL; 2]);
    let variator = |k: usize| heat.place(HeatPart::Variator(k)).and_then(both);
    let frictions = s.frictions.iter().map(|f| match f.what {
        Rubs::Law(place) => {
            let part = s.laws.as_ref().and_then(|laws| laws.places[place].heat_part());
            both(part.and_then(|p| heat.place(p)).unwrap_or(OIL))
        }
        Rubs::Shift(_) => both(OIL),
        Rubs::Rolling(_) => None,
        Rubs::Variator(path) => variator(s.paths[path].variator),
        Rubs::Drag(_) | Rubs::Trace => within(f.members),
    });
    let shafts = train.shafts().iter().map(|shaft| within(shaft.members));
    let meshes = train.meshes().iter().map(|m| mesh(heat, m.gears.each_ref().map(|g| g.member)));
    let paths = s.paths.iter().map(|p| variator(p.variator));
    frictions.chain(shafts).chain(meshes).chain(paths).collect()
}

fn mesh(heat: &Heat, gears: [MemberId; 2]) -> Option<[usize; 2]> {
    Some(gears.map(|g| heat.place(HeatPart::Member(g)).unwrap_or(OIL)))
}
