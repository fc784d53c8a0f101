//! The elements that a layout can have, as points: which of them are the same, and where they lie.

use super::layout::{GROUND, INPUT, Layout, OUTPUT};
use super::motion::{MAX_MOBILITY, Motion, Teeth};
use willis::exact::residue;

/// Coordinates that differ by less may be equal; those that differ by more are not. The coordinates of a point are
/// correctly rounded quotients of integers between -1 and 1, so their error is 1e-16.
const NEAR: f64 = 1e-9;

/// Points that a layout can have: `C(F+1, 2) - 2` for the largest that is searched.
pub(crate) const MAX_POINTS: usize = 64;

/// The elements of a layout and their points.
#[derive(Clone, Debug, Default)]
pub(crate) struct Points {
    pub(crate) mobility: usize,
    /// The pairs of shafts of every element, point by point.
    pub(crate) elements: Vec<[u8; 2]>,
    /// Where the elements of each point begin in `elements`, and the end.
    pub(crate) starts: Vec<usize>,
    /// Coordinate `i` of each point; the largest coordinate of a point is 1.
    pub(crate) place: [Vec<f64>; MAX_MOBILITY],
    /// The vector of each point modulo a prime, not scaled.
    pub(crate) class: Vec<[u64; MAX_MOBILITY]>,
    /// Input and output: place, class.
    pub(crate) ends: [([f64; MAX_MOBILITY], [u64; MAX_MOBILITY]); 2],
    /// What the ratio of input to output speed has to be multiplied with, because the ends are scaled.
    pub(crate) scale: f64,
}

/// Whether an element may join two shafts: neither input nor output may be held.
pub(crate) fn may_join(x: u8, y: u8) -> bool {
    [x, y] != [INPUT, GROUND] && [x, y] != [OUTPUT, GROUND]
}

/// A vector with its largest coordinate made 1, and that coordinate; none for zero.
fn scaled(vector: &[i128]) -> Option<([f64; MAX_MOBILITY], i128)> {
    let mut largest = 0_i128;
    for x in vector {
        if x.unsigned_abs() > largest.unsigned_abs() {
            largest = *x;
        }
    }
    (largest != 0).then(|| {
        let mut place = [0.0; MAX_MOBILITY];
        for (p, x) in place.iter_mut().zip(vector) {
            *p = *x as f64 / largest as f64;
        }
        (place, largest)
    })
}

/// A vector modulo the prime.
pub(crate) fn direction(vector: &[i128]) -> [u64; MAX_MOBILITY] {
    let mut all = [0; MAX_MOBILITY];
    for (c, x) in all.iter_mut().zip(vector) {
        *c = residue::of(*x);
    }
    all
}

/// Whether two vectors have one direction: every 2 x 2 minor is zero.
fn parallel(a: &[u64; MAX_MOBILITY], b: &[u64; MAX_MOBILITY]) -> bool {
    let Some(at) = a.iter().position(|x| *x != 0) else { return false };
    (0..MAX_MOBILITY).all(|i| residue::times(a[at], b[i]) == residue::times(a[i], b[at]))
}

impl Points {
    /// Fills this with the elements of a layout that may join the shafts `may` allows. Returns whether the layout has
    /// independent equations and input and output can turn.
    pub(crate) fn fill(&mut self, layout: &Layout, teeth: &Teeth, may: impl Fn(u8, u8) -> bool) -> bool {
        let Some(motion) = Motion::of(layout, teeth) else { return false };
        self.fill_from(&motion, may)
    }

    /// The same from the motion.
    pub(crate) fn fill_from(&mut self, motion: &Motion, may: impl Fn(u8, u8) -> bool) -> bool {
        self.mobility = motion.mobility;
        self.elements.clear();
        self.starts.clear();
        self.class.clear();
        self.place.iter_mut().for_each(Vec::clear);
        // Elements in the order of their pairs; the point of each, or a new one.
        let mut found: [([u8; 2], u8); 2 * MAX_POINTS] = [([0; 2], 0); 2 * MAX_POINTS];
        let mut count = 0;
        let mut points = 0_usize;
        for x in 0..motion.shafts as u8 {
            for y in x + 1..motion.shafts as u8 {
                if !may(x, y) {
                    continue;
                }
                let vector = motion.element([x, y]);
                let Some((place, _)) = scaled(&vector[..self.mobility]) else { continue };
                let near = |q: usize| (0..self.mobility).all(|i| (self.place[i][q] - place[i]).abs() < NEAR);
                let class = std::cell::OnceCell::new();
                let at = (0..points)
                    .find(|q| near(*q) && parallel(&self.class[*q], class.get_or_init(|| direction(&vector))));
                let at = at.unwrap_or_else(|| {
                    self.class.push(class.into_inner().unwrap_or_else(|| direction(&vector)));
                    for (all, p) in self.place.iter_mut().zip(place).take(self.mobility) {
                        all.push(p);
                    }
                    points += 1;
                    points - 1
                });
                found[count] = ([x, y], at as u8);
                count += 1;
            }
        }
        // Point by point.
        self.starts.resize(points + 1, 0);
        for (_, at) in &found[..count] {
            self.starts[usize::from(*at) + 1] += 1;
        }
        for p in 0..points {
            self.starts[p + 1] += self.starts[p];
        }
        self.elements.resize(count, [0; 2]);
        let mut next = [0; 2 * MAX_POINTS];
        next[..points].copy_from_slice(&self.starts[..points]);
        for (pair, at) in &found[..count] {
            let to = &mut next[usize::from(*at)];
            self.elements[*to] = *pair;
            *to += 1;
        }
        let mut scales = [0; 2];
        for end in 0..2 {
            let vector = motion.shaft(end as u8);
            let Some((place, scale)) = scaled(vector) else { return false };
            self.ends[end] = (place, direction(vector));
            scales[end] = scale;
        }
        self.scale = scales[0] as f64 / scales[1] as f64;
        true
    }

    /// How many points there are.
    pub(crate) fn len(&self) -> usize {
        self.class.len()
    }

    /// The elements at a point.
    pub(crate) fn at(&self, point: usize) -> &[[u8; 2]] {
        &self.elements[self.starts[point]..self.starts[point + 1]]
    }

    /// How many choices of so many elements have no two at one point: an elementary symmetric polynomial.
    pub(crate) fn choices(&self, elements: usize) -> u64 {
        let mut ways = [0_u64; 16];
        ways[0] = 1;
        for point in 0..self.len() {
            let here = self.at(point).len() as u64;
            for n in (1..=elements.min(15)).rev() {
                ways[n] += ways[n - 1] * here;
            }
        }
        ways[elements.min(15)]
    }

    /// The determinant of an end and of points, modulo the prime.
    pub(crate) fn determinant(&self, end: usize, points: &[usize]) -> u64 {
        let mut rows = [[0_u64; MAX_MOBILITY]; MAX_MOBILITY];
        rows[0] = self.ends[end].1;
        for (row, p) in rows[1..].iter_mut().zip(points) {
            *row = self.class[*p];
        }
        // Forms of growing degree, by their sets of coordinates.
        let mut form = [0_u64; 1 << MAX_MOBILITY];
        form[0] = 1;
        for degree in 0..self.mobility {
            let mut next = [0_u64; 1 << MAX_MOBILITY];
            for set in (1_usize..1 << self.mobility).filter(|s| s.count_ones() as usize == degree + 1) {
                let mut sum = 0;
                for i in (0..self.mobility).filter(|i| set >> i & 1 == 1) {
                    let term = residue::times(form[set ^ 1 << i], rows[degree][i]);
                    let above = (set >> (i + 1)).count_ones();
                    sum = if above % 2 == 0 { residue::plus(sum, term) } else { residue::minus(sum, term) };
                }
                next[set] = sum;
            }
            form = next;
        }
        form[(1 << self.mobility) - 1]
    }
}
