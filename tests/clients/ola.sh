#!/usr/bin/env bash
# OLA, as an unprivileged user in a network namespace of its own, receives the values of fixtures by Art-Net and sACN.
# needs: olad ola_patch ola_recorder ola_dev_info ip setpriv unshare
set -e
cd "$(dirname "$0")/../.."
if [ -z "${IN_NAMESPACE-}" ]; then
  [ "$(id -u)" = 0 ] || { echo "left out: root makes the network namespace"; exit 0; }
  IN_NAMESPACE=1 exec unshare --net bash "$0"
fi

folder=$(mktemp -d)
started=()
finish() {
  [ ${#started[@]} = 0 ] || kill "${started[@]}" 2>/dev/null || true
  wait
  rm -rf "$folder"
}
trap finish EXIT
address=10.9.9.1
ip link set lo up
ip link add light0 type veth peer name light1
ip addr add $address/24 dev light0
ip link set light0 up
ip link set light1 up
ip route add 224.0.0.0/4 dev light0

cat > "$folder/lights.lua" <<'LUA'
sim:add_fixture("lamp", { profile = "dimmer", universe = 1, address = 1, dimmer = 1 })
sim:add_fixture("par", { profile = "rgb_par", universe = 1, address = 10, color = vec3(1 / 3, 1, 1), dimmer = 0.5 })
LUA
for plugin in dummy espnet ftdidmx gpio karate kinet milinst nanoleaf opendmx openpixelcontrol osc pathport renard \
  sandnet shownet spi stageprofi uartdmx usbdmx usbserial; do
  echo "enabled = false" > "$folder/ola-$plugin.conf"
done
printf 'enabled = true\nip = %s\n' $address | tee "$folder/ola-artnet.conf" > "$folder/ola-e131.conf"
chown -R nobody "$folder"
setpriv --reuid=nobody --regid=nogroup --clear-groups env HOME="$folder" \
  olad --config-dir "$folder" --no-http > "$folder/olad.log" 2>&1 &
started+=($!)
devices() { ola_dev_info 2>/dev/null; }
for _ in $(seq 300); do
  devices | grep -q E1.31 && break
  sleep 0.1
done
number() { devices | sed -n "s/^Device \([0-9]*\): $1.*/\1/p"; }
# OLA takes the last four bits of its own number as the universe of an Art-Net port: 17 is 0:0:1
ola_patch -d "$(number E1.31)" -p 0 -i -u 1
ola_patch -d "$(number ArtNet)" -p 0 -i -u 17

build/limber play "$folder/lights.lua" --headless --quiet --osc-in 127.0.0.1:0 --osc-out off --query off --lights \
  --lights-out artnet:$address --lights-out sacn,interface=$address &
started+=($!)
# values that stay the same are sent once a second
expected=255,0,0,0,0,0,0,0,0,0,128,0
for universe in 1 17; do
  for _ in $(seq 30); do
    rm -f "$folder/frames"
    timeout 2 ola_recorder --universes $universe --record "$folder/frames" > /dev/null || true
    grep -q "^$universe $expected" "$folder/frames" 2>/dev/null && continue 2
  done
  echo "OLA did not receive $expected in universe $universe:"
  head -c 200 "$folder/frames"
  exit 1
done
echo "ok: OLA $(olad --version 2>/dev/null | grep -o '[0-9.]*' | head -1) received Art-Net and sACN"
