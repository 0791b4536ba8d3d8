#!/usr/bin/env bash
# Pure Data and liblo's tools control a scene and receive its streams.
# needs: pd oscsend oscdump stdbuf python3
set -e
cd "$(dirname "$0")/../.."
python3 tests/clients/score.py build/limber "pd $(pd -version 2>&1 | grep -o '[0-9][0-9.-]*' | head -1)" \
  bash tests/clients/score_pd.bash IN OUT
python3 tests/clients/score.py build/limber "liblo 0.31" bash tests/clients/score_liblo.bash IN OUT
