# shellcheck shell=bash disable=SC2046,SC2086,SC2013,SC2154
# Functions of ./run and ./check: messages, errors, finding and installing packages. Sourced by bash in the root.

# The packages that these scripts installed, one per line, for --uninstall.
installed_list=build/brought_packages.txt

say() { printf '%s: %s\n' "$tool" "$*"; }

# die CODE PROBLEM FIX: prints an error and exits. Codes: 2 wrong usage, 3 a problem of the machine.
die() {
  printf '%s: %s\n%s  fix: %s\n' "$tool" "$2" "${tool//?/ }" "$3" >&2
  exit "$1"
}

# Prints the name and version of the distribution.
system_name() { (. "${LIMBER_OS_RELEASE:-/etc/os-release}" 2>/dev/null && printf '%s' "${PRETTY_NAME:-$ID}") || uname -s; }

# Prints the release as named in .ci/packages: 12 or 13 (Debian, tested), or other.
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

# package_rows STEP...: prints the lines "package kind sign" of .ci/packages for these steps on this release.
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

# sign_present KIND SIGN: true if it is installed, by any means.
sign_present() {
  case $1 in
    program) command -v "$2" >/dev/null ;;
    module) command -v pkg-config >/dev/null && pkg-config --exists "$2" ;;
    file) [ -e "$2" ] ;;
    header) [ -e "/usr/include/$2" ] || [ -e "/usr/local/include/$2" ] ;;
  esac
}

# missing_packages STEP...: prints the packages of these steps that are not installed.
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

# removed_packages PACKAGE...: prints the packages that apt would remove in order to install these.
removed_packages() {
  LC_ALL=C apt-get -s install --no-install-recommends "$@" </dev/null 2>/dev/null | awk '$1 == "Remv" { printf "%s ", $2 }'
}

# check_no_removals PACKAGE...: exits if apt would remove a package.
check_no_removals() {
  local removed
  removed=$(removed_packages "$@")
  [ -z "$removed" ] || die 3 "apt would remove packages in order to install $*: ${removed% }. Nothing was changed." \
    "look at 'apt-get -s install --no-install-recommends $*'; if you don't need them, install these manually, then run $tool again."
}

# install_packages PACKAGE...: asks if not root, then installs with apt, without removing packages.
install_packages() {
  local packages="$*" root=() answer log
  command -v apt-get >/dev/null ||
    die 3 "this system has no apt, so packages can't be installed automatically; not found: $packages" \
      "install them under the names of your system (these are Debian's), then run $tool again."
  if [ "$(id -u)" != 0 ]; then
    command -v sudo >/dev/null ||
      die 3 "packages are missing, this is not root, and there is no sudo." \
        "as root: apt-get update && apt-get install $packages"
    [ -t 0 ] ||
      die 3 "packages are missing, this is not root, and there is no terminal to ask on." \
        "sudo apt-get update && sudo apt-get install $packages"
    say "these Debian packages are missing: $packages"
    read -r -p "$tool: install them with sudo apt-get? [Y/n] " answer
    case $answer in [nN]*) die 3 "nothing was installed, so nothing can be built." \
      "sudo apt-get update && sudo apt-get install $packages" ;; esac
    root=(sudo)
  fi
  say "installing with apt: $packages"
  log=$(mktemp)
  # Continue with outdated lists: the packages may be in the cache, and errors appear on installation.
  "${root[@]}" apt-get update -qq -o APT::Update::Error-Mode=any -o Acquire::Retries=2 -o Acquire::http::Timeout=20 \
    </dev/null >"$log" 2>&1 || say "apt could not update its lists, trying with the old ones"
  check_no_removals $packages
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends --no-remove \
    -o DPkg::Lock::Timeout=120 -o Acquire::Retries=2 -o Acquire::http::Timeout=20 $packages </dev/null 2>&1 |
    tee -a "$log" | sed -un 's/^\(Need to get .*\|Setting up [^ ]*\).*/  \1/p'
  if [ "${PIPESTATUS[0]}" != 0 ]; then
    grep -E '^(E|Err|W):' "$log" | tail -5 >&2
    if grep -qE 'Temporary failure resolving|Could not resolve|Could not connect|Unable to connect|Network is unreachable|Connection (timed out|refused)' "$log"; then
      die 3 "apt cannot reach its servers, so nothing was installed (whole output: $log)." \
        "connect to the network once and run $tool again; afterwards it works offline."
    fi
    die 3 "apt could not install the packages (whole output: $log)." \
      "fix the problem that apt reports above, or install manually: apt-get install $packages"
  fi
  rm -f "$log"
  mkdir -p build 2>/dev/null && printf '%s\n' $packages >>"$installed_list" 2>/dev/null || true
}

# need_packages STEP...: installs missing packages. Prints nothing and does not call apt if none is missing.
need_packages() {
  local missing
  missing=$(missing_packages "$@")
  [ -z "$missing" ] || install_packages ${missing% }
}

# g++ 12 is the oldest version that supports the C++20 features used here.
need_compiler() {
  command -v g++ >/dev/null || die 3 "there is no C++ compiler: g++ is not in PATH." "apt-get install g++ (12 or newer)"
  local major
  major=$(g++ -dumpversion | cut -d. -f1)
  [ "$major" -ge 12 ] || die 3 "g++ is version $major, Limber needs 12 or newer." "install a newer g++ and put it first in PATH."
}

# Prints the number of parallel compilers: one per core, at most one per 1.2 GB of memory.
jobs() {
  local cores memory
  cores=$(nproc 2>/dev/null || echo 1)
  memory=$(awk '/^MemAvailable/ {print int($2 / 1200000)}' /proc/meminfo 2>/dev/null || echo 1)
  [ "${memory:-0}" -ge 1 ] || memory=1
  echo $((cores < memory ? cores : memory))
}

# newest PROGRAM: prints the newest version in PATH, such as clang++-19 for clang++; fails if there is none.
newest() {
  local found
  found=$(compgen -c "$1-" | grep -xE "${1//+/\\+}-[0-9]+" | sort -t- -k2 -V | tail -n 1)
  found=${found:-$1}
  command -v "$found" >/dev/null && printf '%s' "$found"
}

# configure PRESET FOLDER OPTIONS...: runs CMake; starts from scratch if the checkout was moved. Warnings are errors if
# the caller sets `werror` to ON.
configure() {
  local preset=$1 folder=$2 log
  shift 2
  mkdir -p "$folder" 2>/dev/null && [ -w "$folder" ] ||
    die 3 "cannot write to $PWD/$folder." "work in a clone that belongs to you, with free space on the disk."
  if [ -e "$folder/CMakeCache.txt" ] && ! grep -qxF "CMAKE_HOME_DIRECTORY:INTERNAL=$PWD" "$folder/CMakeCache.txt"; then
    say "the checkout has moved since $folder was configured, configuring again"
    rm -rf "$folder/CMakeCache.txt" "$folder/CMakeFiles"
  fi
  log=$folder/configure.log
  if ! cmake --preset "$preset" "-DLIMBER_WERROR=${werror:-OFF}" "$@" </dev/null >"$log" 2>&1; then
    grep -A6 -E 'CMake Error' "$log" | head -20 >&2
    die 3 "configuring the build failed (whole output: $log)." "fix the problem above, or remove $folder and run $tool again."
  fi
}
