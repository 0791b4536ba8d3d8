# shellcheck shell=bash disable=SC2154
# The long part "package": builds packages for each release; .ci/package/inside.sh tests them in minimal systems.

# built_for RELEASE --package|--python-package|--tarball|--wheel: builds it, here if this is that release, else in a root; prints the file name.
built_for() {
  local release=$1 what=$2 file log=build/check/package_$1$2.log
  if [ "$(os_field VERSION_CODENAME)" = "$release" ]; then
    ./run "$what" >"$log" 2>&1 || return
    file=$(sed -n 's/^run: built: //p' "$log")
    [ -n "$file" ] && cp "$file" build/check/package/
  else
    .ci/chroot "$release" ./run "$what" >"$log" 2>&1 || return
    file=$(sed -n 's/^run: built: //p' "$log")
    [ -n "$file" ] && .ci/chroot "$release" --no-source cat "/src/limber/$file" >"build/check/package/${file##*/}"
  fi && printf '%s' "build/check/package/${file##*/}"
}

# older_package DEB FILE: repacks the package as an older version, with an additional file.
older_package() {
  local tree=build/check/package/older
  rm -rf "$tree"
  dpkg-deb -R "$1" "$tree" && sed -i 's/^Version: .*/Version: 0.0.1-1/' "$tree/DEBIAN/control" &&
    echo 'print("older")' >"$tree/usr/share/limber/scripts/older.lua" &&
    dpkg-deb --root-owner-group -Znone --build "$tree" "$2" >/dev/null
  rm -rf "$tree"
}

# package_checks RELEASE TARBALL: runs all checks in a minimal root of that release and counts them.
package_checks() {
  local release=$1 tarball=$2 deb python wheel folder=build/check/package/$1 log=build/check/package_$1.log line
  deb=$(built_for "$release" --package) || { fail "the package of $release was not built" "build/check/package_$release--package.log"; return; }
  python=$(built_for "$release" --python-package) || { fail "the Python package of $release was not built" "build/check/package_$release--python-package.log"; return; }
  wheel=$(built_for "$release" --wheel) || { fail "the wheel of $release was not built" "build/check/package_$release--wheel.log"; return; }
  rm -rf "$folder" && mkdir -p "$folder"
  cp -r "$deb" "$python" "$wheel" "$tarball" tests/mpi .ci/package/python_check.py .ci/package/inside.sh .ci/package/zsh_completion "$folder/"
  package_rows bare | cut -d' ' -f1 >"$folder/tools"
  older_package "$deb" "$folder/older.deb" && build/limber play --headless --fast --ticks 120 --hash --seed 3 \
    2>/dev/null | tail -n 1 >"$folder/expected" || { fail "the files for the checks in $release could not be made"; return; }
  # the log has the output of all checks; an early exit is a failure
  tar -C "$folder" -cf - . | .ci/chroot "$release" --name "package_$release" --fresh --no-source -- \
    sh -c 'mkdir /package && tar -C /package -xf - && exec bash /package/inside.sh </dev/null' >"$log" 2>&1
  while read -r line; do
    case $line in
      "ok "*) pass ;;
      "FAILED "*) fail "$release: ${line#FAILED } (output: $log)" ;;
    esac
  done <"$log"
  grep -q 'purge_keeps_the_home$' "$log" || fail "the checks in $release did not reach their end" "$log"
  say "$release: $(grep -c '^ok ' "$log") checks of the packages passed, $(grep -c '^FAILED ' "$log") failed"
}

# --long package: the Debian packages of 12 and 13, the tarball and the wheels: lintian, minimal systems, upgrade, removal, man page, completion
long_package() {
  local release tarball
  . .ci/package/package.sh
  need_packages run package python long
  rm -rf build/check/package && mkdir -p build/check/package
  ./run --build-only >build/check/package_build.log 2>&1 || { fail "the build" build/check/package_build.log; return; }
  tarball=$(built_for bookworm --tarball) || { fail "the tarball was not built" build/check/package_bookworm--tarball.log; return; }
  tar -xzf "$tarball" -C build/check/package
  if python3 .ci/package/site_links.py build/check/package/limber-*/share/doc/limber/html docs \
    >build/check/package_site.log; then pass; else fail "links of the documentation" build/check/package_site.log; fi
  for release in bookworm trixie; do package_checks "$release" "$tarball"; done
}
