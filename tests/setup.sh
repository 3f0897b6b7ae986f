# Sourced by tests/run.sh behind examples/setup.sh: a browser, in which the tests look at a report.
browse() {
    for browser in chromium chromium-browser google-chrome; do
        command -v "$browser" >/dev/null 2>&1 && return 0
    done
    if ! command -v apt-get >/dev/null 2>&1 || ! install_packages chromium; then
        echo "no browser: tests of the report's page are skipped; install Chromium to run them"
    fi
}
browse
