#!/bin/sh
# Every test, then those of the crate without GDAL. Those of the shared terrain need HACHURE_DEMS, its folder, those of the report's page a browser; where CI
# is set, a skipped test is a failure.
set -eu
cd "$(dirname "$0")/.."
. examples/setup.sh
. tests/setup.sh
said=$(mktemp)
status=$(mktemp)
trap 'rm -f "$said" "$status"' EXIT
{ cargo test --release 2>&1 || echo $? >"$status"; } | tee "$said"
skipped=$(grep -c '^SKIP ' "$said" || true)
if [ "$skipped" -gt 0 ]; then
    echo "$skipped skipped, what they need is said above"
    [ -z "${CI:-}" ] || exit 1
fi
awk '/^test result:/ { passed += $4; failed += $6 } END { print passed + 0 " passed, " failed + 0 " failed" }' "$said"
[ ! -s "$status" ] || exit 1
sh tests/without_gdal.sh
