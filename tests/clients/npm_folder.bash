# npm_folder FILE PACKAGE...: creates a temporary folder with a copy of the file and the npm packages; it is removed at
# the end. Sourced in tests/clients; afterwards the working directory is that folder and $home is the checkout.
npm_folder() {
  home=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  cp "$home/tests/clients/$1" "$folder/"
  cd "$folder" || exit
  npm install --no-audit --no-fund --silent "${@:2}" >/dev/null
}
