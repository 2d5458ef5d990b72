//! The binary `rc` as a user runs it: exit codes, messages, files.

mod adaptive;
mod bad_input;
mod solve;
mod support;
mod tools;
