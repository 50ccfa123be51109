#!/usr/bin/env bash
# tests/robustness/robustness.sh LRBSCOPE [unlimited]: injects faults of the machine and signals. No final file may be half-written,
# no temporary file may remain, and the message must be one line.
# "unlimited" skips the tests with a memory limit, which is too small for ASan's shadow memory.
set -u
bin=$(realpath "$1")
data=$(dirname "$(realpath "${BASH_SOURCE[0]}")")/../data
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 1
failed=0

fail() {
  echo "FAILED: $*"
  sed 's/^/  stderr: /' err 2>/dev/null | head -5
  failed=1
}
# expect CODE WHAT COMMAND...: exit code, one line on stderr if it is not 0 (beside the progress of slow machines), nothing on stdout
expect() {
  local code=$1 what=$2 got=0
  shift 2
  "$@" >out.txt 2>err </dev/null || got=$?
  [ "$got" = "$code" ] || fail "$what: exit $got, expected $code"
  if [ "$code" != 0 ]; then
    [ "$(grep -vc '^progress: ' err)" = 1 ] || fail "$what: $(wc -l <err) lines on stderr, expected 1"
    grep -q '^lrbscope: ' err || fail "$what: the line does not begin with lrbscope:"
    ! grep -q 'internal error' err || fail "$what: an internal error"
  fi
}
no_temporaries() {
  local left
  left=$(find "$dir" -name '*.tmp-*')
  [ -z "$left" ] || fail "$1: left $left"
}
# whole FILE WHAT: a final file is complete
whole() {
  case $1 in
    *.lrb) "$bin" inspect "$1" >/dev/null 2>err || fail "$2: half-written $1" ;;
    *.html) tail -c 20 "$1" | grep -q '</html>' || fail "$2: half-written $1" ;;
    *.json) tail -c 3 "$1" | grep -q '}' || fail "$2: half-written $1" ;;
    *.png) tail -c 8 "$1" | grep -qa IEND || fail "$2: half-written $1" ;;
  esac
}
all_whole() {
  local file
  while IFS= read -r file; do whole "$file" "$2"; done < <(find "$1" -type f)
}

cp "$data/l_block.obj" block.obj
for i in $(seq 1 3000); do echo "1 0 0 0.5 0 1 0 0.25 0 0 1 0.125"; done >poses.txt
cat >long.json <<'END'
{"name": "long", "purpose": "is interrupted",
 "bodies": {"a": {"generator": "ball", "parameters": {"frequency": 4}}, "b": {"generator": "ball", "parameters": {"frequency": 4}}},
 "motion": {"kind": "sweep", "from": [2, 0.1, 0.2], "to": [0, 0.1, 0.2], "steps": 400},
 "frames": {"most": 400, "size": [640, 480]}}
END
sed -e 's/"steps": 400/"steps": 4/' -e 's/"long"/"short"/' long.json >short.json

# --- stdout and its readers
expect 3 "stdout on a full disk" bash -c "'$bin' query block.obj block.obj --poses poses.txt >/dev/full"
expect 3 "help on a full disk" bash -c "'$bin' --help >/dev/full"
"$bin" query block.obj block.obj --poses poses.txt --pairs 2>err | head -1 >out.txt
code=${PIPESTATUS[0]}
[ "$code" = 141 ] || fail "closed pipe: exit $code, expected 141"
[ "$(wc -l <out.txt)" = 1 ] || fail "closed pipe: $(wc -l <out.txt) lines arrived"
[ ! -s err ] || fail "closed pipe: expected no output on stderr"
expect 3 "closed pipe where SIGPIPE is ignored" \
  bash -c "trap '' PIPE; '$bin' query block.obj block.obj --poses poses.txt --pairs | head -1 >/dev/null; exit \${PIPESTATUS[0]}"
expect 3 "closed stdout" bash -c "'$bin' list >&-"

# --- output that cannot be written
expect 3 "a file on a full disk" "$bin" build block.obj -o /dev/full
touch a_file
expect 3 "an output folder that is a file" "$bin" collide block.obj block.obj -o a_file --frames none
expect 3 "an output folder below a file" "$bin" run short.json -o a_file/below
mkdir a_folder
expect 2 "an output file that is a folder" "$bin" build block.obj -o a_folder
expect 2 "an output file in no folder" "$bin" build block.obj -o nowhere/x.lrb
[ -f a_file ] && [ ! -s a_file ] || fail "the file in the way was changed"
mkdir out && mkdir out/index.html
expect 2 "a folder where the page goes" "$bin" run short.json -o out --frames none
all_whole out "a folder where the page goes"
rm -rf out
# A limit on file sizes simulates a disk that fills up during the run.
(
  ulimit -f 8
  trap '' XFSZ
  expect 3 "a disk that fills up" "$bin" run short.json -o full
  exit $failed
) || failed=1
[ ! -d full ] || all_whole full "a disk that fills up"
no_temporaries "a disk that fills up"
if [ "$(id -u)" = 0 ] && mkdir tiny && mount -t tmpfs -o size=128k tmpfs tiny 2>/dev/null; then
  expect 3 "a full file system" "$bin" run short.json -o tiny/out
  all_whole tiny "a full file system"
  no_temporaries "a full file system"
  cat /dev/zero >tiny/rest 2>/dev/null
  expect 3 "a full file system, again" "$bin" build block.obj -o tiny/x.lrb
  [ ! -e tiny/x.lrb ] || whole tiny/x.lrb "a full file system, again"
  umount tiny
else
  echo "skipped: a full tmpfs (needs root and mount)"
fi
if [ "$(id -u)" != 0 ]; then
  mkdir read_only && chmod 555 read_only
  expect 3 "an unwritable folder" "$bin" run short.json -o read_only/out
  expect 2 "a file in an unwritable folder" "$bin" build block.obj -o read_only/x.lrb
  chmod 755 read_only
else
  echo "skipped: an unwritable folder (root may write everywhere)"
fi

# --- nothing is written outside of the output folder
mkdir -p jail/out
# short_as NAME: the short scenario under another name, in jail/named.json
short_as() {
  sed "s|\"short\"|\"$1\"|" short.json >jail/named.json
}
for name in ../escaped ../../escaped "$dir/escaped" .. . a/../../escaped; do
  short_as "$name"
  expect 2 "a scenario called $name" bash -c "cd jail && '$bin' run named.json --frames none"
done
"$bin" run short.json -o good --frames none >/dev/null 2>&1
cp good/*.lrb jail
sed 's|"name": "short"|"name": "../../escaped"|' good/trace.json >jail/trace.json
grep -q escaped jail/trace.json || fail "the trace's scenario could not be renamed"
expect 0 "a trace of a scenario called ../../escaped" bash -c "cd jail && '$bin' render trace.json -o out/drawn"
[ ! -e "$dir/escaped" ] && [ -z "$(find . -name '*escaped*')" ] || fail "written outside: $(find . -name '*escaped*')"
mkdir victim
for link in index.html summary.json trace.json frames frames/frame_0000.png; do
  rm -rf linked && mkdir linked && [ "${link%/*}" = "$link" ] || mkdir -p "linked/${link%/*}"
  ln -s "$dir/victim/$(basename $link)" "linked/$link"
  [ $link != frames ] || { rm linked/frames && ln -s "$dir/victim" linked/frames; }
  expect 3 "an output folder where $link is a link" "$bin" run short.json -o linked
  expect 3 "a folder to draw into where $link is a link" "$bin" render good/trace.json -o linked
done
[ -z "$(ls victim)" ] || fail "written through a link: $(ls victim)"
ln -s victim link_to_folder
expect 0 "an output folder that is a link itself" "$bin" run short.json -o link_to_folder --frames none

# --- no memory
no_memory() {
  awk 'BEGIN { n = 500; for (i = 0; i <= n; ++i) for (j = 0; j <= n; ++j) print "v", i, j, sin(i * j);
    for (i = 0; i < n; ++i) for (j = 0; j < n; ++j) { a = i * (n + 1) + j + 1; print "f", a, a + n + 1, a + 1 } }' >big.obj
  echo "1 0 0 0.5 0 1 0 0.25 0 0 1 0.125" >pose.txt
  # A long array of small objects, like any large trace.
  awk 'BEGIN { printf "{\"traceEvents\": ["; for (i = 0; i < 600000; ++i) printf "{\"name\":\"step\",\"args\":{\"event\":%d}},\n", i; print "{}]}" }' >big.json
  local need limit extra command
  for need in $(seq 20000 4000 400000); do  # kB that the program needs to start
    (ulimit -v "$need"; "$bin" --version >/dev/null 2>&1) && break
  done
  for extra in 4000 12000 30000; do
    limit=$((need + extra))
    for command in "build big.obj -o big.lrb" "query big.obj big.obj --poses pose.txt" "inspect big.obj" \
      "render big.json -o drawn"; do
      # shellcheck disable=SC2086
      expect 3 "$command within $limit kB" bash -c "ulimit -v $limit; exec '$bin' $command"
      [ ! -e big.lrb ] || fail "$command within $limit kB: left big.lrb"
    done
  done
  no_temporaries "no memory"
}
[ "${2:-}" = unlimited ] || no_memory

# --- interrupted
# stop SIGNAL SECONDS NAME COMMAND...
stop() {
  local signal=$1 seconds=$2 name=$3 pid got=0
  shift 3
  # A shell starts background jobs with SIGINT ignored; env restores it.
  env --default-signal=INT "$@" >out.txt 2>err </dev/null &
  pid=$!
  # Signals end the program without a message until it handles them: wait until it blocks them.
  for _ in $(seq 200); do grep -q 'SigBlk:.*[1-9a-f]' "/proc/$pid/status" 2>/dev/null && break; sleep 0.05; done
  sleep "$seconds"
  if ! kill -s "$signal" "$pid" 2>/dev/null; then
    wait "$pid"
    echo "note: $name had ended before SIG$signal"
    return
  fi
  wait "$pid" || got=$?
  [ "$got" = $((128 + $(kill -l "$signal"))) ] || fail "$name: exit $got after SIG$signal"
  [ "$(grep -c "interrupted by SIG$signal" err)" = 1 ] || fail "$name: does not report SIG$signal"
  no_temporaries "$name, SIG$signal"
  [ ! -d "$name" ] || all_whole "$name" "$name, SIG$signal"
}
for seconds in 0.2 0.7 1.5; do
  stop INT $seconds run "$bin" run long.json -o run
  stop TERM $seconds run "$bin" run long.json -o run
  stop TERM $seconds collide "$bin" collide block.obj block.obj -o collide --size 1920x1080
done
stop HUP 0.5 run "$bin" run long.json -o run
(trap '' INT; "$bin" list >/dev/null 2>err & pid=$!; kill -INT $pid; wait $pid) || fail "an ignored SIGINT ended it"

# --- two runs at the same time
"$bin" run long.json -o both >/dev/null 2>err_first &
first=$!
for _ in $(seq 100); do [ -d both/frames ] && break; sleep 0.1; done
if kill -0 $first 2>/dev/null; then
  expect 3 "a second run into one folder" "$bin" run short.json -o both
  grep -q 'another lrbscope' err || fail "a second run: does not report the reason"
fi
kill $first 2>/dev/null
wait $first 2>/dev/null
expect 0 "a run after one that was stopped" "$bin" run short.json -o both
[ "$(find both/frames -name '*.png' | wc -l)" = 4 ] || fail "a run after one that was stopped: expected 4 frames of its own"
all_whole both "two at once"
no_temporaries "two at once"

[ $failed = 0 ] && echo "all faults handled"
exit $failed
