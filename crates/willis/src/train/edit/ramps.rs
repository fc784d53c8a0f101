//! How clutches and brakes are pressed in a scenario: knots of tables over time, which a hand drags.

use toml_edit::{Array, Item, TableLike, Value};

use super::{Document, nth, scalar};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::words::clip;

/// How an element is pressed over time, as the file writes it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ramp {
    /// The clutch or brake.
    pub element: String,
    /// Times and values, such as `["1.2 s", "0.085"]`.
    pub knots: Vec<[String; 2]>,
}

/// # Example
/// ```
/// use willis::train::Document;
///
/// let mut document = Document::parse(r#"
///     [[scenario]]
///     name = "start"
///     [[scenario.engagement]]
///     element = "C"
///     value = { type = "table", points = [ ["0 s", 0], ["0.4 s", 1.00] ] }  # gently
/// "#)?;
/// assert_eq!(document.ramps("start")[0].knots[1], ["0.4 s", "1.00"]);
/// // What is not moved stays as it is written.
/// document.set_knot("start", "C", 1, ["0.6 s", "1.00"]).unwrap();
/// assert!(document.text().contains(r#"[ ["0 s", 0], ["0.6 s", 1.00] ] }  # gently"#));
/// # Ok::<(), String>(())
/// ```
impl Document {
    /// Elements of a scenario that a table presses, with its knots.
    pub fn ramps(&self, scenario: &str) -> Vec<Ramp> {
        let own = entries(self.0.get("scenario")).find(|s| s.get("name").and_then(Item::as_str) == Some(scenario));
        let ramp = |entry: &dyn TableLike| {
            let element = entry.get("element").and_then(Item::as_str)?.to_owned();
            let points = entry.get("value").and_then(Item::as_table_like)?.get("points").and_then(Item::as_array)?;
            let knots = points.iter().map(|p| {
                let p = p.as_array()?;
                Some([scalar(p.get(0)?)?, scalar(p.get(1)?)?])
            });
            Some(Ramp { element, knots: knots.collect::<Option<_>>()? })
        };
        own.into_iter().flat_map(|s| entries(s.get("engagement")).filter_map(ramp).collect::<Vec<_>>()).collect()
    }

    /// Moves a knot of the table that presses an element: its time with a unit, and its value, a number.
    ///
    /// # Errors
    /// There is no such scenario, element or knot; the value is no number.
    pub fn set_knot(
        &mut self,
        scenario: &str,
        element: &str,
        knot: usize,
        [time, value]: [&str; 2],
    ) -> Result<(), Diagnostics> {
        let wrong = |message: String| Diagnostics::from(Diagnostic::new(Code::UnknownSelection, scenario, message));
        let number: f64 = value.trim().parse().map_err(|_| wrong(format!("`{}` is no number", clip(value))))?;
        let none = || wrong(format!("no table of this scenario presses `{}`, or it has no knot {knot}", clip(element)));
        let of_scenario = position(self.0.get("scenario"), "name", scenario).ok_or_else(none)?;
        let own = nth_mut(self.0.get_mut("scenario"), of_scenario).ok_or_else(none)?;
        let of_element = position(own.get("engagement"), "element", element).ok_or_else(none)?;
        let entry = nth_mut(own.get_mut("engagement"), of_element).ok_or_else(none)?;
        let table = entry.get_mut("value").and_then(Item::as_table_like_mut);
        let points = table.and_then(|t| t.get_mut("points")).and_then(Item::as_array_mut);
        let point = points.and_then(|p| p.get_mut(knot)).and_then(Value::as_array_mut).ok_or_else(none)?;
        put(point, 0, time, time.into());
        put(point, 1, value, if number.fract() == 0.0 { (number as i64).into() } else { number.into() });
        Ok(())
    }
}

/// The tables of a list, whichever way it is written.
fn entries(list: Option<&Item>) -> impl Iterator<Item = &dyn TableLike> {
    (0..).map_while(move |k| nth(list?, k))
}

fn position(list: Option<&Item>, key: &str, name: &str) -> Option<usize> {
    entries(list).position(|t| t.get(key).and_then(Item::as_str) == Some(name))
}

fn nth_mut(list: Option<&mut Item>, k: usize) -> Option<&mut dyn TableLike> {
    match list? {
        Item::ArrayOfTables(all) => all.get_mut(k).map(|t| t as &mut dyn TableLike),
        Item::Value(Value::Array(all)) => {
            all.get_mut(k).and_then(Value::as_inline_table_mut).map(|t| t as &mut dyn TableLike)
        }
        _ => None,
    }
}

/// Another value in the place of one, with the spaces around it. What means the same stays as it is written.
fn put(of: &mut Array, k: usize, text: &str, mut value: Value) {
    if let Some(there) = of.get_mut(k).filter(|there| scalar(there).as_deref() != Some(text)) {
        *value.decor_mut() = there.decor().clone();
        *there = value;
    }
}
