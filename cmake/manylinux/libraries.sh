#!/usr/bin/env bash
# cmake/manylinux/libraries.sh FOLDER: in an image of manylinux, installs the libraries that a self-contained wheel needs in FOLDER, by
# vcpkg at the versions of vcpkg.json; fonts and the scripts of pages where CMake looks for them. Untested: see docs/packages.md.
set -euo pipefail
folder=${1:?a folder}
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
dnf install -y dejavu-sans-fonts git mesa-libOSMesa pkgconf-pkg-config perl-core tar unzip zip
git clone https://github.com/microsoft/vcpkg.git /opt/vcpkg
git -C /opt/vcpkg checkout -q "$(sed -n 's/.*"builtin-baseline": "\(.*\)".*/\1/p' "$here/vcpkg.json")"
/opt/vcpkg/bootstrap-vcpkg.sh -disableMetrics
/opt/vcpkg/vcpkg install --x-manifest-root="$here" --x-install-root=/opt/vcpkg_installed
ln -s "/opt/vcpkg_installed/$(uname -m | sed 's/x86_64/x64/; s/aarch64/arm64/')-linux" "$folder"
# Chart.js 3 and three.js 111, in the folders of Debian's packages.
scripts=/usr/local/share/javascript
for package in chart.js/-/chart.js-3.9.1 three/-/three-0.111.0; do
  mkdir -p "/tmp/scripts/${package##*/}"
  curl -sSfL "https://registry.npmjs.org/$package.tgz" | tar -xz --strip-components=1 -C "/tmp/scripts/${package##*/}"
done
install -D -t "$scripts/chart.js" /tmp/scripts/chart.js-*/dist/chart.min.js
install -D -t "$scripts/three" /tmp/scripts/three-*/build/three.min.js
install -D -t "$scripts/three/examples/js/controls" /tmp/scripts/three-*/examples/js/controls/OrbitControls.js
licences=$folder/share/licenses
install -D -m 644 /tmp/scripts/chart.js-*/LICENSE* "$licences/chart.js/copyright"
install -D -m 644 /tmp/scripts/three-*/LICENSE "$licences/three/copyright"
install -D -m 644 "$(rpm -qla 'dejavu*' | grep -m 1 LICENSE)" "$licences/dejavu/copyright"
