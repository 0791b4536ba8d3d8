#!/usr/bin/env python3
"""Controls Limber over OSC and reads its streams, with Python's standard library only.

    python3 limber.py                       while `limber scripts/arms.lua` plays
    python3 limber.py --port 9003 --seconds 5
"""
import argparse
import math
import socket
import struct
import time


def padded(raw):
    return raw + b"\0" * (4 - len(raw) % 4)


def encode(address, *args):
    """Returns one OSC message: int as i, float as f, bool as T or F, text as s."""
    tags, data = ",", b""
    for arg in args:
        if isinstance(arg, bool):
            tags += "T" if arg else "F"
        elif isinstance(arg, int):
            tags, data = tags + "i", data + struct.pack(">i", arg)
        elif isinstance(arg, float):
            tags, data = tags + "f", data + struct.pack(">f", arg)
        else:
            tags, data = tags + "s", data + padded(str(arg).encode())
    return padded(address.encode()) + padded(tags.encode()) + data


def decode(packet):
    """Yields (address, arguments) for each message of a datagram, also inside bundles."""
    if packet.startswith(b"#bundle\0"):
        at = 16
        while at < len(packet):
            size = struct.unpack_from(">i", packet, at)[0]
            yield from decode(packet[at + 4:at + 4 + size])
            at += 4 + size
        return

    def text(at):
        end = packet.index(b"\0", at)
        return packet[at:end].decode(), end + 4 - end % 4
    address, at = text(0)
    tags, at = text(at)
    args = []
    for tag in tags[1:]:
        if tag == "s":
            value, at = text(at)
        else:
            value, at = struct.unpack_from(">" + tag, packet, at)[0], at + 4
        args.append(value)
    yield address, args


class Limber:
    """A connection to one running Limber. Answers and subscribed values arrive at the same socket."""

    def __init__(self, host="127.0.0.1", port=9003):
        self.to = (host, port)
        self.socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)

    def send(self, address, *args):
        self.socket.sendto(encode(address, *args), self.to)

    def receive(self, seconds=1.0):
        """Returns the messages of the next datagram; an empty list after `seconds` without one."""
        self.socket.settimeout(max(seconds, 0.001))
        try:
            return list(decode(self.socket.recv(65536)))
        except (TimeoutError, socket.timeout):
            return []

    def get(self, path):
        self.send("/get", path)
        for address, args in self.receive(10):
            if address == "/error":
                raise LookupError(args[1])
            return args
        raise TimeoutError("no answer; is Limber running?")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--host", default="127.0.0.1")
    parser.add_argument("--port", type=int, default=9003)
    parser.add_argument("--seconds", type=float, default=3)
    options = parser.parse_args()
    limber = Limber(options.host, options.port)

    print("gravity is", limber.get("/physics/sim/gravity"))
    limber.send("/list/bodies")
    bodies = limber.receive(10)[0][1]
    print("bodies:", " ".join(bodies))
    limber.send("/physics/sim/gravity", -3.0)

    # set one property of many motors by a pattern, and receive the positions of the joints 20 times a second
    limber.send("/subscribe", "pos", 20)
    begin = time.monotonic()
    frames = 0
    while (now := time.monotonic() - begin) < options.seconds:
        limber.send("/physics/body/*/motor/*/target", 0.5 * math.sin(2 * math.pi * 0.5 * now))
        while (left := begin + now + 0.02 - time.monotonic()) > 0:
            for address, args in limber.receive(left):
                frames += address == "/physics/joint/pos"
                if address == "/error":
                    print(*args)
    limber.send("/unsubscribe")
    print("frames:", frames)
    limber.send("/physics/sim/gravity", -9.81)


if __name__ == "__main__":
    main()
