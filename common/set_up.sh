# shellcheck shell=bash
# Installs what is missing on Debian and Ubuntu; sourced by lessons/run and tests/run.
# Elsewhere the README names the packages, and the presets work by themselves.

packages=(g++ cmake ninja-build libglm-dev libcli11-dev libstb-dev nlohmann-json3-dev libtinygltf-dev
          libgtest-dev libtinyobjloader-dev)

set_up() {
    command -v dpkg-query >/dev/null || return 0
    local package missing=() as_root=()
    for package in "${packages[@]}"; do
        [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing+=("$package")
    done
    [ ${#missing[@]} -gt 0 ] || return 0
    if [ "$(id -u)" -ne 0 ]; then
        if ! command -v sudo >/dev/null; then
            echo "error: please install ${missing[*]} (as root: apt-get install ...), then run this again" >&2
            return 1
        fi
        as_root=(sudo)
    fi
    echo "Installing ${missing[*]}"
    local log
    log=$(mktemp)
    if ! { "${as_root[@]}" apt-get update && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
           apt-get install -y --no-install-recommends "${missing[@]}"; } >"$log" 2>&1; then
        tail -n 20 "$log" >&2
        echo "error: apt-get could not install them; its whole output is in $log" >&2
        return 1
    fi
    rm -f "$log"
}

# Prints the folder of the lesson that $1 names: its number ("02", "2") or its name.
find_lesson() {
    local number=$1 folder
    [[ $number =~ ^[0-9]$ ]] && number=0$number
    for folder in lessons/[0-9][0-9]_*/; do
        folder=$(basename "$folder")
        if [ "$folder" = "$1" ] || [ "${folder%%_*}" = "$number" ]; then echo "$folder"; return; fi
    done
    echo "error: there is no lesson '$1' (its number comes first); there are: $(cd lessons && echo [0-9][0-9]_*)" >&2
    return 1
}

# Sets `preset`, the build's: "release", or "mine" when $1 is --mine; then says what is the reader's.
# shellcheck disable=SC2034  # it is for the script that calls
choose_preset() {
    preset=release
    [ "${1-}" = --mine ] || return 0
    preset=mine
    local headers=(mine/[0-9][0-9]_*/*.hpp)
    if [ ! -e "${headers[0]}" ]; then
        echo "error: there is no header in mine/ yet; ./lessons/run --start NN puts one there" >&2
        return 1
    fi
    echo "Yours: ${headers[*]}"
}

# Builds the targets in build/$preset; a build folder of another place, as in a moved clone, starts anew.
build() {
    local home fresh=() note=
    home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "build/$preset/CMakeCache.txt" 2>/dev/null || true)
    [ -z "$home" ] || [ "$home" = "$PWD" ] || fresh=(--fresh)
    [ "$home" = "$PWD" ] || note=" (the first time takes a minute or two)"
    quietly cmake --preset "$preset" "${fresh[@]}"
    cmake --build --preset "$preset" --target "$@" -- -n | grep -q 'no work to do' && return
    echo "Building$note"
    quietly cmake --build --preset "$preset" --target "$@"
}

# Runs a command quietly; shows what it printed when it fails.
quietly() {
    local log
    log=$(mktemp)
    if ! "$@" >"$log" 2>&1; then
        cat "$log" >&2
        rm -f "$log"
        echo "error: '$*' failed" >&2
        return 1
    fi
    rm -f "$log"
}
