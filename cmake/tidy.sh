#!/usr/bin/env bash
# cmake/tidy.sh [--seconds N] [FILE...]: runs clang-tidy on these files. Without files: on those that differ from the branch
# main (on main itself: from the commit before), and then, for N seconds (0), on others. Fails on any finding. A file that has
# passed is skipped until it, a header of ours that it includes, or .clang-tidy changes;
# ${XDG_CACHE_HOME:-~/.cache}/lrbscope-tidy remembers them, so that short runs reach all files in time.
set -euo pipefail
script=$(readlink -f "${BASH_SOURCE[0]}")
cd "$(dirname "$script")/.."
database=build/tidy
passed=${XDG_CACHE_HOME:-$HOME/.cache}/lrbscope-tidy

# Prints a hash of all that the verdict on file $1 depends on.
state_of() {
  local command
  command=$(python3 - "$1" "$database" <<'P'
import json, os, re, sys
for entry in json.load(open(sys.argv[2] + "/compile_commands.json")):
    if os.path.realpath(entry["file"]) == os.path.realpath(sys.argv[1]):  # other files may be made only by building
        print("cd", entry["directory"], "&&", re.sub(r" -o \S+", "", entry["command"]), "-MM")
        break
P
  )
  { cat .clang-tidy; bash -c "$command" | tr -d '\\\n' | sed 's/^[^:]*://' | xargs cat; } | sha256sum | cut -c1-32
}

# Checks file $2 unless it has passed. After time $1 (`date +%s`) does not, and prints the file to file descriptor 3.
look_at() {
  local state
  [ "$(date +%s)" -lt "$1" ] || { echo "$2" >&3 && return 0; }
  state=$(state_of "$2")
  [ ! -f "$passed/$state" ] || return 0
  clang-tidy -p "$database" --quiet --warnings-as-errors='*' "$2" 2> >(grep -v 'warnings generated\.$\|^Suppressed\|^Use -header' >&2) || return 1
  touch "$passed/$state"
}
if [ "${1:-}" = --look ]; then
  look_at "$2" "$3"
  exit
fi

seconds=0
if [ "${1:-}" = --seconds ]; then seconds=${2:?a number} && shift 2; fi
case "${1:-}" in -*) sed -n '2,6s/^# //p' "$script" >&2 && exit 2 ;; esac
mkdir -p "$passed"
find "$passed" -type f -mtime +60 -delete
# Without precompiled headers and files compiled together, so that each file is seen to include what it uses.
cmake --preset clang -B "$database" -DLRB_BUILD_TESTS=ON -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DCMAKE_UNITY_BUILD=OFF >/dev/null

known=$(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' "$database/compile_commands.json" | grep -v "/$database/" |
  sed "s|^$PWD/||" | sort -u)
changed_files() { # against main, or against the commit before
  local base
  base=$(git merge-base HEAD main 2>/dev/null || git merge-base HEAD origin/main 2>/dev/null) || return 0
  if [ "$base" = "$(git rev-parse HEAD)" ]; then base=$(git rev-parse -q --verify HEAD~1) || return 0; fi
  git diff --name-only --diff-filter=d "$base" -- '*.cpp' '*.hpp' '*.inl'
}
# A header is checked as part of a file that includes it: its own source file, or another one.
sources_of() {
  local file
  while IFS= read -r file; do
    case "$file" in
      *.cpp) echo "$file" ;;
      *)
        if [ -f "${file%.*}.cpp" ]; then echo "${file%.*}.cpp"; else grep -rlF "\"$file\"" --include='*.cpp' engine trace render scenarios bench tools python tests | head -1; fi
        ;;
    esac
  done | sort -u
}
if [ $# -gt 0 ]; then first=$(printf '%s\n' "$@"); else first=$(changed_files); fi
first=$(comm -12 <(sources_of <<<"$first") <(echo "$known"))
others=""
if [ $# = 0 ] && [ "$seconds" -gt 0 ]; then others=$(comm -13 <(echo "$first") <(echo "$known") | shuf --random-source=<(yes)); fi

end=$(($(date +%s) + seconds))
left=$(mktemp)
trap 'rm -f "$left"' EXIT
each() { xargs -r -P "$(nproc)" -I{} bash "$script" --look "$1" {} 3>>"$left"; }
found=0
sed '/^$/d' <<<"$first" | each 9999999999 || found=1
sed '/^$/d' <<<"$others" | each "$end" || found=1
[ $found = 0 ] || { echo "tidy.sh: mend what clang-tidy found" >&2 && exit 1; }
count() { sed '/^$/d' <<<"$1" | wc -l; }
echo "tidy: nothing found in $(($(count "$first") + $(count "$others") - $(wc -l <"$left"))) files; not looked at for want of time: $(wc -l <"$left")"
