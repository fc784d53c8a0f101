//! Efficiencies of schemes: their train files analysed by Willis.

use willis::diagnostic::Diagnostics;
use willis::exact::Rational;
use willis::work::{Effort, Work, map};
use willis::{Selection, Train, analyze};

use super::report::Schemes;
use super::scheme::{Scheme, SchemeGear};

/// Schemes that get their efficiencies where the work was stopped.
const AT_LEAST: usize = 10;

impl Scheme {
    /// Puts in the efficiency of every gear: that of the scheme's train file when the input drives. Says what Willis assumes
    /// for it, the mesh efficiencies.
    pub fn rate(&mut self) -> Vec<String> {
        let analysed = Train::from_toml(&self.to_toml()).and_then(|train| {
            let analysis = analyze(&train, &Selection::default())?;
            Ok((train.assumptions().to_vec(), analysis))
        });
        let first = |wrong: &Diagnostics| wrong.iter().next().map_or_else(String::new, |d| d.message.clone());
        for gear in self.gears.iter_mut().chain(&mut self.reverse) {
            let row = match &analysed {
                Err(wrong) => Err(first(wrong)),
                Ok((_, analysis)) => analysis.ratios.get(&gear.name).ok_or_else(|| "it is no state of the file".into()),
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
        analysed.map(|(assumptions, _)| assumptions).unwrap_or_default()
    }
}

fn shown(ratio: Option<&Rational>) -> String {
    ratio.map_or_else(|| "none".into(), ToString::to_string)
}

impl Schemes {
    /// How long it takes to put in the efficiencies of so many schemes.
    pub fn effort_of_rating(schemes: usize) -> Effort {
        Effort::new("schemes", schemes as u64, 1.5e-3)
    }

    /// Puts in the efficiencies of the schemes that are shown. Where the work is stopped, the first of them have theirs.
    pub fn rate(&mut self, work: &dyn Work) {
        let rated = |scheme: &Scheme| {
            let mut scheme = scheme.clone();
            let assumptions = scheme.rate();
            (scheme, assumptions)
        };
        work.begin("schemes", self.schemes.len() as u64);
        let done = map(work, self.schemes.len(), |k| {
            work.advance(1);
            rated(&self.schemes[k])
        });
        let done = done.unwrap_or_else(|_| self.schemes.iter().take(AT_LEAST).map(rated).collect());
        let mut assumed = vec![];
        for (own, (scheme, assumptions)) in self.schemes.iter_mut().zip(done) {
            *own = scheme;
            assumed = if assumed.is_empty() { assumptions } else { assumed };
        }
        if let Some(scheme) = self.rediscovered.as_mut().and_then(|r| r.scheme.as_mut()) {
            let assumptions = scheme.rate();
            assumed = if assumed.is_empty() { assumptions } else { assumed };
        }
        self.assumptions.extend(assumed);
    }
}
