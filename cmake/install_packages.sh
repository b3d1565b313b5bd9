#!/bin/sh
# Installs the system packages that the build needs, if any is missing (Debian 12), and says on
# standard output which it has installed. Who watches a terminal sees how far it is.
#   --with-tests    also what tests are better off with: goes on without it if it cannot be had
#   --with-python   also what `import possibility` and its examples need
set -eu

packages="build-essential cmake ninja-build pkg-config libeigen3-dev libsimbody-dev
coinor-libipopt-dev libsundials-dev libbullet-dev liburdfdom-dev libtinyxml2-dev libgtest-dev
libyaml-cpp-dev nlohmann-json3-dev libcli11-dev libfmt-dev libmuparser-dev
libxxhash-dev libassimp-dev libmeshoptimizer-dev libpng-dev zlib1g-dev libzstd-dev libjs-three libopenblas0-pthread"

python="pybind11-dev python3-dev python3-numpy python3-matplotlib"

case "${1-}" in
  "") optional="" ;;
  --with-python) packages="$packages $python"; optional="" ;;
  --with-tests) optional="$python python3-pytest doxygen libdart-dev libompl-dev libnlopt-dev libmujoco-dev python3-dartpy python3-yaml" ;;
  *) echo "usage: install_packages.sh [--with-tests | --with-python]" >&2; exit 1 ;;
esac

# Without dpkg nothing can be asked; configuring names what it does not find.
if ! command -v dpkg-query >/dev/null; then
  echo "possibility: this is not Debian; these packages of Debian 12, or their like, are needed:" \
       $packages $optional >&2
  exit 0
fi

missing_of() {
  installed=$(dpkg-query -W -f '${Package}=${db:Status-Status} ' "$@" 2>/dev/null || true)
  for package in "$@"; do
    case " $installed" in
      *" $package=installed "*) ;;
      *) printf ' %s' "$package" ;;
    esac
  done
}

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  as_root="sudo"
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT

# As long as this script lives: every package is fetched, unpacked and set up.
show_progress() {
  while sleep 1 && kill -0 "$$" 2>/dev/null; do
    awk '/newly installed/ { all = $3; done = 0 }
      /^(Get:[0-9]+ .* \[[0-9]|Unpacking |Setting up )/ { done++ }
      END { if (all > 0) printf "\rinstalling: %d %% ", 100 * done / (3 * all) }' "$log" >&2
  done
}

install() {
  for tool in apt-get $as_root; do
    if ! command -v "$tool" >/dev/null; then
      echo "possibility: $tool is not here to install what is missing: $*" >&2
      return 1
    fi
  done
  echo "possibility: installing $*" >&2
  watcher=""
  if [ -t 2 ]; then
    show_progress &
    watcher=$!
  fi
  failed=""
  { $as_root apt-get -q update &&
         $as_root env DEBIAN_FRONTEND=noninteractive \
             apt-get -q -y --no-install-recommends install "$@"; } >"$log" 2>&1 || failed=yes
  if [ -n "$watcher" ]; then
    kill "$watcher"
    printf '\r\033[K' >&2
  fi
  if [ -n "$failed" ]; then
    cat "$log" >&2
    echo "possibility: could not install: $*" >&2
    return 1
  fi
  echo "$*"
}

missing=$(missing_of $packages)
[ -z "$missing" ] || install $missing
[ -n "$optional" ] || exit 0
missing=$(missing_of $optional)
[ -z "$missing" ] || install $missing || echo "possibility: going on without:$missing" >&2
