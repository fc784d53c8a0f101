//! Transmissions that are known, to be found again.

use serde::{Deserialize, Serialize};

use super::layout::Layout;
use super::scheme::Scheme;
use super::search::Search;

/// A known transmission as a scheme.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Known {
    /// By what it is asked for: `allison-2000`.
    pub id: &'static str,
    /// What it is called.
    pub name: &'static str,
    /// Where its connections come from.
    pub source: &'static str,
    /// Its tooth ratios, ring/sun.
    pub sets: &'static [&'static str],
    layout: &'static str,
    elements: &'static [[u8; 2]],
    /// Closed elements in a gear, forward gears.
    pub closed: usize,
    /// Forward gears.
    pub forward: usize,
}

/// All of them. Elements are pairs of shaft digits of the layout.
pub static KNOWN: &[Known] = &[
    Known {
        id: "gm-440-t4",
        name: "GM 440-T4 (4T60)",
        source: "front-wheel-drive automatic of 1984, two simple sets; teeth 62/26 and 74/42",
        sets: &["62/26", "74/42"],
        layout: "314541",
        elements: &[[0, 3], [0, 4], [2, 3], [2, 5], [2, 4]],
        closed: 2,
        forward: 4,
    },
    Known {
        id: "allison-2000",
        name: "Allison 2000",
        source: "six-speed automatic for trucks, three simple sets; teeth 109/67, 91/49, 97/39",
        sets: &["109/67", "91/49", "97/39"],
        layout: "034546561",
        elements: &[[0, 5], [0, 6], [2, 3], [2, 4], [2, 6]],
        closed: 2,
        forward: 6,
    },
    Known {
        id: "zf-8hp70",
        name: "ZF 8HP70",
        source: "eight-speed automatic of 2008, four simple sets; teeth 96/48, 96/48, 111/69, 85/23",
        sets: &["96/48", "96/48", "111/69", "85/23"],
        layout: "345360678751",
        elements: &[[0, 7], [1, 8], [2, 3], [2, 4], [6, 7]],
        closed: 3,
        forward: 8,
    },
];

/// Tooth ratios, ring/sun, for so many sets where nothing is said of them: those of the known transmission with as many sets;
/// of one set, the first of two; of five, the four of the ZF 8HP70 and a set of 91/49.
pub fn usual_ratios(sets: usize) -> &'static [&'static str] {
    match sets {
        1 => &["62/26"],
        2 => KNOWN[0].sets,
        3 => KNOWN[1].sets,
        4 => KNOWN[2].sets,
        5 => &["96/48", "96/48", "111/69", "85/23", "91/49"],
        _ => &[],
    }
}

/// Whether a known transmission is among the schemes that are wanted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Rediscovered {
    /// What it is called.
    pub name: String,
    /// Where its connections come from.
    pub source: String,
    /// Whether it does what is wanted, with the tooth ratios of the wish.
    pub found: bool,
    /// Where it stands among the schemes that are shown, from 1, if it is one of them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub row: Option<usize>,
    /// As a scheme of the space that was searched, if it does.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scheme: Option<Scheme>,
}

impl Known {
    /// The transmission with this name, or the only one whose name begins so.
    pub fn named(name: &str) -> Option<&'static Self> {
        let name = name.to_lowercase();
        let exact = KNOWN.iter().find(|k| k.id == name);
        exact.or_else(|| {
            let mut all =
                KNOWN.iter().filter(|k| k.id.split('-').any(|part| part.starts_with(&name)) || k.id.starts_with(&name));
            all.next().filter(|_| all.next().is_none() && !name.is_empty())
        })
    }

    /// Its layout.
    pub fn layout(&self) -> Option<Layout> {
        self.layout.parse().ok()
    }

    /// Its elements, as pairs of shafts of the layout.
    pub fn elements(&self) -> &'static [[u8; 2]] {
        self.elements
    }

    /// The layout and elements with the sets in another order.
    fn reordered(&self, order: &[usize]) -> Option<(Layout, Vec<[u8; 2]>)> {
        let (layout, renamed) = self.layout()?.reordered(order);
        let mut elements: Vec<[u8; 2]> =
            self.elements.iter().map(|e| e.map(|s| renamed[usize::from(s)].min(35))).collect();
        elements.iter_mut().for_each(|e| e.sort_unstable());
        elements.sort_unstable();
        Some((layout, elements))
    }

    /// Looks for it in the space of a search: its layout, with its sets in every order, and its elements.
    ///
    /// # Example
    /// ```
    /// use willis_synthesis::schemes::{Known, Search, Wish};
    ///
    /// let wish = Wish { step: "1.1..2.2".parse()?, ..Wish::new(&["109/67", "91/49", "97/39"], 5, 2, 6)? };
    /// let allison = Known::named("allison").unwrap();
    /// assert!(allison.rediscover(&Search::new(&wish)?).found);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn rediscover(&self, search: &Search) -> Rediscovered {
        let scheme = orders(self.sets.len()).into_iter().find_map(|order| {
            let (layout, elements) = self.reordered(&order)?;
            let mut scheme =
                search.is_scheme(&layout, &elements).then(|| Scheme::new(search.wish(), layout, &elements))??;
            scheme.known = Some(self.name.to_owned());
            Some(scheme)
        });
        Rediscovered { name: self.name.into(), source: self.source.into(), found: scheme.is_some(), row: None, scheme }
    }

    /// What a scheme with these elements is called, if it is known.
    pub(crate) fn of(layout: &Layout, elements: &[[u8; 2]]) -> Option<&'static str> {
        let same = |k: &&Self| {
            k.sets.len() == layout.sets()
                && k.elements.len() == elements.len()
                && orders(k.sets.len())
                    .iter()
                    .any(|order| k.reordered(order).is_some_and(|(l, e)| l == *layout && e == elements))
        };
        KNOWN.iter().find(same).map(|k| k.name)
    }
}

/// All orders of so many sets, the given one first.
fn orders(sets: usize) -> Vec<Vec<usize>> {
    let mut all = vec![vec![]];
    for _ in 0..sets {
        all = all
            .into_iter()
            .flat_map(|order: Vec<usize>| {
                let left: Vec<usize> = (0..sets).filter(|s| !order.contains(s)).collect();
                left.into_iter().map(move |s| order.iter().copied().chain([s]).collect())
            })
            .collect();
    }
    all
}
