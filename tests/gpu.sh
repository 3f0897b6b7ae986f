#!/bin/sh
# On whatever adapter is here: the tests that draw, then every view of a file of views, on a page of WxH pixels (1280x720
# unless told), through `hachure compare --floor`: a line a run with its error, its time and how far that is from the
# limits. HACHURE_VIEWS is the file of views (../shared/views.json), HACHURE_DEMS the folder of DEMs (dem beside it).
set -eu
cd "$(dirname "$0")/.."
size=${1:-1280x720}
views=${HACHURE_VIEWS:-../shared/views.json}
dems=${HACHURE_DEMS:-$(dirname "$views")/dem}
# Tests that need shared terrain say so where there is none.
if [ -d "$dems" ]; then
    HACHURE_DEMS=$(cd "$dems" && pwd)
    export HACHURE_DEMS
fi
. examples/setup.sh
cargo build --release
failed=0
cargo test --release -- agreement borders costs cover crossings depth_draw gpu_errors kernels left_out mixed pieces pool \
    reflection same_bytes seams seen silhouettes times vertices watertight || failed=1
compare() {
    name=$1
    shift
    echo "== $name"
    ./target/release/hachure compare "$@" -o "target/gpu/$name" --floor --methods walk
}
if [ ! -f "$views" ] || [ ! -d "$dems" ]; then
    echo "no views $views or no DEMs in $dems: set HACHURE_VIEWS and HACHURE_DEMS; here the sample instead"
    compare sample dem/golden-gate.tif --size "$size" --levels auto
    exit "$failed"
fi
# DEMs that no view names are not read.
compare views "$dems"/* --views "$views" --size "$size" --levels auto --truth-level 8
# 296 197 patches on 1920 x 1080 pixels: the target on a GPU is at most 1 ms a frame.
compare target "$dems/SainteHelens.dem" --views "$views" --size 1920x1080 --levels 1,auto --truth-level 8
exit "$failed"
