//! Description of the machine and the programs of a run, `data/bench/bench.toml`.

use std::collections::BTreeMap;
use std::process::Command;

use anyhow::Result;
use toml::{Table as Toml, Value};

use rc_figures::archive::version;

/// Version, machine, peers, and the time of the whole run (s).
///
/// # Errors
/// When the root manifest has no version.
pub(super) fn description(peers: &BTreeMap<String, String>, seconds: f64) -> Result<Toml> {
    let mut run = Toml::new();
    run.insert("version".into(), version()?.into());
    run.insert("processor".into(), processor().into());
    run.insert("threads".into(), Value::Integer(all_threads() as i64));
    run.insert("system".into(), format!("{} {}", std::env::consts::OS, std::env::consts::ARCH).into());
    run.insert("compiler".into(), compiler().into());
    run.insert("seconds".into(), Value::Integer(seconds.round() as i64));
    let peers = peers.iter().map(|(name, version)| (name.clone(), Value::String(version.clone())));
    run.insert("peers".into(), Value::Table(peers.collect()));
    Ok(run)
}

/// Number of threads that all programs may use.
pub(super) fn all_threads() -> usize {
    std::thread::available_parallelism().map_or(1, usize::from)
}

/// Model of the processor, if the system tells it.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    model.map_or_else(|| "unknown".to_owned(), |(_, name)| name.trim().to_owned())
}

fn compiler() -> String {
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let output = Command::new(compiler).arg("--version").output().ok().filter(|output| output.status.success());
    output.map_or_else(|| "unknown".to_owned(), |output| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_run_says_where_it_was() {
        let run = description(&[("tamaas".to_owned(), "2.9.0".to_owned())].into(), 12.4).expect("a version");
        assert_eq!(run["peers"]["tamaas"].as_str(), Some("2.9.0"));
        assert_eq!(run["seconds"].as_integer(), Some(12));
        assert!(run["threads"].as_integer().is_some_and(|n| n > 0) && run.contains_key("processor"), "{run:?}");
    }
}
