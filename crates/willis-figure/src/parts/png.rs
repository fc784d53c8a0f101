//! Pictures as PNG.

use std::sync::{Arc, LazyLock};

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// The faces of the machine, and one that every machine has, so that no label vanishes.
static FACES: LazyLock<Arc<fontdb::Database>> = LazyLock::new(|| {
    let mut faces = fontdb::Database::new();
    faces.load_font_data(dejavu::sans::regular().to_vec());
    faces.load_font_data(dejavu::sans::bold().to_vec());
    faces.load_system_fonts();
    faces.set_sans_serif_family("DejaVu Sans");
    Arc::new(faces)
});

/// A figure as PNG, so many pixels to a unit of the figure (2 is sharp on most screens).
///
/// # Errors
/// What is wrong with the SVG; a picture of more than 100 million pixels.
pub fn png(svg: &str, scale: f32) -> Result<Vec<u8>, String> {
    let options = Options { fontdb: FACES.clone(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).map_err(|e| format!("the figure is no proper SVG: {e}"))?;
    let size = tree.size().to_int_size().scale_by(scale).ok_or("the figure has no size")?;
    if u64::from(size.width()) * u64::from(size.height()) > 100_000_000 {
        return Err(format!("{} x {} pixels are too many; ask for SVG", size.width(), size.height()));
    }
    let mut pixels = Pixmap::new(size.width(), size.height()).ok_or("the figure has no size")?;
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    pixels.encode_png().map_err(|e| format!("the picture could not be written as PNG: {e}"))
}
