#!/bin/sh
# Installs the system packages that the build needs, if any is missing (Debian 12).
set -eu

packages="build-essential cmake ninja-build pkg-config libeigen3-dev libsimbody-dev
coinor-libipopt-dev libsundials-dev libbullet-dev liburdfdom-dev libgtest-dev libyaml-cpp-dev
nlohmann-json3-dev libcli11-dev libfmt-dev libxxhash-dev libjs-three
libopenblas0-serial"

# Without dpkg nothing can be asked; configuring names what it does not find.
if ! command -v dpkg-query >/dev/null; then
  echo "possibility: this is not Debian; these packages of Debian 12, or their like, are needed:" \
       $packages >&2
  exit 0
fi

installed=$(dpkg-query -W -f '${Package}=${db:Status-Status} ' $packages 2>/dev/null || true)
missing=""
for package in $packages; do
  case " $installed" in
    *" $package=installed "*) ;;
    *) missing="$missing $package" ;;
  esac
done
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" -ne 0 ]; then
  as_root="sudo"
fi
for tool in apt-get $as_root; do
  if ! command -v "$tool" >/dev/null; then
    echo "possibility: $tool is not here to install what is missing:$missing" >&2
    exit 1
  fi
done

log=$(mktemp)
trap 'rm -f "$log"' EXIT
echo "possibility: installing$missing" >&2
if ! { $as_root apt-get -q update &&
       $as_root env DEBIAN_FRONTEND=noninteractive \
           apt-get -q -y --no-install-recommends install $missing; } >"$log" 2>&1; then
  cat "$log" >&2
  echo "possibility: could not install:$missing" >&2
  exit 1
fi
