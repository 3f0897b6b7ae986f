#!/bin/sh
# The crate without GDAL: lints, documentation, its tests, and a program that does not load the library.
set -eu
cd "$(dirname "$0")/.."
cargo clippy --release --no-default-features --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --release --no-default-features --no-deps
if ! said=$(cargo test --release --no-default-features --test without_gdal) ||
    ! echo "$said" | grep '^test result: ok. [1-9]'; then
    echo "$said"
    exit 1
fi
loads_gdal() { readelf -d target/release/hachure | grep 'NEEDED.*libgdal'; }
if loads_gdal; then
    echo "a hachure without GDAL loads it"
    exit 1
fi
cargo build --release
loads_gdal || { echo "the check must see GDAL where it is"; exit 1; }
