//! Memory: what this process used at most, and what the machine has.

/// Peak resident memory of the process, in bytes; `None` where the system does not say.
#[cfg(unix)]
#[must_use]
pub fn peak() -> Option<u64> {
    use nix::sys::resource::{UsageWho, getrusage};
    // Linux counts in KiB, Apple's systems in bytes.
    let unit = if cfg!(target_vendor = "apple") { 1 } else { 1024 };
    let usage = getrusage(UsageWho::RUSAGE_SELF).ok()?;
    u64::try_from(usage.max_rss()).ok().map(|value| value * unit)
}

/// Physical memory of the machine, in bytes; `None` where the system does not say.
#[cfg(target_os = "linux")]
#[must_use]
pub fn physical() -> Option<u64> {
    use nix::unistd::{SysconfVar, sysconf};
    let pages = u64::try_from(sysconf(SysconfVar::_PHYS_PAGES).ok()??).ok()?;
    let page = u64::try_from(sysconf(SysconfVar::PAGE_SIZE).ok()??).ok()?;
    Some(pages.saturating_mul(page))
}

/// Peak resident memory of the process, in bytes; `None` where the system does not say.
#[cfg(not(unix))]
#[must_use]
pub fn peak() -> Option<u64> {
    None
}

/// Physical memory of the machine, in bytes; `None` where the system does not say.
#[cfg(not(target_os = "linux"))]
#[must_use]
pub fn physical() -> Option<u64> {
    None
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #[test]
    fn the_process_uses_part_of_the_machine() {
        let (peak, physical) = (super::peak().expect("Linux says"), super::physical().expect("Linux says"));
        assert!(1 << 16 < peak && peak < physical, "{peak} of {physical} bytes");
    }
}
