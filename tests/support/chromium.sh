#!/bin/sh
# Path of the browser that `make test-browser` drives: $CHROMIUM, or Debian's chromium, installed
# where that may be done. Else says what is missing.
set -eu
if [ -n "${CHROMIUM:-}" ]; then
    command -v "$CHROMIUM" && exit
    echo "CHROMIUM=$CHROMIUM: there is no such program" >&2
    exit 1
fi
for name in chromium chromium-browser google-chrome; do
    if command -v "$name"; then exit; fi
done
if [ "$(id -u)" = 0 ] && command -v apt-get >/dev/null; then
    apt-get update --quiet=2 >&2
    apt-get install --yes --quiet=2 --no-install-recommends chromium fonts-dejavu-core >&2
    command -v chromium
else
    echo "the browser tests need chromium: as root, apt-get install chromium; or say where" \
        "another one is, CHROMIUM=/path/to/chrome make test-browser" >&2
    exit 1
fi
