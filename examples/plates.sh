#!/bin/sh
# Draws the plates of the README into a folder (examples, where none is given) with the program that `cargo build --release` left.
set -eu
cd "$(dirname "$0")/.."
folder=${1:-examples}
draw() {
    plate="$folder/$1.png"
    shift
    "${HACHURE:-./target/release/hachure}" draw dem/golden-gate.tif -o "$plate" "$@"
}
# The Marin Headlands across the Golden Gate, as a field sketch.
draw golden-gate --exaggeration 2 --eye 545900,4184300,+500 --azimuth 327 --altitude -4 --fov 56 --size 1060x451 --border off
# Hills over Rodeo Valley, as a woodcut.
draw headlands --style woodcut --exaggeration 2 --eye 540500,4185300,+150 --azimuth 40 --altitude -1.5 --fov 50 --size 860x410 --border off
# The same land as a hachure map, 1:70 000.
draw map --plan --scale 1:70000 --crop 537800,4185200,547800,4190200 --style atlas --hachures lehmann --creases drainage,shores --dpi 120
