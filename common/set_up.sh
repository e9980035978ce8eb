# shellcheck shell=bash
# Installs what is missing on Debian and Ubuntu; sourced by the scripts that build.
# Elsewhere the README names the packages, and the presets work by themselves.

packages=(g++ cmake ninja-build libglm-dev libcli11-dev libpng-dev libstb-dev nlohmann-json3-dev libtinygltf-dev
          libgtest-dev)

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

# Sets `preset`, the build's: "release"; or for --mine, "mine", and with what may follow it, --debug, --fast or --sanitize,
# "mine_debug" and so on. `taken` is the number of arguments that say so.
# shellcheck disable=SC2034  # they are for the script that calls
choose_preset() {
    preset=release
    taken=0
    [ "${1-}" = --mine ] || return 0
    preset=mine
    taken=1
    case ${2-} in
        --debug | --fast | --sanitize) preset=mine_${2#--} taken=2 ;;
    esac
    local files=(mine/[0-9][0-9]_*/*.[ch]pp)
    if [ ! -e "${files[0]}" ]; then
        echo "error: there is nothing in mine/ yet; ./lessons/run --start NN puts a lesson's files there" >&2
        return 1
    fi
}

# Builds the targets in build/$preset; a build folder of another place, as in a moved clone, starts anew.
build() {
    case $preset in
        mine | mine_debug | mine_fast) preset=release build common || return ;;  # they link what no reader changes
    esac
    local home fresh=() log of=${1%_complete}
    of=${of#lab_}
    home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "build/$preset/CMakeCache.txt" 2>/dev/null || true)
    [ -z "$home" ] || [ "$home" = "$PWD" ] || fresh=(--fresh)
    # A lesson is built again and again: then only what has changed is looked at, and not what may have been installed since.
    if [ "$1" != common ] && [ ! -d "lessons/${of%_hard_cases_test}" ] || [ "$home" != "$PWD" ] || [ CMakePresets.json -nt "build/$preset/build.ninja" ]; then
        quietly cmake --preset "$preset" "${fresh[@]}"
    fi
    log=$(mktemp)
    if ! cmake --build --preset "$preset" --target "$@" 2>&1 | show_progress "$log"; then
        cat "$log" >&2
        rm -f "$log"
        echo "error: this does not compile" >&2
        return 1
    fi
    [[ $preset != mine* ]] || cat "$log" >&2  # warnings
    rm -f "$log"
}

# Reads what a build prints: says how far it is, and writes what compilers say into the file $1. On a terminal the count moves
# in one line; elsewhere there is a line now and then.
show_progress() {
    local line said=$SECONDS is_shown=
    while IFS= read -r line; do
        if [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]]; then
            if [ -t 1 ]; then
                printf '\rBuilding: %s of %s ' "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}"
                is_shown=1
            elif ((BASH_REMATCH[1] > 0 && BASH_REMATCH[1] < BASH_REMATCH[2] && SECONDS - said >= 15)); then
                echo "Building: ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]}"
                said=$SECONDS
            fi
        elif [[ ! $line =~ ^(FAILED: |ninja: |-- |:\ \&\& |[^ ]*/(c\+\+|g\+\+|clang\+\+)[^ ]*\ |ccache ) ]]; then
            printf '%s\n' "$line" >>"$1"
        fi
    done
    [ -z "$is_shown" ] || printf '\r%*s\r' 40 ''
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

# Prints the lines "$1: ..." of the comment in the README of lesson $2.
marks_of() { sed -n "s/^$1: //p" "lessons/$2/README.md"; }

# Prints the lesson that lesson $1 goes on from: the one in its README's line "builds on: ", or the one before it; of the first
# one, nothing.
lesson_before() {
    local before folder
    before=$(marks_of "builds on" "$1")
    [ -n "$before" ] || for folder in lessons/[0-9][0-9]_*/; do
        folder=$(basename "$folder")
        [ "$folder" != "$1" ] || break
        before=$folder
    done
    echo "$before"
}

# Prints the main.cpp that lesson $1 begins with: that of the lesson before, with its own name and number.
main_to_begin_with() {
    local before
    before=$(lesson_before "$1")
    sed "s/\"$before\"/\"$1\"/; s|^/// Lesson ${before%%_*}|/// Lesson ${1%%_*}|" "lessons/$before/main.cpp"
}

# Prints one line of the steps of lesson $2, by its number $1: EQUATIONS | OPTIONS | PICTURES | TITLE.
step_of() {
    local line=
    [[ ! $1 =~ ^[1-9]$ ]] || line=$(marks_of step "$2" | sed -n "${1}p")
    if [ -z "$line" ]; then
        echo "error: lesson ${2%%_*} has no step '$1'; its steps are:" >&2
        marks_of step "$2" | awk -F ' *[|] *' '{ print "  " NR ": " $4 }' >&2
        return 1
    fi
    printf '%s\n' "$line"
}
