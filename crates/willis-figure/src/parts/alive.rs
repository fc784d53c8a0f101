//! What a mark of a picture stands for, so that programs find it: `data-*` attributes and an id that stays while numbers change.

use svg::Node;
use svg::node::element::Element;

use super::words;

/// What a mark stands for, by its name in the train.
#[derive(Clone, Copy)]
pub enum Of<'n> {
    /// A member or planet.
    Member(&'n str),
    /// A mesh, or a set of them.
    Mesh(&'n str),
    /// A shift element, shaft or variator.
    Element(&'n str),
    /// A state, an operating point, or what stands for one.
    State(&'n str),
    /// A number, by the name that answers give it.
    Quantity(&'n str),
}

impl<'n> Of<'n> {
    fn parts(self) -> (&'static str, &'n str) {
        match self {
            Self::Member(name) => ("member", name),
            Self::Mesh(name) => ("mesh", name),
            Self::Element(name) => ("element", name),
            Self::State(name) => ("state", name),
            Self::Quantity(name) => ("quantity", name),
        }
    }

    /// What a reader is told of it: names as they are, quantities in words.
    fn words(self) -> String {
        match self {
            Self::Quantity(name) => words::quantity(name),
            _ => self.parts().1.to_owned(),
        }
    }
}

/// A mark with what it stands for. Its id is made of the same names, behind a word that tells it from other marks of them. A
/// pointer that rests on it shows the names in full.
pub fn of<T: Node>(mark: T, word: &str, all: &[Of<'_>]) -> T {
    let title = all.iter().map(|one| one.words()).collect::<Vec<_>>().join(", ");
    told(mark, word, all, title)
}

/// The same, with other words for a pointer that rests on it.
pub fn told<T: Node>(mut mark: T, word: &str, all: &[Of<'_>], words: String) -> T {
    let mut id = word.to_owned();
    let mut title = Element::new("title");
    title.append(svg::node::Text::new(words));
    mark.append(title);
    for one in all {
        let (kind, name) = one.parts();
        mark.assign(format!("data-{kind}"), name);
        id.push('-');
        id.push_str(kind);
        id.push('-');
        // Neither blanks nor marks: anything else is written by its number.
        for c in name.chars() {
            match c {
                'a'..='z' | 'A'..='Z' | '0'..='9' => id.push(c),
                other => id.push_str(&format!("_{:x}_", other as u32)),
            }
        }
    }
    mark.assign("id", id);
    mark
}

/// A mark that stands for nothing of the train: frame, grid, or key to the signs.
pub fn guide<T: Node>(mut mark: T) -> T {
    mark.assign("class", "guide");
    mark
}

/// The mark of a gear contact, bearing or other part that is named `what` and loses or passes power.
pub fn part(kind: willis::hypergraph::NodeKind, name: &str) -> Of<'_> {
    use willis::hypergraph::NodeKind as Kind;
    match kind {
        Kind::Teeth => Of::Mesh(name),
        Kind::Member | Kind::Gear | Kind::Rotor | Kind::Input | Kind::Output => Of::Member(name),
        _ => Of::Element(name),
    }
}

#[cfg(test)]
mod tests {
    use svg::node::element::Group;

    use super::*;

    #[test]
    fn ids_tell_names_apart_and_have_no_blanks() {
        let id = |name| {
            let mark = of(Group::new(), "bar", &[Of::Member(name), Of::State("1")]).to_string();
            let at = mark.find("id=\"bar").expect("an id") + 4;
            mark[at..].split('"').next().unwrap_or_default().to_owned()
        };
        assert_eq!(id("sun 1"), "bar-member-sun_20_1-state-1");
        assert_ne!(id("a-b"), id("a_b"));
        assert!(!id("<太阳> \"x\"").contains([' ', '<', '"']));
    }
}
