//! Layers by the longest path, rows by barycentres and exchanges, offsets by stacking.

use super::{SankeyLink, SankeyNode};

/// Where a node stands.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seat {
    pub layer: usize,
    /// Among the nodes of its column, from the top.
    pub rank: usize,
}

/// Powers below this part of the largest do not decide what runs forward.
const ROUND_OFF: f64 = 1e-9;
/// Rounds of ordering; the pictures have a dozen nodes.
const SWEEPS: usize = 12;

/// Gives every node its layer and row and every link its offsets; the number of layers.
pub(super) fn arrange(nodes: &mut [SankeyNode], links: &mut [SankeyLink]) -> usize {
    lead_back(nodes.len(), links);
    let layers = assign_layers(nodes, links);
    assign_rows(nodes, links, layers, None);
    stack(nodes, links);
    layers
}

/// The same with places that are given, as far as they are; what has none stands behind what gives to it.
pub(super) fn arrange_at(
    nodes: &mut [SankeyNode],
    links: &mut [SankeyLink],
    seat: &dyn Fn(&SankeyNode) -> Option<Seat>,
    layers: usize,
) -> usize {
    let seats: Vec<Option<Seat>> = nodes.iter().map(seat).collect();
    for (n, s) in nodes.iter_mut().zip(&seats) {
        n.layer = s.map_or(usize::MAX, |s| s.layer);
    }
    for _ in 0..nodes.len() {
        for l in links.iter() {
            if nodes[l.to].layer == usize::MAX && nodes[l.from].layer != usize::MAX {
                nodes[l.to].layer = (nodes[l.from].layer + 1).min(layers.saturating_sub(1));
            }
        }
    }
    for n in nodes.iter_mut().filter(|n| n.layer == usize::MAX) {
        n.layer = 0;
    }
    // Two in one column need another: only where one of them has no place of its own.
    let mut layers = layers;
    for _ in 0..nodes.len() {
        for l in links.iter() {
            if nodes[l.to].layer == nodes[l.from].layer {
                let moved = if seats[l.from].is_none() { l.from } else { l.to };
                nodes[moved].layer += 1;
                layers = layers.max(nodes[moved].layer + 1);
            }
        }
    }
    for l in links.iter_mut() {
        l.back = nodes[l.to].layer < nodes[l.from].layer;
    }
    let rank = |k: usize| seats[k].map_or(usize::MAX, |s| s.rank);
    assign_rows(nodes, links, layers, Some(&rank));
    stack(nodes, links);
    layers
}

/// Power that does not circulate runs forward. Of the links that only circulate, those are led
/// back that would close a circle, the stronger having the first choice.
fn lead_back(nodes: usize, links: &mut [SankeyLink]) {
    let largest = links.iter().fold(0.0f64, |a, l| a.max(l.power_w));
    let onward = |l: &SankeyLink| l.power_w - l.circulating_w > ROUND_OFF * largest;
    let mut order: Vec<usize> = (0..links.len()).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (&links[a], &links[b]);
        onward(b).cmp(&onward(a)).then(b.power_w.total_cmp(&a.power_w))
    });
    // Whether the second is reached from the first.
    let mut reaches = vec![vec![false; nodes]; nodes];
    (0..nodes).for_each(|k| reaches[k][k] = true);
    for j in order {
        let (from, to) = (links[j].from, links[j].to);
        links[j].back = reaches[to][from];
        if !links[j].back {
            for a in (0..nodes).filter(|&a| reaches[a][from]).collect::<Vec<_>>() {
                for b in 0..nodes {
                    reaches[a][b] |= reaches[to][b];
                }
            }
        }
    }
}

/// As early as possible; outputs in the last layer.
fn assign_layers(nodes: &mut [SankeyNode], links: &[SankeyLink]) -> usize {
    for _ in 0..nodes.len() {
        for l in links.iter().filter(|l| !l.back) {
            nodes[l.to].layer = nodes[l.to].layer.max(nodes[l.from].layer + 1);
        }
    }
    let layers = nodes.iter().map(|n| n.layer + 1).max().unwrap_or(0);
    for n in nodes.iter_mut().filter(|n| n.output_w > 0.0) {
        n.layer = layers - 1;
    }
    layers
}

/// What stands in a layer: a node, or a link that passes.
pub(super) struct Columns {
    /// How many items are nodes; they are the first, in the order in which the train has them.
    nodes: usize,
    /// By layer, items from the top.
    pub rows: Vec<Vec<usize>>,
    /// By item.
    layer: Vec<usize>,
    /// Steps of links from one layer to the next: items, and power.
    steps: Vec<(usize, usize, f64)>,
    /// What is led back: from which node to which, and its power. It rises right of the one and comes
    /// down left of the other.
    backs: Vec<(usize, usize, f64)>,
}

impl Columns {
    /// Nodes by their columns, and what passes columns on its way from node to node with a power: items for each of them.
    pub fn of(
        mut layer: Vec<usize>,
        layers: usize,
        links: &[(usize, usize, f64)],
        backs: Vec<(usize, usize, f64)>,
    ) -> (Self, Vec<Vec<usize>>) {
        let nodes = layer.len();
        let mut steps = Vec::new();
        let mut passing: Vec<Vec<usize>> = Vec::with_capacity(links.len());
        for &(from, to, power) in links {
            let mut items = vec![from];
            for between in layer[from] + 1..layer[to] {
                layer.push(between);
                items.push(layer.len() - 1);
            }
            items.push(to);
            steps.extend(items.windows(2).map(|w| (w[0], w[1], power)));
            items.pop();
            passing.push(items.split_off(1));
        }
        let mut rows = vec![vec![]; layers];
        (0..layer.len()).for_each(|item| rows[layer[item]].push(item));
        (Self { nodes, rows, layer, steps, backs }, passing)
    }

    fn largest(&self) -> f64 {
        self.steps.iter().chain(&self.backs).fold(0.0f64, |a, s| a.max(s.2))
    }

    /// Orders all columns so that little crosses.
    pub fn order(&mut self) {
        let (largest, layers) = (self.largest(), self.rows.len());
        self.exchange(largest, false);
        let mut best = (self.cost(largest), self.rows.clone());
        for round in 0..SWEEPS {
            let from_left = round % 2 == 0;
            for k in 0..layers {
                self.sweep(if from_left { k } else { layers - 1 - k }, from_left);
            }
            let swept = self.rows.clone();
            self.exchange(largest, false);
            let cost = self.cost(largest);
            if cost < best.0 {
                best = (cost, self.rows.clone());
            }
            self.rows = swept;
        }
        self.rows = best.1;
    }

    /// Nodes stay in the order of their ranks, and what passes finds its way between them.
    fn fit_between(&mut self, rank: &dyn Fn(usize) -> usize) {
        let (largest, layers) = (self.largest(), self.rows.len());
        for layer in 0..layers {
            // From the left, where all have their place already.
            self.sweep(layer, true);
            let mut nodes: Vec<usize> = self.rows[layer].iter().copied().filter(|i| *i < self.nodes).collect();
            nodes.sort_by_key(|&k| rank(k));
            let mut next = nodes.into_iter();
            let own = self.nodes;
            for item in self.rows[layer].iter_mut().filter(|i| **i < own) {
                *item = next.next().unwrap_or(*item);
            }
        }
        self.exchange(largest, true);
    }

    fn places(&self) -> Vec<usize> {
        let mut place = vec![0; self.layer.len()];
        for column in &self.rows {
            column.iter().enumerate().for_each(|(k, item)| place[*item] = k);
        }
        place
    }

    /// Power that crosses other power; what rises crosses all that stands above it.
    fn cost(&self, largest: f64) -> f64 {
        let place = self.places();
        let crossing = |p: f64, q: f64| p.min(q) + 0.02 * largest;
        let mut sum = 0.0;
        for (k, a) in self.steps.iter().enumerate() {
            for b in &self.steps[..k] {
                let apart = (place[a.0] as i64 - place[b.0] as i64) * (place[a.1] as i64 - place[b.1] as i64);
                if self.layer[a.0] == self.layer[b.0] && apart < 0 {
                    sum += crossing(a.2, b.2);
                }
            }
            for &(from, to, power) in &self.backs {
                for (item, node) in [(a.0, from), (a.1, to)] {
                    if self.layer[item] == self.layer[node] && place[item] < place[node] {
                        sum += crossing(a.2, power);
                    }
                }
            }
        }
        // Where nothing crosses, nodes stand in the order of the train, so that gears look alike.
        for column in &self.rows {
            let own: Vec<usize> = column.iter().copied().filter(|item| *item < self.nodes).collect();
            let turned: usize = (1..own.len()).map(|k| own[..k].iter().filter(|a| **a > own[k]).count()).sum();
            sum += 0.002 * largest * turned as f64;
        }
        // Side by side, the upper should have the shorter way.
        for (k, a) in self.backs.iter().enumerate() {
            for b in &self.backs[..k] {
                let way = |x: &(usize, usize, f64)| self.layer[x.0] - self.layer[x.1];
                for (x, y) in [(a.0, b.0), (a.1, b.1)] {
                    let same = self.layer[x] == self.layer[y];
                    let (upper, lower) = if place[x] < place[y] { (a, b) } else { (b, a) };
                    if same && x != y && way(upper) > way(lower) {
                        sum += crossing(a.2, b.2);
                    }
                }
            }
        }
        sum
    }

    /// Orders a layer by where its neighbours stand on one side.
    fn sweep(&mut self, layer: usize, from_left: bool) {
        let place = self.places();
        let key = |item: usize| {
            let (mut sum, mut weight) = (0.0, 0.0);
            for &(a, b, power) in &self.steps {
                let (own, other) = if from_left { (b, a) } else { (a, b) };
                if own == item {
                    let column = self.rows[self.layer[other]].len() as f64;
                    sum += power * (place[other] as f64 + 0.5) / column;
                    weight += power;
                }
            }
            // What is led back pulls up.
            weight += self.backs.iter().filter(|b| item == if from_left { b.1 } else { b.0 }).map(|b| b.2).sum::<f64>();
            if weight > 0.0 { sum / weight } else { (place[item] as f64 + 0.5) / self.rows[layer].len() as f64 }
        };
        let mut keyed: Vec<(f64, usize)> = self.rows[layer].iter().map(|&item| (key(item), item)).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.rows[layer] = keyed.into_iter().map(|k| k.1).collect();
    }

    /// Exchanges neighbours as long as that helps.
    fn exchange(&mut self, largest: f64, nodes_stay: bool) {
        let mut cost = self.cost(largest);
        for _ in 0..SWEEPS {
            let before = cost;
            for layer in 0..self.rows.len() {
                for k in 1..self.rows[layer].len() {
                    if nodes_stay && self.rows[layer][k - 1..=k].iter().all(|item| *item < self.nodes) {
                        continue;
                    }
                    self.rows[layer].swap(k - 1, k);
                    let now = self.cost(largest);
                    if now < cost {
                        cost = now;
                    } else {
                        self.rows[layer].swap(k - 1, k);
                    }
                }
            }
            if cost >= before {
                break;
            }
        }
    }
}

fn assign_rows(
    nodes: &mut [SankeyNode],
    links: &mut [SankeyLink],
    layers: usize,
    rank: Option<&dyn Fn(usize) -> usize>,
) {
    let (ahead, backs): (Vec<usize>, Vec<usize>) = (0..links.len()).partition(|&j| !links[j].back);
    let arc = |j: &usize| (links[*j].from, links[*j].to, links[*j].power_w);
    let steps: Vec<(usize, usize, f64)> = ahead.iter().map(arc).collect();
    let backs = backs.iter().map(arc).collect();
    let (mut columns, passing) = Columns::of(nodes.iter().map(|n| n.layer).collect(), layers, &steps, backs);
    match rank {
        None => columns.order(),
        Some(rank) => columns.fit_between(rank),
    }
    let place = columns.places();
    nodes.iter_mut().enumerate().for_each(|(k, n)| n.row = place[k]);
    links.iter_mut().for_each(|l| l.rows.clear());
    for (j, items) in ahead.into_iter().zip(passing) {
        links[j].rows = items.into_iter().map(|item| place[item]).collect();
    }
}

/// Stacks what enters and what leaves each node: what is led back first, since it is led above, the
/// shortest way innermost; then by the row where it comes from or goes to; losses last.
fn stack(nodes: &mut [SankeyNode], links: &mut [SankeyLink]) {
    let layer: Vec<usize> = nodes.iter().map(|n| n.layer).collect();
    let row: Vec<usize> = nodes.iter().map(|n| n.row).collect();
    for k in 0..nodes.len() {
        for right in [true, false] {
            let mut own: Vec<usize> =
                (0..links.len()).filter(|&j| k == if right { links[j].from } else { links[j].to }).collect();
            own.sort_by_key(|&j| {
                let l = &links[j];
                let next = if right { l.rows.first() } else { l.rows.last() };
                let other = if right { l.to } else { l.from };
                let place = match l.back {
                    true => layer[l.from] - layer[l.to],
                    false => next.copied().unwrap_or(row[other]),
                };
                (!l.back, place, row[other])
            });
            let mut offset = 0.0;
            for j in own {
                let l = &mut links[j];
                *if right { &mut l.from_offset_w } else { &mut l.to_offset_w } = offset;
                offset += l.power_w;
            }
            if right {
                offset += nodes[k].output_w;
                for loss in &mut nodes[k].losses {
                    loss.offset_w = offset;
                    offset += loss.power_w;
                }
            }
        }
    }
}
