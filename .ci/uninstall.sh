# shellcheck shell=bash disable=SC2154,SC2086
# ./run --uninstall: removes everything that ./run built and installed. Sourced by bash in the root.

settings=${XDG_CONFIG_HOME:-$HOME/.config}/limber
history=${XDG_STATE_HOME:-$HOME/.local/state}/limber

uninstall() {
  local packages='' folders=() folder answer root=()
  [ ! -e "$installed_list" ] || packages=$(awk '!seen[$0]++ {printf "%s ", $0}' "$installed_list")
  for folder in build "$settings" "$history"; do [ ! -e "$folder" ] || folders+=("$folder"); done
  if [ ${#folders[@]} = 0 ]; then say "nothing to remove"; return; fi
  say "this removes: ${folders[*]}"
  [ -z "$packages" ] || say "and these packages, which ./run installed: $packages"
  if [ -t 0 ]; then
    read -r -p "$tool: continue? [y/N] " answer
    case $answer in [yY]*) ;; *) say "nothing was removed"; return ;; esac
  elif [ "$(id -u)" != 0 ]; then
    die 3 "there is no terminal to ask on." "./run --uninstall in a terminal, or as root."
  fi
  if [ -n "$packages" ]; then
    [ "$(id -u)" = 0 ] || root=(sudo)
    "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get remove -y $packages </dev/null >/dev/null ||
      die 3 "apt could not remove the packages; nothing else was removed." "fix the problem that apt reports above, and run it again."
  fi
  rm -rf --one-file-system "${folders[@]}"
  say "removed. Delete the checkout yourself: $PWD"
}
