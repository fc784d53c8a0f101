//! One column and one place in it for every node of a train, from the flows of all its gears together.
//!
//! What a node is passed by in one gear runs the other way in another, so no order of the nodes lets all power run to the
//! right. The order taken is the one against which the least power runs, over all gears, each with the same weight; it
//! is improved as long as moving one node helps. Columns follow from the order, rows from the crossings of the joined graph.

use std::collections::BTreeMap;

use super::layers::{self, Columns, Seat};
use super::{SankeyFlow, SankeyLink, SankeyNode};

/// How much power that goes round counts in the order: it has to turn back somewhere, wherever that is.
const ROUND: f64 = 0.25;

/// The places of all nodes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Seats {
    pub by_id: BTreeMap<String, Seat>,
    pub layers: usize,
}

impl Seats {
    /// Those of flows that are not laid out yet.
    pub fn of(flows: &[SankeyFlow]) -> Self {
        let mut ids: Vec<&str> = Vec::new();
        let mut outputs: Vec<bool> = Vec::new();
        let mut own: Vec<Vec<usize>> = Vec::new();
        for f in flows {
            let mut places = Vec::new();
            for n in &f.nodes {
                let k = ids.iter().position(|id| *id == n.id).unwrap_or_else(|| {
                    ids.push(&n.id);
                    outputs.push(false);
                    ids.len() - 1
                });
                places.push(k);
            }
            own.push(places);
        }
        let count = ids.len();
        let mut net = vec![vec![0.0; count]; count];
        let mut gross = vec![vec![0.0; count]; count];
        for (f, own) in flows.iter().zip(&own) {
            let largest = f.links.iter().fold(f64::MIN_POSITIVE, |a, l| a.max(l.power_w));
            let weight = |l: &SankeyLink| (l.power_w - (1.0 - ROUND) * l.circulating_w) / largest;
            // A gear that is driven from its output stands in the mirror.
            let along: f64 = f.links.iter().map(|l| weight(l) * net[own[l.from]][own[l.to]]).sum();
            for l in &f.links {
                let (a, b) = (own[l.from], own[l.to]);
                let (a, b) = if along < 0.0 { (b, a) } else { (a, b) };
                net[a][b] += weight(l);
                net[b][a] -= weight(l);
                gross[a][b] += weight(l);
            }
            for (n, k) in f.nodes.iter().zip(own) {
                outputs[*k] |= if along < 0.0 { n.input_w > 0.0 } else { n.output_w > 0.0 };
            }
        }
        let order = order(&net);
        let mut layer = vec![0; count];
        for (k, &b) in order.iter().enumerate() {
            for &a in &order[..k] {
                if gross[a][b] > 0.0 || gross[b][a] > 0.0 {
                    layer[b] = layer[b].max(layer[a] + 1);
                }
            }
        }
        let layers = layer.iter().map(|l| l + 1).max().unwrap_or(0);
        // What only leaves stands at the end.
        for k in (0..count).filter(|&k| outputs[k] && gross[k].iter().all(|w| *w == 0.0)) {
            layer[k] = layers - 1;
        }
        // Rows: those of one flow that has everything at once.
        let steps: Vec<(usize, usize, f64)> = (0..count)
            .flat_map(|a| (0..count).map(move |b| (a, b)))
            .map(|(a, b)| (a, b, gross[a][b] + gross[b][a]))
            .filter(|(a, b, w)| layer[*a] < layer[*b] && *w > 0.0)
            .collect();
        let mut columns = Columns::of(layer.clone(), layers, &steps, vec![]).0;
        columns.order();
        let by_id = (0..count).map(|k| {
            let rank = columns.rows[layer[k]].iter().filter(|i| **i < count).position(|i| *i == k).unwrap_or(0);
            (ids[k].to_owned(), Seat { layer: layer[k], rank })
        });
        Self { by_id: by_id.collect(), layers }
    }

    /// Lays out a flow: every node at its place, in the mirror where most of the power would run backwards.
    pub fn arrange(&self, nodes: &mut [SankeyNode], links: &mut [SankeyLink]) -> usize {
        let place = |n: &SankeyNode| self.by_id.get(&n.id).map(|s| s.layer as f64);
        let run: f64 = links
            .iter()
            .filter_map(|l| {
                let step = place(&nodes[l.to])? - place(&nodes[l.from])?;
                Some(step.signum() * (l.power_w - (1.0 - ROUND) * l.circulating_w))
            })
            .sum();
        let seat = |n: &SankeyNode| {
            let s = self.by_id.get(&n.id)?;
            Some(Seat { layer: if run < 0.0 { self.layers - 1 - s.layer } else { s.layer }, ..*s })
        };
        layers::arrange_at(nodes, links, &seat, self.layers)
    }
}

/// The order of all against which the least runs, by moving one at a time.
fn order(net: &[Vec<f64>]) -> Vec<usize> {
    let count = net.len();
    // First those that give more than they take from what is left.
    let mut left: Vec<usize> = (0..count).collect();
    let mut order = Vec::with_capacity(count);
    while !left.is_empty() {
        let gives = |k: usize| left.iter().map(|&o| net[k][o]).sum::<f64>();
        let takes = |k: usize| left.iter().map(|&o| net[o][k].max(0.0)).sum::<f64>();
        let best = (0..left.len())
            .min_by(|&a, &b| {
                let (a, b) = (left[a], left[b]);
                takes(a).total_cmp(&takes(b)).then(gives(b).total_cmp(&gives(a)))
            })
            .unwrap_or(0);
        order.push(left.remove(best));
    }
    loop {
        let mut moved = false;
        for k in 0..count {
            let at = order.iter().position(|o| *o == k).unwrap_or(0);
            // What moving it past its neighbours gains, one after the other.
            let (mut best, mut to) = (1e-9, at);
            let mut gain = 0.0;
            for j in at + 1..count {
                gain += net[order[j]][k];
                if gain > best {
                    (best, to) = (gain, j);
                }
            }
            gain = 0.0;
            for j in (0..at).rev() {
                gain += net[k][order[j]];
                if gain > best {
                    (best, to) = (gain, j);
                }
            }
            if to != at {
                order.remove(at);
                order.insert(to, k);
                moved = true;
            }
        }
        if !moved {
            return order;
        }
    }
}
