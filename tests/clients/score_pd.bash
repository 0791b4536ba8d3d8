#!/usr/bin/env bash
# Controls score.lua and receives its streams with Pure Data: score_pd.bash IN OUT
pd -nogui -nosound -noprefs -stderr -open tests/clients/score.pd -send "ports $1 $2" 2>&1 |
  stdbuf -oL sed -u 's/^\(pos\|score\): /\1 /'
