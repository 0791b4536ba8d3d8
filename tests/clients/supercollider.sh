#!/usr/bin/env bash
# SuperCollider controls a scene and receives its streams.
# needs: sclang python3
set -e
cd "$(dirname "$0")/../.."
export QT_QPA_PLATFORM=offscreen QTWEBENGINE_DISABLE_SANDBOX=1
version=$(timeout 60 sclang -v 2>/dev/null | grep -o '[0-9.]*' | head -1)
python3 tests/clients/score.py build/limber "sclang $version" timeout 60 sclang tests/clients/score.scd IN OUT
