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
}

family! {
    /// Share of the load of a mesh on one tooth pair; 0 outside the path of contact.
    LoadSharing ("load_sharing"): ToothLoad => "share" ["-"];
    equal::Equal,
    stiffness::Stiffness,
    uniform::Uniform,
}

impl<D: crate::Real> ToothLoad<D> {
    /// Whether the place lies on the path of contact.
    ///
    /// # Example
    /// ```
    /// use willis::losses::load_sharing::ToothLoad;
    ///
    /// let place = ToothLoad { position: 1.6, contact_ratio: 1.5, overlap_ratio: 0.0 };
    /// assert!(!place.on_path());
    /// ```
    pub fn on_path(&self) -> bool {
        (0.0..=self.contact_ratio.re()).contains(&self.position.re())
    }
}

impl ToothLoad<f64> {
    /// In the double contact of a spur pair of contact ratio 1.5, for examples and tests.
    pub fn typical() -> Self {
        Self { position: 0.25, contact_ratio: 1.5, overlap_ratio: 0.0 }
    }
}
