#!/usr/bin/env bash
# browser.sh LRBSCOPE: makes pages of runs, of a tree, of answers and of a crowd, opens them in headless Chromium, and drives them (drive.js,
# drive_tree.js, drive_answers.js, drive_crowd.js) with clicks, filters, sliders and keys. Fails if a page disagrees with the trace or the tree, and on any error in the
# browser's console. Skipped (77) without Chromium.
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

# in_frame WIDTH: writes $work/frame.html, the page in a frame of this width; browser windows cannot be as narrow as phones.
in_frame() {
  cat >"$work/frame.html" <<END
<!DOCTYPE html><body style="margin: 0"><iframe src="page.html?drive=layout" style="border: 0; width: $1px; height: 900px"></iframe>
<script>onmessage = (e) => { const out = document.createElement("pre"); out.id = "driven"; out.textContent = e.data; document.body.append(out); };</script>
END
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
for size in "1400 900" "1920 1080" "1000 800"; do
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
for width in 400 3000; do in_frame "$width" && drive 3200 1000 frame.html "${webgl[@]}"; done
drive 1200 900 'page.html?drive=flat' --disable-gpu --disable-3d-apis --disable-software-rasterizer
page "$here/build.json"
drive 1400 1000 'page.html?drive=build' "${webgl[@]}"
# Another engine's run, if its recording program is built.
echo '1 0 0 0.7  0 1 0 0  0 0 1 0' >"$work/poses.txt"
for method in fcl cgal; do
  if "$lrbscope" --quiet xray "$work/out/a.lrb" "$work/out/a.lrb" --method "$method" --poses "$work/poses.txt" -o "$work/xray" >/dev/null 2>&1; then
    with_scripts "$work/xray/$method/index.html" drive.js >"$work/page.html"
    drive 1400 900 'page.html?drive=engine' "${webgl[@]}"
    rm -rf "$work/xray"
  fi
done
page "$here/plane.json"
drive 1400 1000 'page.html?drive=plane' "${webgl[@]}"
page "$here/near.json"
drive 1400 1000 'page.html?drive=measured' "${webgl[@]}"
page "$here/open.json"
drive 1400 1000 'page.html?drive=open' "${webgl[@]}"
"$lrbscope" --quiet tree "$work/out/a.lrb" -o "$work/tree" >/dev/null
with_scripts "$work/tree/index.html" drive_tree.js >"$work/page.html"
drive 1400 1000 page.html "${webgl[@]}"
# Answers about one body: points beside a rock, and two copies of it that cross.
awk 'BEGIN { srand(1); for (i = 0; i < 40; i++) print 3 * rand() - 1.5, 3 * rand() - 1.5, 3 * rand() - 1.5 }' >"$work/points.txt"
"$lrbscope" --quiet run "$here/near.json" --frames none -o "$work/rock" >/dev/null
"$lrbscope" --quiet export "$work/rock/a.lrb" -o "$work/one.obj" >/dev/null
awk '$1 == "v" { n++; x[n] = $2; y[n] = $3; z[n] = $4 } $1 == "f" { m++; f[m] = $0 }
  END { for (c = 0; c < 2; c++) for (i = 1; i <= n; i++) print "v", x[i] + 0.7 * c, y[i], z[i]
    for (c = 0; c < 2; c++) for (i = 1; i <= m; i++) { k = split(f[i], w); printf "f"; for (j = 2; j <= k; j++) printf " %d", w[j] + n * c; print "" } }' \
  "$work/one.obj" >"$work/two.obj"
"$lrbscope" --quiet points "$work/two.obj" "$work/points.txt" --page "$work/answers" >/dev/null
with_scripts "$work/answers/index.html" drive_answers.js >"$work/page.html"
drive 1400 1000 page.html "${webgl[@]}"
"$lrbscope" --quiet inspect "$work/two.obj" --self-intersections --page "$work/answers" >/dev/null || [ $? = 1 ]
with_scripts "$work/answers/index.html" drive_answers.js >"$work/page.html"
for size in "1400 1000" "600 900"; do
  # shellcheck disable=SC2086
  drive $size page.html "${webgl[@]}"
done
"$lrbscope" --quiet crowd "$here/few.crowd.json" -o "$work/crowd" >/dev/null
{
  sed '/^<\/body>$/,$d' "$work/crowd/index.html"
  for data in summary trace; do
    echo "<script type=\"application/json\" id=\"$data-data\">"
    sed 's/</\\u003c/g' "$work/crowd/$data.json"
    echo '</script>'
  done
  echo '</body>'
} >"$work/crowd.html"
with_scripts "$work/crowd.html" drive_crowd.js >"$work/page.html"
for size in "1400 1000" "1920 1080" "600 900"; do
  # shellcheck disable=SC2086
  drive $size page.html "${webgl[@]}"
done
exit "$failed"
