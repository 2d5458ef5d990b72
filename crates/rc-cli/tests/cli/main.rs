//! The binary `rc` as a user runs it: exit codes, messages, files.

mod bad_input;
mod solve;
mod support;
mod tools;
