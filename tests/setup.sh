# Sourced by tests/run.sh behind examples/setup.sh: a browser, in which the tests look at a report, GDAL's tools, which
# errors name as remedies and the tests run, and poppler, a stranger to whom our PDFs are shown.
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
browse
remedies
poppler
