#!/usr/bin/env bash
# npm's OSC libraries play a scene and read its streams.
# needs: node npm python3
set -e
cd "$(dirname "$0")/../.."
home=$PWD folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp tests/clients/score.mjs "$folder/"
cd "$folder"
npm install --no-audit --no-fund --silent osc@2.4.5 node-osc@11.7.1 osc-js@2.4.1 >/dev/null
for library in osc@2.4.5 node-osc@11.7.1 osc-js@2.4.1; do
  python3 "$home/tests/clients/score.py" "$home/build/limber" "npm-${library%@*} ${library#*@}, node $(node --version)" \
    node score.mjs "${library%@*}" IN OUT
done
