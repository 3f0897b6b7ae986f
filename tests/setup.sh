# Sourced by tests/run.sh behind examples/setup.sh: a browser, in which the tests look at a report, GDAL's tools, which
# errors name as remedies and the tests run, poppler, a stranger to whom our PDFs are shown, vpype, which judges the order
# of a plot, topotoolbox, which judges where water runs, Ray and Open Job Description's runner, which share out frames, and
# ffmpeg, which makes motion pictures.
browse() {
    for browser in chromium chromium-browser google-chrome; do
        command -v "$browser" >/dev/null 2>&1 && return 0
    done
    if ! command -v apt-get >/dev/null 2>&1 || ! install_packages chromium; then
        echo "no browser: tests of the report's page are skipped; install Chromium to run them"
    fi
}
remedies() {
    command -v gdalwarp >/dev/null 2>&1 && command -v gdal_fillnodata.py >/dev/null 2>&1 && return 0
    if ! command -v apt-get >/dev/null 2>&1 || ! install_packages gdal-bin; then
        echo "no gdalwarp or gdal_fillnodata.py: tests of remedies are skipped; install GDAL's tools to run them"
    fi
}
poppler() {
    command -v pdftoppm >/dev/null 2>&1 && return 0
    if ! command -v apt-get >/dev/null 2>&1 || ! install_packages poppler-utils; then
        echo "no pdftoppm: tests of what others see in our PDFs are skipped; install poppler-utils to run them"
    fi
}
judge() {
    command -v vpype >/dev/null 2>&1 || [ -x target/vpype/bin/vpype ] && return 0
    if ! python3 -c "import ensurepip" >/dev/null 2>&1 && command -v apt-get >/dev/null 2>&1; then
        install_packages python3 python3-venv || true
    fi
    echo "installing vpype in target/vpype"
    if ! python3 -m venv target/vpype || ! target/vpype/bin/pip install --quiet --disable-pip-version-check "vpype<2"; then
        echo "no vpype: tests of the order of plotting by a stranger are skipped; install it (pip, or pipx) to run them"
    fi
}
hydrology() {
    [ -x target/topotoolbox/bin/python3 ] && return 0
    echo "installing topotoolbox in target/topotoolbox"
    if ! python3 -m venv target/topotoolbox || ! target/topotoolbox/bin/pip install --quiet --disable-pip-version-check topotoolbox; then
        rm -rf target/topotoolbox
        echo "no topotoolbox: tests of channels by a stranger are skipped; install it (pip) to run them"
    fi
}
farm() {
    [ -x target/ray/bin/ray ] && [ -x target/ray/bin/openjd ] && return 0
    echo "installing ray and openjd-cli in target/ray"
    if ! python3 -m venv target/ray || ! target/ray/bin/pip install --quiet --disable-pip-version-check ray openjd-cli; then
        rm -rf target/ray
        echo "no ray or openjd-cli: tests of farms are skipped; install them (pip) to run them"
    fi
}
films() {
    command -v ffmpeg >/dev/null 2>&1 && command -v ffprobe >/dev/null 2>&1 && return 0
    if ! command -v apt-get >/dev/null 2>&1 || ! install_packages ffmpeg; then
        echo "no ffmpeg: tests of motion pictures by it are skipped; install it to run them"
    fi
}
browse
remedies
poppler
judge
hydrology
farm
films
