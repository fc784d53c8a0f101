//! REXS as JSON (`.rexsj`).
//!
//! Values become components as they are met: what nobody reads is skipped and takes no memory.

use std::fmt;

use serde::de::{Deserialize, DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};

use crate::document::{
    Attribute, Budget, Component, Document, LONG_LIST, LoadCase, MOST_LISTED, Relation, Value, word,
};

/// Reads the text of a file.
///
/// # Errors
/// Why it is no REXS file at all.
pub fn read(text: &str) -> Result<Document, String> {
    let mut file = File::default();
    // The reader bounds how deep values are nested.
    let mut json = serde_json::Deserializer::from_str(text);
    let done = Seed(&mut Whole(&mut file)).deserialize(&mut json).and_then(|()| json.end());
    if let Some(why) = file.refused {
        return Err(why);
    }
    done.map_err(|e| format!("it is no JSON: {e}"))?;
    if !file.has_model {
        return Err("it has no object `model`".into());
    }
    file.document.application = format!("{} {}", file.program[0], file.program[1]).trim().to_owned();
    Ok(file.document)
}

/// What is read so far.
#[derive(Default)]
struct File {
    document: Document,
    budget: Budget,
    has_model: bool,
    /// The program that wrote it, and its version.
    program: [String; 2],
    /// The bound that it does not keep.
    refused: Option<String>,
}

impl File {
    fn bounded<E: Error>(&mut self, count: fn(&mut Budget) -> Result<(), String>) -> Result<(), E> {
        count(&mut self.budget).map_err(|why| {
            self.refused = Some(why.clone());
            E::custom(why)
        })
    }
}

/// A value that is read where it has the right form; one of another form counts as empty.
trait Part<'de> {
    /// It is an object.
    fn met(&mut self) {}

    /// A key of it.
    fn key<A: MapAccess<'de>>(&mut self, _: &str, map: &mut A) -> Result<(), A::Error> {
        map.next_value::<IgnoredAny>().map(drop)
    }

    /// The values of a list.
    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        while list.next_element::<IgnoredAny>()?.is_some() {}
        Ok(())
    }
}

struct Seed<'p, P>(&'p mut P);

impl<'de, P: Part<'de>> DeserializeSeed<'de> for Seed<'_, P> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, from: D) -> Result<(), D::Error> {
        from.deserialize_any(self)
    }
}

impl<'de, P: Part<'de>> Visitor<'de> for Seed<'_, P> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any value")
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_u64<E>(self, _: u64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<(), A::Error> {
        self.0.items(&mut list)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        self.0.met();
        while let Some(key) = map.next_key::<String>()? {
            self.0.key(&key, &mut map)?;
        }
        Ok(())
    }
}

struct Whole<'f>(&'f mut File);

impl<'de> Part<'de> for Whole<'_> {
    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        match key {
            "model" => map.next_value_seed(Seed(&mut Model(self.0))),
            _ => map.next_value::<IgnoredAny>().map(drop),
        }
    }
}

struct Model<'f>(&'f mut File);

impl<'de> Part<'de> for Model<'_> {
    fn met(&mut self) {
        self.0.has_model = true;
    }

    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        let file = &mut *self.0;
        match key {
            "version" => file.document.version = map.next_value::<Held>()?.word(),
            "date" => file.document.date = map.next_value::<Held>()?.word(),
            "applicationId" => file.program[0] = map.next_value::<Held>()?.word(),
            "applicationVersion" => file.program[1] = map.next_value::<Held>()?.word(),
            "relations" => map.next_value_seed(Seed(&mut Relations(file)))?,
            "components" => map.next_value_seed(Seed(&mut Components(file)))?,
            "load_spectrum" => map.next_value_seed(Seed(&mut Spectrum(file)))?,
            _ => drop(map.next_value::<IgnoredAny>()?),
        }
        Ok(())
    }
}

struct Relations<'f>(&'f mut File);

impl<'de> Part<'de> for Relations<'_> {
    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        loop {
            let mut part = RelationPart { file: self.0, relation: Relation::default() };
            if list.next_element_seed(Seed(&mut part))?.is_none() {
                return Ok(());
            }
            let relation = part.relation;
            self.0.bounded(Budget::entry)?;
            self.0.document.relations.push(relation);
        }
    }
}

struct RelationPart<'f> {
    file: &'f mut File,
    relation: Relation,
}

impl<'de> Part<'de> for RelationPart<'_> {
    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        match key {
            "id" => self.relation.id = map.next_value::<Held>()?.number().unwrap_or_default(),
            "type" => self.relation.kind = map.next_value::<Held>()?.word(),
            "refs" => map.next_value_seed(Seed(&mut Refs(self.file, &mut self.relation)))?,
            _ => drop(map.next_value::<IgnoredAny>()?),
        }
        Ok(())
    }
}

struct Refs<'f>(&'f mut File, &'f mut Relation);

impl<'de> Part<'de> for Refs<'_> {
    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        loop {
            let mut part = Ref::default();
            if list.next_element_seed(Seed(&mut part))?.is_none() {
                return Ok(());
            }
            self.0.bounded(Budget::attribute)?;
            match part.id {
                Some(id) => self.1.refs.push((part.role, id)),
                None => {
                    let place = format!("model.relations[{}]", self.0.document.relations.len());
                    self.0.document.odd(place, "a reference has no number of a component (`id`)");
                }
            }
        }
    }
}

#[derive(Default)]
struct Ref {
    id: Option<i64>,
    role: String,
}

impl<'de> Part<'de> for Ref {
    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        match key {
            "id" => self.id = map.next_value::<Held>()?.number(),
            "role" => self.role = map.next_value::<Held>()?.word(),
            _ => drop(map.next_value::<IgnoredAny>()?),
        }
        Ok(())
    }
}

struct Components<'f>(&'f mut File);

impl<'de> Part<'de> for Components<'_> {
    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        for k in 0.. {
            let place = || format!("model.components[{k}]");
            let Some(component) = component(self.0, list, &place)? else { break };
            self.0.document.components.extend(component);
        }
        Ok(())
    }
}

/// One spectrum, or a list of them.
struct Spectrum<'f>(&'f mut File);

impl<'de> Part<'de> for Spectrum<'_> {
    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        match key {
            "load_cases" => map.next_value_seed(Seed(&mut Cases(self.0))),
            _ => map.next_value::<IgnoredAny>().map(drop),
        }
    }

    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        while list.next_element_seed(Seed(&mut Spectrum(self.0)))?.is_some() {}
        Ok(())
    }
}

struct Cases<'f>(&'f mut File);

impl<'de> Part<'de> for Cases<'_> {
    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        loop {
            let mut part = CasePart { file: self.0, case: LoadCase::default() };
            if list.next_element_seed(Seed(&mut part))?.is_none() {
                return Ok(());
            }
            let case = part.case;
            self.0.bounded(Budget::entry)?;
            self.0.document.cases.push(case);
        }
    }
}

struct CasePart<'f> {
    file: &'f mut File,
    case: LoadCase,
}

impl<'de> Part<'de> for CasePart<'_> {
    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        match key {
            "id" => self.case.id = map.next_value::<Held>()?.number().unwrap_or_default(),
            "components" => map.next_value_seed(Seed(&mut CaseComponents(self.file, &mut self.case)))?,
            _ => drop(map.next_value::<IgnoredAny>()?),
        }
        Ok(())
    }
}

struct CaseComponents<'f>(&'f mut File, &'f mut LoadCase);

impl<'de> Part<'de> for CaseComponents<'_> {
    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        let case = self.0.document.cases.len();
        for k in 0.. {
            let place = || format!("load_cases[{case}].components[{k}]");
            let Some(component) = component(self.0, list, &place)? else { break };
            self.1.components.extend(component);
        }
        Ok(())
    }
}

/// The next component of a list: none at its end, and none in that if it has no number.
fn component<'de, A: SeqAccess<'de>>(
    file: &mut File,
    list: &mut A,
    place: &dyn Fn() -> String,
) -> Result<Option<Option<Component>>, A::Error> {
    let mut part = ComponentPart { file, component: Component::default(), id: None };
    if list.next_element_seed(Seed(&mut part))?.is_none() {
        return Ok(None);
    }
    let ComponentPart { file, mut component, id } = part;
    file.bounded(Budget::entry)?;
    let Some(id) = id else {
        file.document.odd(place(), "a component has no number (`id`) and is left out");
        return Ok(Some(None));
    };
    component.id = id;
    Ok(Some(Some(component)))
}

struct ComponentPart<'f> {
    file: &'f mut File,
    component: Component,
    id: Option<i64>,
}

impl<'de> Part<'de> for ComponentPart<'_> {
    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        match key {
            "id" => self.id = map.next_value::<Held>()?.number(),
            "type" => self.component.kind = map.next_value::<Held>()?.word(),
            "name" => self.component.name = map.next_value::<Held>()?.word(),
            "attributes" => map.next_value_seed(Seed(&mut Attributes(self.file, &mut self.component)))?,
            _ => drop(map.next_value::<IgnoredAny>()?),
        }
        Ok(())
    }
}

struct Attributes<'f>(&'f mut File, &'f mut Component);

impl<'de> Part<'de> for Attributes<'_> {
    fn items<A: SeqAccess<'de>>(&mut self, list: &mut A) -> Result<(), A::Error> {
        loop {
            let mut part = AttributePart::default();
            if list.next_element_seed(Seed(&mut part))?.is_none() {
                return Ok(());
            }
            self.0.bounded(Budget::attribute)?;
            let value = part.value.unwrap_or(Value::Text(String::new()));
            self.1.attributes.push(Attribute { id: part.id, unit: part.unit, value });
        }
    }
}

#[derive(Default)]
struct AttributePart {
    id: String,
    unit: String,
    value: Option<Value>,
}

impl<'de> Part<'de> for AttributePart {
    fn key<A: MapAccess<'de>>(&mut self, key: &str, map: &mut A) -> Result<(), A::Error> {
        match key {
            "id" => self.id = map.next_value::<Held>()?.word(),
            "unit" => self.unit = map.next_value::<Held>()?.word(),
            // The key says of which type the value is, as the value does itself.
            _ if self.value.is_none() => self.value = Some(map.next_value::<Held>()?.value()),
            _ => drop(map.next_value::<IgnoredAny>()?),
        }
        Ok(())
    }
}

/// A value of any form, without what is too long to be used.
enum Held {
    Nothing,
    Flag(bool),
    Whole(i64),
    Number(f64),
    Text(String),
    List(Value),
    Object,
}

impl Held {
    fn word(self) -> String {
        if let Self::Text(text) = self { text } else { String::new() }
    }

    /// A whole number, also where it is written as `17.0` or `"17"`.
    fn number(&self) -> Option<i64> {
        match self {
            Self::Whole(x) => Some(*x),
            Self::Number(x) => (x.fract() == 0.0 && x.abs() < 9e15).then_some(*x as i64),
            Self::Text(text) => text.trim().parse().ok(),
            _ => None,
        }
    }

    fn value(self) -> Value {
        match self {
            Self::Nothing => Value::Text(String::new()),
            Self::Flag(x) => Value::Flag(x),
            Self::Whole(x) => Value::Number(x as f64),
            Self::Number(x) => Value::Number(x),
            Self::Text(text) => Value::of_text(&text),
            Self::List(value) => value,
            Self::Object => Value::Other("a coded array"),
        }
    }
}

impl<'de> Deserialize<'de> for Held {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(HeldVisitor)
    }
}

struct HeldVisitor;

impl<'de> Visitor<'de> for HeldVisitor {
    type Value = Held;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("any value")
    }

    fn visit_bool<E>(self, x: bool) -> Result<Held, E> {
        Ok(Held::Flag(x))
    }

    fn visit_i64<E>(self, x: i64) -> Result<Held, E> {
        Ok(Held::Whole(x))
    }

    fn visit_u64<E>(self, x: u64) -> Result<Held, E> {
        Ok(i64::try_from(x).map_or(Held::Number(x as f64), Held::Whole))
    }

    fn visit_f64<E>(self, x: f64) -> Result<Held, E> {
        Ok(Held::Number(x))
    }

    fn visit_str<E>(self, text: &str) -> Result<Held, E> {
        Ok(Held::Text(word(text)))
    }

    fn visit_unit<E>(self) -> Result<Held, E> {
        Ok(Held::Nothing)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Held, A::Error> {
        let (mut numbers, mut flags, mut many) = (vec![], vec![], 0);
        while many < MOST_LISTED {
            let Some(item) = list.next_element::<Held>()? else { break };
            many += 1;
            match item {
                Held::Whole(x) => numbers.push(x as f64),
                Held::Number(x) => numbers.push(x),
                Held::Flag(x) => flags.push(x),
                _ => {}
            }
        }
        let mut more = false;
        while many == MOST_LISTED && list.next_element::<IgnoredAny>()?.is_some() {
            more = true;
        }
        Ok(Held::List(if more {
            Value::Other(LONG_LIST)
        } else if numbers.len() == many {
            Value::Numbers(numbers)
        } else if flags.len() == many {
            Value::Flags(flags)
        } else {
            Value::Other("a list or a matrix")
        }))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Held, A::Error> {
        while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(Held::Object)
    }
}
