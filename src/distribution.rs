//! Names the packages of the user's Linux distribution.

use std::path::Path;

use crate::regular_file;

/// Where systemd's specification has the description of the distribution.
const FILES: [&str; 2] = ["/etc/os-release", "/usr/lib/os-release"];

/// Distributions by their `ID`, and how to install Mesa's Vulkan drivers, with the software driver, and the Vulkan loader.
const DRIVERS: [(&str, &str); 7] = [
    ("debian", "apt install mesa-vulkan-drivers"),
    ("ubuntu", "apt install mesa-vulkan-drivers"),
    ("fedora", "dnf install mesa-vulkan-drivers"),
    ("arch", "pacman -S vulkan-icd-loader vulkan-swrast"),
    ("suse", "zypper install libvulkan1 libvulkan_lvp"),
    ("alpine", "apk add vulkan-loader mesa-vulkan-swrast"),
    ("nixos", "set `hardware.graphics.enable = true;` in configuration.nix"),
];

/// A sentence that says how to install a Vulkan driver on this system.
pub(crate) fn install_driver() -> String {
    let read = |path: &str| regular_file::read_text(Path::new(path)).ok();
    advice(&FILES.into_iter().find_map(read).unwrap_or_default())
}

/// The sentence for the distribution that this text of an `os-release` file describes.
fn advice(os_release: &str) -> String {
    let find = |name: &str| DRIVERS.iter().find(|(known, _)| *known == name);
    match ids(os_release).find_map(|id| find(id.strip_prefix("opensuse-").map_or(id, |_| "suse"))) {
        Some((_, command)) => {
            format!("Install the driver of your GPU, or Mesa's, which also draws without a GPU: {command}")
        }
        None => {
            "Install the Vulkan loader, and the driver of your GPU or Mesa's, which also draws without a GPU".into()
        }
    }
}

/// The distribution's own name, then those that it derives from, nearest first.
fn ids(os_release: &str) -> impl Iterator<Item = &str> {
    let value = |key: &'static str| {
        os_release.lines().filter_map(move |line| line.strip_prefix(key)).map(|value| value.trim_matches(['"', '\'']))
    };
    value("ID=").chain(value("ID_LIKE=").flat_map(str::split_whitespace))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_package_is_that_of_the_distribution_or_of_its_nearest_ancestor() {
        for (text, part) in [
            ("NAME=\"Debian GNU/Linux\"\nID=debian\n", "apt install mesa-vulkan-drivers"),
            ("ID=linuxmint\nID_LIKE=\"ubuntu debian\"\n", "apt install mesa-vulkan-drivers"),
            ("ID=\"rocky\"\nID_LIKE=\"rhel centos fedora\"\nVERSION_ID=\"9.4\"\n", "dnf install mesa-vulkan-drivers"),
            ("ID=endeavouros\nID_LIKE='arch'\n", "pacman -S vulkan-icd-loader vulkan-swrast"),
            ("ID=\"opensuse-tumbleweed\"\nID_LIKE=\"opensuse suse\"\n", "zypper install libvulkan1 libvulkan_lvp"),
            ("ID=alpine\n", "apk add vulkan-loader mesa-vulkan-swrast"),
            ("ID=nixos\n", "hardware.graphics.enable"),
            ("ID=plan9\n", "Install the Vulkan loader, and the driver"),
            ("", "Install the Vulkan loader, and the driver"),
        ] {
            assert!(advice(text).contains(part), "{text}: {}", advice(text));
        }
    }
}
