//! The picture of how the work grows with the number of sets in series, from the counts in `benches/growth.csv`.

use std::fs;
use std::path::Path;

/// Where it stands.
pub(crate) const FIGURE: &str = "book/src/figures/growth.svg";
const COUNTS: &str = "benches/growth.csv";

/// Instructions that a core of today's machines gets through in a second, about.
const A_SECOND: f64 = 1e10;

const WIDTH: f64 = 752.0;
const LEFT: f64 = 76.0;
const RIGHT: f64 = 600.0;
const TOP: f64 = 84.0;
const BOTTOM: f64 = 400.0;
const INKS: [&str; 3] = ["#1f5fa8", "#b4521d", "#2e7d4f"];

/// A column of the counts.
struct Curve {
    name: String,
    /// Sets, instructions.
    points: Vec<[f64; 2]>,
}

/// Writes the figure.
pub(crate) fn write(root: &Path) -> Result<(), String> {
    let text = fs::read_to_string(root.join(COUNTS)).map_err(|e| format!("{COUNTS}: {e}"))?;
    let svg = draw(&curves(&text).ok_or_else(|| format!("{COUNTS}: not a table of numbers"))?);
    fs::write(root.join(FIGURE), svg).map_err(|e| format!("{FIGURE}: {e}"))
}

fn curves(text: &str) -> Option<Vec<Curve>> {
    let mut lines = text.lines();
    let (_, names) = lines.next()?.split_once(',')?;
    let mut all: Vec<Curve> = names.split(',').map(|name| Curve { name: name.to_owned(), points: vec![] }).collect();
    for line in lines {
        let numbers = line.split(',').map(|x| x.parse().ok()).collect::<Option<Vec<f64>>>()?;
        let (sets, counts) = numbers.split_first()?;
        if counts.len() != all.len() || numbers.iter().any(|x| *x <= 0.0) {
            return None;
        }
        all.iter_mut().zip(counts).for_each(|(curve, count)| curve.points.push([*sets, *count]));
    }
    all.iter().all(|c| c.points.len() > 1).then_some(all)
}

/// Both axes by powers; straight lines at the right show what growth would be in proportion and by the square.
fn draw(curves: &[Curve]) -> String {
    let all = || curves.iter().flat_map(|c| &c.points);
    let most_sets = all().map(|p| p[0]).fold(1.0, f64::max);
    let low = all().map(|p| p[1].log10()).fold(f64::INFINITY, f64::min).floor();
    let high = all().map(|p| p[1].log10()).fold(0.0, f64::max).ceil();
    let x = |sets: f64| LEFT + (RIGHT - LEFT) * sets.log2() / most_sets.log2();
    let y = |count: f64| BOTTOM - (BOTTOM - TOP) * (count.log10() - low) / (high - low);
    let text = |x: f64, y: f64, anchor: &str, ink: &str, size: f64, words: &str| {
        format!(
            "<text fill=\"{ink}\" font-size=\"{size}\" text-anchor=\"{anchor}\" x=\"{x:.1}\" y=\"{y:.1}\">{words}</text>\n"
        )
    };
    let line = |from: [f64; 2], to: [f64; 2], style: &str| {
        format!("<line {style} x1=\"{:.1}\" x2=\"{:.1}\" y1=\"{:.1}\" y2=\"{:.1}\"/>\n", from[0], to[0], from[1], to[1])
    };
    let grid = "stroke=\"#dddddd\" stroke-width=\"1\"";
    let [ink, faint] = ["#1a1a1a", "#5f5f5f"];
    let mut svg = format!(
        "<svg font-family=\"Inter, 'Helvetica Neue', Arial, 'DejaVu Sans', sans-serif\" height=\"456\" role=\"img\" viewBox=\"0 0 \
         {WIDTH} 456\" width=\"{WIDTH}\" xmlns=\"http://www.w3.org/2000/svg\">\n<title>Work over the number of sets in \
         series</title>\n<rect fill=\"#ffffff\" height=\"456\" width=\"{WIDTH}\" x=\"0\" y=\"0\"/>\n"
    );
    svg += &text(28.0, 36.0, "start", ink, 20.0, "Work over the number of sets in series");
    svg +=
        &text(28.0, 58.0, "start", faint, 13.0, "Instructions of one answer; at the right, about how long that takes");
    for power in low as i32..=high as i32 {
        let count = 10f64.powi(power);
        svg += &line([LEFT, y(count)], [RIGHT, y(count)], grid);
        svg += &text(LEFT - 8.0, y(count) + 4.0, "end", faint, 12.0, &format!("1e{power}"));
        let seconds = count / A_SECOND;
        let told = if seconds >= 1.0 {
            format!("{seconds} s")
        } else if seconds >= 1e-3 {
            format!("{} ms", (seconds * 1e3).round())
        } else {
            format!("{} µs", (seconds * 1e6).round())
        };
        svg += &text(WIDTH - 28.0, y(count) + 4.0, "end", faint, 12.0, &told);
    }
    let mut sets = 1.0;
    while sets <= most_sets {
        svg += &line([x(sets), TOP], [x(sets), BOTTOM], grid);
        svg += &text(x(sets), BOTTOM + 20.0, "middle", faint, 12.0, &format!("{sets}"));
        sets *= 2.0;
    }
    svg += &text((LEFT + RIGHT) / 2.0, BOTTOM + 42.0, "middle", ink, 13.0, "Sets in series");
    // What stands at the end of each line, and where.
    let mut ends: Vec<f64> = curves.iter().map(|c| c.points.last().map_or(BOTTOM, |p| y(p[1]))).collect();
    // What in proportion would be, from the first point of the first curve.
    if let Some([first, count]) = curves.first().and_then(|c| c.points.first()) {
        let end = [x(most_sets), y(count * most_sets / first)];
        svg += &line([x(*first), y(*count)], end, "stroke=\"#8f8f8f\" stroke-dasharray=\"5 4\" stroke-width=\"1.2\"");
        ends.push(end[1]);
    }
    // Names keep clear of each other, the highest first.
    let mut order: Vec<usize> = (0..ends.len()).collect();
    order.sort_by(|a, b| ends[*a].total_cmp(&ends[*b]));
    for pair in order.windows(2) {
        ends[pair[1]] = ends[pair[1]].max(ends[pair[0]] + 15.0);
    }
    if let Some(end) = ends.get(curves.len()) {
        svg += &text(RIGHT + 8.0, end + 4.0, "start", faint, 12.0, "in proportion");
    }
    for ((curve, ink), name) in curves.iter().zip(INKS.iter().cycle()).zip(&ends) {
        let points: Vec<String> = curve.points.iter().map(|p| format!("{:.1},{:.1}", x(p[0]), y(p[1]))).collect();
        svg +=
            &format!("<polyline fill=\"none\" points=\"{}\" stroke=\"{ink}\" stroke-width=\"2\"/>\n", points.join(" "));
        for p in &curve.points {
            svg += &format!("<circle cx=\"{:.1}\" cy=\"{:.1}\" fill=\"{ink}\" r=\"3\"/>\n", x(p[0]), y(p[1]));
        }
        svg += &text(RIGHT + 8.0, name + 4.0, "start", ink, 13.0, &curve.name);
    }
    svg + "</svg>\n"
}
