//! The binary `rc` as a user runs it: exit codes, messages, files.

mod adaptive;
mod bad_input;
mod export;
mod guide;
mod hardness;
mod leakage;
mod measured;
mod over_ranks;
mod rectangles;
mod report;
mod robustness;
mod solids;
mod solve;
mod spectrum;
mod stopped;
mod support;
mod sweep;
mod sweep_damaged;
mod sweep_interrupted;
mod sweep_mean;
mod sweep_refused;
mod sweep_shards;
mod tools;
mod units;
mod warnings;
mod watched;
