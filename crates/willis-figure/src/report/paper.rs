//! Where a figure of a report goes on paper, and how large: no text of it is ever smaller than 7 pt. A figure that would be too
//! wide for the text of a page has a page of its own, and a larger paper if need be.

/// Points to a millimetre.
pub const MM: f64 = 72.0 / 25.4;
/// The smallest size of a text, in points.
pub const SMALLEST: f64 = 7.0;
/// Points to a unit of a figure where there is room.
const USUAL: f64 = 0.66;
/// Between the text and the edges of a page, in all, as the style sheets have it: both sides, top and bottom.
const EDGES: [f64; 2] = [36.0 * MM, 31.0 * MM];
/// How far a figure may stand in both margins, in all.
const INTO_MARGINS: f64 = 16.0 * MM;
/// The same of a page for figures alone.
const PLATE_EDGES: [f64; 2] = [18.0 * MM, 31.0 * MM];
/// Room for a caption below a figure, and for a heading above it.
const CAPTION: f64 = 40.0;
const HEADING: f64 = 40.0;
/// How often a paper is doubled before a page gets the size of its figure: from A4 to A0.
const DOUBLED: usize = 4;

/// Where a figure goes. All lengths are in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// Into the text, so wide.
    Text(f64),
    /// On a page of this width and height, so wide.
    Page([f64; 2], f64),
}

/// A figure as far as its place goes, in units of the figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigureSize {
    /// Width and height.
    pub size: [f64; 2],
    /// The size of its smallest text; none where it has no text.
    pub smallest: Option<f64>,
}

impl FigureSize {
    /// Points to a unit at which the smallest text has its size.
    pub fn least(&self) -> f64 {
        self.smallest.map_or(0.0, |size| SMALLEST / size)
    }

    /// How wide it is set within a box; nothing if its text would be too small.
    fn within(&self, room: [f64; 2]) -> Option<f64> {
        let factor = USUAL.max(self.least()).min(room[0] / self.size[0]).min(room[1] / self.size[1]);
        // Round-off is not worth a page.
        (factor >= self.least() * (1.0 - 1e-9)).then_some(factor * self.size[0])
    }

    /// Where it goes in a report on paper of that width and height.
    pub fn place(&self, [width, height]: [f64; 2]) -> Place {
        let room = [width - EDGES[0], height - EDGES[1] - CAPTION];
        // Into the margins only as far as its text needs.
        if let Some(wide) = self.within(room).or_else(|| self.within([room[0] + INTO_MARGINS, room[1]])) {
            let least = self.least() * self.size[0];
            return Place::Text(if wide > room[0] { least } else { wide });
        }
        let [mut short, mut long] = [width, height];
        for _ in 0..=DOUBLED {
            for page in [[long, short], [short, long]] {
                let room = [page[0] - PLATE_EDGES[0], page[1] - PLATE_EDGES[1] - CAPTION - HEADING];
                if let Some(wide) = self.within(room) {
                    return Place::Page(page, wide);
                }
            }
            [short, long] = [long, 2.0 * short];
        }
        let own = [0, 1].map(|k| self.size[k] * self.least());
        Place::Page([own[0] + PLATE_EDGES[0] + 1.0, own[1] + PLATE_EDGES[1] + CAPTION + HEADING + 1.0], own[0])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const A4: [f64; 2] = [210.0 * MM, 297.0 * MM];
    const LETTER: [f64; 2] = [612.0, 792.0];

    #[test]
    fn no_text_is_smaller_than_seven_points_and_nothing_leaves_its_page() {
        for paper in [A4, LETTER] {
            let mut pages = vec![];
            for width in (100..12_000).step_by(130).map(f64::from) {
                for height in [100.0, 700.0, 1500.0, 9000.0] {
                    let own = FigureSize { size: [width, height], smallest: Some(11.0) };
                    let (wide, page, edges) = match own.place(paper) {
                        Place::Text(wide) => (wide, paper, [EDGES[0] - INTO_MARGINS, EDGES[1]]),
                        Place::Page(page, wide) => (wide, page, PLATE_EDGES),
                    };
                    let factor = wide / width;
                    assert!(factor * 11.0 >= SMALLEST - 1e-6, "{width} x {height}: {}", factor * 11.0);
                    let fits = wide <= page[0] - edges[0] + 1e-6 && factor * height <= page[1] - edges[1] + 1e-6;
                    assert!(fits, "{width} x {height} on {page:?}");
                    pages.push(page);
                }
            }
            pages.dedup();
            assert!(pages.len() > 5);
        }
    }

    #[test]
    fn what_fits_stands_in_the_text() {
        let place = |width: f64, smallest| FigureSize { size: [width, 600.0], smallest }.place(A4);
        assert!(matches!(place(770.0, Some(11.0)), Place::Text(w) if w <= 174.0 * MM + 1e-6));
        assert!(matches!(place(860.0, Some(11.0)), Place::Page([a, b], _) if a > b && a < 850.0));
        assert!(matches!(place(840.0, Some(11.0)), Place::Text(w) if w > 174.0 * MM && w < 190.0 * MM));
        assert!(matches!(place(860.0, Some(12.0)), Place::Text(_)));
        assert!(matches!(place(9000.0, None), Place::Text(_)));
    }
}
