//! What of a line or an area lies within a frame.

type Point = (f64, f64);

/// An upright rectangle.
pub struct Frame {
    pub left: f64,
    pub top: f64,
    pub right: f64,
    pub bottom: f64,
}

impl Frame {
    pub fn corners(&self) -> [Point; 4] {
        [(self.left, self.top), (self.right, self.top), (self.right, self.bottom), (self.left, self.bottom)]
    }

    /// How far a point lies within each edge.
    fn within(&self, p: Point) -> [f64; 4] {
        [p.0 - self.left, self.right - p.0, p.1 - self.top, self.bottom - p.1]
    }

    /// An area cut by each edge in turn (Sutherland and Hodgman).
    pub fn area(&self, edge: &[Point]) -> Vec<Point> {
        let mut all = edge.to_vec();
        for side in 0..4 {
            let mut kept = Vec::new();
            for (k, &p) in all.iter().enumerate() {
                let q = all[(k + 1) % all.len()];
                let (a, b) = (self.within(p)[side], self.within(q)[side]);
                if a >= 0.0 {
                    kept.push(p);
                }
                if (a < 0.0) != (b < 0.0) {
                    kept.push(between(p, q, a / (a - b)));
                }
            }
            all = kept;
        }
        all
    }

    /// The pieces of a line.
    pub fn line(&self, points: &[Point]) -> Vec<Vec<Point>> {
        let mut all: Vec<Vec<Point>> = Vec::new();
        for pair in points.windows(2) {
            let (p, q) = (pair[0], pair[1]);
            let (mut from, mut to) = (0.0f64, 1.0f64);
            for (a, b) in self.within(p).into_iter().zip(self.within(q)) {
                match (a < 0.0, b < 0.0) {
                    (true, true) => to = -1.0,
                    (true, false) => from = from.max(a / (a - b)),
                    (false, true) => to = to.min(a / (a - b)),
                    _ => {}
                }
            }
            if to <= from {
                continue;
            }
            let (start, end) = (between(p, q, from), between(p, q, to));
            match all.last_mut().filter(|l| l.last() == Some(&start)) {
                Some(l) => l.push(end),
                None => all.push(vec![start, end]),
            }
        }
        all
    }
}

fn between(p: Point, q: Point, t: f64) -> Point {
    // Exactly its ends, so that pieces join.
    if t == 0.0 {
        p
    } else if t == 1.0 {
        q
    } else {
        (p.0 + (q.0 - p.0) * t, p.1 + (q.1 - p.1) * t)
    }
}
