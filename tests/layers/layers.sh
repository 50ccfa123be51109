#!/usr/bin/env bash
# layers.sh [TREE]: checks every project #include in the tree's sources, and the number of lines of every module, against
# modules.txt. Fails on an include that its module may not depend on, on a folder or public header that is not listed, on a cyclic
# list, and on a module with more lines than its budget.
# layers.sh --lower: sets each number of modules.txt to the present number of lines if that is lower.
# layers.sh --self-test: adds includes and files that are not allowed to a copy, and fails unless each is detected.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
root=$(cd "$here/../.." && pwd)
tops=(engine trace render scenarios bench tools python)

check() { # the tree's root
  cd "$1"
  # Eigen's sums differ between processors: the building of bodies must not.
  ! grep -rnE '(\.|->)(dot|norm|squaredNorm|normalized|sum)\(' engine/construct engine/mesh engine/tree/binary_tree.?pp engine/tree/*_kernel.inl ||
    { echo "expected dot3(), norm3(), ... of engine/core/geometry.hpp in the building of bodies, found Eigen's"; return 1; }
  grep -rHE --include=*.hpp --include=*.cpp --include=*.inl '^#include ("(engine|trace|render|scenarios|bench|tools|python|tests)/|<lrbscope/)' "${tops[@]}" |
    awk -v modules="$here/modules.txt" -v folders="$(find "${tops[@]}" '(' -name '*.[chi]pp' -o -name '*.inl' ')' -not -path '*/include/*' -printf '%h\n' | sort -u | tr '\n' ' ')" \
        -v headers="$(find engine/include -name '*.hpp' | sort | tr '\n' ' ')" '
      function sees(from, to, depth,   n, i, next_rooms) {
        if (depth > 50 || (from, to) in fails) return 0
        n = split(seen[from], next_rooms, " ")
        for (i = 1; i <= n; i++) if (next_rooms[i] == to || sees(next_rooms[i], to, depth + 1)) return 1
        fails[from, to] = 1
        return 0
      }
      # A public header belongs to the module that implements it, so that no dependency is hidden.
      function room_of(path) {
        if (path in owner) return owner[path]
        sub(/\/include\/lrbscope\/.*$/, "/x", path)
        sub(/\/[^\/]*$/, "", path)
        return path
      }
      BEGIN {
        while ((getline line < modules) > 0) {
          if (line ~ /^ *(#|$)/) continue
          if (split(line, part, / has +/) == 2) {
            count = split(part[2], listed, " ")
            for (i = 1; i <= count; i++) owner["engine/include/lrbscope/" listed[i] ".hpp"] = part[1]
            continue
          }
          if (split(line, part, /: */) < 2) continue  # a folder that is no module
          known[part[1]] = 1
          sub(/^[0-9]+ */, "", part[2])  # the number of lines
          seen[part[1]] = part[2]
        }
        for (module in known) {
          count = split(seen[module], listed, " ")
          for (i = 1; i <= count; i++) if (!(listed[i] in known)) complain("modules.txt: " module " may depend on " listed[i] ", which is not listed")
          if (sees(module, module, 0)) complain("modules.txt: " module " depends on itself: break the cycle")
        }
        count = split(folders, there, " ")
        for (i = 1; i <= count; i++) if (!(there[i] in known)) complain(there[i] ": a new folder: list it and its dependencies in tests/layers/modules.txt")
        count = split(headers, there, " ")
        for (i = 1; i <= count; i++) if (!(there[i] in owner)) complain(there[i] ": a new public header: list it with the module that implements it in tests/layers/modules.txt")
        for (header in owner) if (index(" " headers, " " header " ") == 0) complain("modules.txt: no such header: " header)
      }
      function complain(text) { print text; bad = 1 }
      {
        file = $0; sub(/:#include.*/, "", file)
        target = $0; sub(/^[^"<]*["<]/, "", target); sub(/[">].*/, "", target)
        if (target ~ /^lrbscope\//) {
          component = "engine"
          if (target ~ /^lrbscope\/(trace|render)\//) { component = target; sub(/^lrbscope\//, "", component); sub(/\/.*/, "", component) }
          target = component "/include/" target
        }
        from = room_of(file); to = room_of(target); includes++
        key = from SUBSEP to
        if (!(key in verdict)) verdict[key] = from == to || sees(from, to, 0)
        if (!verdict[key]) complain(file ": includes " target ", but " from " may not depend on " to " (tests/layers/modules.txt)")
      }
      END { if (!bad) print includes " includes between modules, all allowed by tests/layers/modules.txt"; exit bad }'
}

# Counts the lines of each module's tracked files in the tree $1: source files, scripts, pages and documents, but no data. Prints
# modules.txt with the lower numbers to $2. Prints modules with more lines than their number, and fails if there are any.
count_lines() {
  (cd "$1" && git ls-files -z | tr '\0' '\n' | grep -E '\.(cpp|hpp|inl|h|cc|py|pyi|sh|js|css|html|md|cmake|txt|sql|in)$|^(run|check|\.ci/run)$' |
    while read -r file; do [ ! -f "$file" ] || echo "$file"; done | xargs -d '\n' awk 'FNR == 1 { names[++count] = FILENAME } { lines[FILENAME]++ } END { for (i = 1; i <= count; i++) print lines[names[i]], names[i] }') |
    awk -v modules="$here/modules.txt" -v lowered="$2" '
      BEGIN {
        while ((getline line < modules) > 0) {
          text[++rows] = line
          if (line ~ /^ *(#|$)/) continue
          if (split(line, part, / has +/) == 2) {
            count = split(part[2], listed, " ")
            for (i = 1; i <= count; i++) owner["engine/include/lrbscope/" listed[i] ".hpp"] = part[1]
          } else if (split(line, part, /: *| +lines +/) == 2) {
            name[rows] = part[1]
            budget[part[1]] = part[2] + 0
          }
        }
      }
      # The listed folder that holds the file; for a public header, the module that implements it.
      function room_of(path) {
        if (path in owner) return owner[path]
        while (sub(/\/[^\/]*$/, "", path)) if (path in budget) return path
        return "."
      }
      { path = $0; sub(/^[0-9]+ /, "", path); used[room_of(path)] += $1; used["all"] += $1 }
      END {
        for (i = 1; i <= rows; i++) {
          if (!(i in name)) { print text[i] > lowered; continue }
          if (used[name[i]] > budget[name[i]]) {
            print "modules.txt: " name[i] " may have " budget[name[i]] " lines and has " used[name[i]] + 0 ": remove some, here or elsewhere, before you add"
            over = 1
          } else if (match(text[i], / +[0-9]+/)) {
            text[i] = substr(text[i], 1, RSTART - 1) sprintf("%" RLENGTH "d", used[name[i]]) substr(text[i], RSTART + RLENGTH)
          }
          print text[i] > lowered
        }
        if (!over) print used["all"] " lines, of " budget["all"] " in the budget" (used["all"] < budget["all"] ? ": lower it by tests/layers/layers.sh --lower" : "")
        exit over
      }'
}

self_test() {
  copy=$(mktemp -d)
  trap 'rm -rf "$copy"' EXIT # not local: the trap outlives this function
  (cd "$root" && find "${tops[@]}" -name '*.[chi]pp' -o -name '*.inl' | tar -cf - -T -) | tar -xf - -C "$copy"
  # Includes against the list: of a private and of a public header, by a private and by a public one.
  while read -r file target; do
    echo "#include $target" >>"$copy/$file"
    ! (check "$copy") >"$copy/said" && grep -qF "$file: includes " "$copy/said" || { echo "layers.sh: did not detect that $file includes $target" >&2; return 1; }
  done <<'END'
engine/core/geometry.hpp "engine/collide/tree_query.hpp"
engine/tree/kernel_setup.hpp <lrbscope/collide.hpp>
engine/include/lrbscope/mesh.hpp <lrbscope/scene.hpp>
engine/include/lrbscope/lrb_rep.hpp "engine/collide/tree_query.hpp"
trace/include/lrbscope/trace/event.hpp "tools/options.hpp"
render/scene_parts.hpp "scenarios/io/files.hpp"
END
  mkdir "$copy/engine/attic" && : >"$copy/engine/attic/x.hpp"
  ! (check "$copy") >"$copy/said" && grep -q '^engine/attic: a new folder' "$copy/said" || { echo "layers.sh: did not detect a new folder" >&2; return 1; }
  rm -r "$copy/engine/attic"
  : >"$copy/engine/include/lrbscope/attic.hpp"
  ! (check "$copy") >"$copy/said" && grep -q 'attic.hpp: a new public header' "$copy/said" || { echo "layers.sh: did not detect a new public header" >&2; return 1; }
  rm "$copy/engine/include/lrbscope/attic.hpp"
  (cd "$copy" && git init -q && git add . && here=$copy && sed 's/^all  *lines .*/all lines 1/' "$root/tests/layers/modules.txt" >modules.txt &&
    ! count_lines "$copy" /dev/null >said && grep -q '^modules.txt: all may have 1 lines' said) || { echo "layers.sh: did not detect too many lines" >&2; return 1; }
  echo "includes against the list, a new folder, a new public header and too many lines: all detected"
}

case "${1:-}" in
  --self-test) self_test ;;
  --lower)
    lower=$(mktemp)
    count_lines "$root" "$lower" && cat "$lower" >"$here/modules.txt"
    rm "$lower"
    ;;
  *)
    check "${1:-$root}"
    if [ -e "${1:-$root}/.git" ]; then count_lines "${1:-$root}" /dev/null; else echo "lines not counted: no git repository"; fi
    ;;
esac
