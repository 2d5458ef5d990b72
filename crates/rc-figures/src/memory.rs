//! Peak memory of this process.

/// Peak resident memory of the process, in bytes; `None` where the system does not say.
#[cfg(unix)]
#[must_use]
pub fn peak() -> Option<u64> {
    use nix::sys::resource::{UsageWho, getrusage};
    // What Linux accounts to a process begins with what its parent had when it started it; the status is of this program alone.
    if cfg!(target_os = "linux")
        && let Some(peak) = std::fs::read_to_string("/proc/self/status").ok().as_deref().and_then(peak_of_status)
    {
        return Some(peak);
    }
    // Linux counts in KiB, Apple's systems in bytes.
    let unit = if cfg!(target_vendor = "apple") { 1 } else { 1024 };
    let usage = getrusage(UsageWho::RUSAGE_SELF).ok()?;
    u64::try_from(usage.max_rss()).ok().map(|value| value * unit)
}

/// The line `VmHWM:     1234 kB` of a process status, in bytes.
#[cfg(unix)]
fn peak_of_status(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    line.trim().strip_suffix("kB")?.trim_end().parse::<u64>().ok()?.checked_mul(1024)
}

/// Peak resident memory of the process, in bytes; `None` where the system does not say.
#[cfg(not(unix))]
#[must_use]
pub fn peak() -> Option<u64> {
    None
}
