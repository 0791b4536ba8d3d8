#!/usr/bin/env bash
# The Debian package of the program, installed into an empty Debian 12 and played there: the same hash as here.
# As root, after a build; needs the network for Debian's packages, and a gigabyte in build/.
# needs: debootstrap cpack dpkg-shlibdeps chroot
set -euo pipefail
cd "$(dirname "$0")/../.."
play='play --headless --fast --ticks 120 --hash --seed 3'
here=$(build/limber $play 2>/dev/null | tail -1)

rm -rf build/package && mkdir -p build/package
cmake --preset release -B build/package/build -DLIMBER_TESTS=OFF >/dev/null
cmake --build build/package/build --target limber
(cd build/package && cpack --config build/CPackConfig.cmake >/dev/null)
package=$(ls build/package/*.deb)

root=$PWD/build/package/root
debootstrap --variant=minbase bookworm "$root" >build/package/debootstrap.log
cp "$package" "$root/tmp/limber.deb"
mount -t proc proc "$root/proc"
trap 'umount "$root/proc"' EXIT
chroot "$root" apt-get install -y --no-install-recommends /tmp/limber.deb >build/package/install.log 2>&1
there=$(chroot "$root" limber $play 2>/dev/null | tail -1)
echo "here:  $here"
echo "there: $there"
[ -n "$here" ] && [ "$here" = "$there" ]
chroot "$root" limber --version
chroot "$root" limber doctor || true
chroot "$root" apt-get remove -y limber >/dev/null 2>&1
[ ! -e "$root/usr/bin/limber" ]
echo "1 passed, 0 failed"
