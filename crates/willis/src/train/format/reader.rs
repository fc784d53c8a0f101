//! Checks a TOML document against [`keys`](super::keys) and keeps where everything stood.

use std::collections::{BTreeMap, HashMap};
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeArray, DeTable, DeValue};

use crate::diagnostic::{Code, Diagnostic, Diagnostics, is_printable};
use crate::exact::Rational;
use crate::train::words::clip;
use crate::units::{self, Dimension, Quantity, QuantityFault};

use super::keys::{FREE, Kind, Measure, SignalKind, Table, about};
use super::node::{Amount, Datum, Directed, Fields, Node};
use super::synonyms;

/// Where each place of the document stands in the text.
#[derive(Clone, Debug, Default)]
pub(crate) struct Spans {
    /// The places, one after the other.
    places: String,
    /// Where each of them ends there, and where it stands in the document.
    all: Vec<(usize, Range<usize>)>,
}

impl Spans {
    fn add(&mut self, place: &str, span: Range<usize>) {
        self.places.push_str(place);
        self.all.push((self.places.len(), span));
    }

    /// All of them, to look many up.
    pub fn index(&self) -> SpanIndex<'_> {
        let starts = std::iter::once(0).chain(self.all.iter().map(|(end, _)| *end));
        SpanIndex(starts.zip(&self.all).map(|(start, (end, span))| (&self.places[start..*end], span)).collect())
    }
}

/// Where each place stands, by its name.
pub(crate) struct SpanIndex<'s>(HashMap<&'s str, &'s Range<usize>>);

impl SpanIndex<'_> {
    /// The span of a place, or of the smallest thing around it that has one.
    pub fn nearest(&self, place: &str) -> Option<Range<usize>> {
        let mut place = place;
        loop {
            if let Some(span) = self.0.get(place) {
                return Some((*span).clone());
            }
            place = &place[..place.rfind(['.', '['])?];
        }
    }
}

pub(crate) fn read(text: &str, table: &Table, diagnostics: &mut Diagnostics) -> (Fields, Spans) {
    // Recovering from error after error takes time that grows with the square of the garbage.
    const MOST_RECOVERED: usize = 1 << 16;
    const MOST_ERRORS: usize = 20;
    let (root, errors) = if text.len() <= MOST_RECOVERED {
        DeTable::parse_recoverable(text)
    } else {
        match DeTable::parse(text) {
            Ok(root) => (root, vec![]),
            Err(error) => (Spanned::new(0..0, DeTable::new()), vec![error]),
        }
    };
    for error in errors.iter().take(MOST_ERRORS) {
        let mut d = Diagnostic::new(Code::Syntax, "", error.message().trim().replace('\n', ", "));
        d.span = error.span().map(|s| (s.start.min(text.len())..s.end.min(text.len())).into());
        let comma = d.span.and_then(|span| decimal_comma(text, span.start));
        diagnostics.push(match comma {
            Some(number) => d.hint(format!("the decimal sign is a decimal point: write {number}")),
            None => d.hint("strings need quotes; tables are `[[set]]`, inline tables `{ key = value }`"),
        });
    }
    let mut reader = Reader { diagnostics, spans: Spans::default() };
    if !errors.is_empty() {
        return (Fields::default(), reader.spans);
    }
    let fields = reader.table(root.get_ref(), table, "", 0..text.len().min(1), None);
    (fields, reader.spans)
}

/// The number that is meant in the line of a syntax error, if a decimal comma is the cause: `backlash = 20,5`.
fn decimal_comma(text: &str, at: usize) -> Option<String> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |k| k + 1);
    let numeric = |c: char| c.is_ascii_digit() || matches!(c, ',' | '.' | '+' | '-');
    text[start..].lines().next()?.split('=').skip(1).find_map(|value| {
        let value = value.trim_start();
        let end = value.find(|c| !numeric(c)).unwrap_or(value.len());
        units::decimal_point(value[..end].trim_end_matches(','))
    })
}

/// The checked keys of a table that comes by other ways than a text.
pub(crate) fn fields(datum: &Datum, table: &Table) -> Result<Fields, Diagnostics> {
    let text = format!("table = {}", datum.inline());
    let mut diagnostics = Diagnostics::default();
    let mut reader = Reader { diagnostics: &mut diagnostics, spans: Spans::default() };
    let root = DeTable::parse(&text).map_err(|e| {
        let d = Diagnostic::new(Code::Syntax, "", e.message().trim().replace('\n', ", "));
        [d].into_iter().collect::<Diagnostics>()
    })?;
    let value = root.get_ref().get("table").expect("it was written so");
    let fields = match value.get_ref().as_table() {
        Some(map) => reader.table(map, table, "", value.span(), None),
        None => {
            reader.wrong_type("", value, "a table");
            Fields::default()
        }
    };
    if diagnostics.has_errors() { Err(diagnostics) } else { Ok(fields) }
}

struct Reader<'d> {
    diagnostics: &'d mut Diagnostics,
    spans: Spans,
}

type Value<'i> = Spanned<DeValue<'i>>;

impl Reader<'_> {
    fn report(&mut self, code: Code, place: &str, message: String, hint: impl Into<String>) {
        let hint = hint.into();
        let d = Diagnostic::new(code, place, message);
        self.diagnostics.push(if hint.is_empty() { d } else { d.hint(hint) });
    }

    fn wrong_type(&mut self, place: &str, value: &Value<'_>, wanted: &str) {
        let found = describe(value.get_ref());
        let key = place.rsplit('.').next().unwrap_or(place);
        self.report(Code::WrongType, place, format!("`{}` takes {wanted}, here is {found}", clip(key)), "");
    }

    /// The keys of a table; `takes` says all of them where that helps more than the nearest.
    fn table(
        &mut self,
        map: &DeTable<'_>,
        table: &Table,
        path: &str,
        own: Range<usize>,
        takes: Option<&str>,
    ) -> Fields {
        let mut fields = Fields::default();
        for (key, value) in map {
            let name = key.get_ref();
            let place = join(path, name);
            self.spans.add(&place, value.span());
            match table.key(name) {
                Some(known) => {
                    if let Some(node) = self.value(value, &known.kind, &place) {
                        fields.0.insert(known.name, node);
                    }
                }
                None => {
                    let message = format!("there is no key `{}` here", clip(name));
                    let mut d = Diagnostic::new(Code::UnknownKey, place, message);
                    let keys = table.keys().map(|k| k.name);
                    match synonyms::meant(name, keys.clone()) {
                        // Many trains: no single one can be read.
                        None if path.is_empty() && name == "design" => {
                            d = d.hint("with it this is a design file, which the question `design` answers");
                        }
                        Some((key, more)) => {
                            let with = if more.is_empty() { String::new() } else { format!(", with {more}") };
                            d = d.hint(format!("it is called `{key}` here{with}"));
                            // What needs more is not put right by the key alone.
                            d.replacement = Some(key.to_owned()).filter(|_| more.is_empty());
                        }
                        None => d = d.suggest(name, keys),
                    }
                    match takes {
                        Some(takes) => d = d.hint(takes),
                        None if d.hints.is_empty() => {
                            let known: Vec<_> = table.keys().map(|k| k.name).collect();
                            d = d.hint(format!("the keys here are: {}", known.join(", ")));
                        }
                        None => {}
                    }
                    d.span = Some(key.span().into());
                    self.diagnostics.push(d);
                }
            }
        }
        for key in table.keys().filter(|k| k.required) {
            if !map.iter().any(|(k, _)| k.get_ref() == key.name) {
                let place = join(path, key.name);
                let message = match path {
                    "" => format!("`{}` is missing", key.name),
                    _ => format!("`{}` is missing in {path}", key.name),
                };
                let hint = match key.kind {
                    Kind::Format => "write `format = 1` at the top".to_owned(),
                    _ => format!("{}: {}", key.name, about(key.doc)),
                };
                let mut d = Diagnostic::new(Code::MissingKey, place, message).hint(hint);
                d.hints.extend(takes.map(str::to_owned));
                d.span = Some(own.clone().into());
                self.diagnostics.push(d);
            }
        }
        fields
    }

    fn value(&mut self, value: &Value<'_>, kind: &Kind, place: &str) -> Option<Node> {
        match kind {
            Kind::Format => {
                let found = integer(value.get_ref());
                if found != Some(1) {
                    let message = match found {
                        Some(n) => format!("format {n} is not known here; this version reads format 1"),
                        None => format!("`format` is the number 1, here is {}", describe(value.get_ref())),
                    };
                    self.report(Code::Format, place, message, "write `format = 1`");
                }
                (found == Some(1)).then_some(Node::Format)
            }
            Kind::Text | Kind::Name => match value.get_ref().as_str() {
                Some(text) => {
                    // Lines are for texts; names have none, which is checked with the names.
                    let unfit = text.chars().find(|c| !is_printable(*c) && !matches!(c, '\n' | '\r' | '\t'));
                    if let Some(c) = unfit {
                        let message =
                            format!("`{}`: a text has no U+{:04X}, which cannot be shown", clip(text), c as u32);
                        self.report(Code::BadName, place, message, "leave it out");
                        return None;
                    }
                    Some(Node::Text(text.to_owned()))
                }
                None => {
                    let hint = match value.get_ref().as_integer() {
                        Some(i) => format!(", write \"{}\"", i.as_str()),
                        None => String::new(),
                    };
                    self.wrong_type(place, value, &format!("a text in quotes{hint}"));
                    None
                }
            },
            Kind::Names => {
                let Some(array) = value.get_ref().as_array() else {
                    self.wrong_type(place, value, "a list of names, [\"a\", \"b\"]");
                    return None;
                };
                let mut names = Vec::new();
                for (k, item) in array.iter().enumerate() {
                    let place = entry(place, k);
                    self.spans.add(&place, item.span());
                    match item.get_ref().as_str() {
                        Some(name) => names.push(name.to_owned()),
                        None => self.wrong_type(&place, item, "names in quotes"),
                    }
                }
                Some(Node::Names(names))
            }
            Kind::Terminals => {
                let Some(array) = value.get_ref().as_array() else {
                    self.wrong_type(place, value, "a list of names, [\"a\", { name = \"b\", member = \"c\" }]");
                    return None;
                };
                let mut all = Vec::new();
                for (k, item) in array.iter().enumerate() {
                    let place = entry(place, k);
                    self.spans.add(&place, item.span());
                    match item.get_ref() {
                        DeValue::String(name) => all.push((name.to_string(), None)),
                        DeValue::Table(table) => {
                            let text = |reader: &mut Self, value: &Value<'_>, place: &str| {
                                let text = value.get_ref().as_str().map(str::to_owned);
                                if text.is_none() {
                                    reader.wrong_type(place, value, "a name in quotes");
                                }
                                text
                            };
                            let read = self.two(table, &place, ["name", "member"], item.span(), text);
                            all.extend(read.map(|[name, member]| (name, Some(member))));
                        }
                        _ => self.wrong_type(&place, item, "names in quotes, or { name = …, member = … }"),
                    }
                }
                Some(Node::Terminals(all))
            }
            Kind::Integer | Kind::Samples => {
                let found = integer(value.get_ref());
                if found.is_none() {
                    match value.get_ref() {
                        DeValue::Integer(i) => {
                            let message = format!("{} is too large a number", clip(i.as_str()));
                            self.report(Code::OutOfRange, place, message, "");
                        }
                        DeValue::Float(x) => {
                            let message = format!("`{}` is a whole number, here is {}", last(place), clip(x.as_str()));
                            let hint = match kind {
                                Kind::Integer => "a tooth or planet count has no fraction",
                                _ => "",
                            };
                            self.report(Code::WrongType, place, message, hint);
                        }
                        _ => self.wrong_type(place, value, "a whole number"),
                    }
                }
                found.map(Node::Integer)
            }
            Kind::Flag => {
                let found = value.get_ref().as_bool();
                if found.is_none() {
                    self.wrong_type(place, value, "true or false");
                }
                found.map(Node::Flag)
            }
            Kind::Choice(choices) => match value.get_ref().as_str() {
                Some(text) if choices.iter().any(|c| *c == text || *c == spelt(text)) => {
                    let choice = choices.iter().find(|c| **c == text || **c == spelt(text));
                    choice.map(|c| Node::Text((*c).to_owned()))
                }
                Some(text) => {
                    let message = format!("`{}` is not a known `{}`", clip(text), last(place));
                    let mut d =
                        Diagnostic::new(Code::UnknownName, place, message).suggest(text, choices.iter().copied());
                    if d.hints.is_empty() {
                        d = d.hint(format!("one of: {}", choices.join(", ")));
                    }
                    self.diagnostics.push(d);
                    None
                }
                None => {
                    self.wrong_type(place, value, &format!("one of the texts {}", choices.join(", ")));
                    None
                }
            },
            Kind::Efficiency => self.efficiency(value, place).map(Node::Efficiency),
            Kind::SetEfficiency => {
                let by_kind = value
                    .get_ref()
                    .as_table()
                    .filter(|t| t.keys().any(|k| matches!(k.get_ref().as_ref(), "external" | "internal")));
                let Some(table) = by_kind else {
                    return self.efficiency(value, place).map(|e| Node::SetEfficiency(e, None));
                };
                let [external, internal] =
                    self.two(table, place, ["external", "internal"], value.span(), Self::efficiency)?;
                Some(Node::SetEfficiency(external, Some(internal)))
            }
            Kind::MachineEfficiency => self.machine_efficiency(value, place),
            Kind::Store => match value.get_ref().as_table() {
                None => self.store(value, place).map(|power| Node::Stores(vec![(String::new(), power)])),
                Some(table) => {
                    let mut all = Vec::new();
                    for (name, value) in table {
                        let place = join(place, name.get_ref());
                        self.spans.add(&place, name.span());
                        all.extend(self.store(value, &place).map(|power| (name.get_ref().to_string(), power)));
                    }
                    Some(Node::Stores(all))
                }
            },
            Kind::Quantities(dimension) => {
                let Some(table) = value.get_ref().as_table() else {
                    let (_, example) = dimension.describe();
                    self.wrong_type(place, value, &format!("a table of members, {{ sun = \"{example}\" }}"));
                    return None;
                };
                let mut all = Vec::new();
                for (name, value) in table {
                    let place = join(place, name.get_ref());
                    // The whole entry, so that a message about the member underlines its name.
                    self.spans.add(&place, name.span());
                    if let Some(q) = self.quantity(value, *dimension, &place) {
                        all.push((name.get_ref().to_string(), q));
                    }
                }
                Some(Node::Quantities(all))
            }
            Kind::Quantity(dimension) => self.measure(value, Some(*dimension), place).map(Node::Amount),
            Kind::Number => self.measure(value, None, place).map(Node::Amount),
            Kind::Points(of) => self.points(value, *of, place).map(Node::Points),
            Kind::NumberOrPoints(over) => match value.get_ref() {
                DeValue::Array(_) => self.points(value, [Some(*over), None], place).map(Node::Points),
                _ => self.measure(value, None, place).map(Node::Amount),
            },
            Kind::Schedule => {
                let read = |reader: &mut Self, [time, state]: [&Value<'_>; 2], places: [&str; 2]| {
                    let time = reader.quantity(time, Dimension::TIME, places[0]);
                    let name = state.get_ref().as_str().map(str::to_owned);
                    if name.is_none() {
                        reader.wrong_type(places[1], state, "the name of a state in quotes");
                    }
                    Some((time?, name?))
                };
                self.pairs(value, place, "[\"0 s\", \"1\"]", read).map(Node::Schedule)
            }
            Kind::Signal(kind) => self.signal(value, kind(), place),
            Kind::Product(kinds) => {
                let Some([first, second]) = value.get_ref().as_array().and_then(pair) else {
                    self.wrong_type(place, value, "a list of two signals, the second of plain numbers");
                    return None;
                };
                let places = [0, 1].map(|k| entry(place, k));
                for (place, value) in places.iter().zip([first, second]) {
                    self.spans.add(place, value.span());
                }
                let first = self.signal(first, kinds[0](), &places[0]);
                let second = self.signal(second, kinds[1](), &places[1]);
                let one = |node| Fields(BTreeMap::from([("value", node)]));
                Some(Node::Tables(vec![one(first?), one(second?)]))
            }
            Kind::Table(table) => match value.get_ref().as_table() {
                Some(map) => Some(Node::Table(self.table(map, table, place, value.span(), None))),
                None => {
                    // What it must have; where it may have anything, all of it.
                    let must = table.keys().any(|k| k.required);
                    let keys = table.keys().filter(|k| k.required || !must);
                    let keys: Vec<_> = keys.map(|k| format!("{} = …", k.name)).collect();
                    self.wrong_type(place, value, &format!("a table, {{ {} }}", keys.join(", ")));
                    None
                }
            },
            Kind::Tables(table, exactly) => {
                let tables = self.tables(value, place, |_| Some(*table))?;
                if *exactly > 0 && tables.len() != *exactly {
                    let message = format!("`{}` has {} entries, it needs {exactly}", last(place), tables.len());
                    self.report(Code::WrongType, place, message, "a mesh is a pair of gears");
                }
                Some(Node::Tables(tables))
            }
            Kind::Variants(variants) => self
                .tables(value, place, |map| match map.get("type").map(|t| t.get_ref().as_str()) {
                    None => Some(variants[0].1),
                    Some(name) => variants.iter().find(|v| Some(v.0) == name).map(|v| v.1).or(Some(variants[0].1)),
                })
                .map(Node::Tables),
        }
    }

    fn tables<'t>(
        &mut self,
        value: &Value<'_>,
        place: &str,
        table_of: impl Fn(&DeTable<'_>) -> Option<&'t Table>,
    ) -> Option<Vec<Fields>> {
        let Some(array) = value.get_ref().as_array() else {
            let hint = if place.contains(['.', '[']) {
                "a list of tables, [ { … }, { … } ]".to_owned()
            } else {
                format!("a list: write [[{place}]] with two brackets")
            };
            self.wrong_type(place, value, &hint);
            return None;
        };
        let mut all = Vec::new();
        for (k, item) in array.iter().enumerate() {
            let place = entry(place, k);
            self.spans.add(&place, item.span());
            match item.get_ref().as_table() {
                Some(map) => {
                    if let Some(table) = table_of(map) {
                        all.push(self.table(map, table, &place, item.span(), None));
                    }
                }
                None => self.wrong_type(&place, item, "a table, { … }"),
            }
        }
        Some(all)
    }

    /// A quantity, or a plain number.
    fn measure(&mut self, value: &Value<'_>, measure: Measure, place: &str) -> Option<Amount> {
        match measure {
            Some(dimension) => self.quantity(value, dimension, place).map(Amount::Quantity),
            None => self.number(value, place, "").map(Amount::Number),
        }
    }

    /// A list of pairs, each read by `read` from its two values and their places.
    fn pairs<T>(
        &mut self,
        value: &Value<'_>,
        place: &str,
        example: &str,
        mut read: impl FnMut(&mut Self, [&Value<'_>; 2], [&str; 2]) -> Option<T>,
    ) -> Option<Vec<T>> {
        let Some(array) = value.get_ref().as_array() else {
            self.wrong_type(place, value, &format!("a list of pairs, [ {example}, … ]"));
            return None;
        };
        let mut all = Vec::with_capacity(array.len());
        for (k, item) in array.iter().enumerate() {
            let place = entry(place, k);
            self.spans.add(&place, item.span());
            let Some(values) = item.get_ref().as_array().and_then(pair) else {
                self.wrong_type(&place, item, &format!("a pair, {example}"));
                continue;
            };
            let places = [0, 1].map(|j| entry(&place, j));
            for (place, value) in places.iter().zip(values) {
                self.spans.add(place, value.span());
            }
            all.extend(read(self, values, [&places[0], &places[1]]));
        }
        (all.len() == array.len()).then_some(all)
    }

    fn points(&mut self, value: &Value<'_>, of: [Measure; 2], place: &str) -> Option<Vec<[Amount; 2]>> {
        let [x, y] = of.map(|m| m.map_or("0.5".to_owned(), |d| format!("\"{}\"", d.describe().1)));
        self.pairs(value, place, &format!("[{x}, {y}]"), |reader, [x, y], places| {
            let (x, y) = (reader.measure(x, of[0], places[0]), reader.measure(y, of[1], places[1]));
            Some([x?, y?])
        })
    }

    /// A value over time: a constant, or a table by its `type`.
    fn signal(&mut self, value: &Value<'_>, kind: &SignalKind, place: &str) -> Option<Node> {
        let Some(map) = value.get_ref().as_table() else {
            return self.measure(value, kind.of, place).map(Node::Amount);
        };
        let types = || kind.types.iter().map(|t| t.0);
        let listed = || format!("one of: {}", types().collect::<Vec<_>>().join(", "));
        let at = join(place, "type");
        let Some(given) = map.get("type") else {
            let mut d = Diagnostic::new(Code::MissingKey, at, format!("`type` is missing in {place}"));
            d.span = Some(value.span().into());
            self.diagnostics.push(d.hint(listed()));
            return None;
        };
        self.spans.add(&at, given.span());
        let Some(name) = given.get_ref().as_str() else {
            self.wrong_type(&at, given, "a text in quotes");
            return None;
        };
        let Some((name, table)) = kind.types.iter().find(|t| t.0 == name) else {
            let message = format!("there is no signal of type `{}`", clip(name));
            let d = Diagnostic::new(Code::UnknownName, at, message).suggest(name, types());
            self.diagnostics.push(d.hint(listed()));
            return None;
        };
        let keys: Vec<&str> = table.keys().map(|k| k.name).collect();
        let takes = format!("`{name}` takes: {}", keys.join(", "));
        Some(Node::Table(self.table(map, table, place, value.span(), Some(&takes))))
    }

    /// Reads a table of exactly two keys.
    fn two<T>(
        &mut self,
        table: &DeTable<'_>,
        place: &str,
        names: [&str; 2],
        span: Range<usize>,
        read: impl Fn(&mut Self, &Value<'_>, &str) -> Option<T>,
    ) -> Option<[T; 2]> {
        let mut found = [None, None];
        for (key, value) in table {
            let place = join(place, key.get_ref());
            self.spans.add(&place, value.span());
            match names.iter().position(|n| n == key.get_ref()) {
                Some(k) => found[k] = Some(read(self, value, &place)),
                None => {
                    let message = format!("there is no key `{}` here", clip(key.get_ref()));
                    let mut d = Diagnostic::new(Code::UnknownKey, place, message).suggest(key.get_ref(), names);
                    d.span = Some(key.span().into());
                    self.diagnostics.push(d.hint(format!("the keys here are: {}", names.join(", "))));
                }
            }
        }
        for (k, name) in names.iter().enumerate() {
            if found[k].is_none() {
                let message = format!("`{name}` is missing: give both {} and {}", names[0], names[1]);
                let mut d = Diagnostic::new(Code::MissingKey, join(place, name), message);
                d.span = Some(span.clone().into());
                self.diagnostics.push(d);
            }
        }
        let [a, b] = found.map(Option::flatten);
        Some([a?, b?])
    }

    fn efficiency(&mut self, value: &Value<'_>, place: &str) -> Option<Directed> {
        match value.get_ref() {
            DeValue::Table(table) => {
                let [forward, backward] =
                    self.two(table, place, ["forward", "backward"], value.span(), Self::fraction)?;
                Some(Directed { forward, backward: Some(backward) })
            }
            DeValue::Integer(_) | DeValue::Float(_) | DeValue::String(_) => {
                self.fraction(value, place).map(|forward| Directed { forward, backward: None })
            }
            _ => {
                self.wrong_type(place, value, "a number such as 0.98, or { forward = 0.98, backward = 0.97 }");
                None
            }
        }
    }

    /// The efficiency of a machine: a value, one for each direction, or the file of a map.
    fn machine_efficiency(&mut self, value: &Value<'_>, place: &str) -> Option<Node> {
        let Some(table) = value.get_ref().as_table() else {
            return self.efficiency(value, place).map(Node::Efficiency);
        };
        let Some(map) = table.get("map").filter(|_| table.len() == 1) else {
            let [forward, backward] =
                self.two(table, place, ["motoring", "generating"], value.span(), Self::fraction)?;
            return Some(Node::Efficiency(Directed { forward, backward: Some(backward) }));
        };
        let place = join(place, "map");
        self.spans.add(&place, map.span());
        match map.get_ref().as_str() {
            Some(file) => Some(Node::Text(file.to_owned())),
            None => {
                self.wrong_type(&place, map, "the name of a CSV file in quotes");
                None
            }
        }
    }

    /// What a store gives: a power, or whatever balances its bus.
    fn store(&mut self, value: &Value<'_>, place: &str) -> Option<Option<Quantity>> {
        match value.get_ref().as_str() {
            Some(FREE) => Some(None),
            _ => self.quantity(value, Dimension::POWER, place).map(Some),
        }
    }

    /// One efficiency. A text may hold a fraction that no decimal number is, "96/97".
    fn fraction(&mut self, value: &Value<'_>, place: &str) -> Option<Rational> {
        let text = value.get_ref().as_str().filter(|t| t.contains('/'));
        match text.and_then(|t| t.parse().ok()) {
            Some(fraction) => Some(fraction),
            None => self.number(value, place, "write 0.98 for 98 %"),
        }
    }

    fn number(&mut self, value: &Value<'_>, place: &str, hint: &str) -> Option<Rational> {
        let text = match value.get_ref() {
            DeValue::Integer(i) if i.radix() == 10 => i.as_str(),
            DeValue::Float(x) => x.as_str(),
            DeValue::String(s) => {
                let message = format!("`{}` is a number without quotes, here is \"{}\"", last(place), clip(s));
                let comma = units::decimal_point(s).map(|n| format!("the decimal sign is a decimal point: write {n}"));
                self.report(Code::WrongType, place, message, comma.unwrap_or_else(|| hint.to_owned()));
                return None;
            }
            _ => {
                self.wrong_type(place, value, "a number");
                return None;
            }
        };
        match text.parse() {
            Ok(value) => Some(value),
            Err(_) => {
                let message = format!("{} is not a finite number of sensible size", clip(text));
                self.report(Code::OutOfRange, place, message, "");
                None
            }
        }
    }

    fn quantity(&mut self, value: &Value<'_>, dimension: Dimension, place: &str) -> Option<Quantity> {
        let (kind, example) = dimension.describe();
        let unit = example.split_once(' ').map_or("", |e| e.1);
        let at = value.span();
        let mut report = |message: String, hint: String, replacement: Option<String>| {
            let mut d = Diagnostic::new(Code::Quantity, place, message).hint(hint);
            d.span = Some(at.clone().into());
            d.replacement = replacement;
            self.diagnostics.push(d);
        };
        match value.get_ref() {
            DeValue::String(text) => match units::parse(text, dimension) {
                Ok(q) => return Some(q),
                Err(error) => {
                    let replacement = match error.instead.as_slice() {
                        // Without a unit nobody knows which is meant.
                        [one] if error.fault != QuantityFault::NoUnit => Some(format!("\"{one}\"")),
                        _ => None,
                    };
                    report(format!("\"{}\" is not {kind}: {error}", clip(text)), error.hint(), replacement);
                }
            },
            DeValue::Integer(_) | DeValue::Float(_) => {
                let shown = match value.get_ref() {
                    DeValue::Integer(i) => clip(i.as_str()),
                    DeValue::Float(x) => clip(x.as_str()),
                    _ => unreachable!(),
                };
                let hint = format!("write \"{shown} {unit}\" if that is the unit meant");
                report(format!("{shown} has no unit; {kind} is a text with one"), hint, None);
            }
            other => {
                let found = describe(other);
                report(
                    format!("{kind} is a text with a unit, here is {found}"),
                    format!("an example: \"{example}\""),
                    None,
                );
            }
        }
        None
    }
}

/// The two entries of a list that has two.
fn pair<'v, 'i>(array: &'v DeArray<'i>) -> Option<[&'v Value<'i>; 2]> {
    let mut values = array.iter();
    match (values.next(), values.next(), values.next()) {
        (Some(first), Some(second), None) => Some([first, second]),
        _ => None,
    }
}

fn integer(value: &DeValue<'_>) -> Option<i64> {
    let i = value.as_integer()?;
    i64::from_str_radix(&i.as_str().replace('_', ""), i.radix()).ok()
}

fn describe(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(s) => format!("the text \"{}\"", clip(s)),
        DeValue::Integer(i) => format!("the number {}", clip(i.as_str())),
        DeValue::Float(x) => format!("the number {}", clip(x.as_str())),
        DeValue::Boolean(b) => format!("{b}"),
        DeValue::Datetime(_) => "a date".into(),
        DeValue::Array(_) => "a list".into(),
        DeValue::Table(_) => "a table".into(),
    }
}

fn join(path: &str, key: &str) -> String {
    if path.is_empty() { key.to_owned() } else { [path, ".", key].concat() }
}

/// The place of an entry of a list.
fn entry(list: &str, k: usize) -> String {
    [list, "[", &k.to_string(), "]"].concat()
}

fn last(place: &str) -> &str {
    place.rsplit('.').next().unwrap_or(place)
}

/// A choice as it may be written in a sentence: `Deep groove ball bearing` is `deep-groove-ball`.
fn spelt(text: &str) -> String {
    let plain = text.trim().to_lowercase().replace([' ', '_'], "-");
    let plain = plain.strip_suffix("-bearing").unwrap_or(&plain);
    plain.strip_prefix("two-row-").map_or(plain.to_owned(), |rest| format!("double-row-{rest}"))
}
