//! Errors of single values become diagnostics, so that one error type is enough: `?` does it. Modules further down the
//! pipeline convert their own errors with [`through_diagnostic!`].

use crate::exact::NotANumber;
use crate::units::QuantityError;

use super::{Code, Diagnostic, Diagnostics};

impl From<Diagnostic> for Diagnostics {
    fn from(one: Diagnostic) -> Self {
        [one].into_iter().collect()
    }
}

impl From<Box<Diagnostic>> for Diagnostics {
    fn from(one: Box<Diagnostic>) -> Self {
        (*one).into()
    }
}

impl From<QuantityError> for Diagnostic {
    fn from(error: QuantityError) -> Self {
        let message = format!("this is not {}: {error}", error.expected.describe().0);
        Self::new(Code::Quantity, "", message).hint(error.hint())
    }
}

impl From<NotANumber> for Diagnostic {
    fn from(error: NotANumber) -> Self {
        Self::new(Code::WrongType, "", error.to_string())
    }
}

/// One diagnostic is a list of one.
macro_rules! through_diagnostic {
    ($($error:ty),+) => {
        $(impl From<$error> for $crate::diagnostic::Diagnostics {
            fn from(error: $error) -> Self {
                $crate::diagnostic::Diagnostic::from(error).into()
            }
        })+
    };
}
pub(crate) use through_diagnostic;

through_diagnostic!(QuantityError, NotANumber);
