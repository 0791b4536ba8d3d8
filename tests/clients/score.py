"""Has a client play score.lua and read its streams: score.py PROGRAM TITLE COMMAND... with IN and OUT for the ports.

What the client sends passes through here; where LIMBER_RECORD names a folder, its bytes are kept there as TITLE.hex.
"""
import os
import re
import shlex
import signal
import socket
import subprocess
import sys
import threading

PATIENCE = 60  # s; only a failing test waits as long
PLAYED = "score\t-3\t0.75\t0.25\t0.5\tfalse\twild\ttrue\t4.5\tvec3(1, 2, 3)"
HEARD = ["pos arm 1 2 3", "score 4.5"]


def udp(port=0):
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.bind(("127.0.0.1", port))
    return made


class Relay:
    """Stands between a client and Limber, answers included, and keeps what the client sent."""

    def __init__(self, port):
        self.to_client, self.to_limber, self.port = udp(), udp(), port
        self.client, self.kept = None, []
        for way in (self.forth, self.back):
            threading.Thread(target=way, daemon=True).start()

    def forth(self):
        while True:
            data, self.client = self.to_client.recvfrom(65536)
            self.kept.append(data)
            self.to_limber.sendto(data, ("127.0.0.1", self.port))

    def back(self):
        while True:
            data = self.to_limber.recv(65536)
            if self.client:
                self.to_client.sendto(data, self.client)


class Lines:
    """A program's output, read as it comes."""

    def __init__(self, stream):
        self.text, self.news = "", threading.Condition()
        threading.Thread(target=self.read, args=(stream,), daemon=True).start()

    def read(self, stream):
        for line in stream:
            with self.news:
                self.text += line
                self.news.notify_all()

    def wait_for(self, part):
        with self.news:
            if self.news.wait_for(lambda: part in self.text, PATIENCE):
                return
        sys.exit(f"FAILED: '{part}' did not come; what came:\n{self.text[-4000:]}")


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
        printed, said = Lines(limber.stdout), Lines(limber.stderr)
        said.wait_for("playing headless")
        relay = Relay(int(re.search(r"OSC in 127.0.0.1:(\d+)", said.text)[1]))
        into = relay.to_client.getsockname()[1]
        words = [str(into) if w == "IN" else str(out) if w == "OUT" else w for w in command]
        player = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  start_new_session=True)
        heard = Lines(player.stdout)
        for part in HEARD:
            heard.wait_for(part)
        printed.wait_for(PLAYED)
        if folder := os.environ.get("LIMBER_RECORD"):
            with open(os.path.join(folder, title.split()[0] + ".hex"), "w", encoding="utf-8") as file:
                file.write(f"# {title}\n# {shlex.join(command)}\n")
                file.writelines(data.hex() + "\n" for data in relay.kept)
        print(f"ok: {title}")
    finally:
        limber.kill()
        if player:
            os.killpg(player.pid, signal.SIGKILL)  # with all that it has started


main()
