#!/usr/bin/env bash
# Independent clients from npm: oscquery reads the tree, ws and osc listen and set.
# needs: node npm
set -e
cd "$(dirname "$0")/../.."
home=$PWD folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cp tests/clients/oscquery.mjs "$folder/"
cd "$folder"
npm install --no-audit --no-fund --silent oscquery@1.1.1 ws@8.18.0 osc@2.4.5 >/dev/null
exec timeout 120 node oscquery.mjs "$home/build/limber"
