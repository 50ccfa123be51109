#!/usr/bin/env bash
# layers.sh [TREE]: reads every #include of ours in engine, trace, render and scenarios against rooms.txt, and fails on each
# that goes where its room may not see, on a folder that is not on the list, and on a list with a circle.
# layers.sh --self-test: turns an include of each room round, one after another in a copy, and fails unless each is found.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tops=(engine trace render scenarios)

check() { # the tree's root
  cd "$1"
  grep -rHE --include=*.hpp --include=*.cpp --include=*.inl '^#include "(engine|trace|render|scenarios|tests)/' "${tops[@]}" |
    awk -v rooms="$here/rooms.txt" -v folders="$(find "${tops[@]}" -name '*.[chi]pp' -printf '%h\n' | sort -u | tr '\n' ' ')" '
      function sees(from, to, depth,   n, i, next_rooms) {
        if (depth > 50) return 0
        n = split(seen[from], next_rooms, " ")
        for (i = 1; i <= n; i++) if (next_rooms[i] == to || sees(next_rooms[i], to, depth + 1)) return 1
        return 0
      }
      function folder(path) { sub(/\/[^\/]*$/, "", path); return path }
      BEGIN {
        while ((getline line < rooms) > 0) {
          if (line ~ /^ *(#|$)/) continue
          split(line, part, /: */)
          known[part[1]] = 1
          seen[part[1]] = part[2]
        }
        for (room in known) {
          count = split(seen[room], listed, " ")
          for (i = 1; i <= count; i++) if (!(listed[i] in known)) complain("rooms.txt: " room " may see " listed[i] ", which is not on the list")
          if (sees(room, room, 0)) complain("rooms.txt: " room " sees itself: break the circle")
        }
        count = split(folders, there, " ")
        for (i = 1; i <= count; i++) if (!(there[i] in known)) complain(there[i] ": a new folder: put it, and what it may see, on tests/layers/rooms.txt")
      }
      function complain(text) { print text; bad = 1 }
      {
        file = $0; sub(/:#include.*/, "", file)
        target = $0; sub(/^[^"]*"/, "", target); sub(/".*/, "", target)
        from = folder(file); to = folder(target); includes++
        key = from SUBSEP to
        if (!(key in verdict)) verdict[key] = from == to || sees(from, to, 0)
        if (!verdict[key]) complain(file ": includes " target ", but " from " may not see " to " (tests/layers/rooms.txt)")
      }
      END { if (!bad) print includes " includes between rooms, all as tests/layers/rooms.txt allows"; exit bad }'
}

self_test() {
  local root turned=0
  root=$(cd "$here/../.." && pwd)
  copy=$(mktemp -d)
  trap 'rm -rf "$copy"' EXIT # not local: the trap outlives this function
  (cd "$root" && find "${tops[@]}" -name '*.[chi]pp' -o -name '*.inl' | tar -cf - -T -) | tar -xf - -C "$copy"
  # An include from one room to another, turned round: the header that was included includes its user's room.
  while read -r file header; do
    cp "$copy/$header" "$copy/kept"
    printf '#include "%s"\n' "$file" >>"$copy/$header"
    if (check "$copy") >"$copy/said"; then
      echo "layers.sh: did not notice that $header includes $file" >&2
      return 1
    fi
    grep -qF "$header: includes $file" "$copy/said" || { echo "layers.sh: complained of something else than $header" >&2; return 1; }
    mv "$copy/kept" "$copy/$header"
    turned=$((turned + 1))
  done < <(cd "$copy" && grep -rHoE --include=*.hpp '^#include "(engine|trace|render|scenarios)/[^"]+' "${tops[@]}" | sed 's/:#include "/ /' |
             awk '{ a = $1; b = $2; sub(/\/[^\/]*$/, "", a); sub(/\/[^\/]*$/, "", b); if (a != b && !(a in done)) { done[a] = 1; print $1, $2 } }')
  [ "$turned" -gt 10 ] || { echo "layers.sh: only $turned includes to turn round" >&2; return 1; }
  mkdir "$copy/engine/attic" && : >"$copy/engine/attic/x.hpp"
  ! (check "$copy") >"$copy/said" && grep -q '^engine/attic: a new folder' "$copy/said" || { echo "layers.sh: did not notice a new folder" >&2; return 1; }
  echo "$turned includes turned round, and a new folder: each was noticed"
}

case "${1:-}" in
  --self-test) self_test ;;
  *) check "${1:-$here/../..}" ;;
esac
