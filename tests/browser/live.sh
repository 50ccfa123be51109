#!/usr/bin/env bash
# live.sh LRBSCOPE: makes the live page of a run and opens it in headless Chromium. Compares the engine in the page with the native
# one: relation, number of pairs and fingerprint at 1,000 poses, and at the poses to which drive_live.js drags B. Skipped (77)
# without Chromium or without the engine for pages (-DLRB_WASM=ON).
set -euo pipefail
lrbscope=$(realpath "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/chromium.sh"

if ! "$lrbscope" --quiet run "$here/meet.json" --live --frames none -o "$work/out" >/dev/null 2>"$work/error"; then
  if grep -q 'LRB_WASM=ON' "$work/error"; then
    echo "live.sh: skipped: $(cat "$work/error")"
    exit 77
  fi
  cat "$work/error" >&2
  exit 1
fi

# Random rotations of B, near A: two thirds of them meet it.
awk 'BEGIN {
  srand(40)
  for (i = 0; i < 1000; i++) {
    do {
      norm = 0
      for (k = 0; k < 4; k++) { q[k] = 2 * rand() - 1; norm += q[k] * q[k] }
    } while (norm > 1 || norm < 0.01)
    for (k = 0; k < 4; k++) q[k] /= sqrt(norm)
    w = q[0]; x = q[1]; y = q[2]; z = q[3]
    printf "%.17g %.17g %.17g %.17g ", 1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 4 * rand() - 2
    printf "%.17g %.17g %.17g %.17g ", 2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 4 * rand() - 2
    printf "%.17g %.17g %.17g %.17g\n", 2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), 4 * rand() - 2
  }
}' >"$work/poses.txt"

# native POSES: prints "relation pairs fingerprint" of each pose.
native() {
  "$lrbscope" query "$work/out/a.lrb" "$work/out/b.lrb" --poses "$1" |
    sed -E 's/.*"relation":"([a-z_]*)","pairs":([0-9]*),"fingerprint":"([0-9a-f]*)".*/\1 \2 \3/'
}

{
  sed '/^<head>$/q' "$work/out/live.html"
  script watch.js
  sed -e '1,/^<head>$/d' -e '/^<\/body>$/,$d' "$work/out/live.html"
  printf '<script type="text/plain" id="poses">%s</script>\n' "$(cat "$work/poses.txt")"
  script drive_live.js
  echo '</body></html>'
} >"$work/page.html"
# Twice if there is no result at all: on a machine under load the browser may be ended before the engine is compiled.
for attempt in 1 2; do
  browse --window-size=1400,900 --timeout=300000 --virtual-time-budget=600000 "${webgl[@]}" "file://$work/page.html" >"$work/dom" || true
  sed -n '/<pre id="driven">/,/<\/pre>/p' "$work/dom" | sed -e 's/.*<pre id="driven">//' -e 's/<\/pre>.*//' | unmarked >"$work/driven"
  [ ! -s "$work/driven" ] || break
  echo "live.sh: attempt $attempt: the browser printed no result" >&2
done
grep -v '^pose ' "$work/driven" | cut -c1-200 || true

failed=0
if grep -q '^FAIL' "$work/driven" || ! grep -q '^done' "$work/driven"; then
  echo "live.sh: the page failed" >&2
  tail -5 "$work/browser.log" >&2
  failed=1
fi
native "$work/poses.txt" >"$work/native"
sed -n 's/^pose //p' "$work/driven" >"$work/page"
if ! cmp "$work/native" "$work/page" || [ "$(wc -l <"$work/page")" -ne 1000 ]; then
  diff "$work/native" "$work/page" | head -5 >&2 || true
  echo "live.sh: the page's answers differ from native ones" >&2
  failed=1
fi
cut -d' ' -f1 "$work/native" | sort | uniq -c
# At least one of each kind, so that the comparison says something.
for relation in separate crossing; do
  [ "$(grep -c "^$relation " "$work/native")" -ge 100 ] || { echo "live.sh: fewer than 100 poses are $relation" >&2 && failed=1; }
done

sed -n 's/^dragged to //p' "$work/driven" >"$work/dragged"
sed -n 's/^dragged answer //p' "$work/driven" >"$work/dragged_page"
native "$work/dragged" >"$work/dragged_native"
if [ ! -s "$work/dragged" ] || ! cmp "$work/dragged_native" "$work/dragged_page"; then
  echo "live.sh: the answers shown after dragging differ from native ones" >&2
  diff "$work/dragged_native" "$work/dragged_page" >&2 || true
  failed=1
fi
exit "$failed"
