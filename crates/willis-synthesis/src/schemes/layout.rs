//! Layouts: which members of the sets are one shaft.

use std::collections::BTreeMap;
use std::fmt;

use serde::{Deserialize, Serialize};

/// The input shaft.
pub const INPUT: u8 = 0;
/// The output shaft.
pub const OUTPUT: u8 = 1;
/// The housing.
pub const GROUND: u8 = 2;
/// Sets that a layout may have.
pub const MAX_SETS: usize = 5;
/// Members that a layout may have.
pub(crate) const MAX_MEMBERS: usize = 3 * MAX_SETS;
/// Shafts that a layout may have, the housing included.
pub(crate) const MAX_SHAFTS: usize = MAX_MEMBERS + 3;

/// The permanent connections of a train of simple planetary sets: the shaft of every member.
///
/// Members are counted sun, ring, carrier, set by set. Shaft 0 is the input, 1 the output, 2 the housing; other shafts are
/// numbered in the order in which they appear. So a layout has one name, the string of its shaft numbers, and two
/// different names are two different layouts.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::Layout;
///
/// let allison: Layout = "034546561".parse()?;
/// assert_eq!((allison.sets(), allison.shafts()), (3, 7));
/// assert_eq!(allison.to_string(), "034546561");
/// // Sun and ring of one set cannot be one shaft.
/// assert!("330".parse::<Layout>().is_err());
/// # Ok::<(), willis_synthesis::schemes::NoLayout>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Layout {
    blocks: [u8; MAX_MEMBERS],
    members: u8,
    /// Shafts with the housing.
    shafts: u8,
}

/// Why a text is no layout.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoLayout(String);

impl fmt::Display for NoLayout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for NoLayout {}

impl Layout {
    /// The layout in which member `m` belongs to shaft `blocks[m]`; new shafts are renumbered in the order in which they
    /// appear.
    ///
    /// # Errors
    /// The number of members is not that of one to five sets, or two members of a set are in one shaft.
    pub fn new(blocks: &[u8]) -> Result<Self, NoLayout> {
        if blocks.is_empty() || blocks.len() > MAX_MEMBERS || !blocks.len().is_multiple_of(3) {
            let found = blocks.len();
            return Err(NoLayout(format!("a layout has three members for each of 1 to {MAX_SETS} sets, not {found}")));
        }
        for (set, three) in blocks.chunks(3).enumerate() {
            if three[0] == three[1] || three[1] == three[2] || three[0] == three[2] {
                return Err(NoLayout(format!("two members of set {} are in one shaft", set + 1)));
            }
        }
        let mut names: Vec<u8> = vec![INPUT, OUTPUT, GROUND];
        let mut own = [0; MAX_MEMBERS];
        for (m, block) in blocks.iter().enumerate() {
            let at = names.iter().position(|n| n == block).unwrap_or_else(|| {
                names.push(*block);
                names.len() - 1
            });
            own[m] = at as u8;
        }
        Ok(Self { blocks: own, members: blocks.len() as u8, shafts: names.len() as u8 })
    }

    /// Sets of the train.
    pub fn sets(&self) -> usize {
        usize::from(self.members) / 3
    }

    /// Shafts, with input, output and housing, whether or not a member belongs to them.
    pub fn shafts(&self) -> usize {
        usize::from(self.shafts)
    }

    /// The shaft of every member: sun, ring, carrier, set by set.
    pub fn blocks(&self) -> &[u8] {
        &self.blocks[..usize::from(self.members)]
    }

    /// The same train with its sets in another order: set `j` of the result is set `order[j]` of this one.
    pub(crate) fn reordered(&self, order: &[usize]) -> (Self, [u8; MAX_SHAFTS]) {
        let mut renamed = [u8::MAX; MAX_SHAFTS];
        (renamed[0], renamed[1], renamed[2]) = (INPUT, OUTPUT, GROUND);
        let (mut blocks, mut next) = ([0; MAX_MEMBERS], 3);
        for (to, from) in order.iter().enumerate() {
            for part in 0..3 {
                let name = &mut renamed[usize::from(self.blocks[3 * from + part])];
                if *name == u8::MAX {
                    *name = next;
                    next += 1;
                }
                blocks[3 * to + part] = *name;
            }
        }
        (Self { blocks, ..*self }, renamed)
    }
}

/// Shaft numbers above 9 are letters: a layout of five sets has up to 18 shafts.
impl fmt::Display for Layout {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.blocks().iter().try_for_each(|b| write!(f, "{}", shaft_digit(*b)))
    }
}

/// The digit or letter of a shaft number.
pub(crate) fn shaft_digit(block: u8) -> char {
    char::from_digit(u32::from(block), 36).unwrap_or('?')
}

impl std::str::FromStr for Layout {
    type Err = NoLayout;

    fn from_str(text: &str) -> Result<Self, NoLayout> {
        let digit = |c: char| {
            let value = c.to_digit(36).ok_or_else(|| NoLayout(format!("`{c}` is no shaft number")))?;
            Ok(value as u8)
        };
        Self::new(&text.chars().map(digit).collect::<Result<Vec<u8>, NoLayout>>()?)
    }
}

impl Serialize for Layout {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Layout {
    fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(serde::de::Error::custom)
    }
}

#[cfg(feature = "schema")]
impl schemars::JsonSchema for Layout {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        "Layout".into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "string", "pattern": "^([0-9a-h]{3}){1,5}$" })
    }
}

/// How many layouts of so many sets there are, by their number of shafts besides the housing.
///
/// Of the three members of the next set, j go to old shafts, in `C(3,j) b!/(b-j)!` ways where there are b shafts, and the
/// others are new shafts. This is a recursion over numbers and walks no layout.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::count_layouts;
///
/// assert_eq!(count_layouts(2)[&5], 882);
/// assert_eq!(count_layouts(4)[&8], 18_428_400);
/// assert_eq!(count_layouts(5).values().sum::<u128>(), 66_653_198_353);
/// ```
pub fn count_layouts(sets: usize) -> BTreeMap<usize, u128> {
    let mut counts = BTreeMap::from([(2, 1_u128)]);
    for _ in 0..sets {
        let mut next = BTreeMap::new();
        for (shafts, count) in counts {
            for old in 0..=3_usize {
                let choices = [1, 3, 3, 1][old];
                let placed: u128 = (0..old).map(|j| (shafts + 1 - j) as u128).product();
                *next.entry(shafts + 3 - old).or_insert(0) += count * choices * placed;
            }
        }
        counts = next;
    }
    counts
}

/// A stretch of the space of layouts: all that begin alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Prefix {
    blocks: [u8; MAX_MEMBERS],
    given: usize,
    /// Shafts with the housing.
    next: u8,
}

impl Prefix {
    const EMPTY: Self = Self { blocks: [0; MAX_MEMBERS], given: 0, next: 3 };

    /// Whether a layout belongs to it.
    pub fn holds(&self, layout: &Layout) -> bool {
        layout.blocks().starts_with(&self.blocks[..self.given])
    }
}

/// Layouts of so many sets and of so many shafts besides the housing, in the order of their names.
///
/// # Example
/// ```
/// use willis_synthesis::schemes::Layouts;
///
/// let space = Layouts::new(2, 5);
/// let mut names = vec![];
/// for prefix in space.prefixes(3) {
///     space.walk(&prefix, &mut |layout| { names.push(layout.to_string()); true });
/// }
/// assert_eq!(names.len(), 882);
/// assert!(names.is_sorted());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layouts {
    members: usize,
    /// Shafts with the housing.
    shafts: u8,
    /// Shafts that have a name of their own, the first ones.
    terminals: u8,
}

impl Layouts {
    /// All with so many sets, up to five, and so many shafts besides the housing.
    pub fn new(sets: usize, shafts: usize) -> Self {
        Self::with_terminals(sets, shafts, 3)
    }

    /// The same where so many shafts, the housing included, have names of their own and are numbered first.
    pub(crate) fn with_terminals(sets: usize, shafts: usize, terminals: u8) -> Self {
        let shafts = (shafts.min(MAX_SHAFTS - 1) + 1) as u8;
        Self { members: 3 * sets.min(MAX_SETS), shafts, terminals }
    }

    /// The space in stretches, each the layouts with the same shafts of the first `given` members.
    pub fn prefixes(&self, given: usize) -> Vec<Prefix> {
        let mut all = vec![];
        let given = given.min(self.members);
        self.descend(&mut Prefix { next: self.terminals, ..Prefix::EMPTY }, given, &mut |p| {
            all.push(*p);
            true
        });
        all
    }

    /// Calls `visit` with every layout of a stretch, until it says false. Returns whether it never did.
    pub fn walk(&self, prefix: &Prefix, visit: &mut dyn FnMut(&Layout) -> bool) -> bool {
        let (members, shafts) = (self.members as u8, self.shafts);
        self.descend(&mut prefix.clone(), self.members, &mut |p| visit(&Layout { blocks: p.blocks, members, shafts }))
    }

    fn descend(&self, at: &mut Prefix, depth: usize, visit: &mut dyn FnMut(&Prefix) -> bool) -> bool {
        let left = self.members - at.given;
        if usize::from(at.next) + left < usize::from(self.shafts) {
            return true;
        }
        if at.given == depth {
            return visit(at);
        }
        let (m, next) = (at.given, at.next);
        let before = m - m % 3;
        at.given += 1;
        for block in 0..=next.min(self.shafts - 1) {
            if at.blocks[before..m].contains(&block) {
                continue;
            }
            at.blocks[m] = block;
            at.next = next.max(block + 1);
            if !self.descend(at, depth, visit) {
                return false;
            }
        }
        at.blocks[m] = 0;
        at.next = next;
        at.given = m;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn walked_layouts_are_as_many_as_the_recursion_says() {
        for sets in 1..=3 {
            for (shafts, count) in count_layouts(sets) {
                let space = Layouts::new(sets, shafts);
                for given in [0, 3, 4] {
                    let mut walked = 0;
                    for prefix in space.prefixes(given) {
                        space.walk(&prefix, &mut |layout| {
                            assert!(prefix.holds(layout));
                            assert_eq!(layout.shafts(), shafts + 1);
                            walked += 1;
                            true
                        });
                    }
                    assert_eq!(walked, count, "{sets} sets, {shafts} shafts");
                }
            }
        }
    }

    /// Every assignment of members to shafts, with no thought of order, renamed and counted once.
    #[test]
    fn layouts_are_all_assignments_up_to_names() {
        let mut seen = std::collections::BTreeSet::new();
        for code in 0..9_u32.pow(6) {
            let blocks: Vec<u8> = (0..6).map(|m| (code / 9_u32.pow(m) % 9) as u8).collect();
            seen.extend(Layout::new(&blocks).ok());
        }
        assert_eq!(seen.len() as u128, count_layouts(2).values().sum::<u128>());
    }
}
