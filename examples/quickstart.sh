#!/bin/sh
# From a fresh checkout to a picture: installs what is missing, builds, draws the sample.
set -eu
cd "$(dirname "$0")/.."
. examples/setup.sh
cargo build --release
picture="target/golden-gate.png"
./target/release/hachure draw dem/golden-gate.tif -o "$picture" \
    --exaggeration 2 --eye 547500,4183300,+300 --azimuth 318 --altitude -6 --fov 50 --size 1600x700
echo "the picture: $(pwd)/$picture"
