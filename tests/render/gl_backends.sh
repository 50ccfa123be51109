#!/usr/bin/env bash
# gl_backends.sh LRBSCOPE RENDER_HASH: tests the choice of the library that draws, by $LRB_GL and by the installed libraries. A library
# is hidden by an empty file of its name in LD_LIBRARY_PATH. Skipped (77) if this machine has neither OSMesa nor EGL.
set -euo pipefail
bin=$1 hashes=$2
unset LRB_GL
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
bad() { echo "gl_backends.sh: $1" && cat "$dir/out" "$dir/err" 2>/dev/null && exit 1; }
mkdir -p "$dir/no_osmesa" "$dir/no_egl" "$dir/neither"
touch "$dir/no_osmesa/libOSMesa.so.8" "$dir/no_egl/libEGL.so.1" "$dir/neither/libOSMesa.so.8" "$dir/neither/libEGL.so.1"

# used NAME=VALUE...: prints the line of doctor about the library in use.
used() { env "$@" "$bin" doctor | sed -n 's/^ok  *off-screen OpenGL: //p'; }
# rejected PATTERN NAME=VALUE...: drawing must fail with exit code 3 and one line that matches.
rejected() {
  local pattern=$1 code=0
  shift
  env "$@" "$bin" -q run figure1 -o "$dir/drawn" >"$dir/out" 2>"$dir/err" || code=$?
  [ $code = 3 ] || bad "$*: exit code $code, expected 3"
  [ "$(wc -l <"$dir/err")" = 1 ] && grep -qE "$pattern" "$dir/err" || bad "$*: expected one line that matches '$pattern'"
  [ -z "$(find "$dir/drawn" -name '*.png')" ] || bad "$*: wrote a picture"
}

rejected "^lrbscope: LRB_GL: expected osmesa or egl, found 'vulkan'$" LRB_GL=vulkan
rejected 'libOSMesa.so.8: .*libEGL.so.1: .*install Debian.s libosmesa6, or libegl1 and libgl1-mesa-dri$' "LD_LIBRARY_PATH=$dir/neither"
rejected 'LRB_GL=osmesa.*libOSMesa.so.8: .*install Debian.s libosmesa6, or unset LRB_GL$' LRB_GL=osmesa "LD_LIBRARY_PATH=$dir/no_osmesa"
rejected 'LRB_GL=egl.*libEGL.so.1: .*install Debian.s libegl1 and libgl1-mesa-dri, or unset LRB_GL$' LRB_GL=egl "LD_LIBRARY_PATH=$dir/no_egl"

# The default is OSMesa, then EGL.
osmesa=$(used LRB_GL=osmesa) egl=$(used LRB_GL=egl)
[ -n "$osmesa$egl" ] || { echo "skipped: neither OSMesa nor EGL is installed" && exit 77; }
[ "$(used LRB_GL=)" = "${osmesa:-$egl}" ] || bad "the default is not OSMesa, then EGL"
case "${osmesa:-OSMesa, }" in "OSMesa, "*) ;; *) bad "LRB_GL=osmesa draws with $osmesa" ;; esac
case "${egl:-EGL, }" in "EGL, "*) ;; *) bad "LRB_GL=egl draws with $egl" ;; esac
[ "$(used "LD_LIBRARY_PATH=$dir/no_osmesa")" = "$egl" ] || bad "EGL does not take the place of OSMesa"
[ "$(used "LD_LIBRARY_PATH=$dir/no_egl")" = "$osmesa" ] || bad "OSMesa needs EGL"

# One Mesa draws the same pictures by both. (Test golden_egl compares those of another Mesa within the goldens' tolerance.)
if [ -n "$osmesa" ] && [ "${osmesa#OSMesa, }" = "${egl#EGL, }" ]; then
  LRB_GL=osmesa "$hashes" >"$dir/out"
  DISPLAY='' WAYLAND_DISPLAY='' LRB_GL=egl "$hashes" >"$dir/err"
  [ -s "$dir/out" ] && cmp "$dir/out" "$dir/err" || bad "OSMesa's and EGL's pictures differ"
fi

# Commands that draw nothing load neither.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n' >"$dir/a.obj"
echo '1 0 0 0.1 0 1 0 0.1 0 0 1 0.1' >"$dir/poses.txt"
loaded() { env LD_DEBUG=files "$bin" "$@" 2>&1 >/dev/null | grep -cE 'file=lib(OSMesa|EGL|LLVM)' || true; }
[ "$(loaded doctor)" -gt 0 ] || bad "LD_DEBUG=files does not list the library that draws"
[ "$(loaded --version)" = 0 ] || bad "--version loads a library of OpenGL"
[ "$(loaded query "$dir/a.obj" "$dir/a.obj" --poses "$dir/poses.txt")" = 0 ] || bad "query loads a library of OpenGL"
echo "drawn with: ${osmesa:-no OSMesa}; ${egl:-no EGL}"
