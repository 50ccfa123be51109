#!/usr/bin/env bash
# capture_header.sh TREE: lrbscope_capture.h alone.
# - It compiles without warnings in C99, C11, C++11, C++17 and C++20 with every compiler found, enabled and not.
# - Objects compiled without LRBCAP_ENABLE contain nothing of it.
# - A program that exits early leaves a whole capture; a FIFO receives the same bytes; a full disk ends the recording.
# - The C blocks of docs/capture.md compile.
set -euo pipefail
tree=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "capture_header: $1" && exit 1; }
warnings=(-Werror -Wall -Wextra -pedantic -Wconversion -Wshadow -I "$tree/trace/include")

# A program with every call.
cat >calls.h <<'END'
#include <lrbscope_capture.h>
int append(void *user, const void *bytes, uint64_t size);
int append(void *user, const void *bytes, uint64_t size) { return user && bytes && size ? 1 : 0; }
int main(int argc, char **argv) {
  const double xyz[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0}, box[6] = {0, 0, 0, 1, 1, 0};
  const uint32_t corners[3] = {0, 1, 2}, none[2] = {0, 0}, one[2] = {0, 1};
  const int axis = argc; /* used by macros only */
  uint32_t tree, name;
  lrbcap_tree shape = {0, 0, 0, 0, 0, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL};
  LRBCAP_OPEN("every call", argc > 1 ? argv[1] : NULL);
  LRBCAP_EVERY(1);
  if (argc > 9) LRBCAP_OPEN_SINK("every call", append, &shape);
  shape.mesh = LRBCAP_MESH("triangle", 3, xyz, 1, corners);
  shape.nodes = 1, shape.volume = LRBCAP_AABB, shape.first_child = none, shape.first_prim = one, shape.prim = none;
  shape.volumes = box;
  tree = LRBCAP_TREE(&shape);
  name = LRBCAP_NAME("counter");
  shape.mesh = LRBCAP_INSTANCES("row", &shape, 0, &tree, NULL);
  for (int q = 0; q < 4000; ++q) {
    const uint32_t query = LRBCAP_BEGIN(LRBCAP_ALL_PAIRS, tree, NULL, tree, NULL);
    LRBCAP_JOIN(query);
    LRBCAP_PHASE(name);
    for (int i = 0; i < 20; ++i) LRBCAP_NODE(0, 0, 1, axis);
    LRBCAP_NODES(0, 0, 4, 2, LRBCAP_NO_AXIS);
    LRBCAP_PRIM(0, 0, 1);
    LRBCAP_COUNT(name, q);
    LRBCAP_ENTER(LRBCAP_TOP, 0);
    LRBCAP_VALUE(0, 0.5 * q);
    LRBCAP_END(LRBCAP_INTERSECTING, 1);
    LRBCAP_RAY(LRBCAP_DISTANCE, tree, NULL, xyz); LRBCAP_POINT(LRBCAP_ANY, tree, NULL, xyz); LRBCAP_BOX(LRBCAP_ANY, tree, NULL, box);
  }
  if (argc > 2) return 0; /* without LRBCAP_CLOSE */
  LRBCAP_THREAD_END();
  LRBCAP_CLOSE();
  return 0;
}
END
cp calls.h calls.c
cp calls.h calls.cpp
awk '/^```c$/ { on = 1; next } /^```/ { on = 0 } on' "$tree/docs/capture.md" >block.c
[ -s block.c ] || fail "docs/capture.md has no C block"

builds=0
for compiler in gcc clang aarch64-linux-gnu-gcc x86_64-w64-mingw32-gcc; do
  command -v "$compiler" >/dev/null || { echo "without $compiler, which is not installed"; continue; }
  for how in "c c99" "c c11" "cpp c++11" "cpp c++17" "cpp c++20"; do
    read -r language standard <<<"$how"
    command=("$compiler" "-std=$standard" "${warnings[@]}")
    [ "$language" = c ] || command+=(-Wold-style-cast)
    # Without optimisation, which would remove what is not used; warnings come from the flow of data.
    "${command[@]}" -O0 -c "calls.$language" -o off.o || fail "$compiler $how disabled"
    if nm off.o | grep -i lrbcap || strings -a off.o | grep -i lrbcap; then fail "$compiler $how: a disabled object has symbols or text"; fi
    "${command[@]}" -O2 -DLRBCAP_ENABLE -c "calls.$language" -o user.o || fail "$compiler $how enabled"
    "${command[@]}" -O2 -DLRBCAP_ENABLE -DLRBCAP_IMPLEMENTATION -c "calls.$language" -o all.o ||
      fail "$compiler $how with the implementation"
    builds=$((builds + 3))
  done
  if [ "$compiler" = clang ]; then # every warning, also in the dialect of Visual C++
    for how in "c c99" "cpp c++11" "cpp c++20"; do
      read -r language standard <<<"$how"
      for dialect in -fno-ms-extensions "-fms-extensions -fms-compatibility"; do
        # shellcheck disable=SC2086
        clang -std=$standard -Weverything -I "$tree/trace/include" $dialect -DLRBCAP_ENABLE -DLRBCAP_IMPLEMENTATION -c "calls.$language" -o all.o 2>said ||
          fail "clang $how $dialect: $(cat said)"
        if grep -q 'lrbscope_capture.h:.*warning' said; then fail "clang -Weverything $how $dialect: $(grep 'capture.h:.*warning' said)"; fi
      done
    done
  fi
  for enable in -DLRBCAP_ENABLE -DNDEBUG; do
    "$compiler" -std=c99 "${warnings[@]}" "$enable" -c block.c -o block.o || fail "$compiler: the C blocks of docs/capture.md"
  done
done
[ "$builds" != 0 ] || { echo "skipped: no C compiler"; exit 77; }

compiler=gcc
command -v gcc >/dev/null || compiler=clang
"$compiler" -std=c99 "${warnings[@]}" -O2 -DLRBCAP_ENABLE -DLRBCAP_IMPLEMENTATION calls.c -o calls
# whole FILE: its last chunk is STOP, of 24 + 8 bytes.
whole() { [ "$(tail -c 32 "$1" | head -c 4)" = STOP ] || fail "$1 does not end with STOP"; }
env -u LRBCAP_OUT ./calls
LRBCAP_OUT='' ./calls
[ "$(find . -newer calls -type f | wc -l)" = 0 ] || fail "a program without LRBCAP_OUT wrote a file"
LRBCAP_OUT=env.lrbcap ./calls
./calls path.lrbcap
./calls exit.lrbcap early
for file in env path exit; do whole $file.lrbcap; done
size=$(stat -c %s env.lrbcap)
mkfifo fifo
cat fifo >from_fifo.lrbcap &
./calls fifo
wait
whole from_fifo.lrbcap
for file in path.lrbcap exit.lrbcap from_fifo.lrbcap; do
  more=$(($(stat -c %s $file) - size))  # a slow run has more SYNC chunks
  [ $((more % 32)) = 0 ] || fail "$file has $more bytes more"
done
code=0
./calls no/such/folder 2>said || code=$?
[ $code = 0 ] && grep -q 'no/such/folder: cannot open the file; nothing is recorded' said || fail "an unusable path: $(cat said)"
if [ -c /dev/full ]; then
  ./calls /dev/full 2>said || code=$?
  [ $code = 0 ] && grep -q 'cannot write; the recording ends here' said || fail "a full disk: $(cat said)"
  [ "$(wc -l <said)" = 1 ] || fail "a full disk is reported more than once"
fi
echo "capture_header: $builds builds without warnings, 6 runs as expected"
