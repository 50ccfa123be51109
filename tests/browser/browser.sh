#!/usr/bin/env bash
# browser.sh LRBSCOPE: makes pages of runs and of a tree, opens them in headless Chromium, and drives them (drive.js,
# drive_tree.js, drive_compare.js). Fails if a page disagrees with the trace or the tree, and on any error in the
# browser's console. measure.sh measures pages of each kind. Skipped (77) without Chromium.
set -euo pipefail
lrbscope=$(realpath "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
source "$here/chromium.sh"

# page SCENARIO: runs it, and writes its page with the scripts of this folder and its trace to $work/page.html.
page() {
  "$lrbscope" --quiet run "$1" -o "$work/out" >/dev/null
  {
    with_scripts "$work/out/index.html" drive.js
    echo '<script type="application/json" id="trace-data">'
    sed 's/</\\u003c/g' "$work/out/trace.json"
    echo '</script>'
  } >"$work/page.html"
}

# drive WIDTH HEIGHT FILE OPTION...: opens a file of $work and prints the results of drive.js.
drive() {
  local size=$1,$2 file=$3
  shift 3
  browse --window-size="$size" --virtual-time-budget=60000 "$@" "file://$work/$file" >"$work/dom" || true
  sed -n '/<pre id="driven">/,/<\/pre>/p' "$work/dom" |
    sed -e 's/.*<pre id="driven">//' -e 's/<\/pre>.*//' | unmarked >"$work/driven"
  sed "s/^/$size: /" "$work/driven"
  if grep -q '^FAIL' "$work/driven" || ! grep -q '^done' "$work/driven"; then
    echo "browser.sh: the page failed at $size" >&2
    tail -5 "$work/browser.log" >&2
    failed=1
  fi
}

failed=0
page "$here/meet.json"
drive 1600 1200 'page.html?drive=all' "${webgl[@]}"
# The address that the page made leads to the same state in a page that opens with it.
camera=$(sed -n 's/^camera //p' "$work/driven")
command=$(sed -n 's/^command lrbscope //p' "$work/driven")
verdict=$(sed -n 's/^verdict .*Decided by \(.*\)\./\1/p' "$work/driven")
hash=$(sed -n 's/^hash //p' "$work/driven")
drive 1400 900 "page.html?drive=reload$hash" "${webgl[@]}"
for size in "1920 1080" "1280 800" "1000 800"; do
  # shellcheck disable=SC2086
  drive $size 'page.html?drive=screen' "${webgl[@]}"
done
# The camera copied by the page is valid in a scenario.
scenario=$(cat "$here/meet.json")
printf '%s\n' "${scenario/'"frames": {'/"\"frames\": { \"most\": 1, \"views\": [$camera],"}" >"$work/copied.json"
"$lrbscope" --quiet run "$work/copied.json" -o "$work/copied" >/dev/null
# The command shown by the page gives the page's verdict.
if ! eval "\"$lrbscope\" $command" | grep -qxF "decided by $verdict"; then
  echo "browser.sh: \"$command\" does not print \"decided by $verdict\"" >&2
  failed=1
fi
drive 1200 900 'page.html?drive=flat' --disable-gpu --disable-3d-apis --disable-software-rasterizer
page "$here/build.json"
drive 1400 1000 'page.html?drive=build' "${webgl[@]}"
# Two constructions of a body; its page frames those of the runs, in which the driver reads what is selected.
sed 's/"frequency": 8 }/&, "build": { "patch_interior": 6 }/' "$here/build.json" >"$work/other.json"
"$lrbscope" --quiet run "$work/other.json" -o "$work/other" --frames none >/dev/null
"$lrbscope" --quiet compare "$work/out" "$work/other" -o "$work/compare" >/dev/null || [ $? = 1 ]
with_scripts "$work/compare/index.html" drive_compare.js >"$work/compare/page.html"
drive 1400 1000 compare/page.html "${webgl[@]}" --allow-file-access-from-files
page "$here/plane.json"
drive 1400 1000 'page.html?drive=plane' "${webgl[@]}"
page "$here/near.json"
drive 1400 1000 'page.html?drive=measured' "${webgl[@]}"
page "$here/open.json"
drive 1400 1000 'page.html?drive=open' "${webgl[@]}"
"$lrbscope" --quiet tree "$work/out/a.lrb" -o "$work/tree" >/dev/null
with_scripts "$work/tree/index.html" drive_tree.js >"$work/page.html"
drive 1400 1000 page.html "${webgl[@]}"
exit "$failed"
