//! Which member is a planet of which carrier, and the order in which members are met.

use willis::train::{FRAME, MemberId, MemberKind, Train};

/// A member by its place in [`Members::order`]; `None` is the frame.
pub(super) type Net = Option<usize>;

pub(super) struct Members {
    /// Every rotor in the order in which gears, then joints, then terminals name it: the picture
    /// does not depend on the order of names.
    pub order: Vec<MemberId>,
    number: Vec<Net>,
    /// For a planet, its carrier.
    carrier: Vec<Option<MemberId>>,
    /// A planet that something beside its own meshes needs: a line leads to it.
    led_out: Vec<bool>,
}

impl Members {
    pub fn new(train: &Train) -> Self {
        let count = train.members().len();
        let mut order = Vec::with_capacity(count);
        let meshes = train.meshes().iter().flat_map(|m| [m.gears[0].member, m.gears[1].member, m.carrier]);
        let joined = train.shift_elements().iter().flat_map(|e| e.members);
        let shafts = train.shafts().iter().flat_map(|s| s.members);
        let rest = (0..count).map(|k| train.member(&train.members()[k].name).unwrap_or(FRAME));
        let mut seen = vec![false; count];
        seen[FRAME.index()] = true;
        for m in meshes.chain(joined).chain(shafts).chain(train.terminals().iter().copied()).chain(rest) {
            if !std::mem::replace(&mut seen[m.index()], true) {
                order.push(m);
            }
        }
        let mut number = vec![None; count];
        order.iter().enumerate().for_each(|(k, m)| number[m.index()] = Some(k));

        let mut outer = vec![false; count];
        let touched = train.shift_elements().iter().flat_map(|e| e.members);
        let touched = touched.chain(train.shafts().iter().flat_map(|s| s.members));
        touched.chain(train.terminals().iter().copied()).for_each(|m| outer[m.index()] = true);
        let mut carries = vec![false; count];
        train.meshes().iter().for_each(|m| carries[m.carrier.index()] = true);
        let carrier = carriers(train, &outer, &carries);
        let led_out = (0..count)
            .map(|k| {
                let elsewhere = train
                    .meshes()
                    .iter()
                    .any(|m| m.gears.iter().any(|g| g.member.index() == k) && Some(m.carrier) != carrier[k]);
                carrier[k].is_some() && (outer[k] || carries[k] || elsewhere)
            })
            .collect();
        Self { order, number, carrier, led_out }
    }

    pub fn net(&self, member: MemberId) -> Net {
        self.number[member.index()]
    }

    pub fn is_planet_of(&self, member: MemberId, carrier: MemberId) -> bool {
        self.carrier[member.index()] == Some(carrier)
    }

    pub fn is_planet(&self, member: MemberId) -> bool {
        self.carrier[member.index()].is_some()
    }

    pub fn led_out(&self, member: MemberId) -> bool {
        self.led_out[member.index()]
    }
}

/// The carrier of each planet. A set says what its planets are; of a mesh written by hand, a planet
/// is what nothing else can be.
fn carriers(train: &Train, outer: &[bool], carries: &[bool]) -> Vec<Option<MemberId>> {
    let mut carrier: Vec<Option<MemberId>> = vec![None; train.members().len()];
    for m in train.meshes() {
        for g in &m.gears {
            if train.members()[g.member.index()].kind == MemberKind::Planet {
                carrier[g.member.index()].get_or_insert(m.carrier);
            }
        }
    }
    let free: Vec<_> = train.meshes().iter().filter(|m| m.carrier != FRAME && m.set.is_none()).collect();
    let in_set = |member: MemberId| {
        let mut of_sets = train.meshes().iter().filter(|m| m.set.is_some());
        of_sets.any(|m| m.gears.iter().any(|g| g.member == member))
    };
    let only_on = |member: MemberId, on: MemberId| {
        let mut own = train.meshes().iter().filter(|m| m.gears.iter().any(|g| g.member == member));
        own.all(|m| m.carrier == on)
    };
    for m in &free {
        for g in &m.gears {
            let k = g.member.index();
            if g.member != FRAME
                && !in_set(g.member)
                && !outer[k]
                && !carries[k]
                && !g.internal
                && only_on(g.member, m.carrier)
            {
                carrier[k].get_or_insert(m.carrier);
            }
        }
    }
    // One axis of every pair on a turning carrier moves with it.
    for m in &free {
        let [a, b] = &m.gears;
        if [a, b].iter().any(|g| carrier[g.member.index()] == Some(m.carrier)) {
            continue;
        }
        let fits = |g: &willis::train::Gear| g.member != FRAME && carrier[g.member.index()].is_none();
        let second = match (fits(a), fits(b)) {
            (false, _) => true,
            (_, false) => false,
            _ => a.internal || (!b.internal && (only_on(b.member, m.carrier) || !only_on(a.member, m.carrier))),
        };
        let planet = if second { b } else { a };
        if planet.member != FRAME {
            carrier[planet.member.index()] = Some(m.carrier);
        }
    }
    carrier
}
