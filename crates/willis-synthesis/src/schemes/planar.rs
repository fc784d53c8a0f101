//! Whether a scheme can be drawn: nested shafts without a crossing.
//!
//! In a stick diagram sets stand in a row on one axis, and only the half above the axis is drawn. The drawing is a plane
//! graph: a node for every set, for every shaft and for the housing, an edge from a set to the shaft of each of its
//! members, an edge for every clutch and brake. The housing is around everything, and input and output come in from
//! outside, so these three lie on one face. That is so exactly if the graph is planar with one more node that is joined
//! to these three. A shaft that passes through the bore of a sun passes between set and axis; how many nested shafts
//! have room there is not counted.
//!
//! Planarity is decided by growing a plane drawing face by face (Demoucron, Malgrange and Pertuiset 1964).

use std::collections::BTreeSet;

use super::layout::{GROUND, INPUT, Layout, OUTPUT};

type Edge = (usize, usize);

/// Whether a layout with these elements can be drawn.
pub(crate) fn is_planar(layout: &Layout, elements: &[[u8; 2]]) -> bool {
    let shafts = layout.shafts();
    let outside = shafts + layout.sets();
    let mut edges: BTreeSet<Edge> = BTreeSet::new();
    let mut join = |a: usize, b: usize| {
        edges.insert((a.min(b), a.max(b)));
    };
    for (m, block) in layout.blocks().iter().enumerate() {
        join(usize::from(*block), shafts + m / 3);
    }
    for [x, y] in elements {
        join(usize::from(*x), usize::from(*y));
    }
    for end in [INPUT, OUTPUT, GROUND] {
        join(usize::from(end), outside);
    }
    graph_is_planar(outside + 1, edges.into_iter().collect())
}

/// Whether a simple graph is planar: its blocks, one by one.
pub(crate) fn graph_is_planar(nodes: usize, edges: Vec<Edge>) -> bool {
    blocks(nodes, &edges).into_iter().all(|block| block_is_planar(nodes, block))
}

/// The edges of the blocks (parts without a node that cuts them in two) of a graph.
fn blocks(nodes: usize, edges: &[Edge]) -> Vec<Vec<Edge>> {
    struct Walk<'a> {
        edges: &'a [Edge],
        time: usize,
        seen: Vec<usize>,
        low: Vec<usize>,
        stack: Vec<usize>,
        used: Vec<bool>,
        found: Vec<Vec<Edge>>,
    }
    impl Walk<'_> {
        fn go(&mut self, node: usize) {
            self.time += 1;
            (self.seen[node], self.low[node]) = (self.time, self.time);
            for (e, (a, b)) in self.edges.iter().enumerate() {
                let other = match node {
                    n if n == *a => *b,
                    n if n == *b => *a,
                    _ => continue,
                };
                if self.used[e] {
                    continue;
                }
                self.used[e] = true;
                let depth = self.stack.len();
                self.stack.push(e);
                if self.seen[other] != 0 {
                    self.low[node] = self.low[node].min(self.seen[other]);
                    continue;
                }
                self.go(other);
                self.low[node] = self.low[node].min(self.low[other]);
                if self.low[other] >= self.seen[node] {
                    let own = self.stack.drain(depth..).map(|e| self.edges[e]).collect();
                    self.found.push(own);
                }
            }
        }
    }
    let (seen, low, used) = (vec![0; nodes], vec![0; nodes], vec![false; edges.len()]);
    let mut walk = Walk { edges, time: 0, seen, low, stack: vec![], used, found: vec![] };
    for node in 0..nodes {
        if walk.seen[node] == 0 {
            walk.go(node);
        }
    }
    walk.found
}

/// Some way in a block from one node to another that passes only `through` nodes.
fn path(
    edges: &[Edge],
    from: usize,
    to: impl Fn(usize) -> bool,
    through: impl Fn(usize) -> bool,
) -> Option<Vec<usize>> {
    let mut reached = vec![(from, usize::MAX)];
    let mut at = 0;
    while at < reached.len() {
        let node = reached[at].0;
        for (a, b) in edges {
            let other = match node {
                n if n == *a => *b,
                n if n == *b => *a,
                _ => continue,
            };
            if to(other) && other != from {
                let mut way = vec![other];
                let mut back = at;
                while back != usize::MAX {
                    way.push(reached[back].0);
                    back = reached[back].1;
                }
                way.reverse();
                return Some(way);
            }
            if through(other) && reached.iter().all(|(n, _)| *n != other) {
                reached.push((other, at));
            }
        }
        at += 1;
    }
    None
}

fn block_is_planar(nodes: usize, block: Vec<Edge>) -> bool {
    if block.len() < 9 {
        // The smallest graphs that are not planar have nine edges (three houses, three wells).
        return true;
    }
    // Some cycle: an edge, and a way back without it.
    let (first, rest) = (block[0], &block[1..]);
    let Some(cycle) = path(rest, first.0, |n| n == first.1, |_| true) else { return true };
    let mut drawn = vec![false; nodes];
    cycle.iter().for_each(|n| drawn[*n] = true);
    let mut left: BTreeSet<Edge> = block.iter().copied().collect();
    let drop = |left: &mut BTreeSet<Edge>, way: &[usize]| {
        for pair in way.windows(2) {
            left.remove(&(pair[0].min(pair[1]), pair[0].max(pair[1])));
        }
    };
    drop(&mut left, &cycle);
    left.remove(&first);
    let mut faces = vec![cycle.clone(), cycle];
    while !left.is_empty() {
        // Pieces that are not drawn: single edges between drawn nodes, or connected parts with their ends.
        let mut open: BTreeSet<Edge> = left.clone();
        let mut chosen: Option<(Vec<Edge>, Vec<usize>, BTreeSet<usize>)> = None;
        while let Some(seed) = open.pop_first() {
            let mut piece = vec![seed];
            let mut at = 0;
            while at < piece.len() {
                let (a, b) = piece[at];
                for node in [a, b].into_iter().filter(|n| !drawn[*n]) {
                    let near: Vec<Edge> = open.iter().copied().filter(|(x, y)| *x == node || *y == node).collect();
                    for edge in near {
                        open.remove(&edge);
                        piece.push(edge);
                    }
                }
                at += 1;
            }
            let ends: BTreeSet<usize> = piece.iter().flat_map(|(a, b)| [*a, *b]).filter(|n| drawn[*n]).collect();
            let fits: Vec<usize> = (0..faces.len()).filter(|f| ends.iter().all(|n| faces[*f].contains(n))).collect();
            if fits.is_empty() {
                return false;
            }
            if chosen.as_ref().is_none_or(|(_, old, _)| fits.len() < old.len()) {
                chosen = Some((piece, fits, ends));
            }
        }
        let Some((piece, fits, ends)) = chosen else { return true };
        let Some(from) = ends.first().copied() else { return true };
        // A way through the piece from one drawn node to another divides the face in two.
        let Some(way) = path(&piece, from, |n| drawn[n], |n| !drawn[n]) else { return true };
        let face = faces.swap_remove(fits[0]);
        let place = |node: usize| face.iter().position(|n| *n == node).unwrap_or(0);
        let (a, b) = (place(way[0]), place(way[way.len() - 1]));
        let around = |from: usize, to: usize| -> Vec<usize> {
            let steps = (to + face.len() - from) % face.len();
            (0..=steps).map(|s| face[(from + s) % face.len()]).collect()
        };
        let inner = &way[1..way.len() - 1];
        let mut one = around(b, a);
        one.extend(inner);
        let mut other = around(a, b);
        other.extend(inner.iter().rev());
        drop(&mut left, &way);
        inner.iter().for_each(|n| drawn[*n] = true);
        faces.extend([one, other]);
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;

    fn complete(n: usize) -> Vec<Edge> {
        (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b))).collect()
    }

    #[test]
    fn the_classics() {
        assert!(graph_is_planar(4, complete(4)));
        assert!(!graph_is_planar(5, complete(5)));
        let wells: Vec<Edge> = (0..3).flat_map(|a| (3..6).map(move |b| (a, b))).collect();
        assert!(!graph_is_planar(6, wells.clone()));
        assert!(graph_is_planar(6, wells[1..].to_vec()));
        let octahedron = complete(6).into_iter().filter(|(a, b)| a + 3 != *b).collect();
        assert!(graph_is_planar(6, octahedron));
        // Petersen's graph.
        let petersen = (0..5).flat_map(|i| [(i, (i + 1) % 5), (i, i + 5), (5 + i, 5 + (i + 2) % 5)]);
        let petersen = petersen.map(|(a, b): Edge| (a.min(b), a.max(b))).collect();
        assert!(!graph_is_planar(10, petersen));
    }

    /// Euler's bound and Kuratowski's theorem for all graphs of six nodes: not planar exactly if contracting and deleting
    /// leads to K5 or K3,3.
    #[test]
    fn all_graphs_of_six_nodes() {
        fn minor(nodes: usize, edges: &BTreeSet<Edge>, seen: &mut std::collections::HashMap<Vec<Edge>, bool>) -> bool {
            if edges.len() < 9 || nodes < 5 {
                return true;
            }
            let key: Vec<Edge> = edges.iter().copied().collect();
            if let Some(known) = seen.get(&key) {
                return *known;
            }
            let degree = |n: usize| edges.iter().filter(|(a, b)| *a == n || *b == n).count();
            let used: Vec<usize> = (0..6).filter(|n| degree(*n) > 0).collect();
            let k5 = used.len() == 5 && edges.len() == 10;
            let k33 = used.len() == 6 && edges.len() == 9 && used.iter().all(|n| degree(*n) == 3) && {
                let side: Vec<usize> = used.iter().copied().filter(|n| *n != used[0]).collect();
                let far: Vec<usize> =
                    side.iter().copied().filter(|n| !edges.contains(&(used[0], *n))).chain([used[0]]).collect();
                edges.iter().all(|(a, b)| far.contains(a) != far.contains(b))
            };
            let planar = !(k5 || k33)
                && edges.iter().all(|e| {
                    let deleted: BTreeSet<Edge> = edges.iter().copied().filter(|f| f != e).collect();
                    let to = |n: usize| if n == e.1 { e.0 } else { n };
                    let contracted = deleted.iter().map(|(a, b)| (to(*a), to(*b))).filter(|(a, b)| a != b);
                    let contracted: BTreeSet<Edge> = contracted.map(|(a, b)| (a.min(b), a.max(b))).collect();
                    minor(nodes, &deleted, seen) && minor(nodes - 1, &contracted, seen)
                });
            seen.insert(key, planar);
            planar
        }
        let all = complete(6);
        let mut seen = std::collections::HashMap::new();
        for bits in (0..1_u32 << 15).filter(|b| b.count_ones() >= 9 && b % 3 == 0) {
            let edges: Vec<Edge> = (0..15).filter(|e| bits >> e & 1 == 1).map(|e| all[e]).collect();
            let expected = minor(6, &edges.iter().copied().collect(), &mut seen);
            assert_eq!(graph_is_planar(6, edges.clone()), expected, "{edges:?}");
        }
    }
}
