//! What this process has used; `None` where the system does not say without unsafe code.

/// The most memory that was in use at one time, bytes.
#[cfg(target_os = "linux")]
pub fn peak_memory_bytes() -> Option<u64> {
    peak_in(&std::fs::read_to_string("/proc/self/status").ok()?)
}

/// Processor time of all threads, seconds.
#[cfg(target_os = "linux")]
pub fn cpu_seconds() -> Option<f64> {
    cpu_in(&std::fs::read_to_string("/proc/self/stat").ok()?)
}

#[cfg(not(target_os = "linux"))]
pub fn peak_memory_bytes() -> Option<u64> {
    None
}

#[cfg(not(target_os = "linux"))]
pub fn cpu_seconds() -> Option<f64> {
    None
}

/// From proc(5)'s `status`: the high-water mark of resident memory, in KiB.
#[cfg(any(target_os = "linux", test))]
fn peak_in(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|l| l.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kibibytes * 1024)
}

/// From proc(5)'s `stat`: user and system time are fields 14 and 15, in ticks of 1/100 s, which
/// is the unit of that file on every processor that Rust's Linux targets have.
#[cfg(any(target_os = "linux", test))]
fn cpu_in(stat: &str) -> Option<f64> {
    // Field 2 is the program's name, which may hold spaces and parentheses.
    let (_, after_name) = stat.rsplit_once(')')?;
    let mut fields = after_name.split_whitespace().skip(11);
    let user: u64 = fields.next()?.parse().ok()?;
    let system: u64 = fields.next()?.parse().ok()?;
    Some((user + system) as f64 / 100.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_found_behind_any_name() {
        let stat = "7 (a ) b) R 1 1 1 0 -1 4 100 0 0 0 250 50 9 9 20 0 1 0 5 6 7";
        assert_eq!(cpu_in(stat), Some(3.0));
        assert_eq!(cpu_in("nonsense"), None);
    }

    #[test]
    fn the_high_water_mark_is_in_bytes() {
        let status = "Name:\thalfshade\nVmPeak:\t  99 kB\nVmHWM:\t    12 kB\n";
        assert_eq!(peak_in(status), Some(12288));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn this_process_has_used_memory() {
        assert!(peak_memory_bytes().is_some_and(|bytes| bytes > 100_000));
        assert!(cpu_seconds().is_some());
    }
}
