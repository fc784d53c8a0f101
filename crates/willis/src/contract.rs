//! Results contracts: a report that says in its field `format` what it is and in which version.
//!
//! A contract is a structure that serialises, reads back and, with the feature `schema`, describes
//! itself as JSON Schema. Fields are added, never renamed or removed; a report that cannot keep that
//! promise gets the next number.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

use serde::de::{Deserialize, Deserializer, Error};
use serde::ser::{Serialize, Serializer};

/// A report with a name and a version.
pub trait Contract {
    /// Name and version, as in `willis-analysis-1`.
    const FORMAT: &'static str;
}

/// The field `format` of a contract: the text [`Contract::FORMAT`] and nothing else.
///
/// Reading back any other text is an error that names both.
///
/// # Example
/// ```
/// use serde::{Deserialize, Serialize};
/// use willis::contract::{Contract, Format};
///
/// #[derive(Debug, Serialize, Deserialize)]
/// struct Report {
///     format: Format<Report>,
///     loss_w: f64,
/// }
///
/// impl Contract for Report {
///     const FORMAT: &'static str = "willis-example-1";
/// }
///
/// let text = serde_json::to_string(&Report { format: Format::new(), loss_w: 2.0 })?;
/// assert_eq!(text, r#"{"format":"willis-example-1","loss_w":2.0}"#);
/// let other = text.replace("example-1", "example-2");
/// let wrong = serde_json::from_str::<Report>(&other).unwrap_err();
/// assert!(wrong.to_string().starts_with("this is `willis-example-2`, not `willis-example-1`"));
/// # Ok::<(), serde_json::Error>(())
/// ```
pub struct Format<C>(PhantomData<fn() -> C>);

impl<C> Format<C> {
    /// The only value there is.
    pub const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<C> Default for Format<C> {
    fn default() -> Self {
        Self::new()
    }
}

impl<C> Clone for Format<C> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<C> Copy for Format<C> {}

impl<C> PartialEq for Format<C> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<C> Eq for Format<C> {}

impl<C: Contract> fmt::Debug for Format<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(C::FORMAT)
    }
}

impl<C: Contract> fmt::Display for Format<C> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(C::FORMAT)
    }
}

impl<C: Contract> Serialize for Format<C> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(C::FORMAT)
    }
}

impl<'de, C: Contract> Deserialize<'de> for Format<C> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let found = Cow::<str>::deserialize(deserializer)?;
        match found == C::FORMAT {
            true => Ok(Self::new()),
            false => Err(D::Error::custom(format_args!("this is `{found}`, not `{}`", C::FORMAT))),
        }
    }
}

#[cfg(feature = "schema")]
impl<C: Contract> schemars::JsonSchema for Format<C> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        C::FORMAT.into()
    }

    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        schemars::json_schema!({ "type": "string", "const": C::FORMAT })
    }
}
