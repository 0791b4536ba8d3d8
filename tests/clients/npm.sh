#!/usr/bin/env bash
# OSC libraries of npm control a scene and receive its streams.
# needs: node npm python3
set -e
. "$(dirname "$0")/npm_folder.bash"
libraries="osc@2.4.5 node-osc@11.7.1 osc-js@2.4.1"
# shellcheck disable=SC2086
npm_folder score.mjs $libraries
for library in $libraries; do
  python3 "$home/tests/clients/score.py" "$home/build/limber" "npm-${library%@*} ${library#*@}, node $(node --version)" \
    node score.mjs "${library%@*}" IN OUT
done
