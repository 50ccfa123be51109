#!/usr/bin/env bash
# capture.sh TREE LRBSCOPE AABB [FCL]: runs the example engines of examples/capture with the models of data/. Both must find the
# same pairs, and record a whole capture if and only if LRBCAP_OUT names a file. Then runs the commands of
# docs/profile_your_engine.md, whose blocks must show aabb.c and their output.
set -euo pipefail
tree=$(cd "$1" && pwd)
program=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "example_capture: $1" && exit 1; }
gear=$tree/tests/data/gear.obj
block=$tree/tests/data/l_block.obj
cat >poses <<'END'
# crossing, by another turn, apart
1 0 0 0.7 0 1 0 0.1 0 0 1 -0.1
0.6 -0.8 0 0.65 0.8 0.6 0 0.1 0 0 1 -0.1
1 0 0 3 0 1 0 0 0 0 1 0
END
unset LRBCAP_OUT
for engine in "$@"; do
  name=$(basename "$engine")
  "$engine" "$gear" "$block" poses >"$name.pairs" 2>/dev/null || fail "$name: exit code $?"
  [ "$(find . -name '*.lrbcap')" = "" ] || fail "$name: recorded without LRBCAP_OUT"
  LRBCAP_OUT=$name.lrbcap "$engine" "$gear" "$block" poses 2>/dev/null | cmp - "$name.pairs" || fail "$name: other answers if recorded"
  [ "$(tail -c 32 "$name.lrbcap" | head -c 4)" = STOP ] || fail "$name: the capture is not whole"
  rm "$name.lrbcap"
  [ "$(wc -l <"$name.pairs")" = 3 ] || fail "$name: expected a line per pose: $(cat "$name.pairs")"
  [ "$(tail -1 "$name.pairs")" = "0 pairs" ] || fail "$name: bodies 3 apart: $(tail -1 "$name.pairs")"
  head -2 "$name.pairs" | grep -q '^0 ' && fail "$name: crossing bodies without a pair: $(cat "$name.pairs")"
  cmp "$(basename "$1").pairs" "$name.pairs" || fail "$name: other pairs: $(cat "$name.pairs")"
done
# FCL's distances: 0 for crossing bodies, else as lrbscope's. No visit is left without a price.
if [ $# -gt 1 ]; then
  LRBCAP_OUT=distance.lrbcap "$2" "$gear" "$block" poses distance >distances 2>/dev/null || fail "distance: exit code $?"
  ours=$(tail -1 poses >apart && "$program" distance "$gear" "$block" --poses apart | sed 's/.*"upper":\([0-9.e+-]*\).*/\1/')
  awk -v ours="$ours" 'NR < 3 && $1 > 0 || NR == 3 && ($1 - ours > 1e-9 || ours - $1 > 1e-9) { exit 1 }' distances ||
    fail "distances: expected 0, 0, $ours: $(cat distances)"
  "$program" check distance.lrbcap >said || fail "check of distances: exit code $?: $(cat said)"
  grep -q '3 distance' said && ! grep -q unattributed said || fail "prices of distances: $(cat said)"
fi
[ "$(head -1 "$(basename "$1").pairs")" = "43 pairs" ] || fail "expected the 43 pairs that lrbscope finds"
code=0
"$1" "$gear" missing.obj poses >/dev/null 2>said || code=$?
[ $code = 1 ] && grep -qF 'missing.obj: cannot open the file' said || fail "a missing file: $(cat said)"

# The page, in a folder like a checkout. Without FCL its commands are left out, and the output of them.
page=$tree/docs/profile_your_engine.md
mkdir page
cd page
ln -s "$tree/examples" "$tree/tests" "$tree/trace" .
lrbscope() { "$program" "$@"; }
sed 's/^ *//' examples/capture/aabb.c >shown
ran=0
while IFS= read -r line; do
  case "$line" in *fcl*) [ $# -gt 1 ] || continue ;; esac
  expected=0 code=0
  case "$line" in *"# exit code 1") expected=1 ;; esac
  eval "$line" >said 2>&1 || code=$?
  [ $code = $expected ] || fail "$page: exit code $code, expected $expected: $line: $(cat said)"
  sed 's/^ *//; s/\xe2\x80\xaf/ /g' said >>shown # the space between thousands
  ran=$((ran + 1))
done < <(awk '/^```sh$/ { on = 1; next } /^```/ { on = 0 } on' "$page")
[ $ran -ge 13 ] || fail "$page: ran only $ran commands"
# Blocks without a language, but not those of FCL without it.
awk -v fcl=$(($# - 1)) '/^```/ { if (inside && plain && (fcl || block !~ /FCL/)) printf "%s", block
    inside = !inside; plain = $0 == "```"; block = ""; next }
  inside && $1 != "..." { sub(/^ */, ""); block = block $0 "\n" }' "$page" >blocks
[ "$(wc -l <blocks)" -ge 30 ] || fail "$page: found only $(wc -l <blocks) lines of output"
while IFS= read -r line; do
  grep -qxF -- "$line" shown || fail "$page: no command prints, and aabb.c does not contain: $line"
done <blocks
# `live --exit` ends with the program, not with its capture.
"$program" live --exit -- sh -c './aabb tests/data/gear.obj tests/data/l_block.obj poses.txt; sleep 1; touch ended' >said 2>&1 ||
  fail "live --exit, a program that continues: exit code $?: $(cat said)"
[ -f ended ] || fail "live --exit ended a program that continues: $(cat said)"
# The page of `live`, its state and the page of a query, while the server runs; then its end by a signal.
"$program" live -- ./aabb tests/data/gear.obj tests/data/l_block.obj poses.txt >said 2>address &
live=$!
cat >fetch.py <<'END'
import json, sys, time, urllib.error, urllib.request
while not (text := open("address").read()).endswith("\n"):
    time.sleep(0.05)
url = text.split()[-1]
page = urllib.request.urlopen(url).read().decode()
assert "<title>Live" in page, page[:200]
state = {"running": True}
while state["running"]:
    state = json.load(urllib.request.urlopen(url + "state", timeout=60))
queries = {q["number"]: q for q in state["queries"]}
assert [queries[n]["pairs"] for n in (1, 2, 3)] == [43, 98, 0], queries
assert all(q["verdict"] == "right" and q["us"] > 0 for q in queries.values()), queries
run = urllib.request.urlopen(url + "queries/2/", timeout=60).read().decode()
assert "AABB trees in C99" in run, run[:200]
assert json.load(urllib.request.urlopen(url + "queries/2/summary.json")), "no summary"
for path, headers, status in (("queries/9/", {}, 404), ("queries/2/../capture", {}, 404), ("queries/../capture", {}, 404), ("", {"Host": "example.com"}, 403)):
    try:
        urllib.request.urlopen(urllib.request.Request(url + path, headers=headers))
        sys.exit(path + ": expected " + str(status))
    except urllib.error.HTTPError as e:
        assert e.code == status, (path, e.code)
END
timeout 120 python3 fetch.py || { kill -9 $live; fail "the page of live: $(cat address said)"; }
kill -TERM $live
code=0
wait $live || code=$?
[ $code = 0 ] && grep -qF 'AABB trees in C99: 3 queries: 3 right' said || fail "live, ended by a signal: exit code $code: $(cat said address)"
echo "example_capture: as expected, with $ran commands of the page"
