//! What this process has used; `None` where the system does not say without unsafe code.

/// The most memory that was in use at one time, bytes.
#[cfg(target_os = "linux")]
pub fn peak_memory_bytes() -> Option<u64> {
    peak_in(&std::fs::read_to_string("/proc/self/status").ok()?)
}

#[cfg(not(target_os = "linux"))]
pub fn peak_memory_bytes() -> Option<u64> {
    None
}

/// From proc(5)'s `status`: the high-water mark of resident memory, in KiB.
#[cfg(any(target_os = "linux", test))]
fn peak_in(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_high_water_mark_is_in_bytes() {
        let status = "Name:\thalfshade\nVmPeak:\t  99 kB\nVmHWM:\t    12 kB\n";
        assert_eq!(peak_in(status), Some(12288));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_process_has_used_memory() {
        assert!(peak_memory_bytes().is_some_and(|bytes| bytes > 100_000));
    }
}
