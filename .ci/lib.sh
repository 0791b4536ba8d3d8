# shellcheck shell=bash disable=SC2046,SC2086,SC2013,SC2154
# Words that ./run and ./check share: saying, refusing, finding and installing packages. Sourced by bash in the root.

# the packages that were installed from here, a line each, so that they can go again
brought=build/brought_packages.txt

say() { printf '%s: %s\n' "$tool" "$*"; }

# refuse CODE TEXT CURE: every refusal says what is wrong and what to do; 2: wrong usage, 3: the machine is at fault
refuse() {
  printf '%s: %s\n%s  cure: %s\n' "$tool" "$2" "${tool//?/ }" "$3" >&2
  exit "$1"
}

# the distribution's name and number, as it calls itself
system_name() { (. "${LIMBER_OS_RELEASE:-/etc/os-release}" 2>/dev/null && printf '%s' "${PRETTY_NAME:-$ID}") || uname -s; }

# the release, as .ci/packages names it: 12 and 13 are Debian's, on which everything is tested; other
release() {
  local word
  word=$( (. "${LIMBER_OS_RELEASE:-/etc/os-release}" 2>/dev/null && [ "$ID" = debian ] && printf '%s' "${VERSION_ID-}"))
  case $word in 12 | 13) printf '%s' "$word" ;; *) printf other ;; esac
}
is_tested() { [ "$(release)" != other ]; }

introduce() {
  if is_tested; then say "Limber on $(system_name)"; else
    say "Limber on $(system_name): untested (Debian 12 and 13 are tested), trying"
  fi
}

# package_rows STEP...: lines "package kind sign" of .ci/packages for these steps on this release
package_rows() {
  local column package kind sign here step steps releases
  here=$(release)
  while read -r column package kind sign; do
    steps=${column%%@*} releases=
    case $column in '' | \#*) continue ;; *@*) releases=${column#*@} ;; esac
    case ",$releases," in ,, | *",$here,"*) ;; *) continue ;; esac
    for step; do
      case ",$steps," in *",$step,"*) printf '%s %s %s\n' "$package" "$kind" "$sign"; break ;; esac
    done
  done <.ci/packages | awk '!known[$1]++'
}

# is anything there that answers to this kind of sign, however it came
sign_present() {
  case $1 in
    program) command -v "$2" >/dev/null ;;
    module) command -v pkg-config >/dev/null && pkg-config --exists "$2" ;;
    file) [ -e "$2" ] ;;
    header) [ -e "/usr/include/$2" ] || [ -e "/usr/local/include/$2" ] ;;
  esac
}

# the packages of these purposes that are not installed
missing_packages() {
  local rows installed package kind sign
  rows=$(package_rows "$@")
  if command -v dpkg-query >/dev/null; then
    # shellcheck disable=SC2046
    installed=$(dpkg-query -W -f='${db:Status-Abbrev}${Package} \n' $(cut -d' ' -f1 <<<"$rows") 2>/dev/null | grep '^ii')
    while read -r package kind sign; do
      case $installed in *"ii $package "*) ;; *) printf '%s ' "$package" ;; esac
    done <<<"$rows"
  else
    while read -r package kind sign; do
      sign_present "$kind" "$sign" || printf '%s ' "$package"
    done <<<"$rows"
  fi
}

# removed_packages PACKAGE...: what apt would remove in order to install these
removed_packages() {
  LC_ALL=C apt-get -s install --no-install-recommends "$@" </dev/null 2>/dev/null | awk '$1 == "Remv" { printf "%s ", $2 }'
}

# nothing that is installed may be removed
refuse_removal() {
  local removed
  removed=$(removed_packages "$@")
  [ -z "$removed" ] || refuse 3 "apt would remove packages in order to install $*: ${removed% }. Nothing was changed." \
    "look at 'apt-get -s install --no-install-recommends $*'; if you can do without them, install these by hand, then call $tool again."
}

# asks when not root, then installs with apt, which removes nothing
install_packages() {
  local packages="$*" root=() answer log
  command -v apt-get >/dev/null ||
    refuse 3 "this system has no apt, so nothing can be installed from here; not found: $packages" \
      "install them under the names your system gives them (these are Debian's), then call $tool again."
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
      refuse 3 "packages are missing, this is not root, and there is no sudo." \
        "as root: apt-get update && apt-get install $packages"
    [ -t 0 ] ||
      refuse 3 "packages are missing, this is not root, and there is no terminal to ask on." \
        "sudo apt-get update && sudo apt-get install $packages"
    say "these Debian packages are missing: $packages"
    read -r -p "$tool: install them with sudo apt-get? [Y/n] " answer
    case $answer in [nN]*) refuse 3 "nothing was installed, so nothing can be built." \
      "sudo apt-get update && sudo apt-get install $packages" ;; esac
    root=(sudo)
  fi
  say "installing with apt: $packages"
  log=$(mktemp)
  # an old list is no reason to stop when the packages are in the cache, so only installing decides
  "${root[@]}" apt-get update -qq -o APT::Update::Error-Mode=any -o Acquire::Retries=2 -o Acquire::http::Timeout=20 \
    </dev/null >"$log" 2>&1 || say "apt could not refresh its lists, trying with the old ones"
  refuse_removal $packages
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends --no-remove \
    -o DPkg::Lock::Timeout=120 -o Acquire::Retries=2 -o Acquire::http::Timeout=20 $packages </dev/null 2>&1 |
    tee -a "$log" | sed -un 's/^\(Need to get .*\|Setting up [^ ]*\).*/  \1/p'
  if [ "${PIPESTATUS[0]}" != 0 ]; then
    grep -E '^(E|Err|W):' "$log" | tail -5 >&2
    if grep -qE 'Temporary failure resolving|Could not resolve|Could not connect|Unable to connect|Network is unreachable|Connection (timed out|refused)' "$log"; then
      refuse 3 "apt cannot reach its servers, so nothing was installed (whole output: $log)." \
        "connect to the network once and call $tool again; afterwards it works without."
    fi
    refuse 3 "apt could not install the packages (whole output: $log)." \
      "mend what apt says above, or install by hand: apt-get install $packages"
  fi
  rm -f "$log"
  mkdir -p build 2>/dev/null && printf '%s\n' $packages >>"$brought" 2>/dev/null || true
}

# finds what is missing and installs it; says nothing and calls no apt when all is there
need_packages() {
  local missing
  missing=$(missing_packages "$@")
  [ -z "$missing" ] || install_packages ${missing% }
}

# g++ 12 is the oldest that knows the C++20 used here
need_compiler() {
  command -v g++ >/dev/null || refuse 3 "there is no C++ compiler: g++ is not in PATH." "apt-get install g++ (12 or newer)"
  local major
  major=$(g++ -dumpversion | cut -d. -f1)
  [ "$major" -ge 12 ] || refuse 3 "g++ is version $major, Limber needs 12 or newer." "install a newer g++ and put it first in PATH."
}

# parallel compilers: one per core, and no more than memory carries (about 1.2 GB each)
jobs() {
  local cores memory
  cores=$(nproc 2>/dev/null || echo 1)
  memory=$(awk '/^MemAvailable/ {print int($2 / 1200000)}' /proc/meminfo 2>/dev/null || echo 1)
  [ "${memory:-0}" -ge 1 ] || memory=1
  echo $((cores < memory ? cores : memory))
}

# newest PROGRAM: the newest version in PATH, such as clang++-19 for clang++; fails when there is none
newest() {
  local found
  found=$(compgen -c "$1-" | grep -xE "${1//+/\\+}-[0-9]+" | sort -t- -k2 -V | tail -n 1)
  found=${found:-$1}
  command -v "$found" >/dev/null && printf '%s' "$found"
}

# configure PRESET FOLDER OPTIONS...: quick when it was done before; a checkout that moved starts afresh. Warnings are
# errors where the caller sets `werror` to ON
configure() {
  local preset=$1 folder=$2 log
  shift 2
  mkdir -p "$folder" 2>/dev/null && [ -w "$folder" ] ||
    refuse 3 "cannot write to $PWD/$folder." "work in a clone that belongs to you, with free space on the disk."
  if [ -e "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" "$folder/CMakeCache.txt"; then
    say "the checkout has moved since $folder was made, configuring afresh"
    rm -rf "$folder/CMakeCache.txt" "$folder/CMakeFiles"
  fi
  log=$folder/configure.log
  if ! cmake --preset "$preset" "-DLIMBER_WERROR=${werror:-OFF}" "$@" </dev/null >"$log" 2>&1; then
    grep -A6 -E 'CMake Error' "$log" | head -20 >&2
    refuse 3 "configuring the build failed (whole output: $log)." "mend what is said above, or remove $folder and call $tool again."
  fi
}
