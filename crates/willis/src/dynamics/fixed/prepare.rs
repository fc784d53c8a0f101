//! Modes beside those that a rehearsal met, made ready before they are needed.
//!
//! Under other inputs a run goes through other modes. From one that was met it leaves by one flip: a group comes to rest, is
//! released or turns round, the power of a mesh reverses, a shaft opens or touches.

use crate::dynamics::fused::Exactly;

use super::FixedStep;
use super::map::Key;
use super::shafts::{others, set_word};

/// Numbers in maps and fused steps that are made ready, at most: 16 MB.
const MOST_NUMBERS: usize = 1 << 21;

/// Meshes whose sides are turned in every combination, at most.
const MOST_TURNED: u32 = 4;

impl FixedStep {
    /// Prepares what lies one flip beside the modes met so far, those settled in first.
    pub(super) fn prepare_neighbours(&mut self) {
        let mut numbers = 0;
        let mut settled: Vec<Exactly> = self.by_exact_key.keys().copied().collect();
        settled.sort_unstable();
        for mode in settled {
            for other in self.beside(mode) {
                if numbers < MOST_NUMBERS {
                    numbers += self.prepare(other, true);
                }
            }
        }
        // Those only tried on the way to another.
        let mut tried: Vec<Key> = self.by_key.keys().copied().collect();
        tried.sort_unstable();
        for Key { held, coast, touch } in tried {
            let mode = Exactly { held, coast, touch, ..Exactly::default() };
            for other in self.beside(mode).into_iter().chain(self.whatever_drives(mode)) {
                if numbers < MOST_NUMBERS {
                    numbers += self.prepare(other, false);
                }
            }
        }
        let most = self.fused.iter().map(|fused| fused.rows).max().unwrap_or(0);
        for room in [&mut self.base, &mut self.least, &mut self.ends] {
            room.reserve(most.saturating_sub(room.len()));
        }
    }

    /// The modes one flip beside another.
    fn beside(&self, mode: Exactly) -> Vec<Exactly> {
        let mut all = Vec::new();
        for (g, group) in self.groups.iter().enumerate() {
            let bit = 1 << g;
            let forward =
                Exactly { held: mode.held & !bit, idle: mode.idle & !bit, forward: mode.forward | bit, ..mode };
            all.extend([forward, Exactly { forward: mode.forward & !bit, ..forward }]);
            if !group.driven {
                all.push(Exactly {
                    held: mode.held | bit,
                    idle: mode.idle & !bit,
                    forward: mode.forward & !bit,
                    ..mode
                });
            }
            if group.elements.is_empty() {
                all.push(Exactly {
                    held: mode.held & !bit,
                    idle: mode.idle | bit,
                    forward: mode.forward & !bit,
                    ..mode
                });
            }
        }
        all.extend((0..self.teeth.len()).map(|j| Exactly { coast: mode.coast ^ 1 << j, ..mode }));
        all.extend(others(mode.touch, self.shafts.len()).map(|touch| Exactly { touch, ..mode }));
        all.retain(|other| *other != mode);
        all
    }

    /// The mode with its meshes driven either way, if they are few: on the way to a mode they turn one after another.
    fn whatever_drives(&self, mode: Exactly) -> Vec<Exactly> {
        let moving = self.moving(mode.held);
        if moving.count_ones() > MOST_TURNED {
            return vec![];
        }
        // The subsets of a word, from the whole to none.
        let next = |coast: &u64| coast.checked_sub(1).map(|less| less & moving);
        std::iter::successors(Some(moving), next).map(|coast| Exactly { coast, ..mode }).collect()
    }

    /// The elements that move while these groups are held.
    fn moving(&self, held: u64) -> u64 {
        let moving = self.groups.iter().enumerate().filter(|(g, _)| held >> g & 1 == 0);
        moving.flat_map(|(_, group)| &group.elements).fold(0, |word, j| word | 1 << j)
    }

    /// Prepares a mode, with its fused step if asked for; how many numbers that takes.
    fn prepare(&mut self, mode: Exactly, fused: bool) -> usize {
        let key = Key { held: mode.held, coast: mode.coast & self.moving(mode.held), touch: mode.touch };
        set_word(&mut self.shafts, mode.touch);
        self.twist_shafts();
        let before = self.maps.len();
        self.last = None;
        let Some(map) = self.map(key) else { return 0 };
        let mut numbers = self.maps[before..].iter().map(|map| map.rows.len()).sum();
        let shares = self.groups.iter().enumerate().any(|(g, group)| mode.held >> g & 1 == 1 && group.shares);
        if fused && (!shares || self.maps[map as usize].is_redundant) {
            let before = self.fused.len();
            self.fused_of(map, mode);
            numbers += self.fused[before..].iter().map(|fused| fused.size()).sum::<usize>();
        }
        numbers
    }
}
