#!/usr/bin/env bash
# adapters.sh TREE LRBSCOPE RAYS INSTANCES [BULLET] [ODE] [EMBREE]: the recorded engines of examples/capture miss no pair of triangles and no contact,
# and their trees have no faults. Bullet's margin makes pairs that are apart false; ODE's contacts are of triangles that intersect.
set -euo pipefail
tree=$(cd "$1" && pwd) program=$2
shift 2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
fail() { echo "example_adapters: $1" && exit 1; }
printf '%s\n' '1 0 0 .7 0 1 0 .1 0 0 1 -.1' '.6 -.8 0 .65 .8 .6 0 .1 0 0 1 -.1' '1 0 0 3 0 1 0 0 0 0 1 0' >poses
{ echo '1 0 0 0 0 1 0 0 0 0 1 0' && cat poses; } >copies
printf '%s\n' '.1 .9 5 0 0 -1' '3 2 1 -1 -.6 -.33' '3 2 1 1 0 0' >rays
for engine in "$@"; do
  name=$(basename "$engine")
  inputs=("$tree"/tests/data/{gear,l_block}.obj poses)
  case $name in *embree | *rays) inputs=("$tree"/tests/data/gear.obj rays) ;; *instances) inputs=("$tree"/tests/data/gear.obj rays copies) ;; esac
  LRBCAP_OUT=$name.lrbcap "$engine" "${inputs[@]}" >found || fail "$name: exit code $?"
  [ "$(sed 's/^[1-9].*/some/; s/inf/0/' found | tr '\n' ' ')" = "some some 0 " ] || fail "$name found $(cat found)"
  "$program" tree "$name.lrbcap" >said || fail "$name: faults of its trees: $(cat said)"
  "$program" check "$name.lrbcap" --json >said || [[ $name = *bullet ]] || fail "$name: wrong answers: $(cat said)"
  ! grep -E '"missed": ?[1-9]' said || fail "$name misses pairs"
done
[ $# = 5 ] || { echo "skipped: not all of libbullet-dev, libode-dev and libembree-dev are installed" && exit 77; }
