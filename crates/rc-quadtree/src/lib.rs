//! The mesh that the default solver runs on, and the paper's.

mod morton;
pub mod paper;

pub use self::morton::morton_code;
