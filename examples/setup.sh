# Sourced by quickstart.sh and tests/run.sh: what hachure needs from the system, installed where we know how.
need() {
    command -v cargo >/dev/null 2>&1 || { echo "hachure needs Rust: see https://rustup.rs"; exit 1; }
    missing=""
    command -v pkg-config >/dev/null 2>&1 || missing="$missing pkg-config"
    { command -v pkg-config >/dev/null 2>&1 && pkg-config --exists gdal; } || missing="$missing libgdal-dev"
    command -v cc >/dev/null 2>&1 || missing="$missing gcc"
    drivers=$(ls /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json 2>/dev/null || true)
    loader=$(PATH="$PATH:/usr/sbin:/sbin" ldconfig -p 2>/dev/null | grep libvulkan.so.1 || true)
    if [ "$(uname)" = Linux ] && { [ -z "$drivers" ] || [ -z "$loader" ]; }; then
        missing="$missing mesa-vulkan-drivers libvulkan1"
    fi
    [ -z "$missing" ] && return 0
    if ! command -v apt-get >/dev/null 2>&1; then
        echo "hachure needs GDAL 3 with headers, pkg-config, a C compiler and, on Linux, a Vulkan driver."
        echo "Fedora: dnf install gdal-devel pkgconf gcc mesa-vulkan-drivers"
        echo "Arch:   pacman -S gdal pkgconf gcc vulkan-swrast"
        echo "macOS:  brew install gdal pkgconf"
        exit 1
    fi
    # shellcheck disable=SC2086 # a list of packages
    install_packages $missing || {
        echo "could not install$missing: install them and run this again"
        exit 1
    }
}
# Installs packages of Debian and its kin.
install_packages() {
    as_root=""
    [ "$(id -u)" = 0 ] || as_root=sudo
    echo "installing $*"
    $as_root apt-get update -qq && $as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq "$@" >/dev/null
}
need
