#!/usr/bin/env bash
# Tests the remote panel in a real browser: opens it, moves a slider, checks that a change by OSC is shown.
# needs: chromium python3
cd "$(dirname "$0")/../.." && exec python3 tests/clients/panel.py build/limber
