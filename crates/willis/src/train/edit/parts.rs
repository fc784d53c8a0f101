//! Parts of a train file that come, go and get other names; what is written beside them stays.

use toml_edit::{Array, ArrayOfTables, InlineTable, Item, Table, TableLike, Value};

use super::Document;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::words::clip;

/// Keys whose values are names of members. Parts that heat a place may be other things, but a name of a member is one.
const MEMBERS: [&str; 8] = ["member", "members", "carrier", "input", "output", "fixed", "terminals", "parts"];
/// Keys of tables whose own keys are names of members.
const BY_MEMBER: [&str; 5] = ["speeds", "torques", "powers", "inertias", "initial_speeds"];
/// The member that every train has.
const FRAME: &str = "frame";

/// # Example
/// ```
/// use willis::train::{Document, Train};
///
/// let mut document = Document::parse(r#"
///     format = 1
///     name = "two shafts"
///     members = ["s", "r", "c"]   # in this order
///     terminals = ["s", "c"]
/// "#)?;
/// document.add_set("P1", 30, 70).unwrap();
/// document.join("s", "sun P1").unwrap();
/// document.join("c", "carrier P1").unwrap();
/// document.join("frame", "ring P1").unwrap();
/// let text = document.text();
/// assert!(text.contains("# in this order") && !text.contains("sun P1"));
/// assert!(Train::from_toml(&text).is_ok(), "{text}");
/// # Ok::<(), String>(())
/// ```
impl Document {
    /// Makes two members one, under the name of the first. Its place in operations is that of the first too.
    ///
    /// # Errors
    /// There are no such two members; the second is the frame.
    pub fn join(&mut self, one: &str, other: &str) -> Result<(), Diagnostics> {
        if one == other {
            return Err(wrong(one, format!("`{}` is one member already", clip(one))));
        }
        self.known(one)?;
        if other == FRAME {
            return self.join(FRAME, one);
        }
        self.known(other)?;
        let members = self.0.get_mut("members").and_then(Item::as_array_mut);
        if let Some(all) = members {
            all.retain(|v| v.as_str() != Some(other));
        }
        if one == FRAME {
            // The frame is no terminal, and nothing is prescribed for it.
            self.forget(other);
        }
        renamed(self.0.as_table_mut(), other, one);
        Ok(())
    }

    /// Gives a member another name.
    ///
    /// # Errors
    /// There is no such member, or there is one of the new name.
    pub fn rename(&mut self, from: &str, to: &str) -> Result<(), Diagnostics> {
        self.known(from)?;
        if from == FRAME {
            return Err(wrong(from, "the frame is always called so".to_owned()));
        }
        if self.known(to).is_ok() {
            return Err(wrong(to, format!("there is a member `{}` already", clip(to))));
        }
        renamed(self.0.as_table_mut(), from, to);
        Ok(())
    }

    /// Takes the entry of a list away, such as a `set`, `shift_element`, `state` or `operation`. States lose an element that
    /// is no more, operations in a state go with it, and members that belonged to nothing but a set go with that.
    ///
    /// # Errors
    /// There is no such entry.
    pub fn remove(&mut self, list: &str, name: &str) -> Result<(), Diagnostics> {
        if !self.has(list, name) {
            return Err(wrong(name, format!("there is no `{}` in `{list}`", clip(name))));
        }
        self.keep(list, |t| !is_called(t, "name", name));
        match list {
            "shift_element" => self.each("state", |state| {
                if let Some(engaged) = state.get_mut("engaged").and_then(Item::as_array_mut) {
                    engaged.retain(|v| v.as_str() != Some(name));
                }
            }),
            "state" => self.keep("operation", |o| !is_called(o, "state", name)),
            "set" => self.drop_unused(),
            _ => {}
        }
        Ok(())
    }

    /// Adds a simple set whose members are new: `sun NAME`, `ring NAME` and `carrier NAME`.
    ///
    /// # Errors
    /// There is something of that name.
    pub fn add_set(&mut self, name: &str, sun: u32, ring: u32) -> Result<(), Diagnostics> {
        self.unused("set", name)?;
        let members = ["sun", "ring", "carrier"].map(|part| format!("{part} {name}"));
        for member in &members {
            if self.known(member).is_ok() {
                return Err(wrong(member, format!("there is a member `{}` already", clip(member))));
            }
        }
        let all = self.0.entry("members").or_insert(Item::Value(Value::Array(Array::new())));
        if let Some(all) = all.as_array_mut() {
            members.iter().for_each(|m| all.push(m.as_str()));
        }
        let gear = |member: &str, teeth: u32| {
            let mut gear = InlineTable::new();
            gear.insert("member", member.into());
            gear.insert("teeth", i64::from(teeth).into());
            Item::Value(Value::InlineTable(gear))
        };
        let mut set = Table::new();
        set.insert("name", toml_edit::value(name));
        set.insert("sun", gear(&members[0], sun));
        set.insert("ring", gear(&members[1], ring));
        set.insert("carrier", toml_edit::value(members[2].as_str()));
        set.insert("mesh_efficiency", toml_edit::value(0.99));
        self.push("set", set);
        Ok(())
    }

    /// Adds a clutch between two members, or a brake on one.
    ///
    /// # Errors
    /// There is something of that name, no such member, or neither one nor two of them.
    pub fn add_element(&mut self, name: &str, members: &[String]) -> Result<(), Diagnostics> {
        self.unused("shift_element", name)?;
        members.iter().try_for_each(|m| self.known(m))?;
        let kind = match members {
            [_] => "brake",
            [_, _] => "clutch",
            _ => return Err(wrong(name, "a brake has one member, a clutch has two".to_owned())),
        };
        let mut element = Table::new();
        element.insert("name", toml_edit::value(name));
        element.insert("kind", toml_edit::value(kind));
        element.insert("members", toml_edit::value(members.iter().map(String::as_str).collect::<Array>()));
        self.push("shift_element", element);
        Ok(())
    }

    /// Adds a state in which these elements are closed.
    ///
    /// # Errors
    /// There is a state of that name.
    pub fn add_state(&mut self, name: &str, engaged: &[String]) -> Result<(), Diagnostics> {
        self.unused("state", name)?;
        let mut state = Table::new();
        state.insert("name", toml_edit::value(name));
        state.insert("engaged", toml_edit::value(engaged.iter().map(String::as_str).collect::<Array>()));
        self.push("state", state);
        Ok(())
    }

    /// Adds an entry to a list of tables, whichever way it is written.
    fn push(&mut self, list: &str, entry: Table) {
        let item = self.0.entry(list).or_insert(Item::ArrayOfTables(ArrayOfTables::new()));
        match item {
            Item::ArrayOfTables(all) => all.push(entry),
            Item::Value(Value::Array(all)) => all.push(entry.into_inline_table()),
            _ => {}
        }
    }

    fn known(&self, member: &str) -> Result<(), Diagnostics> {
        let listed = self.0.get("members").and_then(Item::as_array).into_iter().flatten().filter_map(Value::as_str);
        let all: Vec<&str> = listed.chain([FRAME]).collect();
        if all.contains(&member) {
            return Ok(());
        }
        let message = format!("there is no member `{}`", clip(member));
        Err(Diagnostic::new(Code::UnknownName, "members", message).suggest(member, all).into())
    }

    fn unused(&self, list: &str, name: &str) -> Result<(), Diagnostics> {
        match self.has(list, name) {
            true => Err(wrong(name, format!("there is a `{}` in `{list}` already", clip(name)))),
            false => Ok(()),
        }
    }

    /// Whether a list has an entry of a name.
    fn has(&self, list: &str, name: &str) -> bool {
        let is = |t: &dyn TableLike| is_called(t, "name", name);
        match self.0.get(list) {
            Some(Item::ArrayOfTables(all)) => all.iter().any(|t| is(t)),
            Some(Item::Value(Value::Array(all))) => all.iter().filter_map(Value::as_inline_table).any(|t| is(t)),
            _ => false,
        }
    }

    /// Keeps the entries of a list that are wanted, whichever way it is written.
    fn keep(&mut self, list: &str, wanted: impl Fn(&dyn TableLike) -> bool) {
        match self.0.get_mut(list) {
            Some(Item::ArrayOfTables(all)) => all.retain(|t| wanted(t)),
            Some(Item::Value(Value::Array(all))) => all.retain(|v| v.as_inline_table().is_none_or(|t| wanted(t))),
            _ => {}
        }
    }

    /// Changes the entries of a list, whichever way it is written.
    fn each(&mut self, list: &str, change: impl Fn(&mut dyn TableLike)) {
        match self.0.get_mut(list) {
            Some(Item::ArrayOfTables(all)) => all.iter_mut().for_each(|t| change(t)),
            Some(Item::Value(Value::Array(all))) => {
                all.iter_mut().filter_map(Value::as_inline_table_mut).for_each(|t| change(t));
            }
            _ => {}
        }
    }

    /// Takes a member out of the terminals and out of what operations prescribe.
    fn forget(&mut self, member: &str) {
        if let Some(all) = self.0.get_mut("terminals").and_then(Item::as_array_mut) {
            all.retain(|v| v.as_str() != Some(member));
        }
        self.each("operation", |operation| {
            for key in BY_MEMBER {
                if let Some(t) = operation.get_mut(key).and_then(Item::as_table_like_mut) {
                    t.remove(member);
                }
            }
        });
    }

    /// Takes members out of the list that nothing else names.
    fn drop_unused(&mut self) {
        let mut used = vec![];
        for (key, item) in self.0.as_table().iter().filter(|(key, _)| *key != "members") {
            names(key, item, &mut used);
        }
        if let Some(all) = self.0.get_mut("members").and_then(Item::as_array_mut) {
            all.retain(|v| v.as_str().is_some_and(|m| used.iter().any(|u| u == m)));
        }
    }
}

fn is_called(table: &dyn TableLike, key: &str, name: &str) -> bool {
    table.get(key).and_then(Item::as_str) == Some(name)
}

fn wrong(place: &str, message: String) -> Diagnostics {
    Diagnostic::new(Code::UnknownSelection, place, message).into()
}

/// Names of members in an item.
fn names(key: &str, item: &Item, all: &mut Vec<String>) {
    let value = |v: &Value, all: &mut Vec<String>| match v {
        Value::String(s) if MEMBERS.contains(&key) => all.push(s.value().clone()),
        Value::InlineTable(t) => inside(key, t, all),
        _ => {}
    };
    match item {
        Item::Value(Value::Array(array)) => array.iter().for_each(|v| value(v, all)),
        Item::Value(one) => value(one, all),
        Item::Table(t) => inside(key, t, all),
        Item::ArrayOfTables(tables) => tables.iter().for_each(|t| inside(key, t, all)),
        Item::None => {}
    }
}

fn inside(key: &str, table: &dyn TableLike, all: &mut Vec<String>) {
    for (inner, item) in table.iter() {
        if BY_MEMBER.contains(&key) {
            all.push(inner.to_owned());
        }
        names(inner, item, all);
    }
}

/// Puts another name in the place of a member's, everywhere below a table.
fn renamed(table: &mut dyn TableLike, from: &str, to: &str) {
    let keys: Vec<String> = table.iter().map(|(k, _)| k.to_owned()).collect();
    for key in keys {
        let Some(item) = table.get_mut(&key) else { continue };
        match item {
            Item::ArrayOfTables(all) => all.iter_mut().for_each(|t| renamed(t, from, to)),
            Item::Table(t) => renamed_in(&key, t, from, to),
            Item::Value(value) => renamed_value(&key, value, from, to),
            Item::None => {}
        }
    }
}

fn renamed_in(key: &str, table: &mut dyn TableLike, from: &str, to: &str) {
    if BY_MEMBER.contains(&key) && table.contains_key(from) {
        let value = table.remove(from);
        // What is prescribed for the name that stays holds.
        if let Some(value) = value.filter(|_| !table.contains_key(to)) {
            table.insert(to, value);
        }
    }
    renamed(table, from, to);
}

fn renamed_value(key: &str, value: &mut Value, from: &str, to: &str) {
    match value {
        Value::String(s) if MEMBERS.contains(&key) && s.value() == from => {
            let decor = s.decor().clone();
            *value = Value::from(to);
            *value.decor_mut() = decor;
        }
        Value::String(s) if key == "formula" => {
            let decor = s.decor().clone();
            *value = Value::from(in_formula(s.value(), &format!("w_{from}"), &format!("w_{to}")));
            *value.decor_mut() = decor;
        }
        Value::Array(all) => {
            all.iter_mut().for_each(|v| renamed_value(key, v, from, to));
            // A list of names holds each once.
            let mut seen = vec![];
            all.retain(|v| match v.as_str() {
                Some(s) if seen.contains(&s.to_owned()) && MEMBERS.contains(&key) => false,
                Some(s) => {
                    seen.push(s.to_owned());
                    true
                }
                None => true,
            });
        }
        Value::InlineTable(t) => renamed_in(key, t, from, to),
        _ => {}
    }
}

/// Another name for a variable of a formula; names that begin or end alike stay.
fn in_formula(formula: &str, from: &str, to: &str) -> String {
    let within = |c: char| c.is_alphanumeric() || c == '_';
    let mut out = String::new();
    let mut rest = formula;
    while let Some(at) = rest.find(from) {
        let (before, after) = (&rest[..at], &rest[at + from.len()..]);
        let whole = !before.ends_with(within) && !after.starts_with(within);
        out += before;
        out += if whole { to } else { from };
        rest = after;
    }
    out + rest
}
