#!/usr/bin/env bash
# The remote panel in a real browser: it opens, moves a slider, and shows a change made over OSC.
# needs: chromium python3
cd "$(dirname "$0")/../.." && exec python3 tests/clients/panel.py build/limber
