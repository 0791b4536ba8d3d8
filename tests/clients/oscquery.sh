#!/usr/bin/env bash
# Independent clients of npm: oscquery reads the tree, ws and osc listen and set values.
# needs: node npm
set -e
. "$(dirname "$0")/npm_folder.bash"
npm_folder oscquery.mjs oscquery@1.1.1 ws@8.18.0 osc@2.4.5
timeout 120 node oscquery.mjs "$home/build/limber"
