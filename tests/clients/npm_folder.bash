# npm_folder FILE PACKAGE...: a folder of its own with a copy of that file and npm's packages beside it, gone at the end.
# Sourced in tests/clients; afterwards the shell stands in that folder, and $home is the checkout.
npm_folder() {
  home=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
  folder=$(mktemp -d)
  trap 'rm -rf "$folder"' EXIT
  cp "$home/tests/clients/$1" "$folder/"
  cd "$folder" || exit
  npm install --no-audit --no-fund --silent "${@:2}" >/dev/null
}
