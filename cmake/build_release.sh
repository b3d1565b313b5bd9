#!/bin/sh
# Installs what is missing, configures and builds the release preset: all of it, or the targets
# named. Says nothing unless something fails, so that a program's output stays its own; only who
# watches a terminal sees how far it is.
#   build_release.sh [--with-tests | --with-python] [TARGET...]
#     --with-tests: packages that only tests use, too; --with-python: those of `import possibility`
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

# While the build writes its steps to the log, and as long as this script lives: on one line, how
# many are done.
show_progress() {
  while sleep 1 && kill -0 "$$" 2>/dev/null; do
    awk -F '[][/ ]' '/^\[[0-9]+\/[0-9]+ / { done = $2; all = $3; seconds = $4 }
      END { if (done > 0) printf "\r%d of %d steps, about %d s left ", done, all,
                                 seconds * (all - done) / done }' "$log" >&2
  done
}

build() {
  watcher=""
  if [ -t 2 ]; then
    show_progress &
    watcher=$!
  fi
  NINJA_STATUS='[%f/%t %e] '
  export NINJA_STATUS
  quietly cmake --build --preset release "$@"
  if [ -n "$watcher" ]; then
    kill "$watcher"
    printf '\r\033[K' >&2
  fi
}

also=""
case "${1-}" in
  --with-*)
    also=$1
    shift ;;
esac

cd "$root"
installed=""
# Where packages cannot be asked about, say once what is needed.
if [ ! -f build/release/build.ninja ] || command -v dpkg-query >/dev/null; then
  installed=$(sh cmake/install_packages.sh $also)
fi
# What has just been installed is found by configuring again.
if [ ! -f build/release/build.ninja ] || [ -n "$installed" ]; then
  quietly cmake --preset release
fi
if [ "$#" -gt 0 ]; then
  build --target "$@"
else
  build
fi
