//! Share of the load of a mesh that one tooth pair carries at one place of its path of contact.
//!
//! The share is that of the transverse section, averaged over the face width when the law couples
//! the sections of a helical gear. Along a whole path it adds up, in base pitches, to 1:
//! `∫ share dx = 1`, because the force of the mesh is always carried.

/// Place of a tooth pair on its path of contact.
#[derive(Clone, Copy, Debug)]
pub struct ToothLoad<D> {
    /// Distance from the start of the path A in base pitches, `x = (s − s_A)/p_bt`, 0 to ε_α.
    pub position: D,
    /// Transverse contact ratio `ε_α`.
    pub contact_ratio: D,
    /// Overlap ratio `ε_β` of one helix, 0 for spur gears.
    pub overlap_ratio: D,
    /// Tip relief of both gears.
    pub relief: Relief<D>,
}

/// Linear tip relief of both gears under a load, on the path of contact.
///
/// In both arrays the start A of the path comes first, where the tip of the second gear enters, then its end E, where
/// the tip of the first gear leaves.
///
/// # Formula
/// ```text
/// depth = c' C_a b/F_bt        length = l_Ca/p_bt
/// ```
/// with the amount `C_a` at the tip, the length `l_Ca` along the path of contact, and the stiffness `c'` of one tooth pair
/// for each width. A depth of 1 is what one pair gives way when it carries the whole load: ISO 6336-1:2006 judges relief
/// by the same ratio, `B_k = |1 − c' C_a b/F|`, equation (17).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Relief<D> {
    /// Amount at the end of the path, over the deflection of one tooth pair that carries the whole load.
    pub depth: [D; 2],
    /// Length along the path, in base pitches.
    pub length: [D; 2],
}

impl<D: crate::Real> Relief<D> {
    /// No relief.
    pub fn none() -> Self {
        Self { depth: [D::zero(); 2], length: [D::zero(); 2] }
    }

    /// Whether there is any.
    pub fn any(&self) -> bool {
        (0..2).any(|k| self.depth[k].re() > 0.0 && self.length[k].re() > 0.0)
    }

    /// The larger depth; 0 without relief.
    pub fn largest(&self) -> f64 {
        if self.any() { self.depth[0].re().max(self.depth[1].re()) } else { 0.0 }
    }

    /// How far the flanks stand apart at a place of the path when those without relief touch, in deflections of one tooth
    /// pair under the whole load.
    ///
    /// # Example
    /// By hand: relief of depth 1 over half a base pitch leaves 1 − 0.1/0.5 = 0.8 at 0.1 from A.
    /// ```
    /// use willis::losses::load_sharing::Relief;
    ///
    /// let relief = Relief { depth: [1.0, 0.0], length: [0.5, 0.0] };
    /// assert_eq!(relief.gap(0.1, 1.5), 0.8);
    /// assert_eq!(relief.gap(0.7, 1.5), 0.0);
    /// ```
    pub fn gap(&self, position: D, contact_ratio: D) -> D {
        let mut gap = D::zero();
        for (k, from_end) in [position, contact_ratio - position].into_iter().enumerate() {
            let length = self.length[k];
            if length.re() > 0.0 && from_end.re() < length.re() {
                gap += self.depth[k] * (-(from_end / length) + 1.0);
            }
        }
        gap
    }
}

impl<D: crate::Real> ToothLoad<D> {
    /// The share of a tooth pair of a spur gear whose tips may be relieved, when each pair is a spring of the given
    /// stiffness, 1 for the pair that `depth` of [`Relief`] counts with.
    ///
    /// All pairs in contact give way by as much, less their gap: `Σ_k c_k (δ − g_k) = 1` over those with `δ > g_k`. The sum
    /// is convex in δ and taken over all pairs first, so that Newton's method comes from above and ends after as many steps
    /// as there are pairs.
    fn relieved(&self, stiffness: impl Fn(&D) -> D) -> D {
        let (x, e_a) = (self.position, self.contact_ratio);
        if !self.on_path() {
            return D::zero();
        }
        let first = -x.re().floor();
        let pairs = ((x.re().floor() + (e_a.re() - x.re()).floor()) as usize + 1).min(1000);
        let mut deflection: Option<D> = None;
        for _ in 0..=pairs {
            let (mut load, mut spring) = (D::one(), D::zero());
            for k in 0..pairs {
                let place = x + (first + k as f64);
                let gap = self.relief.gap(place, e_a);
                if deflection.is_none_or(|d| gap.re() < d.re()) {
                    let c = stiffness(&place);
                    load += c * gap;
                    spring += c;
                }
            }
            let next = load / spring;
            if deflection.is_some_and(|d| d.re() <= next.re()) {
                break;
            }
            deflection = Some(next);
        }
        let own = deflection.unwrap_or(D::zero()) - self.relief.gap(x, e_a);
        if own.re() > 0.0 { own * stiffness(&x) } else { D::zero() }
    }
}

family! {
    /// Share of the load of a mesh on one tooth pair; 0 outside the path of contact.
    LoadSharing ("load_sharing"): ToothLoad => "share" ["-"];
    equal::Equal,
    stiffness::Stiffness,
    uniform::Uniform,
}

pub(crate) use equal::Slices;

impl<D: crate::Real> ToothLoad<D> {
    /// Whether the place lies on the path of contact.
    ///
    /// # Example
    /// ```
    /// use willis::losses::load_sharing::{Relief, ToothLoad};
    ///
    /// let place = ToothLoad { position: 1.6, contact_ratio: 1.5, overlap_ratio: 0.0, relief: Relief::none() };
    /// assert!(!place.on_path());
    /// ```
    pub fn on_path(&self) -> bool {
        (0.0..=self.contact_ratio.re()).contains(&self.position.re())
    }
}

impl ToothLoad<f64> {
    /// In the double contact of a spur pair of contact ratio 1.5, for examples and tests.
    pub fn typical() -> Self {
        Self { position: 0.25, contact_ratio: 1.5, overlap_ratio: 0.0, relief: Relief::none() }
    }
}
