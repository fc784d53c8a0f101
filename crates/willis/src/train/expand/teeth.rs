//! The teeth of a set, where its geometry is given.

use crate::diagnostic::{Code, Diagnostic};
use crate::train::Teeth;
use crate::train::specification::Hand;
use crate::train::words::clip;

use super::expansion::Expansion;
use super::pairs::Pair;

/// How far two centre distances of one set may differ, in modules: the last digit of printed shifts.
const CONCENTRIC: f64 = 5e-3;

/// The teeth of each mesh of the set, where its geometry is given, on one centre distance.
pub(super) fn teeth(e: &mut Expansion<'_, '_>, pairs: &[Pair<'_>]) -> Vec<Option<Teeth>> {
    let mut all = Vec::with_capacity(pairs.len());
    let has_sun = pairs.iter().any(|p| p.central.is_some_and(|c| !c.internal));
    for p in pairs {
        let own = p.central.and_then(|c| c.geometry.as_ref());
        let geometry = own.or(e.set.geometry.as_ref());
        let gears = [&p.gears[0], &p.gears[1]].map(|g| (g.teeth.to_f64(), g.internal, &g.tooth));
        let title = format!("{}.{}", e.set.name, p.name);
        if geometry.is_some_and(|g| g.offset.is_some()) && p.bevel {
            let message =
                format!("set `{}`: an offset, but the axes of its planets meet that of the set", clip(&e.set.name));
            let d = Diagnostic::new(Code::Conflict, format!("{}.geometry.offset", e.place), message);
            e.a.report(d.hint("hypoid gears are pairs: write a [[mesh]] with `kind = \"bevel\"`"));
        }
        let teeth = geometry.and_then(|g| e.a.tooth_pair(g, gears, p.bevel, &title, &e.place));
        // What a set says holds for its suns, what a gear says for itself. A sun stands first in its pair; a ring
        // stands second, and the planet that stands first has its hand.
        let named = p.central.is_some_and(|c| own.is_some() || c.internal != has_sun);
        let hand = geometry.and_then(|g| g.hand).filter(|_| named).map_or(0.0, Hand::sign);
        all.push(teeth.map(|t| Teeth { hand, ..t }));
    }
    concentric(e, pairs, &all);
    all
}

/// Every central gear meshes with planets whose axes run on one circle.
fn concentric(e: &mut Expansion<'_, '_>, pairs: &[Pair<'_>], teeth: &[Option<Teeth>]) {
    let central: Vec<(&Pair<'_>, &Teeth)> = pairs
        .iter()
        .zip(teeth)
        .filter(|(p, _)| p.central.is_some() && !p.bevel)
        .filter_map(|(p, t)| Some((p, t.as_ref()?)))
        .collect();
    for (k, (p, t)) in central.iter().enumerate() {
        // In a set with two kinds of planets the circles differ.
        for (q, u) in central.iter().take(k).filter(|(q, _)| p.planet_member() == q.planet_member()) {
            let (here, there) = (t.pair.centre_distance, u.pair.centre_distance);
            if (here - there).abs() > CONCENTRIC * t.pair.data.module {
                let message = format!(
                    "set `{}`: the planets' axes lie on one circle, but {} needs a centre distance of {:.4} mm and {} \
                     of {:.4} mm",
                    clip(&e.set.name),
                    q.name,
                    there * 1e3,
                    p.name,
                    here * 1e3
                );
                e.a.report(
                    Diagnostic::new(Code::ImpossibleGeometry, format!("{}.geometry", e.place), message).hint(
                        "give `centre_distance` (profile shift or backlash make up the rest), or shifts that agree",
                    ),
                );
            }
        }
    }
}
