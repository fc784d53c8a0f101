//! Ranges of whole numbers, as they are written in a design file: `"18..60 odd"`.

use std::fmt;
use std::str::FromStr;

use willis::diagnostic::{Code, Diagnostic};

/// The largest tooth number that a range may contain.
pub const MOST_TEETH: i64 = 10_000;

/// A set of whole numbers, such as the tooth numbers that a gear may have.
///
/// | text | numbers |
/// |---|---|
/// | `24` | 24 |
/// | `18..60` | 18 to 60, both included |
/// | `12..` | 12 and more, up to what the use of the range allows |
/// | `..120` | up to 120 |
/// | `18..60 odd`, `18..60 even` | the odd ones, the even ones |
/// | `23, 29, 31` | these three |
///
/// # Example
/// ```
/// use willis_synthesis::teeth::Counts;
///
/// let odd: Counts = "18..25 odd".parse().unwrap();
/// assert_eq!(odd.within(1, 100).collect::<Vec<_>>(), [19, 21, 23, 25]);
/// let open: Counts = "12..".parse().unwrap();
/// assert_eq!(open.within(1, 14).collect::<Vec<_>>(), [12, 13, 14]);
/// let wrong = "60..18".parse::<Counts>().unwrap_err();
/// assert_eq!(wrong.message, "`60..18` contains no number: 60 is above 18");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts {
    text: String,
    kind: Kind,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Kind {
    /// From, to, and every how many.
    Range { from: Option<i64>, to: Option<i64>, parity: Option<i64> },
    /// Ascending, without repetition.
    List(Vec<i64>),
}

impl Counts {
    /// All numbers from `from` to `to`.
    pub fn range(from: i64, to: i64) -> Self {
        let text = if from == to { from.to_string() } else { format!("{from}..{to}") };
        Self { text, kind: Kind::Range { from: Some(from), to: Some(to), parity: None } }
    }

    /// Exactly these numbers.
    pub fn list(numbers: impl IntoIterator<Item = i64>) -> Self {
        let mut list: Vec<i64> = numbers.into_iter().collect();
        list.sort_unstable();
        list.dedup();
        let text = list.iter().map(i64::to_string).collect::<Vec<_>>().join(", ");
        Self { text, kind: Kind::List(list) }
    }

    /// These numbers of a file, within the bounds of what a file may say.
    ///
    /// # Errors
    /// There is none, or one is beyond ±[`MOST_TEETH`].
    pub(crate) fn checked(numbers: Vec<i64>) -> Result<Self, Box<Diagnostic>> {
        if numbers.is_empty() {
            return Err(wrong("no range of whole numbers is given".into()));
        }
        match numbers.iter().find(|n| !(-MOST_TEETH..=MOST_TEETH).contains(*n)) {
            Some(n) => Err(wrong(format!("{n} is beyond ±{MOST_TEETH}"))),
            None => Ok(Self::list(numbers)),
        }
    }

    /// The only number, where there is only one.
    pub fn single(&self) -> Option<i64> {
        match &self.kind {
            Kind::List(list) if list.len() == 1 => Some(list[0]),
            Kind::Range { from: Some(a), to: Some(b), .. } if a == b => Some(*a),
            _ => None,
        }
    }

    /// Its numbers from `least` to `most`, ascending.
    pub fn within(&self, least: i64, most: i64) -> impl Iterator<Item = i64> + Clone + '_ {
        let (from, to, step, list): (i64, i64, i64, &[i64]) = match &self.kind {
            Kind::List(list) => (0, -1, 1, list),
            Kind::Range { from, to, parity } => {
                let from = from.unwrap_or(least).max(least);
                let to = to.unwrap_or(most).min(most);
                match parity {
                    Some(p) => (from + (p - from).rem_euclid(2), to, 2, &[]),
                    None => (from, to, 1, &[]),
                }
            }
        };
        let count = if to >= from { (to - from) / step + 1 } else { 0 };
        (0..count).map(move |k| from + k * step).chain(list.iter().copied().filter(move |z| (least..=most).contains(z)))
    }

    /// Whether a number is in it.
    pub fn contains(&self, number: i64) -> bool {
        match &self.kind {
            Kind::List(list) => list.binary_search(&number).is_ok(),
            Kind::Range { from, to, parity } => {
                from.is_none_or(|a| number >= a)
                    && to.is_none_or(|b| number <= b)
                    && parity.is_none_or(|p| number.rem_euclid(2) == p)
            }
        }
    }

    /// Its smallest number, where it has a lower end.
    pub fn least(&self) -> Option<i64> {
        match &self.kind {
            Kind::List(list) => list.first().copied(),
            Kind::Range { from, parity, .. } => from.map(|a| parity.map_or(a, |p| a + (p - a).rem_euclid(2))),
        }
    }

    /// Its largest number, where it has an upper end.
    pub fn most(&self) -> Option<i64> {
        match &self.kind {
            Kind::List(list) => list.last().copied(),
            Kind::Range { to, parity, .. } => to.map(|b| parity.map_or(b, |p| b - (b - p).rem_euclid(2))),
        }
    }

    /// Whether every number of a range from `from` to `to` is in it.
    pub(crate) fn is_gapless(&self) -> bool {
        match &self.kind {
            Kind::List(list) => list.windows(2).all(|w| w[1] == w[0] + 1),
            Kind::Range { parity, .. } => parity.is_none(),
        }
    }
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

fn wrong(message: String) -> Box<Diagnostic> {
    let hint = "write a number, `18..60`, `12..`, `..120`, `18..60 odd`, or a list such as `23, 29, 31`";
    Box::new(Diagnostic::new(Code::OutOfRange, "", message).hint(hint))
}

impl FromStr for Counts {
    type Err = Box<Diagnostic>;

    fn from_str(text: &str) -> Result<Self, Box<Diagnostic>> {
        let whole = text.trim();
        if whole.is_empty() || whole.len() > 1000 {
            return Err(wrong("no range of whole numbers is given".into()));
        }
        let (body, parity) = match whole.rsplit_once(char::is_whitespace) {
            Some((body, "odd")) => (body.trim_end(), Some(1)),
            Some((body, "even")) => (body.trim_end(), Some(0)),
            _ => (whole, None),
        };
        let number = |part: &str| -> Result<i64, Box<Diagnostic>> {
            match part.trim().parse::<i64>() {
                Ok(n) => Self::checked(vec![n]).map(|_| n),
                Err(_) => Err(wrong(format!("`{}` in `{whole}` is no whole number", part.trim()))),
            }
        };
        let kind = if let Some((from, to)) = body.split_once("..") {
            let end = |part: &str| -> Result<Option<i64>, Box<Diagnostic>> {
                let part = part.trim().trim_start_matches('=');
                if part.is_empty() { Ok(None) } else { number(part).map(Some) }
            };
            let (from, to) = (end(from)?, end(to)?);
            if let (Some(a), Some(b)) = (from, to)
                && a > b
            {
                return Err(wrong(format!("`{whole}` contains no number: {a} is above {b}")));
            }
            Kind::Range { from, to, parity }
        } else {
            let mut list = body.split(',').map(number).collect::<Result<Vec<_>, _>>()?;
            if let Some(p) = parity {
                list.retain(|z| z.rem_euclid(2) == p);
            }
            list.sort_unstable();
            list.dedup();
            Kind::List(list)
        };
        let counts = Self { text: whole.to_owned(), kind };
        let none = match (&counts.kind, counts.least(), counts.most()) {
            (Kind::List(list), ..) => list.is_empty(),
            (_, Some(a), Some(b)) => a > b,
            _ => false,
        };
        if none {
            return Err(wrong(format!("`{whole}` contains no number")));
        }
        Ok(counts)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(text: &str) -> Vec<i64> {
        text.parse::<Counts>().unwrap().within(1, 30).collect()
    }

    #[test]
    fn every_way_of_writing() {
        assert_eq!(all("24"), [24]);
        assert_eq!(all("18..=20"), [18, 19, 20]);
        assert_eq!(all("..3"), [1, 2, 3]);
        assert_eq!(all("28.. even"), [28, 30]);
        assert_eq!(all("9,3 , 5,3"), [3, 5, 9]);
        assert_eq!(all("3, 4, 5 odd"), [3, 5]);
        assert_eq!(Counts::list([5, 3]).within(4, 9).collect::<Vec<_>>(), [5]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        for (text, message) in [
            ("", "no range of whole numbers is given"),
            ("18..x", "`x` in `18..x` is no whole number"),
            ("1..99999", "99999 is beyond ±10000"),
            ("18..18 odd", "`18..18 odd` contains no number"),
            ("2, 4 odd", "`2, 4 odd` contains no number"),
        ] {
            assert_eq!(text.parse::<Counts>().unwrap_err().message, message);
        }
    }

    #[test]
    fn ends_and_members_agree() {
        for text in ["18..25 odd", "17..24 even", "5", "3, 8, 9", "2..7"] {
            let c: Counts = text.parse().unwrap();
            let all: Vec<i64> = c.within(-100, 100).collect();
            assert_eq!((c.least(), c.most()), (all.first().copied(), all.last().copied()), "{text}");
            assert!((-100..=100).all(|z| c.contains(z) == all.contains(&z)), "{text}");
        }
    }
}
