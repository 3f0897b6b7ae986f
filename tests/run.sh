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
run() { cargo "$@" 2>&1 || echo $? >>"$status"; }
{
    # Tests run the examples too.
    run build --release --bins --examples
    # Every target of tests by its name, for the crate is built once more for those inside it, which need no speed.
    run test --release --test hachure --test without_gdal
    run test --release --doc
    run test --release --lib --config profile.release.package.hachure.opt-level=1
} | tee "$said"
skipped=$(grep -c '^SKIP ' "$said" || true)
if [ "$skipped" -gt 0 ]; then
    echo "$skipped skipped, what they need is said above"
    [ -z "${CI:-}" ] || exit 1
fi
awk '/^test result:/ { passed += $4; failed += $6 } END { print passed + 0 " passed, " failed + 0 " failed" }' "$said"
[ ! -s "$status" ] || exit 1
sh tests/without_gdal.sh
