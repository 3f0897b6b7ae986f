#!/bin/sh
# From a fresh checkout to pictures: installs what is missing, builds, draws the plates of the README.
set -eu
cd "$(dirname "$0")/.."
. examples/setup.sh
cargo build --release
sh examples/plates.sh target
