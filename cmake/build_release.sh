#!/bin/sh
# Installs what is missing, configures and builds the release preset: all of it, or the targets
# named. Says nothing unless something fails, so that a program's output stays its own.
#   build_release.sh [--with-tests] [TARGET...]   --with-tests: packages that only tests use, too
set -eu

root=$(cd "$(dirname "$0")/.." && pwd)
log=$(mktemp)
trap 'rm -f "$log"' EXIT

quietly() {
  if ! "$@" >"$log" 2>&1; then
    cat "$log" >&2
    echo "possibility: failed: $*" >&2
    exit 1
  fi
}

for_tests=""
if [ "${1-}" = --with-tests ]; then
  for_tests=$1
  shift
fi

cd "$root"
installed=""
# Where packages cannot be asked about, say once what is needed.
if [ ! -f build/release/build.ninja ] || command -v dpkg-query >/dev/null; then
  installed=$(sh cmake/install_packages.sh $for_tests)
fi
# What has just been installed is found by configuring again.
if [ ! -f build/release/build.ninja ] || [ -n "$installed" ]; then
  quietly cmake --preset release
fi
if [ "$#" -gt 0 ]; then
  quietly cmake --build --preset release --target "$@"
else
  quietly cmake --build --preset release
fi
