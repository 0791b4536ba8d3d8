# shellcheck shell=bash disable=SC2154,SC2086,SC2016
# ./run --package, --python-package, --tarball and --wheel: build Debian packages of the program and of the Python
# package, an archive that runs without installation, and a wheel, from build. Sourced by bash in the root, after a
# build.

package_out=build/package
package_maintainer='Limber contributors <limber@example.org>'

# Prints the version in CMakeLists.txt.
package_version() { sed -n 's/^project(limber VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt; }

# os_field NAME: prints a field of /etc/os-release.
os_field() { (. "${LIMBER_OS_RELEASE:-/etc/os-release}" 2>/dev/null && printf '%s' "${!1-}"); }

# Prints the release for the package's version: deb12, deb13, debsid; ubuntu24.04.
release_tag() {
  local id number
  id=$(os_field ID)
  number=$(os_field VERSION_ID)
  printf '%s' "${id/debian/deb}${number:-$(os_field VERSION_CODENAME)}"
}

# Prints the time of the commit in seconds, for reproducible packages.
source_time() {
  local time=${SOURCE_DATE_EPOCH-}
  # in a checkout, this file has no time
  [ -n "$time" ] || time=$(sed -n 's/^time: \([0-9][0-9]*\)$/\1/p' .git_archival.txt 2>/dev/null)
  [ -n "$time" ] || time=$(git log -1 --format=%ct 2>/dev/null)
  printf '%s' "${time:-$(date -r CHANGELOG.md +%s)}"
}

# packages with headers or static libraries, which become part of the program
compiled_in='libimgui-dev libcli11-dev libglm-dev nlohmann-json3-dev libstb-dev libboost-dev libtinygltf-dev
  libfmt-dev'

# install_licences FOLDER PACKAGE...: copies their license texts.
install_licences() {
  local folder=$1 package
  shift
  mkdir -p "$folder"
  for package; do
    [ -e "$folder/$package" ] || cp "/usr/share/doc/$package/copyright" "$folder/$package" ||
      die 3 "the license of $package was not found." "apt-get install --reinstall $package"
  done
}

# Builds the modules for MPI and pagmo, which a build without their headers has left out. The packages depend on neither.
build_modules() {
  mkdir -p "$package_out"
  cmake -DLIMBER_MPI=ON build >"$package_out/modules.log" 2>&1 &&
    cmake --build build --target limber-mpi-openmpi limber-mpi-mpich limber-pagmo </dev/null \
      >>"$package_out/modules.log" 2>&1 ||
    die 3 "the modules for MPI and pagmo could not be built (whole output: $package_out/modules.log)." \
      "apt-get install libopenmpi-dev libmpich-dev libpagmo-dev"
}

# need_program PROGRAM PACKAGE: exits with an error if the program is missing.
need_program() {
  command -v "$1" >/dev/null || die 3 "$1 not found, so no package can be built." "apt-get install $2"
}

# install_tree PREFIX: runs `cmake --install`, strips the program, and adds icons in the usual sizes.
install_tree() {
  local prefix=$1 size folder
  need_program rsvg-convert librsvg2-bin
  umask 022
  cmake --install build --prefix "$prefix" --strip >"$package_out/install.log" ||
    die 3 "installing into $prefix failed (whole output: $package_out/install.log)." "remove build/package and try again."
  for size in 16 24 32 48 64 128 256; do
    folder=$prefix/share/icons/hicolor/${size}x$size/apps
    mkdir -p "$folder"
    rsvg-convert -w $size -h $size src/app/desktop/limber.svg -o "$folder/limber.png" || exit 3
  done
  install_licences "$prefix/share/doc/limber/licences" $compiled_in
}

# install_site FOLDER: builds the documentation as HTML pages that work offline, from a server and from files.
install_site() {
  local folder=$1
  need_program mkdocs mkdocs
  mkdocs build --strict --clean -f mkdocs.yml -d "$PWD/$folder" >"$package_out/site.log" 2>&1 ||
    die 3 "mkdocs could not build the documentation (whole output: $package_out/site.log)." "fix the problem in its output."
  # the sources of the images, and files that mkdocs writes for servers
  rm -rf "$folder"/{media,plots}/{make,*.lua} "$folder"/{sitemap.xml,sitemap.xml.gz,404.html}
  # the search contains lunr
  install_licences "$(dirname "$folder")/licences" libjs-lunr
}

# Prints the newest section of CHANGELOG.md as an entry of a Debian changelog.
debian_changelog() {
  printf 'limber (%s) %s; urgency=medium\n' "$1" "$(os_field VERSION_CODENAME)"
  awk '
    function flush_item(   line, i, n, words) {
      n = split(item, words, /[ \t]+/)
      if (!n) return
      line = "  *"
      for (i = 1; i <= n; ++i) {
        if (words[i] == "") continue
        if (length(line) + 1 + length(words[i]) > 79) { print line; line = "   " }
        line = line " " words[i]
      }
      print line
      item = ""
    }
    /^## / { if (seen++) exit; next }
    !seen { next }
    /^### / { flush_item(); sub(/^### /, ""); printf "\n  [ %s ]\n", $0; next }
    /^- / { flush_item(); item = substr($0, 3); next }
    /^  / && item != "" { item = item " " $0; next }
    { flush_item() }
    END { flush_item() }' CHANGELOG.md
  printf '\n -- %s  %s\n' "$package_maintainer" "$(LC_ALL=C date -R -u -d "@$(source_time)")"
}

# library_dependencies FILE...: prints their dependencies on libraries, as found by dpkg-shlibdeps. -l FOLDER: one with
# libraries of the package.
library_dependencies() {
  local depends
  mkdir -p "$package_out/debian"
  printf 'Source: limber\n\nPackage: limber\nArchitecture: any\n' >"$package_out/debian/control"
  depends=$(cd "$package_out" && dpkg-shlibdeps -O "$@" 2>shlibdeps.log | sed -n 's/^shlibs:Depends=//p')
  case $depends in
    *libc6*) printf '%s' "$depends" ;;
    *) die 3 "dpkg-shlibdeps found no dependencies (its messages: $package_out/shlibdeps.log)." \
      "install the libraries from Debian's packages and build again." ;;
  esac
}

debian_control() {
  cat <<TEXT
Package: limber
Version: $1
Architecture: $(dpkg --print-architecture)
Maintainer: $package_maintainer
Installed-Size: $(du -sk --apparent-size "$2/usr" | cut -f1)
Depends: $3, libegl1, libgl1, libgles2
Recommends: libgl1-mesa-dri, fonts-inter, fonts-jetbrains-mono
Suggests: ffmpeg, avahi-utils, liblo-tools, openmpi-bin | mpich, libpagmo8 | libpagmo9t64
Section: graphics
Priority: optional
Description: live simulator of actuated, articulated bodies
 Limber simulates bodies that are built from URDF files or in Lua, moved by
 motors and behaviors, and played over OSC. A scene is a Lua script: a saved
 change is in force while the show plays on.
 .
 It has a direct solver for articulated bodies, a panel, a remote panel for
 browsers (OSCQuery), presets and morphs, rewind, takes that are replayed to
 the bit, stills and films, and exports motion as CSV, BVH and glTF.
TEXT
}

# Adapts the documentation to Debian's policy: compressed, with the license in `copyright`.
debian_documents() {
  local doc=$1/usr/share/doc/limber version=$2
  rm "$doc/LICENSE" "$doc/README.md" "$doc/licences.md"
  mv "$doc/CHANGELOG.md" "$doc/changelog"
  debian_changelog "$version" >"$doc/changelog.Debian"
  cp .ci/package/copyright "$doc/copyright"
  install_site "${doc#"$PWD"/}/html"
  gzip -9n "$doc/changelog" "$doc/changelog.Debian" "$1"/usr/share/man/man1/*.1
  mkdir -p "$1/usr/share/doc-base"
  # Debian 12's lintian reports the unknown tag as an error
  if [ "$(release_tag)" != deb12 ]; then
    mkdir -p "$1/usr/share/lintian/overrides"
    cp .ci/package/lintian-overrides "$1/usr/share/lintian/overrides/limber"
  fi
  cp .ci/package/doc-base "$1/usr/share/doc-base/limber.limber"
  # Debian's zsh searches this folder
  mkdir -p "$1/usr/share/zsh/vendor-completions"
  mv "$1/usr/share/zsh/site-functions/_limber" "$1/usr/share/zsh/vendor-completions/"
  rmdir "$1/usr/share/zsh/site-functions"
}

make_package() {
  local stage=$package_out/stage version depends file
  for file in dpkg-deb dpkg-shlibdeps; do need_program $file dpkg-dev; done
  version=$(package_version)-1~$(release_tag)
  build_modules
  rm -rf "$stage" && mkdir -p "$stage/DEBIAN"
  install_tree "$stage/usr"
  debian_documents "$stage" "$version"
  depends=$(library_dependencies stage/usr/bin/limber) || exit
  debian_control "$version" "$stage" "$depends" >"$stage/DEBIAN/control"
  build_debian "$stage" limber "$version"
}

# build_debian STAGE NAME VERSION: adds the checksums, and writes the package.
build_debian() {
  local stage=$1 file=$package_out/$2_$3_$(dpkg --print-architecture).deb
  (cd "$stage" && find usr -type f -print0 | LC_ALL=C sort -z | xargs -0 md5sum >DEBIAN/md5sums)
  find "$stage" -exec touch -h -d "@$(source_time)" {} +
  SOURCE_DATE_EPOCH=$(source_time) dpkg-deb --root-owner-group -Zxz --build "$stage" "$file" >/dev/null ||
    die 3 "dpkg-deb could not build $file." "fix the problem above and try again."
  say "built: $file"
  say "to install it: apt install ./$file"
}

# Builds the Python module, which a build without Python's headers has left out.
build_python() {
  mkdir -p "$package_out"
  cmake -DLIMBER_PYTHON=ON build >"$package_out/python.log" 2>&1 &&
    cmake --build build --target limber_python -j "$(jobs)" </dev/null >>"$package_out/python.log" 2>&1 ||
    die 3 "the Python package could not be built (whole output: $package_out/python.log)." \
      "apt-get install python3-dev python3-numpy pybind11-dev"
}

python_control() {
  local minor
  minor=$(/usr/bin/python3 -c 'import sys; print(sys.version_info[1])')
  cat <<TEXT
Package: python3-limber
Source: limber
Version: $1
Architecture: $(dpkg --print-architecture)
Maintainer: $package_maintainer
Installed-Size: $(du -sk --apparent-size "$2/usr" | cut -f1)
Depends: $3, limber (= $1), python3 (<< 3.$((minor + 1))), python3 (>= 3.$minor), python3-numpy
Section: python
Priority: optional
Description: live simulator of actuated bodies, as a Python module
 Limber simulates bodies that are built from URDF files or in Lua, moved by
 motors and behaviors. With this module, Python programs step simulations,
 read and set their properties as NumPy arrays, save and restore their state,
 and draw images without a display.
 .
 Scenes are environments with Gymnasium's protocol, also many at once in
 several processes.
TEXT
}

make_python_package() {
  local stage=$package_out/python_stage version depends file files packages doc
  for file in dpkg-deb dpkg-shlibdeps; do need_program $file dpkg-dev; done
  build_python
  version=$(package_version)-1~$(release_tag)
  packages=$stage/usr/lib/python3/dist-packages doc=$stage/usr/share/doc/python3-limber
  rm -rf "$stage" && mkdir -p "$stage/DEBIAN" "$packages" "$doc/examples"
  umask 022
  cmake --install build --component python --prefix "$packages" --strip >"$package_out/install.log" ||
    die 3 "installing into $packages failed (whole output: $package_out/install.log)." "remove build/package and try again."
  cp .ci/package/copyright "$doc/copyright"
  cp python/examples/*.py "$doc/examples/"
  debian_changelog "$version" | gzip -9n >"$doc/changelog.Debian.gz"
  files=$(cd "$package_out" && echo python_stage/usr/lib/python3/dist-packages/limber/{_core.*.so,lib/liblimber.so.*.*})
  depends=$(library_dependencies -lpython_stage/usr/lib/python3/dist-packages/limber/lib $files) || exit
  python_control "$version" "$stage" "$depends" >"$stage/DEBIAN/control"
  # Python compiles the modules after the installation, as Debian's other packages do
  cat >"$stage/DEBIAN/postinst" <<'TEXT'
#!/bin/sh
set -e
if [ "$1" = configure ] && command -v py3compile >/dev/null; then py3compile -p python3-limber; fi
TEXT
  cat >"$stage/DEBIAN/prerm" <<'TEXT'
#!/bin/sh
set -e
if command -v py3clean >/dev/null; then py3clean -p python3-limber; fi
TEXT
  chmod 755 "$stage/DEBIAN/postinst" "$stage/DEBIAN/prerm"
  build_debian "$stage" python3-limber "$version"
}

make_wheel() {
  local file
  build_python
  file=$(SOURCE_DATE_EPOCH=$(source_time) /usr/bin/python3 .ci/package/wheel.py build "$package_out") ||
    die 3 "the wheel could not be built." "fix the problem above and try again."
  say "built: $file"
  say "to install it: pip install $file"
}

# True for libraries of the system: the C and C++ library, and libraries of graphics drivers.
system_library() {
  case $1 in
    ld-linux* | libc.so.* | libm.so.* | libdl.so.* | libpthread.so.* | librt.so.* | libresolv.so.* | libutil.so.* | \
      libstdc++.so.* | libgcc_s.so.* | libGL.so.* | libEGL.so.* | libGLX.so.* | libOpenGL.so.* | libGLdispatch.so.* | \
      libdrm.so.* | libgbm.so.* | libwayland-*) return 0 ;;
  esac
  return 1
}

# Copies the libraries that the program loads, and their licenses.
bundle_libraries() {
  local tree=$1 name path package
  mkdir -p "$tree/lib"
  while read -r name path; do
    system_library "$name" && continue
    cp -L "$path" "$tree/lib/$name" && strip --strip-unneeded "$tree/lib/$name" &&
      patchelf --force-rpath --set-rpath '$ORIGIN' "$tree/lib/$name" || exit 3
    package=$(dpkg-query -S "*/$(basename "$(realpath "$path")")" 2>/dev/null | sed 's/:.*//;q')
    [ -n "$package" ] || die 3 "$path belongs to no package, so its license is unknown." "build with Debian's libraries."
    install_licences "$tree/share/doc/limber/licences" "$package"
  done < <(LC_ALL=C ldd "$tree/bin/limber" | awk '$2 == "=>" && $3 ~ /^\// { print $1, $3 }')
  patchelf --force-rpath --set-rpath '$ORIGIN/../lib' "$tree/bin/limber" || exit 3
}

make_tarball() {
  local name tree
  [ "$(os_field ID)$(os_field VERSION_ID)" = debian12 ] || die 3 \
    "a tarball built on $(system_name) would not run on Debian 12, which has an older C library." \
    "build it on Debian 12: .ci/chroot bookworm ./run --tarball"
  need_program patchelf patchelf
  name=limber-$(package_version)-linux-$(uname -m)
  tree=$package_out/$name
  build_modules
  rm -rf "$tree" && mkdir -p "$tree"
  install_tree "$tree"
  bundle_libraries "$tree"
  install_site "$tree/share/doc/limber/html"
  tar -C "$package_out" --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$(source_time)" -czf \
    "$package_out/$name.tar.gz" "$name" || die 3 "tar could not write $package_out/$name.tar.gz." "free some disk space."
  say "built: $package_out/$name.tar.gz"
}
