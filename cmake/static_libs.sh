#!/usr/bin/env bash
# cmake/static_libs.sh PREFIX: installs the libraries that a self-contained wheel contains (LRB_SELF_CONTAINED) in PREFIX, as static
# libraries. Builds them from the source packages of this Debian, because Debian's own static libraries cannot be linked into a
# Python module: they are not position-independent. Nothing is built if PREFIX has the same versions already.
# Needs Debian, a C and a C++ compiler, cmake, ninja-build, make, pkg-config, patch, xz-utils.
set -euo pipefail
mkdir -p "${1:?a folder}"
prefix=$(cd "$1" && pwd)
packages=(zlib libpng1.6 freetype pixman cairo onetbb)

# apt with sources of this machine's repositories, in a state of its own.
apt_state=$prefix/apt
mkdir -p "$apt_state/lists/partial" "$apt_state/archives/partial"
release=$(. /etc/os-release && echo "$VERSION_CODENAME")
apt-get indextargets --format '$(REPO_URI)|$(RELEASE)|$(COMPONENT)|$(ORIGIN)|$(SIGNED_BY)' 'Created-By: Packages' |
  awk -F'|' -v release="$release" '
    index($2, release) == 1 && $3 == "main" && ($4 == "" || $4 == "Debian" || $4 ~ /^\$/) {
      print "deb-src " ($5 ~ /^\// ? "[signed-by=" $5 "] " : "") $1, $2, "main"
    }' | LC_ALL=C sort -u >"$apt_state/sources.list"
[ -s "$apt_state/sources.list" ] || { echo "static_libs.sh: found no repository of Debian" >&2 && exit 3; }
apt() {
  apt-get -q -o Dir::Etc::SourceList="$apt_state/sources.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$apt_state/lists" \
    -o Dir::Cache="$apt_state" -o APT::Sandbox::User=root "$@"
}
apt update >"$apt_state/log" 2>&1 || { cat "$apt_state/log" >&2 && exit 3; }
versions=$(for p in "${packages[@]}"; do apt source --print-uris "$p" | awk '/\.dsc/ { print $2 }'; done)
key=$({ echo "$versions" && cat "${BASH_SOURCE[0]}" && "${CC:-cc}" --version; } | sha256sum)
if [ "$key" = "$(cat "$prefix/key" 2>/dev/null)" ]; then exit 0; fi
rm -rf "$prefix"/{key,source,bin,include,lib,share}
mkdir -p "$prefix/source"
cd "$prefix/source"

export CFLAGS="-O2 -fPIC" CXXFLAGS="-O2 -fPIC" PKG_CONFIG_PATH=$prefix/lib/pkgconfig
jobs=${LRB_JOBS:-$(nproc)}
cmake_build() { # FOLDER OPTION...
  cmake -S "$1" -B "$1/built" -G Ninja -DCMAKE_BUILD_TYPE=None -DBUILD_SHARED_LIBS=OFF -DCMAKE_INSTALL_PREFIX="$prefix" -DCMAKE_INSTALL_LIBDIR=lib \
    -DCMAKE_PREFIX_PATH="$prefix" "${@:2}"
  ninja -C "$1/built" -j "$jobs"
  ninja -C "$1/built" install
}
# A mirror may lack the files of an update: then the release's own version.
download() { # PACKAGE, into the folder of its name
  local what=(--download-only)
  [ "$1" != pixman ] || what=(--tar-only) # Debian's patches are only its packaging
  (cd "$1" && { apt source "${what[@]}" "$1" || apt source "${what[@]}" "$1/$release"; })
}
# `make` may not run autoconf again, which Debian's patches to configure.ac would cause.
made() { make -j "$jobs" ACLOCAL=: AUTOCONF=: AUTOHEADER=: AUTOMAKE=: "$@"; }
build() { # PACKAGE FOLDER
  case $1 in
    zlib) (cd "$2" && ./configure --static --prefix="$prefix" && make -j "$jobs" libz.a && make install) ;;
    libpng1.6) (cd "$2" && CPPFLAGS=-I$prefix/include LDFLAGS=-L$prefix/lib ./configure --disable-shared --disable-maintainer-mode --prefix="$prefix" &&
      made install) ;;
    freetype) cmake_build "$2" -DFT_DISABLE_{BROTLI,BZIP2,HARFBUZZ,PNG}=ON -DFT_REQUIRE_ZLIB=ON ;;
    pixman) (cd "$2" && ./configure --disable-shared --disable-gtk --disable-libpng --disable-openmp --prefix="$prefix" &&
      made -C pixman install && made install-pkgconfigDATA) ;;
    cairo) (cd "$2" && ./configure --disable-shared --enable-ft --enable-pdf --enable-png \
      --disable-{fc,xlib,xcb,gobject,ps,svg,script,interpreter,trace,gtk-doc} --prefix="$prefix" && made -C src install) ;;
    onetbb) cmake_build "$2" -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBBMALLOC_BUILD=OFF ;;
  esac
}
for package in "${packages[@]}"; do
  mkdir "$package"
  log=$prefix/source/$package.log
  download "$package" >"$log" 2>&1 || { tail -n 20 "$log" >&2 && exit 3; }
  if compgen -G "$package/*.dsc" >/dev/null; then
    dpkg-source --no-check -x "$package"/*.dsc "$package/tree" >>"$log" 2>&1
  else
    mkdir "$package/tree" && tar -C "$package/tree" --strip-components=1 -xf "$package"/*.orig.tar.*
  fi
  # With set -e in effect, which a condition would disable.
  set +e
  (set -e && build "$package" "$package/tree") >>"$log" 2>&1
  code=$?
  set -e
  [ $code = 0 ] || { tail -n 20 "$log" >&2 && echo "static_libs.sh: cannot build $package, see $log" >&2 && exit 1; }
  mkdir -p "$prefix/share/licenses/$package"
  cp "$package/tree/debian/copyright" "$prefix/share/licenses/$package/" 2>/dev/null || cp "$package/tree/COPYING" "$prefix/share/licenses/$package/copyright"
  echo "built $(basename "$(ls "$package"/*.orig.tar.* | head -n 1)" | sed 's/\.orig.*//; s/_/ /')"
done
rm -rf "$prefix"/lib/*.la "$prefix/bin" "$prefix/share/"{man,doc,aclocal,gtk-doc}
rm -rf "$prefix/source"
echo "$key" >"$prefix/key"
