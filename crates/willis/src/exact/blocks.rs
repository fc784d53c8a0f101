//! Equations in an order in which they are solved one group after the other.
//!
//! A train of many sets is seldom one system: a set in series is loaded by the one before it and loads the next. Rows and
//! columns are put into block triangular form (a perfect matching, then the strongly connected components of the graph
//! that it gives: Duff and Reid, ACM Trans. Math. Softw. 4, 1978). The determinant is the product of those of the diagonal
//! blocks, so each block is certified by itself, a certificate costs the cube of the largest block, not of the train, and a
//! closed formula is a product of short factors.

/// Rows and columns of a diagonal block.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Block {
    pub rows: Vec<usize>,
    pub columns: Vec<usize>,
}

/// Whether putting the rows and columns of all blocks in their order takes an odd number of exchanges.
pub(crate) fn is_odd(blocks: &[Block]) -> bool {
    let odd = |order: Vec<usize>| {
        let mut seen = vec![false; order.len()];
        // A circle of an even number of places is an odd number of exchanges.
        (0..order.len()).fold(false, |odd, start| {
            let (mut at, mut length) = (start, 0);
            while !std::mem::replace(&mut seen[at], true) {
                at = order[at];
                length += 1;
            }
            odd ^ (length > 0 && length % 2 == 0)
        })
    };
    odd(blocks.iter().flat_map(|b| b.rows.iter().copied()).collect())
        != odd(blocks.iter().flat_map(|b| b.columns.iter().copied()).collect())
}

/// The diagonal blocks of a square system, each after those whose unknowns its equations contain. `rows_of` has the rows
/// of each column. `None` where no choice of numbers makes the system regular.
pub(crate) fn blocks(rows_of: &[Vec<usize>]) -> Option<Vec<Block>> {
    let n = rows_of.len();
    let mut column_of = vec![None; n];
    // By which column each row was tried last.
    let mut tried_by = vec![n; n];
    let mut path = Vec::with_capacity(n);
    for start in 0..n {
        match_column(start, rows_of, &mut column_of, &mut tried_by, &mut path).then_some(())?;
    }
    let column_of: Vec<usize> = column_of.into_iter().collect::<Option<_>>()?;
    // The equation that was matched with an unknown, and the other unknowns in it.
    let mut needs: Vec<Vec<usize>> = vec![vec![]; n];
    for (column, rows) in rows_of.iter().enumerate() {
        rows.iter().map(|&r| column_of[r]).filter(|&of| of != column).for_each(|of| needs[of].push(column));
    }
    let mut row_of = vec![0; n];
    column_of.iter().enumerate().for_each(|(row, &column)| row_of[column] = row);
    let ordered = components(&needs).into_iter();
    Some(ordered.map(|columns| Block { rows: columns.iter().map(|&c| row_of[c]).collect(), columns }).collect())
}

/// Finds a row for a column, moving others away on an augmenting path; without recursion, as trains may be long.
fn match_column(
    start: usize,
    rows_of: &[Vec<usize>],
    column_of: &mut [Option<usize>],
    tried_by: &mut [usize],
    path: &mut Vec<(usize, usize)>,
) -> bool {
    // The column at which the path stands, and how many of its rows were tried; the row that led on from it is the last.
    path.clear();
    path.push((start, 0));
    while let Some((column, tried)) = path.last_mut() {
        let Some(&row) = rows_of[*column].get(*tried) else {
            path.pop();
            continue;
        };
        *tried += 1;
        if std::mem::replace(&mut tried_by[row], start) == start {
            continue;
        }
        match column_of[row] {
            Some(other) => path.push((other, 0)),
            None => {
                path.iter().for_each(|&(column, tried)| column_of[rows_of[column][tried - 1]] = Some(column));
                return true;
            }
        }
    }
    false
}

/// Strongly connected components, each after those that it needs (Tarjan), without recursion.
fn components(needs: &[Vec<usize>]) -> Vec<Vec<usize>> {
    const UNSEEN: usize = usize::MAX;
    let n = needs.len();
    let (mut order, mut low, mut done) = (vec![UNSEEN; n], vec![UNSEEN; n], vec![false; n]);
    let (mut open, mut path, mut all, mut count) = (vec![], vec![], vec![], 0);
    for start in 0..n {
        if order[start] != UNSEEN {
            continue;
        }
        path.push((start, 0));
        while let Some((at, next)) = path.last_mut() {
            let at = *at;
            if *next == 0 {
                (order[at], low[at]) = (count, count);
                count += 1;
                open.push(at);
            }
            if let Some(&of) = needs[at].get(*next) {
                *next += 1;
                if order[of] == UNSEEN {
                    path.push((of, 0));
                } else if !done[of] {
                    low[at] = low[at].min(order[of]);
                }
                continue;
            }
            path.pop();
            if let Some(&(above, _)) = path.last() {
                low[above] = low[above].min(low[at]);
            }
            if low[at] == order[at] {
                let from = open.iter().rposition(|&c| c == at).expect("it was put there");
                let mut component: Vec<usize> = open.split_off(from);
                component.sort_unstable();
                component.iter().for_each(|&c| done[c] = true);
                all.push(component);
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_block_needs_only_those_before_it() {
        // A hundred thousand columns in a chain: no stack is used up.
        let n = 100_000;
        let chain: Vec<Vec<usize>> = (0..n).map(|c| if c + 1 < n { vec![c + 1, c] } else { vec![c] }).collect();
        let found = blocks(&chain).unwrap();
        assert_eq!(found.len(), n);
        assert!(found.iter().enumerate().all(|(k, b)| b.rows == [k] && b.columns == [k]));
    }

    #[test]
    fn a_circle_is_one_block_and_a_column_without_a_row_is_singular() {
        assert_eq!(blocks(&[vec![0, 1], vec![1, 2], vec![2, 0]]).unwrap().len(), 1);
        assert_eq!(blocks(&[vec![0], vec![0]]), None);
        assert_eq!(blocks(&[]), Some(vec![]));
    }

    #[test]
    fn random_systems_are_in_block_triangular_form() {
        let mut seed = 1u64;
        let mut random = |below: usize| {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 33) as usize % below
        };
        for _ in 0..300 {
            let n = 1 + random(12);
            let rows_of: Vec<Vec<usize>> = (0..n)
                .map(|c| {
                    let mut rows: Vec<usize> = (0..random(3)).map(|_| random(n)).chain([(c * 5 + 3) % n]).collect();
                    rows.sort_unstable();
                    rows.dedup();
                    rows
                })
                .collect();
            let Some(found) = blocks(&rows_of) else { continue };
            let mut known = vec![false; n];
            for block in &found {
                assert_eq!(block.rows.len(), block.columns.len());
                block.columns.iter().for_each(|&c| known[c] = true);
                for &row in &block.rows {
                    let inside = (0..n).filter(|&c| rows_of[c].contains(&row));
                    assert!(inside.clone().all(|c| known[c]), "{rows_of:?} {found:?}");
                }
            }
            assert!(known.iter().all(|k| *k));
        }
    }
}
