#!/bin/bash
# Tests the packages in a minimal Debian. `./check --long package` calls it in the root, in a folder with
# limber_*.deb, python3-limber_*.deb, limber-*.whl, older.deb, limber-*.tar.gz, python_check.py, expected (the hash of the
# run below), tools (packages that the checks need), zsh_completion and mpi (tests/mpi).
# Prints "ok NAME" or "FAILED NAME" with the end of the output for each check.
# shellcheck disable=SC2046,SC2086
cd "$(dirname "$0")" || exit 3
play='play --headless --fast --ticks 120 --hash --seed 3'
deb=$(echo ./limber_*.deb)
export HOME=/home/player XDG_RUNTIME_DIR=/run/player LC_ALL=C.UTF-8
unset DISPLAY WAYLAND_DISPLAY
mkdir -p "$HOME" "$XDG_RUNTIME_DIR" && chmod 700 "$XDG_RUNTIME_DIR"

# check NAME COMMAND...: prints "ok NAME" or "FAILED NAME".
check() {
  local name=$1
  shift
  if "$@" >log 2>&1; then
    echo "ok $name"
  else
    echo "FAILED $name"
    tail -n 25 log | sed 's/^/    /'
  fi
}

install_debian() { apt-get install -y -q --no-install-recommends "$@"; }
hash_is_expected() { [ "$("$@" $play 2>play.err | tail -n 1)" = "$(cat expected)" ] || { cat play.err expected; "$@" $play; false; }; }
is_clean() { "$@" 2>&1 | tee clean.out; [ ! -s clean.out ]; }
no_missing_library() { ! ldd "$1" | grep 'not found'; }

# Commands that draw use another home, because they save window settings, and Mesa's driver saves shaders.
# Renders a still in software; the size shows that it is not a single color.
draws() {
  rm -f still.png
  HOME=/home/other "$@" play --screenshot still.png --at 1 --size 640x360 && [ "$(stat -c %s still.png)" -gt 20000 ]
}
# Plays in a window for two simulated seconds.
shows_a_window() { HOME=/home/other xvfb-run -a -s '-screen 0 1280x800x24' "$@" play --duration 2 --osc-in off --osc-out off --query off --strict; }

# ---- the archive, in a system without other packages
tar -xzf limber-*.tar.gz
tarball=$(echo "$PWD"/limber-*/bin/limber)
check tarball_finds_its_libraries no_missing_library "$tarball"
check tarball_plays hash_is_expected "$tarball"
check tarball_inspects "$tarball" inspect "${tarball%/bin/limber}/share/limber/urdf/arm17.urdf" --json
mkdir moved && mv limber-*/ "moved/with space"
tarball=$PWD/moved/with\ space/bin/limber
check tarball_plays_where_it_was_moved hash_is_expected "$tarball"

# ---- an older package, a home folder with projects and settings, then an upgrade to this package
apt-get update -qq
check installs_older install_debian ./older.deb
check older_has_its_file test -e /usr/share/limber/scripts/older.lua
(cd "$HOME" && limber new show my_show && mkdir -p .config/limber &&
  echo '{"text_size": 1.5, "favourites": ["/physics/sim/gravity"]}' >.config/limber/panel.json &&
  cd my_show && limber scripts/main.lua --headless --fast --ticks 60 --record evening.take &&
  mkdir -p "$HOME/.local/state/limber" &&
  echo 'sim.gravity' >"$HOME/.local/state/limber/console_history") >home.log 2>&1
(cd "$HOME" && find . -type f -print0 | sort -z | xargs -0 md5sum) >home.md5
home_is_kept() { (cd "$HOME" && md5sum --quiet -c -) <home.md5 && [ "$(cd "$HOME" && find . -type f | wc -l)" = "$(wc -l <home.md5)" ]; }
has_a_show() { cat home.log && grep -q evening.take home.md5 && grep -q panel.json home.md5 && grep -q console_history home.md5; }
check home_has_a_show_and_settings has_a_show
check upgrades install_debian "$deb"
check upgrade_removes_what_is_gone test ! -e /usr/share/limber/scripts/older.lua
check upgrade_keeps_the_home home_is_kept
check finds_its_libraries no_missing_library /usr/bin/limber
check plays hash_is_expected limber
check replays_the_take limber --replay "$HOME/my_show/evening.take" --headless --fast --strict
check draws_a_still draws limber
check version_is_the_packages test "$(limber --version | cut -d' ' -f2)" = "$(dpkg-query -W -f '${Version}' limber | cut -d- -f1)"

# ---- the Python package and the wheel; the wheel without any other package of ours
hash_and_image() { PYTHONPATH=$1 HOME=/home/other python3 python_check.py "$2" "$(cat expected)"; }
check wheel_needs install_debian python3-numpy python3-pip
check wheel_installs pip install --no-index --no-deps --target /opt/wheel ./limber-*.whl
check wheel_steps_and_draws hash_and_image /opt/wheel /opt/wheel
check python_installs install_debian ./python3-limber_*.deb
check python_steps_and_draws hash_and_image "" /usr/lib/python3/dist-packages/limber
check python_has_its_version sh -c 'python3 -c "import limber; print(limber.__version__)" | grep -qx "$(dpkg-query -W -f "\${Version}" python3-limber | cut -d- -f1)"'
check python_removes apt-get purge -y -q python3-limber
check python_leaves_nothing test ! -e /usr/lib/python3/dist-packages/limber

# ---- the modules for MPI and pagmo, without these libraries and with them
without_mpi() {
  ! PMI_RANK=0 PMI_SIZE=1 limber sweep /usr/share/limber/scripts/gait.lua --samples 1 --out none.csv 2>none.log || return
  cat none.log
  grep -q "/usr/lib/limber/limber-mpi-mpich.so can't be loaded: libmpich.*Install this MPI on the node" none.log
}
with_mpi() { [ "$(mpi/run "$1" openmpi_table mpich_table | tee /dev/stderr | grep -c '^ok ')" = 2 ]; }
swarm() {
  limber evolve /usr/share/limber/scripts/gait.lua --maximize speed --algorithm pso --generations 2 --population 4 \
    --duration 1 --out swarm 2>swarm.log
}
without_pagmo() {
  ! swarm || return
  cat swarm.log
  grep -q "/usr/lib/limber/limber-pagmo.so can't be loaded: libpagmo.*Install pagmo" swarm.log
}
check names_the_missing_mpi without_mpi
check names_the_missing_pagmo without_pagmo

# ---- integration with desktops, shells, man pages
check installs_tools install_debian $(cat tools)
check sweeps_with_mpi with_mpi /usr/bin/limber
check searches_with_pagmo swarm
check tarball_sweeps_with_mpi with_mpi "$tarball"
check lintian lintian --allow-root --fail-on error,warning "$deb"
check lintian_python lintian --allow-root --fail-on error ./python3-limber_*.deb
check desktop_file is_clean desktop-file-validate /usr/share/applications/limber.desktop
# without a home page, see lintian-overrides; the appstreamcli of Debian 12 does not know that tag
appstream_data() {
  local file=/usr/share/metainfo/org.limber.limber.metainfo.xml
  appstreamcli validate --no-net --explain $file || appstreamcli validate --no-net --override=url-homepage-missing=info $file
}
check appstream appstream_data
check man_page_renders is_clean sh -c 'man --warnings -E UTF-8 -l -Tutf8 -Z /usr/share/man/man1/limber.1.gz >man.out'
check man_finds_it sh -c 'man -w limber && man limber | grep -q "live simulator"'
check md5sums dpkg --verify limber
completes_in_bash() {
  # _comp_load exists in bash-completion 2.12 and newer
  bash --norc -c '. /usr/share/bash-completion/bash_completion
    _comp_load limber 2>/dev/null || _completion_loader limber
    complete -p limber || exit 1
    COMP_WORDS=(limber export --format g) COMP_CWORD=3; _limber; [ "${COMPREPLY[*]}" = gltf ]'
}
check completes_in_bash completes_in_bash
check completes_in_zsh timeout 120 zsh -f ./zsh_completion
check window shows_a_window limber
check tarball_draws_a_still draws "$tarball"
check tarball_window shows_a_window "$tarball"

# ---- removal and purge
removed() { ! ls -d /usr/bin/limber /usr/lib/limber /usr/share/limber /usr/share/doc/limber 2>/dev/null | grep .; }
check removes apt-get remove -y -q limber
check removal_leaves_nothing removed
check removal_keeps_the_home home_is_kept
check installs_again install_debian "$deb"
check purges apt-get purge -y -q limber
check purge_leaves_nothing removed
check purge_keeps_the_home home_is_kept
