#!/usr/bin/env bash
# cmake/release.sh [--out DIR] [PART...]: makes the files of a release from a clean checkout, in DIR (build/dist):
#   source   lrbscope-V-source.tar.gz, the files of HEAD
#   sdist    lrbscope-V.tar.gz, the source distribution for pip
#   wheel    lrbscope-V-...-manylinux_....whl for LRB_PYTHON (python3), self-contained, checked by tests/python/wheel.sh
#   debs     lrbscope_V-1_ARCH.deb and the other packages of Debian
#   site     lrbscope-V-site.tar.gz, the documentation, with the reference if Doxygen is installed
# and SHA256SUMS of all files there. By default all parts. Two runs of one commit in one folder make the same bytes, by one compiler:
# times in files are that of the commit. Exit codes: 1 if a part failed, 2 for unknown arguments, 3 if something is missing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
parts=() out=build/dist
while [ $# -gt 0 ]; do
  case "$1" in
    --out) out=${2:?a folder} && shift ;;
    source | sdist | wheel | debs | site) parts+=("$1") ;;
    *) sed -n '2,11s/^# //p' "$0" >&2 && exit 2 ;;
  esac
  shift
done
[ ${#parts[@]} -gt 0 ] || parts=(source sdist wheel debs site)
lack() { echo "release.sh: $1" >&2 && exit 3; }
# CMake finds source files by patterns: no others may be there.
[ -z "$(git status --porcelain)" ] || lack "the checkout has changes or other files: commit them, or remove them (git status)"
python=${LRB_PYTHON:-python3}
mkdir -p "$out"
out=$(cd "$out" && pwd)
version=$(sed -n 's/^project(lrbscope VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
umask 022

compressed() { gzip -9n >"$out/$1"; } # from standard input
need_backend() {
  "$python" -c 'import scikit_build_core' 2>/dev/null ||
    lack "$python has no scikit_build_core: $python -m pip install scikit-build-core pybind11 (Debian 13: python3-scikit-build-core pybind11-dev)"
}

part_source() { git archive --format=tar --prefix="lrbscope-$version/" HEAD | compressed "lrbscope-$version-source.tar.gz"; }
part_sdist() {
  need_backend
  "$python" -c 'import sys, scikit_build_core.build as b; b.build_sdist(sys.argv[1])' "$work" >"$work/sdist.log" 2>&1 || { cat "$work/sdist.log" >&2 && return 1; }
  mv "$work/lrbscope-$version.tar.gz" "$out/"
}
part_wheel() {
  local glibc
  bash cmake/packages.sh build python wheel
  need_backend
  "$python" -c 'import pip, wheel' || lack "$python has no pip or wheel"
  cmake/static_libs.sh build/static_libs
  CMAKE_ARGS="-DLRB_SELF_CONTAINED=$PWD/build/static_libs ${CMAKE_ARGS:-}" "$python" -m pip --disable-pip-version-check wheel --no-deps \
    --no-build-isolation --no-index --wheel-dir "$work/wheel" . >"$work/wheel.log" 2>&1 ||
    { tail -n 40 "$work/wheel.log" >&2 && return 1; }
  # The tag names the glibc of this machine, the oldest one with which the wheel can be expected to work.
  glibc=$(getconf GNU_LIBC_VERSION | sed 's/.* //; s/\./_/')
  (cd "$work/wheel" && "$python" -m wheel unpack -d unpacked ./*.whl && chmod +x unpacked/*/*.data/scripts/* &&
    sed -i "s/^\(Tag: .*\)-linux_/\1-manylinux_${glibc}_/" unpacked/*/*.dist-info/WHEEL &&
    rm ./*.whl && "$python" -m wheel pack -d . unpacked/*) >>"$work/wheel.log" 2>&1 || { tail -n 20 "$work/wheel.log" >&2 && return 1; }
  bash tests/python/wheel.sh "$work"/wheel/*.whl "$python"
  mv "$work"/wheel/*.whl "$out/"
}
part_debs() {
  ./check debs >"$work/debs.log" 2>&1 || { tail -n 40 "$work/debs.log" >&2 && return 1; }
  cp build/debs-shared-OFF/debs/*.deb "$out/"
}
part_site() {
  ! command -v doxygen >/dev/null || ./check api >"$work/api.log" 2>&1 || { tail -n 20 "$work/api.log" >&2 && return 1; }
  ./check site >"$work/site.log" 2>&1 || { tail -n 20 "$work/site.log" >&2 && return 1; }
  tar -C build/site --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=go=rX,u+rw \
    --transform="s/^html/lrbscope-$version-site/" -cf - html | compressed "lrbscope-$version-site.tar.gz"
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for part in "${parts[@]}"; do
  echo "release: $part"
  "part_$part"
done
(cd "$out" && rm -f SHA256SUMS && sha256sum -- * >"$work/sums" && mv "$work/sums" SHA256SUMS && cat SHA256SUMS)
echo "release: $version of $(git log -1 --format='%h, %cs'), in $out"
