#!/usr/bin/env bash
# Controls score.lua with liblo's oscsend and receives its streams with oscdump: score_liblo.bash IN OUT
to=osc.udp://127.0.0.1:$1
coproc DUMP { exec stdbuf -oL oscdump -L "$2"; }
trap 'kill "$DUMP_PID"' EXIT
# the first line shows that oscdump is listening
read -r _ <&"${DUMP[0]}"
oscsend "$to" /physics/sim/gravity i -3
oscsend "$to" /physics/part/friction ssf arm tip 0.75
oscsend "$to" '/physics/body/*/part/tip/restitution' d 0.25
oscsend "$to" /physics/body/arm/motor/elbow/target f 0.5
oscsend "$to" /physics/behavior/parameter sssF arm push active
oscsend "$to" /scene/style S wild
oscsend "$to" /scene/lively T
oscsend "$to" /scene/wind f 4.5
oscsend "$to" /scene/where ihd 1 2 3
oscsend "$to" /done
while read -r line <&"${DUMP[0]}"; do
  case $line in
    */physics/joint/pos\ sfff\ \"arm\"\ 1.000000\ 2.000000\ 3.000000*) echo "pos arm 1 2 3" ;;
    */score\ f\ 4.500000*) echo "score 4.5" ;;
  esac
done
