//! A power split in one fused pass: one lossy element, two prescribed speeds on two of its three shafts, one torque.
//!
//! Where both speeds stay and the torque runs up or down, as along a row of a grid, every power has one sign over long
//! stretches. The signs at the ends of 64 points then hold between them: sums and products round monotonically. Such a
//! stretch needs no comparison; the numbers are the same to the last bit.

use crate::arch::Arch;

use super::duty::ShaftDrag;
use super::kernel::{General, LEAST_POWER};
use super::parts::CHUNK;

/// The numbers of the power split.
#[derive(Clone, Copy, Debug)]
pub(super) struct Single {
    /// Speed of the third shaft over those of the first two.
    third: [f64; 2],
    /// Relative speed of end p over the first two, with the sign of the force per loaded torque.
    drive: [f64; 2],
    /// Torques of the two open shafts per torque that reaches the set: p drives, q drives, at rest.
    gain: [[f64; 3]; 2],
    drag: [ShaftDrag; 3],
    /// Place (of the three shafts) of the loaded shaft.
    loaded: usize,
    /// Whether the open shafts are asked for in the other order than that of their places, in which they are kept.
    swapped: bool,
    /// Bits that are kept of an input that has not all digits.
    tiny: u64,
}

/// All bits but those of the size.
const SIGN: u64 = 1 << 63;
const EXPONENT: u64 = 0x7ff << 52;

/// Where the results of [`Single`] go.
#[derive(Default)]
pub(super) struct SingleOut<'o> {
    pub torque: [Option<&'o mut [f64]>; 2],
    pub loss: Option<&'o mut [f64]>,
    pub efficiency: Option<&'o mut [f64]>,
}

/// Results at one point.
struct SinglePoint {
    torque: [f64; 2],
    /// Of the loaded shaft and the open ones.
    power: [f64; 3],
    /// Positive where p drives.
    drive: f64,
    loss: f64,
    efficiency: f64,
    /// Whether nothing rests and every number has all its digits.
    usual: bool,
}

impl SinglePoint {
    /// 0 and 1 the torques, 2 the loss, 3 the efficiency.
    #[inline(always)]
    fn result<const WHAT: usize>(&self) -> f64 {
        match WHAT {
            0 => self.torque[0],
            1 => self.torque[1],
            2 => self.loss,
            _ => self.efficiency,
        }
    }
}

/// All points at two speeds.
#[derive(Clone, Copy, Debug)]
struct Row {
    /// Sign and size of the power that enters at end p, per torque that reaches the set.
    relative: f64,
    /// Speeds and drags of the loaded shaft and the open ones.
    speed: [f64; 3],
    drag: [f64; 3],
    /// As in [`Single`].
    gain: [[f64; 3]; 2],
}

impl Row {
    /// One point.
    #[inline(always)]
    fn point(&self, torque: f64) -> SinglePoint {
        let Self { relative, speed: [wl, wa, wb], drag: [dl, da, db], gain: [[ap, aq, ar], [bp, bq, br]] } = *self;
        let reaches = torque - dl;
        let drive = reaches * relative;
        let pick = |p: f64, q: f64, rest: f64| {
            let moving = if drive > 0.0 { p } else { q };
            if drive == 0.0 { rest } else { moving }
        };
        let ta = pick(ap, aq, ar) * reaches + da;
        let tb = pick(bp, bq, br) * reaches + db;
        let (pl, pa, pb) = (torque * wl, ta * wa, tb * wb);
        let pos = |p: f64| if p > 0.0 { p } else { 0.0 };
        let power_in = pos(pl) + pos(pa) + pos(pb);
        let loss = pl + pa + pb;
        // Powers beyond floating point have no efficiency: nothing times infinity is no number.
        let efficiency = if power_in >= LEAST_POWER { (power_in - loss) / power_in + loss * 0.0 } else { 0.0 };
        SinglePoint { torque: [ta, tb], power: [pl, pa, pb], drive, loss, efficiency, usual: false }
    }

    /// The signs at a point: which powers enter, and whether p drives. None of them is 0 by chance.
    #[inline(always)]
    fn signs(&self, torque: f64) -> u64 {
        /// Sums of three such powers are finite.
        const FINITE: f64 = 1e300;
        let SinglePoint { power: [l, a, b], drive, .. } = self.point(torque);
        let bit = |is: bool, bit: u64| if is { bit } else { 0 };
        let entering = bit(l > 0.0, ENTERS[0]) | bit(a > 0.0, ENTERS[1]) | bit(b > 0.0, ENTERS[2]);
        let driving = bit(drive > 0.0, FIRST_DRIVES) | bit(drive < 0.0, SECOND_DRIVES);
        let finite = l.abs() < FINITE && a.abs() < FINITE && b.abs() < FINITE;
        entering | driving | bit(!finite, UNSURE)
    }

    /// The signs at the ends of the stretches of a chunk.
    #[inline(always)]
    fn signs_of(&self, torque: &[f64]) -> [u64; ENDS] {
        let [first, last] = [torque.first(), torque.last()].map(|t| self.signs(t.copied().unwrap_or(0.0)));
        if first == last {
            return [first; ENDS];
        }
        let mut ends = [0.0; ENDS];
        ends.iter_mut().zip(torque.iter().step_by(STRETCH)).for_each(|(e, t)| *e = *t);
        ends[torque.len().div_ceil(STRETCH)] = torque.last().copied().unwrap_or(0.0);
        let row = *self;
        ends.map(|torque| row.signs(torque))
    }
}

/// Bits of [`Row::signs`]: powers that enter, the end that drives, and that a power is too large.
const ENTERS: [u64; 3] = [1, 2, 4];
const FIRST_DRIVES: u64 = 8;
const SECOND_DRIVES: u64 = 16;
const UNSURE: u64 = 32;

/// Points of one speed whose powers keep their signs.
#[derive(Clone, Copy, Debug)]
struct Stretch {
    speed: [f64; 3],
    drag: [f64; 3],
    gain: [f64; 2],
    /// All bits where the power enters, none elsewhere.
    enters: [u64; 3],
}

impl Stretch {
    fn new(row: &Row, signs: u64) -> Self {
        let driver = usize::from(signs & FIRST_DRIVES == 0);
        let enters = ENTERS.map(|bit| if signs & bit == 0 { 0 } else { u64::MAX });
        Self { speed: row.speed, drag: row.drag, gain: row.gain.map(|g| g[driver]), enters }
    }

    /// One point: the operations of [`Row::point`] without those whose result is known.
    #[inline(always)]
    fn point(&self, torque: f64) -> SinglePoint {
        let Self { speed: [wl, wa, wb], drag: [dl, da, db], gain: [a, b], enters: [l, m, n] } = *self;
        let reaches = torque - dl;
        let ta = a * reaches + da;
        let tb = b * reaches + db;
        let (pl, pa, pb) = (torque * wl, ta * wa, tb * wb);
        let pos = |p: f64, enters: u64| f64::from_bits(p.to_bits() & enters);
        let power_in = pos(pl, l) + pos(pa, m) + pos(pb, n);
        let loss = pl + pa + pb;
        let efficiency = if power_in >= LEAST_POWER { (power_in - loss) / power_in } else { 0.0 };
        SinglePoint { torque: [ta, tb], power: [pl, pa, pb], drive: 0.0, loss, efficiency, usual: true }
    }
}

/// The loaded shaft first, then the open ones in order.
#[inline(always)]
fn loaded_first<const LOADED: usize>([a, b, c]: [(f64, f64); 3]) -> ((f64, f64), (f64, f64), (f64, f64)) {
    match LOADED {
        0 => (a, b, c),
        1 => (b, a, c),
        _ => (c, a, b),
    }
}

impl Single {
    /// `divides`: an efficiency is asked for, for which inputs without all digits count as zero.
    pub fn new(g: &General, loaded: usize, open: [usize; 2], drag: [ShaftDrag; 3], divides: bool) -> Option<Self> {
        let p = g.parts();
        if p.columns.len() != 1 || g.moving() != 1 || !p.certified || p.torques != 1 || p.speeds != 2 {
            return None;
        }
        let element = &p.columns[0];
        // Terminals of the balance: the loaded one first, then the open ones.
        let mut rows = [[0.0; 2]; 3];
        for (t, place) in p.terminals.iter().zip([loaded, open[0], open[1]]) {
            rows[place] = [t.speed[0], t.speed[1]];
        }
        if rows[0] != [1.0, 0.0] || rows[1] != [0.0, 1.0] {
            return None;
        }
        let &[(_, constant, slope)] = &element.entries[..] else { return None };
        let force = |rho: f64| 1.0 / (constant + slope * rho);
        let rho = [element.rho[0], element.rho[1], 1.0];
        // Certified: the coefficient has one sign, so the sign of the force is that of the torque.
        let side = force(1.0).signum();
        let gain = [0, 1].map(|o| rho.map(|r| force(r) * (p.per_force[0][0][o] + r * p.per_force[0][1][o])));
        let swapped = open[0] > open[1];
        Some(Self {
            third: rows[2],
            drive: [element.relative[0] * side, element.relative[1] * side],
            gain: if swapped { [gain[1], gain[0]] } else { gain },
            drag,
            loaded,
            swapped,
            tiny: if divides { SIGN } else { u64::MAX },
        })
    }

    /// What two speeds say, whatever the torque. Scalars throughout: an array indexed in here would become a gather.
    #[inline(always)]
    fn at<const LOADED: usize>(&self, w0: f64, w1: f64) -> Row {
        let Self { third: [t0, t1], drive: [r0, r1], gain: [a, b], drag: [d0, d1, d2], .. } = *self;
        let w2 = t0 * w0 + t1 * w1;
        let drag = |d: ShaftDrag, w: f64| (if w == 0.0 { 0.0 } else { d.coulomb.copysign(w) }) + d.viscous * w;
        let (d0, d1, d2) = (drag(d0, w0), drag(d1, w1), drag(d2, w2));
        let ((wl, dl), (wa, da), (wb, db)) = loaded_first::<LOADED>([(w0, d0), (w1, d1), (w2, d2)]);
        Row { relative: r0 * w0 + r1 * w1, speed: [wl, wa, wb], drag: [dl, da, db], gain: [a, b] }
    }

    /// One point, right where it says that it is usual: the operations of [`Self::point`] without those that
    /// only zeros and numbers at the ends of floating point need.
    #[inline(always)]
    fn usual<const LOADED: usize>(&self, w0: f64, w1: f64, torque: f64) -> SinglePoint {
        let Self { third: [t0, t1], drive: [r0, r1], gain: [[ap, aq, _], [bp, bq, _]], drag: [d0, d1, d2], .. } = *self;
        let w2 = t0 * w0 + t1 * w1;
        let drag = |d: ShaftDrag, w: f64| d.coulomb.copysign(w) + d.viscous * w;
        let (d0, d1, d2) = (drag(d0, w0), drag(d1, w1), drag(d2, w2));
        let ((wl, dl), (wa, da), (wb, db)) = loaded_first::<LOADED>([(w0, d0), (w1, d1), (w2, d2)]);
        let reaches = torque - dl;
        let drive = reaches * (r0 * w0 + r1 * w1);
        let p_drives = drive > 0.0;
        let ta = (if p_drives { ap } else { aq }) * reaches + da;
        let tb = (if p_drives { bp } else { bq }) * reaches + db;
        let (pl, pa, pb) = (torque * wl, ta * wa, tb * wb);
        let pos = |p: f64| if p > 0.0 { p } else { 0.0 };
        let power_in = pos(pl) + pos(pa) + pos(pb);
        let loss = pl + pa + pb;
        let efficiency = (power_in - loss) / power_in;
        let has_all_digits = |x: f64| x.to_bits() & EXPONENT != 0;
        let inputs = has_all_digits(w0) & has_all_digits(w1) & has_all_digits(torque);
        let usual =
            inputs & (w2 != 0.0) & (drive != 0.0) & (power_in >= LEAST_POWER) & (efficiency.abs() < f64::INFINITY);
        SinglePoint { torque: [ta, tb], power: [pl, pa, pb], drive, loss, efficiency, usual }
    }

    /// One point.
    #[inline(always)]
    fn point<const LOADED: usize>(&self, w0: f64, w1: f64, torque: f64) -> SinglePoint {
        let whole = |x: f64| {
            let bits = x.to_bits();
            f64::from_bits(bits & if bits & EXPONENT == 0 { self.tiny } else { u64::MAX })
        };
        self.at::<LOADED>(whole(w0), whole(w1)).point(whole(torque))
    }

    pub fn run(&self, arch: Arch, w0: &[f64], w1: &[f64], torque: &[f64], mut out: SingleOut<'_>) {
        if self.swapped {
            out.torque.swap(0, 1);
        }
        match self.loaded {
            0 => self.go::<0>(arch, w0, w1, torque, out),
            1 => self.go::<1>(arch, w0, w1, torque, out),
            _ => self.go::<2>(arch, w0, w1, torque, out),
        }
    }

    fn go<const LOADED: usize>(&self, arch: Arch, w0: &[f64], w1: &[f64], torque: &[f64], out: SingleOut<'_>) {
        let SingleOut { torque: [first, second], loss, efficiency } = out;
        let set = self;
        match (first, second, loss, efficiency) {
            (Some(first), Some(second), Some(loss), Some(efficiency)) => {
                arch.dispatch(SingleAll::<LOADED> { set, w0, w1, torque, first, second, loss, efficiency });
            }
            (None, None, Some(loss), Some(efficiency)) => {
                arch.dispatch(SinglePowers::<LOADED> { set, w0, w1, torque, loss, efficiency });
            }
            (first, second, loss, efficiency) => {
                if let Some(out) = first {
                    arch.dispatch(SingleOne::<LOADED, 0> { set, w0, w1, torque, out });
                }
                if let Some(out) = second {
                    arch.dispatch(SingleOne::<LOADED, 1> { set, w0, w1, torque, out });
                }
                if let Some(out) = loss {
                    arch.dispatch(SingleOne::<LOADED, 2> { set, w0, w1, torque, out });
                }
                if let Some(out) = efficiency {
                    arch.dispatch(SingleEfficiency::<LOADED> { set, w0, w1, torque, out });
                }
            }
        }
    }

    /// Points at two speeds whose torques run up or down.
    pub fn run_row(&self, arch: Arch, speeds: [f64; 2], torque: &[f64], mut out: SingleOut<'_>) {
        if self.swapped {
            out.torque.swap(0, 1);
        }
        let [w0, w1] = speeds;
        let row = match self.loaded {
            0 => self.at::<0>(w0, w1),
            1 => self.at::<1>(w0, w1),
            _ => self.at::<2>(w0, w1),
        };
        let mut start = 0;
        while start < torque.len() {
            let len = CHUNK.min(torque.len() - start);
            let now = out.take(len);
            row.go(arch, &torque[start..start + len], now);
            start += len;
        }
    }
}

impl<'o> SingleOut<'o> {
    /// The first points, which are taken away.
    pub fn take(&mut self, len: usize) -> SingleOut<'o> {
        let head = |slice: &mut Option<&'o mut [f64]>| slice.as_mut()?.split_off_mut(..len);
        let [first, second] = &mut self.torque;
        let torque = [head(first), head(second)];
        SingleOut { torque, loss: head(&mut self.loss), efficiency: head(&mut self.efficiency) }
    }
}

impl Row {
    fn go(&self, arch: Arch, torque: &[f64], out: SingleOut<'_>) {
        let row = self;
        let SingleOut { torque: [first, second], loss, efficiency } = out;
        match (first, second, loss, efficiency) {
            (Some(first), Some(second), Some(loss), Some(efficiency)) => {
                arch.dispatch(RowAll { row, torque, first, second, loss, efficiency });
            }
            (None, None, Some(loss), Some(efficiency)) => {
                arch.dispatch(RowPowers { row, torque, loss, efficiency });
            }
            (first, second, loss, efficiency) => {
                if let Some(out) = first {
                    arch.dispatch(RowOne::<0> { row, torque, out });
                }
                if let Some(out) = second {
                    arch.dispatch(RowOne::<1> { row, torque, out });
                }
                if let Some(out) = loss {
                    arch.dispatch(RowOne::<2> { row, torque, out });
                }
                if let Some(out) = efficiency {
                    arch.dispatch(RowOne::<3> { row, torque, out });
                }
            }
        }
    }
}

/// Points of arrays that are computed again where one of them is not usual.
const BLOCK: usize = 128;
/// Points whose signs are those at their ends.
const STRETCH: usize = 64;
/// Most ends of a chunk, filled up to whole vectors.
const ENDS: usize = 16;

/// The stretches of a row: their ranges, and the signs if they are the same at both ends.
fn stretches(signs: &[u64; ENDS], len: usize) -> impl Iterator<Item = (std::ops::Range<usize>, Option<u64>)> + '_ {
    let mut at = 0;
    let last = len.div_ceil(STRETCH);
    std::iter::from_fn(move || {
        let from = at;
        let sure = |k: usize| {
            let known = signs[k] & (FIRST_DRIVES | SECOND_DRIVES) != 0 && signs[k] & UNSURE == 0;
            known && signs[k] == signs[k + 1]
        };
        if from >= last {
            return None;
        }
        at += 1;
        let is_sure = sure(from);
        while at < last && sure(at) == is_sure && (!is_sure || signs[at] == signs[from]) {
            at += 1;
        }
        Some((from * STRETCH..(at * STRETCH).min(len), is_sure.then_some(signs[from])))
    })
}

/// Computes points by [`Single::usual`], [`BLOCK`] at a time, and by [`Single::point`] those of a block that has another one.
macro_rules! usual_first {
    ($set:expr, [$w0:ident, $w1:ident, $torque:ident], [$($out:ident),+], |$i:ident, $p:ident| $store:block) => {
        let (set, n) = ($set, $torque.len());
        let ($w0, $w1) = (&$w0[..n], &$w1[..n]);
        $(let $out = &mut $out[..n];)+
        for start in (0..n).step_by(BLOCK) {
            let range = start..n.min(start + BLOCK);
            let n = range.len();
            let [$w0, $w1, $torque] = [$w0, $w1, $torque].map(|x| &x[range.clone()][..n]);
            $(let $out = &mut $out[range.clone()][..n];)+
            let mut usual = true;
            for $i in 0..n {
                let $p = set.usual::<LOADED>($w0[$i], $w1[$i], $torque[$i]);
                $store
                usual &= $p.usual;
            }
            for $i in if usual { 0..0 } else { 0..n } {
                let $p = set.point::<LOADED>($w0[$i], $w1[$i], $torque[$i]);
                $store
            }
        }
    };
}

lanes! {
    /// Loss and efficiency of a row.
    RowPowers<'a> {
        row: &'a Row, torque: &'a [f64], loss: &'a mut [f64], efficiency: &'a mut [f64],
    } -> () {
        let signs = row.signs_of(torque);
        for (range, signs) in stretches(&signs, torque.len()) {
            let torque = &torque[range.clone()];
            let n = torque.len();
            let (loss, efficiency) = (&mut loss[range.clone()][..n], &mut efficiency[range][..n]);
            match signs.map(|signs| Stretch::new(row, signs)) {
                Some(stretch) => {
                    for i in 0..n {
                        let p = stretch.point(torque[i]);
                        loss[i] = p.loss;
                        efficiency[i] = p.efficiency;
                    }
                }
                None => {
                    let row = *row;
                    for i in 0..n {
                        let p = row.point(torque[i]);
                        loss[i] = p.loss;
                        efficiency[i] = p.efficiency;
                    }
                }
            }
        }
    }
    /// All results of a row.
    RowAll<'a> {
        row: &'a Row, torque: &'a [f64],
        first: &'a mut [f64], second: &'a mut [f64], loss: &'a mut [f64], efficiency: &'a mut [f64],
    } -> () {
        let signs = row.signs_of(torque);
        for (range, signs) in stretches(&signs, torque.len()) {
            let torque = &torque[range.clone()];
            let n = torque.len();
            let (first, second) = (&mut first[range.clone()][..n], &mut second[range.clone()][..n]);
            let (loss, efficiency) = (&mut loss[range.clone()][..n], &mut efficiency[range][..n]);
            match signs.map(|signs| Stretch::new(row, signs)) {
                Some(stretch) => {
                    for i in 0..n {
                        let p = stretch.point(torque[i]);
                        first[i] = p.torque[0];
                        second[i] = p.torque[1];
                        loss[i] = p.loss;
                        efficiency[i] = p.efficiency;
                    }
                }
                None => {
                    let row = *row;
                    for i in 0..n {
                        let p = row.point(torque[i]);
                        first[i] = p.torque[0];
                        second[i] = p.torque[1];
                        loss[i] = p.loss;
                        efficiency[i] = p.efficiency;
                    }
                }
            }
        }
    }
    /// One result of a row: 0 and 1 the torques, 2 the loss, 3 the efficiency.
    RowOne<'a, const WHAT> {
        row: &'a Row, torque: &'a [f64], out: &'a mut [f64],
    } -> () {
        let signs = row.signs_of(torque);
        for (range, signs) in stretches(&signs, torque.len()) {
            let torque = &torque[range.clone()];
            let n = torque.len();
            let out = &mut out[range][..n];
            match signs.map(|signs| Stretch::new(row, signs)) {
                Some(stretch) => {
                    for i in 0..n {
                        out[i] = stretch.point(torque[i]).result::<WHAT>();
                    }
                }
                None => {
                    let row = *row;
                    for i in 0..n {
                        out[i] = row.point(torque[i]).result::<WHAT>();
                    }
                }
            }
        }
    }
    /// Loss and efficiency of a power split.
    SinglePowers<'a, const LOADED> {
        set: &'a Single, w0: &'a [f64], w1: &'a [f64], torque: &'a [f64], loss: &'a mut [f64], efficiency: &'a mut [f64],
    } -> () {
        usual_first!(*set, [w0, w1, torque], [loss, efficiency], |i, p| {
            loss[i] = p.loss;
            efficiency[i] = p.efficiency;
        });
    }
    /// All results of a power split.
    SingleAll<'a, const LOADED> {
        set: &'a Single, w0: &'a [f64], w1: &'a [f64], torque: &'a [f64],
        first: &'a mut [f64], second: &'a mut [f64], loss: &'a mut [f64], efficiency: &'a mut [f64],
    } -> () {
        usual_first!(*set, [w0, w1, torque], [first, second, loss, efficiency], |i, p| {
            first[i] = p.torque[0];
            second[i] = p.torque[1];
            loss[i] = p.loss;
            efficiency[i] = p.efficiency;
        });
    }
    /// Efficiency of a power split.
    SingleEfficiency<'a, const LOADED> {
        set: &'a Single, w0: &'a [f64], w1: &'a [f64], torque: &'a [f64], out: &'a mut [f64],
    } -> () {
        usual_first!(*set, [w0, w1, torque], [out], |i, p| {
            out[i] = p.efficiency;
        });
    }
    /// One result of a power split: 0 and 1 the torques, 2 the loss.
    SingleOne<'a, const LOADED, const WHAT> {
        set: &'a Single, w0: &'a [f64], w1: &'a [f64], torque: &'a [f64], out: &'a mut [f64],
    } -> () {
        let n = out.len();
        let (w0, w1, torque) = (&w0[..n], &w1[..n], &torque[..n]);
        let set = *set;
        for i in 0..n {
            out[i] = set.point::<LOADED>(w0[i], w1[i], torque[i]).result::<WHAT>();
        }
    }
}
