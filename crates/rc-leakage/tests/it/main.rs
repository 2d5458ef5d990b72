//! Flows against closed forms and elimination, and properties of every flow.

mod dense;
mod exact;
mod properties;
