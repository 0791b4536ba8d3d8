"""Hostile and broken network traffic, on the loopback interface."""
import random
import re
import signal
import socket
import struct
import time

import osc
from place import expect, row, until

GROUP = "Networks"


def while_playing(name, send, expected="plays to its end with the same hash, and answers"):
    """Adds a row that calls send(show, client) while the show plays."""
    @row(GROUP, name, expected)
    def play(place):
        show = place.play(take=False)
        client = show.osc()
        expect(client.ping(), "no answer before")
        send(show, client)
        expect(show.gone() or client.ping(), "no answer afterwards")
        return place.expect_end(show, take=False)


def noise(show, client):
    draw = random.Random(1)
    for _ in range(3000):
        client.raw(draw.randbytes(draw.randrange(1, 200)))


def broken_osc(show, client):
    good = osc.bundle([osc.message("/heard", 1, "text", 0.5), osc.message("/physics/body/*/name")])
    draw = random.Random(2)
    for _ in range(3000):
        bad = bytearray(good)
        for _ in range(draw.randrange(1, 6)):
            bad[draw.randrange(len(bad))] = draw.randrange(256)
        client.raw(bytes(bad[:draw.randrange(1, len(bad) + 1)]))


def unknown(show, client):
    for i in range(5000):
        client.send(f"/no/such/address/{i}", i)


def heard(show, client):
    for i in range(20000):
        client.send("/heard", i)


def patterns(show, client):
    burst = osc.bundle([osc.message("/physics/body/*/part/*/no_such/*", 1.0)] * 500)
    for _ in range(100):
        client.raw(burst)


def queries(show, client):
    for _ in range(3000):
        client.send("/physics/body/*/part/*/position")


def zero_length(show, client):
    for _ in range(1000):
        client.socket.send(b"")


def largest(show, client):
    for _ in range(50):
        client.raw(osc.message("/heard", "x" * 65000))


def nested(show, client):
    deep = osc.message("/heard", 1)
    while len(deep) < 60000:
        deep = osc.bundle([deep])
    for _ in range(20):
        client.raw(deep)


def subscriptions(show, client):
    for i in range(300):
        client.send("/subscribe", f"/physics/body/*/part/b{i % 6}/*", 1000.0)
    until("its answers", lambda: client.ping() or show.gone())


while_playing("3000 datagrams of random bytes", noise)
while_playing("3000 damaged OSC messages", broken_osc)
while_playing("5000 messages for addresses that do not exist", unknown)
while_playing("20 000 messages for a script", heard)
while_playing("50 000 patterns in bundles", patterns)
while_playing("3000 queries with patterns", queries)
while_playing("1000 empty datagrams", zero_length)
while_playing("50 messages of 65 000 bytes", largest)
while_playing("20 bundles, nested as deep as a datagram allows", nested)
while_playing("300 subscriptions by one sender", subscriptions)


@row(GROUP, "/transport/panic in 20 000 messages", "panic while they arrive, and the take replays")
def panic(place):
    show = place.play(ticks=None)
    client = show.osc()
    expect(client.ping(), "no answer before")
    for i in range(20000):
        client.send("/heard", i)
        if i == 10000:
            client.send("/transport/panic")
    until("a panic", lambda: show.console("sim.panicked") == "true")
    expect(show.end(signal.SIGTERM) == 0, f"exit code {show.code}")
    return "panicked; " + place.replays()


@row(GROUP, "its OSC port is in use", "exit code 3 and a message")
def taken(place):
    other = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    other.bind(("127.0.0.1", 0))
    show = place.start("play", place.scene, "--headless", "--osc-in", f"127.0.0.1:{other.getsockname()[1]}", "--osc-out", "off",
                       "--query", "off", "--ticks", "5")
    code = show.end()
    other.close()
    expect(code == 3 and "already in use" in show.err, f"exit code {code}: {show.err[-300:]}")
    return f"exit code 3; \"{place.short(show.err.strip().splitlines()[-1])}\""


@row(GROUP, "its OSC port is in use, --osc-optional", "plays to its end with the same hash; reported")
def taken_optional(place):
    other = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    other.bind(("127.0.0.1", 0))
    place.later(other.close)
    show = place.start("play", place.scene, "--headless", "--osc-in", f"127.0.0.1:{other.getsockname()[1]}", "--osc-out", "off",
                       "--query", "off", "--ticks", "150", "--hash", "--osc-optional")
    return place.expect_end(show, take=False, says="already in use")


@row(GROUP, "the receiver of its streams doesn't exist", "the same hash")
def no_receiver(place):
    probe = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    probe.bind(("127.0.0.1", 0))
    port = probe.getsockname()[1]
    probe.close()
    return place.expect_end(place.play("--osc-out", f"127.0.0.1:{port}"))


@row(GROUP, "a receiver's name can't be resolved", "the same hash; reported")
def unresolved(place):
    return place.expect_end(place.play("--osc-out", "no-such-host.invalid:9005"), says="no-such-host")


@row(GROUP, "a separate network without active interfaces", "the same hash, or exit code 3 and a message")
def no_interface(place):
    show = place.start("play", place.scene, "--headless", "--osc-in", "127.0.0.1:0", "--osc-out", "127.0.0.1:9005", "--query",
                       "127.0.0.1:0", "--ticks", "150", "--hash", before=["unshare", "-Urn"])
    code = show.end()
    expect(code in (0, 3), f"exit code {code}: {show.err[-300:]}")
    expect(code == 3 or place.hash_of(show, take=False) == place.hash_expected, "another hash")
    return f"exit code {code}" + (", same hash" if code == 0 else f"; \"{place.short(show.err.strip().splitlines()[-1])}\"")


def web_port(show):
    found = until("the port of OSCQuery", lambda: re.search(r"http://127\.0\.0\.1:(\d+)", show.err))
    return int(found.group(1))


def web_row(name, act, expected="plays to its end with the same hash; a page is served meanwhile"):
    @row(GROUP, name, expected)
    def play(place):
        show = place.play(ticks=400)
        port = web_port(show)
        sockets = act(port)
        page = socket.create_connection(("127.0.0.1", port), timeout=30, source_address=("127.0.0.3", 0))
        page.sendall(f"GET /transport HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nConnection: close\r\n\r\n".encode())
        page.settimeout(30)
        got = page.recv(64)
        expect(got.startswith(b"HTTP/1.1 200"), f"no page: {got[:60]}")
        page.close()
        for one in sockets:
            one.close()
        expect(show.end() == 0, f"exit code {show.code}: {show.err[-300:]}")
        return "a page was served; exit code 0, " + place.replays()


def connections(port):
    return [socket.create_connection(("127.0.0.1", port), timeout=30) for _ in range(300)]


def half_requests(port):
    made = connections(port)[:100]
    for one in made:
        try:
            one.sendall(b"GET / HTTP/1.1\r\nHost: x")
        except OSError:
            pass
    return made


def resets(port):
    for _ in range(500):
        one = socket.create_connection(("127.0.0.1", port), timeout=30)
        one.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))
        one.sendall(b"GET / HTTP/1.1\r\n")
        one.close()
    return []


def websockets(port):
    made = []
    for _ in range(300):
        try:
            made.append(osc.WebSocket(port))
        except OSError:
            break
    return made


def unread_websockets(port):
    made = [osc.WebSocket(port) for _ in range(20)]
    for one in made:
        one.send(b'{"COMMAND":"LISTEN","DATA":"/transport/history_memory"}', kind=1)
        one.send(osc.message("/subscribe", "/physics/body/*/part/*/*", 1000.0))
    time.sleep(0.5)
    return made


def noise_http(port):
    draw = random.Random(3)
    for _ in range(300):
        one = socket.create_connection(("127.0.0.1", port), timeout=30)
        try:
            one.sendall(draw.randbytes(draw.randrange(1, 3000)))
        except OSError:
            pass
        one.close()
    return []


web_row("300 idle connections from one address to its web server", connections)
web_row("100 incomplete requests", half_requests)
web_row("500 connections that are reset", resets)
web_row("300 WebSockets from one address", websockets)
web_row("20 WebSockets that subscribe and never read", unread_websockets)
web_row("300 connections with random bytes", noise_http)
