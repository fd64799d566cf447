# SPDX-License-Identifier: Apache-2.0
# What quickstart, runtests and bench share: Debian packages, configure, build. Sourced by them; expects $root.
# Every step is skipped when its result is there already, so a second run does next to nothing.

say() { printf '%s\n' "$*"; }
fail() { printf '%s\n' "$*" >&2; exit 3; }

# Runs a command with its output in a log; shows the end of the log when the command fails.
logged() {
    local log=$1; shift
    mkdir -p "$(dirname "$log")"
    "$@" >"$log" 2>&1 </dev/null && return
    tail -n 40 "$log" >&2
    fail "failed: $* (whole log: $log)"
}

missing_packages() {
    local package
    while read -r package; do
        case $package in '' | '#'*) continue ;; esac
        dpkg-query -W -f='${Status}\n' "$package" 2>/dev/null | grep -q '^install ok installed' || echo "$package"
    done <"$root/scripts/packages.txt"
}

# Installs what is missing; touches neither network nor package system when nothing is.
install_packages() {
    if ! command -v dpkg-query >/dev/null; then
        say "packages: not a Debian system; the packages of scripts/packages.txt are needed"
        return
    fi
    local missing as_root=()
    missing=$(missing_packages)
    [ -n "$missing" ] || return 0
    if [ "$(id -u)" != 0 ]; then
        command -v sudo >/dev/null || fail "missing packages; as root: apt-get install" $missing
        as_root=(sudo)
    fi
    say "packages: installing" $missing
    logged "$root/build-logs/apt.log" "${as_root[@]}" apt-get update
    logged "$root/build-logs/apt.log" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
        apt-get install -y --no-install-recommends $missing
}

# configure FOLDER MESON-OPTIONS...: sets a build folder up. Meson lists the test cases when it configures, so a folder
# that exists is configured again when cases came or went.
configure() {
    local folder=$1; shift
    local cases; cases=$(python3 -B "$root/testsuite/run.py" --list-cases)
    # An interrupted first configuration leaves a folder that Meson cannot configure again.
    [ -f "$folder/build.ninja" ] || rm -rf "$folder"
    if [ ! -d "$folder" ]; then
        say "configure: $(basename "$folder")"
        logged "$root/build-logs/configure.log" meson setup "$folder" "$root" "$@"
    elif [ "$cases" != "$(cat "$folder/cases.seen" 2>/dev/null)" ]; then
        logged "$root/build-logs/configure.log" meson setup --reconfigure "$folder" "$root"
    fi
    printf '%s\n' "$cases" >"$folder/cases.seen"
}

# What `meson install` installs, as targets of the build; tests and benchmarks are not among them.
installed_targets() {
    python3 -B - "$1" <<'PYTHON'
import json, os, sys
folder = os.path.realpath(sys.argv[1])
with open(os.path.join(folder, "meson-info", "intro-installed.json"), encoding="utf-8") as file:
    for path in map(os.path.realpath, json.load(file)):
        if path.startswith(folder + os.sep):
            print(os.path.relpath(path, folder))
PYTHON
}

# build FOLDER [TARGET...]: all of it without targets.
build() {
    local folder=$1; shift
    logged "$root/build-logs/build.log" ninja -C "$folder" "$@"
}

# The build that users get: optimised, assertions off, installed into dist/.
set_up_release() {
    install_packages
    configure "$root/build-release" --prefix="$root/dist" --libdir=lib --buildtype=release -Doptimization=2
    say "build: programs and shaders"
    build "$root/build-release" $(installed_targets "$root/build-release")
    logged "$root/build-logs/install.log" meson install -C "$root/build-release" --no-rebuild --only-changed
}
