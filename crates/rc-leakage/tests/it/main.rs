//! Flows against closed forms, elimination, and properties that every flow has.

mod dense;
mod exact;
mod properties;
