//! Memory: peak of this process, memory of the machine, and budget of a command.

mod budget;
mod byte_size;

pub use budget::{Bound, Budget, MemoryError};
pub use byte_size::ByteSize;

/// Peak resident memory of the process, in bytes, or `None` if unknown.
#[cfg(unix)]
#[must_use]
pub fn peak() -> Option<u64> {
    use nix::sys::resource::{UsageWho, getrusage};
    // On Linux, `getrusage` includes the memory of the parent process at the start. The status contains only this
    // program.
    if cfg!(target_os = "linux")
        && let Some(peak) = std::fs::read_to_string("/proc/self/status").ok().as_deref().and_then(peak_of_status)
    {
        return Some(peak);
    }
    // Linux counts in KiB, systems of Apple in bytes.
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

/// Physical memory of the machine, in bytes, or `None` if unknown.
#[cfg(target_os = "linux")]
#[must_use]
pub fn physical() -> Option<u64> {
    use nix::unistd::{SysconfVar, sysconf};
    let pages = u64::try_from(sysconf(SysconfVar::_PHYS_PAGES).ok()??).ok()?;
    let page = u64::try_from(sysconf(SysconfVar::PAGE_SIZE).ok()??).ok()?;
    Some(pages.saturating_mul(page))
}

/// Peak resident memory of the process, in bytes, or `None` if unknown.
#[cfg(not(unix))]
#[must_use]
pub fn peak() -> Option<u64> {
    None
}

/// Physical memory of the machine, in bytes, or `None` if unknown.
#[cfg(not(target_os = "linux"))]
#[must_use]
pub fn physical() -> Option<u64> {
    None
}

/// Number of bytes that a file may unpack to: `limit`, or a quarter of the machine.
///
/// A map is unpacked, converted and then solved, so that a larger part would not leave room for the solve.
#[must_use]
pub fn read_limit(limit: Option<ByteSize>) -> u64 {
    const UNKNOWN_MACHINE: u64 = 2 << 30;
    limit.map_or_else(|| physical().map_or(UNKNOWN_MACHINE, |bytes| bytes / 4), |limit| limit.0)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #[test]
    fn the_process_uses_part_of_the_machine() {
        let (peak, physical) = (super::peak().expect("Linux says"), super::physical().expect("Linux says"));
        assert!(1 << 16 < peak && peak < physical, "{peak} of {physical} bytes");
    }

    #[test]
    fn the_status_has_the_peak() {
        assert_eq!(super::peak_of_status("Name:\trc\nVmHWM:\t    1234 kB\nVmRSS:\t 99 kB\n"), Some(1234 * 1024));
        assert_eq!(super::peak_of_status("VmRSS:\t 99 kB\nVmHWM:\t much\n"), None);
    }
}
