#!/usr/bin/env bash
# capture.sh TREE AABB [FCL]: runs the example engines of examples/capture with the models of data/. Both must find the same
# pairs, and record a whole capture if and only if LRBCAP_OUT names a file.
set -euo pipefail
tree=$1
shift
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
[ "$(head -1 "$(basename "$1").pairs")" = "43 pairs" ] || fail "expected the 43 pairs that lrbscope finds"
code=0
"$1" "$gear" missing.obj poses >/dev/null 2>said || code=$?
[ $code = 1 ] && grep -qF 'missing.obj: cannot open the file' said || fail "a missing file: $(cat said)"
echo "example_capture: as expected"
