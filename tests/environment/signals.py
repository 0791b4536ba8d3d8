"""Signals in the various states of a show."""
import signal
import time

import osc
from place import Stopped, expect, row

GROUP = "Signals"

ENDLESS = 'sim:on_step(function() while true do end end)\n'


def ended(place, show, number, within=20):
    code = show.end(number, within)
    expect(code == 0, f"exit code {code}: {show.err[-300:]}")
    info = place.run("take", "info", place.folder / "tmp/show.take")
    expect("complete" in info.out, f"the take is not complete: {info.out[-300:]}")
    return "exit code 0, the take is complete, and " + place.replays()


def add_end(number):
    @row(GROUP, f"{number.name} while it plays", "ends cleanly: exit code 0, the take is complete and replays")
    def play(place):
        show = place.play(ticks=None)
        show.tick(30)
        return ended(place, show, number)


for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    add_end(number)


@row(GROUP, "SIGINT twice", "ends cleanly, as with one")
def twice(place):
    show = place.play(ticks=None)
    show.tick(30)
    show.signal(signal.SIGINT)
    return ended(place, show, signal.SIGINT)


@row(GROUP, "SIGTERM while paused", "ends cleanly")
def paused(place):
    show = place.play(ticks=None)
    show.tick(10)
    show.osc().ask("/transport/pause", tries=1)
    return ended(place, show, signal.SIGTERM)


@row(GROUP, "SIGTERM while the scene loads", "ends at once")
def loading(place):
    scene = place.write("show/slow.lua", "while true do end\n")
    show = place.play(ticks=None, scene=scene, take=False)
    show.wait_for("slow.lua")
    code = show.end(signal.SIGTERM, 20)
    expect(code >= 0, f"a signal ended it: {code}")
    expect("stopped after 5 s" not in show.err, "it waited for the script")
    return f"exit code {code}"


@row(GROUP, "SIGTERM during an endless script", "ends cleanly; the script was stopped")
def endless(place):
    scene = place.write("show/endless.lua", ENDLESS)
    show = place.play(ticks=None, scene=scene)
    show.wait_for("endless.lua:1")
    return ended(place, show, signal.SIGTERM)


@row(GROUP, "SIGTERM while its terminal is stopped", "ends cleanly")
def terminal(place):
    stopped = Stopped()
    show = place.play(ticks=None, out=stopped.slave, err=stopped.slave)
    show.tick(30)
    return ended(place, show, signal.SIGTERM)


def add_ignored(number):
    @row(GROUP, number.name, "plays to its end with the same hash")
    def play(place):
        show = place.play()
        show.tick(20)
        for _ in range(20):
            show.signal(number)
        return place.expect_end(show)


for number in (signal.SIGPIPE, signal.SIGWINCH, signal.SIGCHLD, signal.SIGCONT, signal.SIGURG, signal.SIGIO,
               signal.SIGUSR1, signal.SIGTTOU, signal.SIGTTIN):
    add_ignored(number)


@row(GROUP, "SIGSTOP for a second, then SIGCONT", "plays on to its end with the same hash")
def asleep(place):
    show = place.play()
    show.tick(20)
    show.signal(signal.SIGSTOP)
    time.sleep(1)
    show.signal(signal.SIGCONT)
    return place.expect_end(show)


@row(GROUP, "SIGUSR2", "panic")
def panic(place):
    show = place.play(ticks=None)
    show.tick(30)
    client = show.osc()
    client.drain()
    show.signal(signal.SIGUSR2)
    show.wait_for("panic")
    answer = show.console("sim.panicked")
    expect(answer == "true", f"sim.panicked is {answer}")
    return ended(place, show, signal.SIGTERM).replace("exit code 0", "panicked; exit code 0")


@row(GROUP, "SIGUSR2 while 200 000 messages a second arrive", "panic while they arrive")
def panic_under_flood(place):
    show = place.play(ticks=None, take=False)
    show.tick(10)
    client = show.osc()
    burst = osc.bundle([osc.message("/physics/body/*/part/*/color/1", 0.5)] * 60)
    end = time.monotonic() + 3
    begin = None
    while time.monotonic() < end:
        for _ in range(30):
            client.raw(burst)
        if begin is None:
            show.signal(signal.SIGUSR2)
            begin = time.monotonic()
        if "panic" in show.err:
            break
    show.wait_for("panic")
    show.end(signal.SIGTERM)
    return f"panicked after {1000 * (time.monotonic() - begin):.0f} ms, with the sender and its log on this machine"
