"""Runs a client that controls score.lua and receives its streams: score.py PROGRAM TITLE COMMAND... with IN and OUT for
the ports.

The client's packets are relayed by this script; if LIMBER_RECORD names a folder, they are saved there as TITLE.hex.
"""
import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import threading

TIMEOUT = 60  # s; reached only by failing tests
PLAYED = "score\t-3\t0.75\t0.25\t0.5\tfalse\twild\ttrue\t4.5\tvec3(1, 2, 3)"
EXPECTED = ["pos arm 1 2 3", "score 4.5"]


def udp(port=0):
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.bind(("127.0.0.1", port))
    return made


class Relay:
    """Relays packets between a client and Limber in both directions, and records those of the client."""

    def __init__(self, port):
        self.to_client, self.to_limber, self.port = udp(), udp(), port
        self.client, self.recorded = None, []
        for direction in (self.forward, self.backward):
            threading.Thread(target=direction, daemon=True).start()

    def forward(self):
        while True:
            data, self.client = self.to_client.recvfrom(65536)
            self.recorded.append(data)
            self.to_limber.sendto(data, ("127.0.0.1", self.port))

    def backward(self):
        while True:
            data = self.to_limber.recv(65536)
            if self.client:
                self.to_client.sendto(data, self.client)


class Lines:
    """The output of a program, read in the background."""

    def __init__(self, stream):
        self.text, self.changed = "", threading.Condition()
        threading.Thread(target=self.read, args=(stream,), daemon=True).start()

    def read(self, stream):
        for line in stream:
            with self.changed:
                self.text += line
                self.changed.notify_all()

    def wait_for(self, part):
        with self.changed:
            if self.changed.wait_for(lambda: part in self.text, TIMEOUT):
                return
        sys.exit(f"FAILED: '{part}' not found in:\n{self.text[-4000:]}")


def main():
    program, title, command = sys.argv[1], sys.argv[2], sys.argv[3:]
    scene = os.path.join(os.path.dirname(os.path.abspath(__file__)), "score.lua")
    free = udp()
    out = free.getsockname()[1]
    free.close()
    limber = subprocess.Popen(
        [program, scene, "--osc-in", "127.0.0.1:0", "--osc-out", f"127.0.0.1:{out}", "--query", "off"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    player = None
    try:
        printed, logged = Lines(limber.stdout), Lines(limber.stderr)
        logged.wait_for("playing headless")
        relay = Relay(int(re.search(r"OSC in 127.0.0.1:(\d+)", logged.text)[1]))
        into = relay.to_client.getsockname()[1]
        words = [str(into) if w == "IN" else str(out) if w == "OUT" else w for w in command]
        player = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  start_new_session=True)
        received = Lines(player.stdout)
        for part in EXPECTED:
            received.wait_for(part)
        printed.wait_for(PLAYED)
        if folder := os.environ.get("LIMBER_RECORD"):
            with open(os.path.join(folder, title.split()[0] + ".hex"), "w", encoding="utf-8") as file:
                file.write(f"# {title}\n# {shlex.join(command)}\n")
                file.writelines(data.hex() + "\n" for data in relay.recorded)
        print(f"ok: {title}")
    finally:
        limber.kill()
        if player:
            os.killpg(player.pid, signal.SIGKILL)  # and its child processes


main()
