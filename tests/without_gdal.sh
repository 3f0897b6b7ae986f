#!/bin/sh
# The crate without GDAL: lints, documentation, the tests beside it, and a program that does not load the library. The
# crate's own tests are the same with GDAL, and run there.
set -eu
cd "$(dirname "$0")/.."
cargo clippy --release --no-default-features --all-targets -- -D warnings
RUSTDOCFLAGS="-D warnings" cargo doc --release --no-default-features --no-deps
status=0
# These need no speed, so that the crate is built faster.
said=$(cargo test --release --no-default-features --config profile.release.package.hachure.opt-level=1 --test without_gdal) || status=$?
echo "$said" | grep '^test result: ok. [1-9]' || true
if [ "$status" -ne 0 ] || ! echo "$said" | grep -q '^test result: ok. [1-9]'; then
    echo "$said"
    exit 1
fi
# The libraries a program names, as Linux or as macOS tells them.
libraries() { if command -v readelf >/dev/null 2>&1; then readelf -d "$1"; else otool -L "$1"; fi; }
loads_gdal() { libraries target/release/hachure | grep 'libgdal'; }
if loads_gdal; then
    echo "a hachure without GDAL loads it"
    exit 1
fi
cargo build --release
loads_gdal || { echo "the check must see GDAL where it is"; exit 1; }
