//! What can be read on pages: how small the smallest text is, that of figures included.

use typst::layout::{Frame, FrameItem};
use typst::visualize::ImageKind;
use typst_layout::PagedDocument;

use crate::pictures::Picture;

/// What was measured on pages that are set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// How many pages there are.
    pub pages: usize,
    /// The size of the smallest text, in points; infinite where there is none.
    pub smallest: f64,
}

impl Measured {
    /// Measures pages.
    pub fn of(document: &PagedDocument) -> Self {
        let pages = document.pages();
        let smallest = pages.iter().map(|page| smallest(&page.frame, 1.0)).fold(f64::INFINITY, f64::min);
        Self { pages: pages.len(), smallest }
    }
}

/// The smallest text of a frame that is magnified so much.
fn smallest(frame: &Frame, scale: f64) -> f64 {
    let one = |item: &FrameItem| match item {
        FrameItem::Group(group) => smallest(&group.frame, scale * group.transform.sx.get()),
        FrameItem::Text(text) if !text.text.trim().is_empty() => scale * text.size.to_pt(),
        FrameItem::Image(image, size, _) => match image.kind() {
            ImageKind::Svg(svg) => {
                let words = std::str::from_utf8(svg.data()).map_err(|e| e.to_string());
                let own = words.and_then(Picture::of).ok().and_then(|p| Some(p.extent.smallest? / p.extent.size[0]));
                own.map_or(f64::INFINITY, |part| scale * part * size.x.to_pt())
            }
            _ => f64::INFINITY,
        },
        _ => f64::INFINITY,
    };
    frame.items().map(|(_, item)| one(item)).fold(f64::INFINITY, f64::min)
}
