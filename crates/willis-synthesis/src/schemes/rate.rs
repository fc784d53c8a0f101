//! Efficiencies of schemes: their train files analysed by Willis.

use willis::diagnostic::Diagnostics;
use willis::exact::Rational;
use willis::work::{Work, map};
use willis::{Selection, Train, analyze};

use super::report::Schemes;
use super::scheme::{Scheme, SchemeGear};
use super::wish::decimal;

/// Schemes that get their efficiencies where the work was stopped.
const AT_LEAST: usize = 10;

impl Scheme {
    /// Puts in the efficiency of every gear: that of the scheme's train file when the input drives.
    pub fn rate(&mut self) {
        let analysed = Train::from_toml(&self.to_toml()).and_then(|train| analyze(&train, &Selection::default()));
        let first = |wrong: &Diagnostics| wrong.iter().next().map_or_else(String::new, |d| d.message.clone());
        for gear in self.gears.iter_mut().chain(&mut self.reverse) {
            let row = match &analysed {
                Err(wrong) => Err(first(wrong)),
                Ok(analysis) => analysis.ratios.get(&gear.name).ok_or_else(|| "it is no state of the file".into()),
            };
            let known = row.and_then(|row| match (row.exact == Some(gear.ratio.clone()), row.drive.efficiency) {
                (false, _) => Err(format!("the train file has the ratio {}", shown(row.exact.as_ref()))),
                (true, Some(efficiency)) => Ok(efficiency),
                (true, None) => {
                    let reason = row.drive.reason.as_ref().map_or_else(String::new, |why| format!(": {why}"));
                    Err(format!("{}{reason}", row.drive.verdict.words()))
                }
            });
            let SchemeGear { efficiency, no_efficiency, .. } = gear;
            (*efficiency, *no_efficiency) = match known {
                Ok(value) => (Some(value), None),
                Err(why) => (None, Some(why)),
            };
        }
    }
}

fn shown(ratio: Option<&Rational>) -> String {
    ratio.map_or_else(|| "none".into(), ToString::to_string)
}

impl Schemes {
    /// Puts in the efficiencies of the schemes that are shown, and says which of the meshes they are with. Where the work is
    /// stopped, the first of them have theirs.
    pub fn rate(&mut self, work: &dyn Work) {
        let rated = |scheme: &Scheme| {
            let mut scheme = scheme.clone();
            scheme.rate();
            scheme
        };
        work.begin("schemes", self.schemes.len() as u64);
        let done = map(work, self.schemes.len(), |k| {
            work.advance(1);
            rated(&self.schemes[k])
        });
        let done = done.unwrap_or_else(|_| self.schemes.iter().take(AT_LEAST).map(rated).collect());
        for (own, scheme) in self.schemes.iter_mut().zip(done) {
            *own = scheme;
        }
        let known = self.rediscovered.as_mut().and_then(|r| r.scheme.as_mut());
        if known.map(Scheme::rate).is_some() || !self.schemes.is_empty() {
            let [external, internal] = self.wish.mesh_efficiencies.each_ref().map(decimal);
            self.assumptions.push(format!(
                "efficiencies are those of {external} of sun and planet and {internal} of planet and ring in every set: \
                 tooth friction alone, without bearings, oil and open elements"
            ));
        }
    }
}
