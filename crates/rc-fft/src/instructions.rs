//! Choice of the vector instructions.

use std::sync::OnceLock;

/// Name of the environment variable that lowers [`Instructions::of_process`].
const VARIABLE: &str = "RC_SIMD";

/// The widest vector instructions that code chosen at run time may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Instructions {
    /// Instructions that every processor of the architecture has.
    Scalar,
    /// Transforms with SSE 4.1 if the processor has it. The same as `Scalar` on other architectures than x86.
    Sse,
    /// The widest instructions that the processor has.
    Best,
}

impl Instructions {
    /// The instructions that this process uses.
    ///
    /// This is [`Instructions::Best`] unless the environment variable `RC_SIMD` is `scalar` or `sse`. The variable is
    /// read once.
    ///
    /// Other instructions round sums in another order. So results differ in their last digits, as they do on other
    /// processors.
    ///
    /// # Panics
    /// When the variable has another value than `scalar`, `sse` or `best`.
    #[must_use]
    pub fn of_process() -> Self {
        static CHOSEN: OnceLock<Instructions> = OnceLock::new();
        *CHOSEN.get_or_init(|| match std::env::var_os(VARIABLE) {
            None => Self::Best,
            Some(value) => Self::named(&value.to_string_lossy())
                .unwrap_or_else(|| panic!("{VARIABLE} is {}; write scalar, sse or best", value.display())),
        })
    }

    fn named(name: &str) -> Option<Self> {
        match name {
            "scalar" => Some(Self::Scalar),
            "sse" => Some(Self::Sse),
            "best" => Some(Self::Best),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_exact() {
        assert_eq!(Instructions::named("scalar"), Some(Instructions::Scalar));
        assert_eq!(Instructions::named("sse"), Some(Instructions::Sse));
        assert_eq!(Instructions::named("SSE"), None);
    }
}
