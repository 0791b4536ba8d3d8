#!/usr/bin/env python3
"""Measures the time from a packet of motion capture to the DMX value that it changes.

    tests/bench/lights_latency.py build/limber [SECONDS]

Plays sixteen fixtures and three dancers of 67 joints at 120 frames per second, with a VMC performer and sixteen
trackers of PosiStageNet beside them, all by loopback. Every fourth of a second a joint jumps by a meter, which a route turns into the dimmer of a fixture; the time
until the first Art-Net packet with the new value is a sample. Prints the distribution in ms; the bar is one tick + 2 ms
for 99 % and two ticks for 99.9 %.
"""

import math
import pathlib
import select
import socket
import struct
import subprocess
import sys
import tempfile
import time

TICK = 1 / 60
JOINTS = 67
RATE = 120
TRACKERS = 16
SCENE = """
for i = 1, 3 do
  local joints = {}
  for k = 1, %d do joints[k] = "j" .. k end
  sim:add_mocap("dancer" .. i, {
    messages = { ["/mocap/" .. i .. "/joint/pos_world"] = "x y z" }, joints = joints, max_speed = 1e4 })
end
sim:add_mocap("vmc", { source = "vmc" })
sim:add_mocap("psn", { source = "psn:127.0.0.1:PSN_PORT" })
for i = 1, 16 do sim:add_fixture("f" .. i, { profile = "dimmer", universe = 1, address = i, dimmer = 0 }) end
sim:add_route("light", { from = "/physics/mocap/dancer1/joint/j1/position.x", to = "/lighting/fixture/f1/dimmer",
  input = { 0, 1 }, output = { 0, 1 } })
""" % JOINTS


def padded(text):
    data = text.encode() + b"\0"
    return data + b"\0" * (-len(data) % 4)


def floats(address, values):
    return padded(address) + padded("," + "f" * len(values)) + struct.pack(f">{len(values)}f", *values)


def bone(name, values):
    return padded("/VMC/Ext/Bone/Pos") + padded(",s" + "f" * 7) + padded(name) + struct.pack(">7f", *values)


def chunk(number, content, has_chunks=False):
    """A chunk of PosiStageNet."""
    return struct.pack("<I", number | len(content) << 16 | has_chunks << 31) + content


def psn_header(frame):
    return chunk(0, struct.pack("<QBBBB", round(1e6 * frame / RATE), 2, 3, frame % 256, 1))


def psn_names(frame):
    names = b"".join(chunk(k, chunk(0, f"tracker {k}".encode()), True) for k in range(TRACKERS))
    return chunk(0x6756, psn_header(frame) + chunk(1, b"bench") + chunk(2, names, True), True)


def psn_places(frame):
    places = [(math.sin(0.01 * frame + k), 1, k) for k in range(TRACKERS)]
    trackers = b"".join(chunk(k, chunk(0, struct.pack("<3f", *place)), True) for k, place in enumerate(places))
    return chunk(0x6755, psn_header(frame) + chunk(1, trackers, True), True)


def ports():
    """Three free UDP ports on loopback: closed sockets for the program, an open one for its light."""
    sockets = [socket.socket(socket.AF_INET, socket.SOCK_DGRAM) for _ in range(3)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    numbers = [each.getsockname()[1] for each in sockets[:2]]
    for each in sockets[:2]:
        each.close()
    return (*numbers, sockets[2])


def measure(limber, seconds):
    port, psn_port, light = ports()
    folder = tempfile.TemporaryDirectory()
    scene = pathlib.Path(folder.name) / "latency.lua"
    scene.write_text(SCENE.replace("PSN_PORT", str(psn_port)))
    show = subprocess.Popen(
        [limber, "play", str(scene), "--headless", "--quiet", "--osc-in", f"127.0.0.1:{port}", "--osc-out", "off",
         "--query", "off", "--lights", "--lights-out", f"artnet:127.0.0.1:{light.getsockname()[1]},rate=60"])
    out = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    to = ("127.0.0.1", port)
    samples, value, changed_at, frame = [], 0, None, 0
    begin = time.monotonic()
    next_frame = next_change = begin + 2
    while (now := time.monotonic()) < begin + 2 + seconds:
        if now >= next_frame:
            next_frame += 1 / RATE
            frame += 1
            if now >= next_change and changed_at is None:
                value, changed_at = 1 - value, time.monotonic()
                next_change = now + 0.25 + 0.0137 * math.sin(frame)  # in all phases of a tick
            for dancer in (1, 2, 3):
                places = [value if dancer == 1 else 0, 0, 1] + [math.sin(0.01 * frame + k) for k in range(3 * JOINTS - 3)]
                out.sendto(floats(f"/mocap/{dancer}/joint/pos_world", places), to)
            out.sendto(bone("Hips", [0, 1, 0, 0, 0, 0, 1]), to)
            if frame % RATE == 1:
                out.sendto(psn_names(frame), ("127.0.0.1", psn_port))
            out.sendto(psn_places(frame), ("127.0.0.1", psn_port))
        if select.select([light], [], [], max(0, min(next_frame - time.monotonic(), 0.01)))[0]:
            packet = light.recv(2048)
            arrived = time.monotonic()
            if packet[8:10] == b"\x00\x50" and changed_at is not None and (packet[18] > 127) == (value > 0):
                samples.append(1000 * (arrived - changed_at))
                changed_at = None
    show.terminate()
    show.wait()
    return sorted(samples)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    samples = measure(sys.argv[1], float(sys.argv[2]) if len(sys.argv) == 3 else 60)
    if len(samples) < 10:
        sys.exit("too few values arrived; is the machine busy?")
    at = lambda share: samples[min(len(samples) - 1, int(share * len(samples)))]
    print(f"{len(samples)} values: median {at(0.5):.1f} ms, 90 % {at(0.9):.1f}, 99 % {at(0.99):.1f}, "
          f"99.9 % {at(0.999):.1f}, largest {samples[-1]:.1f}; a tick {1000 * TICK:.1f}")


if __name__ == "__main__":
    main()
