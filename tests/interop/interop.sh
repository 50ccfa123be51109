#!/usr/bin/env bash
# interop.sh LRBSCOPE: exports a run and opens the files in other programs. All must find the same faces and numbers.
# - interop.py: VTP, PLY and GLB by independent readers; all formats by VTK (Debian's python3-vtk9)
# - assimp (assimp-utils): PLY and GLB; Khronos' validator (npm's gltf-validator): GLB; speedscope (npm's, in Chromium): the trace
# Missing programs are reported as skipped. Exit code 77 (skipped) without python3. LRB_NODE_MODULES: folder of npm's packages, if
# node does not find them.
set -euo pipefail
lrbscope=$(realpath "$1")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
python=/usr/bin/python3 # the system's, which has Debian's modules
[ -x "$python" ] || python=$(command -v python3 || true)
[ -n "$python" ] || { echo "interop.sh: skipped: needs python3" && exit 77; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$lrbscope" --quiet run stick_through_wall -o run >/dev/null
for name in run.vtp run.ply run.glb; do "$lrbscope" --quiet export run -o "$name" >/dev/null; done
"$lrbscope" --quiet export run --what body,wrapper,contacts --colour-by face_tests -o all.glb >/dev/null

"$python" "$here/interop.py" run/trace.json run.vtp run.ply run.glb all.glb

if command -v assimp >/dev/null; then
  faces=$("$python" "$here/interop.py" --count run.vtp) # polygons, and line segments as counted by assimp
  for name in run.ply:polygons run.glb:all; do
    found=$(assimp info "${name%:*}" | awk '$1 == "Faces:" { print $2 }')
    wanted=$(awk -v w="${name#*:}" '{ print w == "all" ? $1 + $2 : $1 }' <<<"$faces")
    [ "$found" = "$wanted" ] || { echo "assimp finds $found faces in ${name%:*}, not $wanted" && exit 1; }
  done
  echo "assimp: the same faces in PLY and GLB"
else
  echo "skipped: assimp is not installed (Debian's assimp-utils)"
fi

export NODE_PATH=${LRB_NODE_MODULES:-$(npm root -g 2>/dev/null || true)}
if command -v node >/dev/null && node -e 'require.resolve("gltf-validator")' 2>/dev/null; then
  node "$here/validate.js" run.glb all.glb
else
  echo "skipped: gltf-validator is not installed (npm install gltf-validator)"
fi

status=0
"$here/speedscope.sh" run/trace.json 'lrbscope: stick_through_wall (pid 1), time steps (tid 1)' || status=$?
[ $status = 0 ] || [ $status = 77 ] || exit 1
