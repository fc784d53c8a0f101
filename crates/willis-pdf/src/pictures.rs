//! Figures as they come: their size, their smallest text, their words.

use roxmltree::Node;

use crate::paper::FigureSize;

/// A figure before it is set.
pub struct Picture {
    /// Its size, and that of its smallest text.
    pub extent: FigureSize,
    /// What it shows, in its own words.
    pub alternative: String,
}

impl Picture {
    /// Reads a figure.
    ///
    /// # Errors
    /// What is no SVG, or has no size.
    pub fn of(svg: &str) -> Result<Self, String> {
        let xml = roxmltree::Document::parse(svg).map_err(|e| e.to_string())?;
        let root = xml.root_element();
        let number = |name: &str| root.attribute(name).and_then(|v| v.trim_end_matches("px").parse::<f64>().ok());
        let size = ["width", "height"].map(|name| number(name).filter(|x| x.is_finite() && *x > 0.0));
        let [Some(width), Some(height)] = size else { return Err("it has no width and height".to_owned()) };
        let sizes = xml.descendants().filter(|n| n.is_text() && within_text(*n)).filter_map(font_size);
        let extent = FigureSize { size: [width, height], smallest: sizes.reduce(f64::min) };
        let says = |name: &str| root.children().find(|n| n.tag_name().name() == name).and_then(|n| n.text());
        let words: Vec<&str> = ["title", "desc"].into_iter().filter_map(says).map(str::trim).collect();
        Ok(Self { extent, alternative: words.join(". ") })
    }
}

fn within_text(node: Node<'_, '_>) -> bool {
    node.text().is_some_and(|t| !t.trim().is_empty()) && node.ancestors().any(|n| n.tag_name().name() == "text")
}

/// The size at which a text is set, in units of the figure.
fn font_size(text: Node<'_, '_>) -> Option<f64> {
    let size: f64 = text.ancestors().find_map(|n| n.attribute("font-size"))?.trim_end_matches("px").parse().ok()?;
    let scale = |n: Node<'_, '_>| {
        let (_, arguments) = n.attribute("transform")?.split_once("scale(")?;
        arguments.split([',', ' ', ')']).next()?.parse::<f64>().ok()
    };
    Some(text.ancestors().filter_map(scale).fold(size, |size, s| size * s.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smallest_text_is_found_as_it_is_seen() {
        let texts = r#"<g transform="scale(0.5)"><text font-size="18"><tspan>a</tspan></text></g><text font-size="12">b</text>"#;
        let svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="90" height="60"><title>A</title><desc>B</desc>{texts}</svg>"#
        );
        let picture = Picture::of(&svg).expect("a figure");
        assert_eq!(picture.extent, FigureSize { size: [90.0, 60.0], smallest: Some(9.0) });
        assert_eq!(picture.alternative, "A. B");
        assert!(Picture::of("<svg/>").is_err() && Picture::of("<svg").is_err());
    }
}
