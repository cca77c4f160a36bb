//! What a measurement says about the machine that it was made on.

use halfshade::converge::Machine;

/// This machine, with the threads of the current pool.
pub fn machine() -> Machine {
    let processor = processor().unwrap_or_else(|| std::env::consts::ARCH.to_owned());
    Machine {
        processor,
        system: std::env::consts::OS,
        threads: rayon::current_num_threads(),
    }
}

#[cfg(target_os = "linux")]
fn processor() -> Option<String> {
    let text = std::fs::read_to_string("/proc/cpuinfo").ok()?;
    let line = text.lines().find(|line| line.starts_with("model name"))?;
    Some(line.split_once(':')?.1.trim().to_owned())
}

#[cfg(not(target_os = "linux"))]
fn processor() -> Option<String> {
    None
}
