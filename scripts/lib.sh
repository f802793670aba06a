# shellcheck shell=bash disable=SC2034
# Shared by the scripts in this folder: packages, users, builds. Sourced by bash with `set -euo pipefail`.
#
# After sourcing: ROOT is the project's folder and the current directory. Messages go to stderr, so
# that stdout belongs to the program that a script runs.

ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
cd "$ROOT" || exit

# To build the server. "package:command" also counts as installed if the command comes from elsewhere.
BUILD_PACKAGES=(g++:g++ cmake:cmake ninja-build:ninja pkgconf:pkg-config esbuild:esbuild
  libcpp-httplib-dev nlohmann-json3-dev libeigen3-dev libspdlog-dev libcli11-dev libpng-dev
  libyaml-cpp-dev)
# In addition: for the tests of the release build, for all tests, for the checks of the sources, for the fuzz targets.
UNIT_TEST_PACKAGES=(libgtest-dev libgmock-dev python3:python3 curl:curl jq:jq)
TEST_PACKAGES=(nodejs:node npm:npm chromium-headless-shell:chromium-headless-shell haproxy:haproxy mosquitto:mosquitto
  mypy python3-build python3-paho-mqtt python3-pip python3-setuptools python3-wheel)
CHECK_PACKAGES=(clang-tidy:clang-tidy)
FUZZ_PACKAGES=(clang:clang++ libclang-rt-dev)

say() { printf '%s: %s\n' "${0##*/}" "$*" >&2; }
die() { say "$*"; exit 1; }

# ---------------------------------------------------------------- packages

# missing_packages PACKAGE[:COMMAND]...: prints the names of the packages that are not installed.
missing_packages() {
  local wanted installed
  installed=$(dpkg-query -W -f '${Package} ${Status}\n' "${@%%:*}" 2>/dev/null || true)
  for wanted in "$@"; do
    grep -qxF "${wanted%%:*} install ok installed" <<<"$installed" && continue
    [[ $wanted == *:* ]] && command -v "${wanted#*:}" >/dev/null && continue
    printf '%s\n' "${wanted%%:*}"
  done
}

as_root() {
  if [ "$(id -u)" = 0 ]; then "$@"; else sudo "$@"; fi
}

# need_packages PACKAGE[:COMMAND]...: installs the missing packages, if any.
need_packages() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    die "this is not a Debian system (no apt-get). Install the equivalents of: ${*%%:*};" \
      "then: cmake --preset serve && cmake --build --preset serve && build/serve/server/fleetplan"
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  [ ${#missing[@]} -gt 0 ] || return 0
  if [ "$(id -u)" != 0 ] && ! command -v sudo >/dev/null; then
    die "missing packages: ${missing[*]}. Run this once as root, or: apt-get install ${missing[*]}"
  fi
  say "installing ${missing[*]}"
  local apt=(env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=600
    -o Acquire::Retries=3 -o Dpkg::Use-Pty=0)
  local log
  log=$(mktemp)
  if ! { as_root "${apt[@]}" update && as_root "${apt[@]}" install --no-install-recommends "${missing[@]}"; } \
    >"$log" 2>&1 </dev/null; then
    tail -n 20 "$log" >&2
    rm -f "$log"
    die "could not install: ${missing[*]}"
  fi
  rm -f "$log"
}

# download_promtool: downloads the package with promtool to the current directory; in Debian 12 it is Prometheus' own.
download_promtool() { apt-get -q download promtool || apt-get -q download prometheus; }

# need_promtool: puts promtool, which checks metrics for Prometheus, on the PATH. If it is not installed, extracts it
# from its package (19 MB), because installing that would start a server on Debian 12.
need_promtool() {
  local folder=$ROOT/build/tools package
  PATH=$PATH:$folder/usr/bin
  command -v promtool >/dev/null && return 0
  say "fetching promtool"
  package=$(mktemp -d)
  (cd "$package" && { download_promtool || { as_root apt-get -q update && download_promtool; }; }) >&2 &&
    mkdir -p "$folder" &&
    dpkg-deb --fsys-tarfile "$package"/*.deb | tar -C "$folder" -x ./usr/bin/promtool
  rm -rf "$package"
  command -v promtool >/dev/null
}

# ---------------------------------------------------------------- users

# become_invoking_user SCRIPT [ARGS...]: when run through sudo, starts the script again as the user who called sudo. So
# the build belongs to this user. Stays root if this user cannot write to the project.
become_invoking_user() {
  [ "$(id -u)" = 0 ] && [ "${SUDO_UID:-0}" != 0 ] || return 0
  local entry name home
  entry=$(getent passwd "$SUDO_UID") || return 0
  IFS=: read -r name _ _ _ _ home _ <<<"$entry"
  local user=(setpriv --reuid "$SUDO_UID" --regid "${SUDO_GID:-$SUDO_UID}" --init-groups)
  "${user[@]}" test -w "$ROOT" || return 0
  if [ -e build ] && ! "${user[@]}" test -w build; then return 0; fi
  exec "${user[@]}" env -u SUDO_UID -u SUDO_GID HOME="$home" USER="$name" LOGNAME="$name" "$@"
}

# need_writable_build: reports how to proceed if an earlier run as root owns the build.
need_writable_build() {
  mkdir -p build 2>/dev/null || die "cannot write in $ROOT; run this as the user who owns it"
  local other
  other=$(find build -maxdepth 2 -type d ! -writable -print -quit)
  [ -z "$other" ] || die "$ROOT/$other belongs to another user (built as root before?):" \
    "sudo chown -R $(id -un) '$ROOT/build'"
}

# ---------------------------------------------------------------- builds

# How many compilers at once: as many as CPUs, and as memory allows at 1 GiB each.
build_jobs() {
  local cpus kib limit
  cpus=$(nproc)
  kib=$(awk '/^MemAvailable:/ {print $2}' /proc/meminfo)
  limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
  if [ "$limit" != max ] && [ $((limit / 1024)) -lt "$kib" ]; then kib=$((limit / 1024)); fi
  local fitting=$((kib / 1024 / 1024))
  if [ "$fitting" -lt 1 ]; then fitting=1; fi
  echo $((cpus < fitting ? cpus : fitting))
}

# configure PRESET [OPTIONS...]: quiet unless it fails; starts again if the old configuration cannot be used, for
# example after the project was moved.
configure() {
  local log
  log=$(mktemp)
  if ! cmake --preset "$@" >"$log" 2>&1 && ! cmake --fresh --preset "$@" >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    return 1
  fi
  rm -f "$log"
}

# build PRESET [TARGET...]: configures and builds.
build() {
  local preset=$1
  shift
  configure "$preset" && cmake --build --preset "$preset" -j "$(build_jobs)" ${1:+--target "$@"}
}
