//! Where a report was made, and by which command.

use std::path::Path;
use std::thread::available_parallelism;

use crate::gpu::Gpu;
use crate::report::results::Machine;

/// The command, with its flags as typed.
pub(crate) fn command() -> String {
    std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}

/// Processor, adapter and driver.
pub(crate) fn machine(gpu: &Gpu) -> Machine {
    let info = &gpu.info;
    Machine {
        system: format!("{} {}{}", std::env::consts::OS, std::env::consts::ARCH, processor()),
        cores: available_parallelism().map_or(1, usize::from),
        adapter: info.name.clone(),
        adapter_kind: format!("{:?}", info.device_type).to_lowercase(),
        driver: format!("{} {}", info.driver, info.driver_info),
        int64: gpu.int64,
        timing: gpu.clock.describe().to_owned(),
    }
}

/// The processor's name where Linux tells it.
fn processor() -> String {
    let about = std::fs::read_to_string(Path::new("/proc/cpuinfo")).unwrap_or_default();
    let name = about.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or(String::new(), |(_, name)| format!(", {}", name.trim()))
}
