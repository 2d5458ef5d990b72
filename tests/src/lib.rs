//! Nothing to export: the tests are in `it/`.
