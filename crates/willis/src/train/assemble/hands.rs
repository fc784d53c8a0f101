//! Which way helical teeth wind, and where gears and bearings stand along their axes, as far as it is not given.

use crate::diagnostic::{Code, Diagnostic};
use crate::train::assembler::Assembler;
use crate::train::physical::BearingMount;
use crate::train::words::clip;

/// Signs that depend on each other: each is that of its root, or the opposite.
struct Signs {
    parent: Vec<(usize, f64)>,
    /// Of roots: the sign, where it is known.
    known: Vec<Option<f64>>,
}

impl Signs {
    fn new(count: usize) -> Self {
        Self { parent: (0..count).map(|k| (k, 1.0)).collect(), known: vec![None; count] }
    }

    fn root(&self, mut k: usize) -> (usize, f64) {
        let mut sign = 1.0;
        while self.parent[k].0 != k {
            sign *= self.parent[k].1;
            k = self.parent[k].0;
        }
        (k, sign)
    }

    /// Sets one sign; whether it agrees with what is known.
    fn set(&mut self, k: usize, sign: f64) -> bool {
        let (root, of_root) = self.root(k);
        let wanted = sign * of_root;
        *self.known[root].get_or_insert(wanted) == wanted
    }

    /// Makes two signs the same (1) or opposite (-1); whether that agrees with what is known.
    fn join(&mut self, a: usize, b: usize, relation: f64) -> bool {
        let ((ra, sa), (rb, sb)) = (self.root(a), self.root(b));
        let relation = sa * sb * relation;
        if ra == rb {
            return relation == 1.0;
        }
        match (self.known[ra], self.known[rb]) {
            (Some(x), Some(y)) if x != y * relation => return false,
            (None, Some(y)) => self.known[ra] = Some(y * relation),
            _ => {}
        }
        self.parent[rb] = (ra, relation);
        true
    }
}

impl Assembler<'_> {
    /// The hand of every helical gear. What is given holds, mating gears follow, and where nothing is said all gears
    /// of a shaft have one hand: so that the thrusts of a driven gear and of a pinion beside it act against each other.
    pub fn hands(&mut self, bearings: bool) {
        let helical: Vec<usize> = (0..self.meshes.len())
            .filter(|j| {
                self.meshes[*j]
                    .teeth
                    .as_ref()
                    .is_some_and(|t| t.cones.is_none() && t.pair.data.helix != 0.0 && !t.pair.data.double_helical)
            })
            .collect();
        // One sign a mesh, that of its first gear.
        let mut signs = Signs::new(helical.len());
        // Of each gear: the place of its mesh in the list, and its hand when that of the first gear is right.
        let gears: Vec<(usize, usize, f64)> = (helical.iter().enumerate())
            .flat_map(|(place, j)| {
                let internal = self.meshes[*j].gears.iter().any(|g| g.internal);
                [(place, 0, 1.0), (place, 1, if internal { 1.0 } else { -1.0 })]
            })
            .collect();
        let pairs = || gears.iter().enumerate().flat_map(|(k, a)| gears[..k].iter().map(move |b| (*a, *b)));
        let gear = |(place, k, _): (usize, usize, f64)| &self.meshes[helical[place]].gears[k];
        let mut faults = Vec::new();
        for (a, b) in pairs() {
            let (x, y) = (gear(a), gear(b));
            let same_gear = x.member == y.member && x.teeth == y.teeth && x.internal == y.internal;
            if same_gear && x.member != crate::train::FRAME && !signs.join(a.0, b.0, a.2 * b.2) {
                faults.push(helical[a.0]);
            }
        }
        for (place, j) in helical.iter().enumerate() {
            let given = self.meshes[*j].teeth.as_ref().map_or(0.0, |t| t.hand);
            if given != 0.0 && !signs.set(place, given) {
                faults.push(*j);
            }
        }
        let mut assumed = false;
        for (a, b) in pairs() {
            let (x, y) = (gear(a), gear(b));
            if x.member == y.member && x.member != crate::train::FRAME && signs.root(a.0).0 != signs.root(b.0).0 {
                let both = [a.0, b.0].map(|k| signs.known[signs.root(k).0]);
                if signs.join(a.0, b.0, a.2 * b.2) {
                    assumed |= both.contains(&None);
                }
            }
        }
        for (place, j) in helical.iter().enumerate() {
            let (root, sign) = signs.root(place);
            let hand = sign * signs.known[root].unwrap_or(1.0);
            if let Some(teeth) = &mut self.meshes[*j].teeth {
                teeth.hand = hand;
            }
        }
        for j in faults {
            let message = format!("the teeth of {} would wind both ways", clip(&self.meshes[j].name));
            let place = match self.meshes[j].set {
                Some(set) => format!("set[{set}].geometry.hand"),
                None => format!("mesh[{j}].geometry.hand"),
            };
            let d = Diagnostic::new(Code::Conflict, place, message);
            self.report(d.hint("external gears in mesh have opposite hands, a ring has that of its planets: give one"));
        }
        if assumed && bearings {
            let name = self.meshes[helical[0]].name.clone();
            self.assume(&name, "hand of the helices not given, taken as the same on all gears of a shaft");
        }
    }

    /// Says where positions along the axes are known of some parts only.
    pub fn positions(&mut self, bearings: &[BearingMount]) {
        let gears: Vec<(String, bool)> =
            (self.meshes.iter()).filter_map(|m| Some((m.name.clone(), m.teeth.as_ref()?.position.is_some()))).collect();
        let any = gears.iter().any(|g| g.1) || bearings.iter().any(|b| b.position.is_some());
        if !any || bearings.is_empty() {
            return;
        }
        for (name, _) in gears.iter().filter(|g| !g.1) {
            self.assume(name, "position along the axis not given, taken as 0");
        }
        for b in bearings.iter().filter(|b| b.position.is_none()) {
            self.assume(&b.name, "position along the axis not given, taken as the middle of the gears of its shaft");
        }
    }
}
