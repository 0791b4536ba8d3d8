"""Wall clocks that are wrong, jump, or run at another speed (libfaketime)."""
import glob
import time

from place import expect, row

GROUP = "Clocks"


def with_clock(place, show_of, text, monotonic=False):
    library = next(iter(glob.glob("/usr/lib/*/faketime/libfaketime.so.1")), None)
    expect(library, "libfaketime is missing: apt-get install faketime")
    file = place.write("tmp/clock", text + "\n")
    environment = {**place.environment, "LD_PRELOAD": library, "FAKETIME_TIMESTAMP_FILE": str(file), "FAKETIME_NO_CACHE": "1",
                   "FAKETIME_DONT_FAKE_MONOTONIC": "0" if monotonic else "1", "DONT_FAKE_MONOTONIC": "0" if monotonic else "1"}
    return show_of(environment), file


def add(name, text, expected="the same hash, and the take replays"):
    @row(GROUP, name, expected)
    def play(place):
        show, _ = with_clock(place, lambda e: place.play(environment=e), text)
        return place.expect_end(show) + ", " + place.replays()


add("it is 1970", "@1970-01-01 00:00:10")
add("it is 1901 (before the epoch)", "@1901-12-14 00:00:00")
add("it is 2038-01-19, two seconds before 32-bit time ends", "@2038-01-19 03:14:06")
add("it is 2262", "@2262-04-11 00:00:00")
add("the clock runs ten times as fast", "+0 x10")
add("the clock is stopped", "2026-01-01 00:00:00")


def add_jump(name, before, after):
    @row(GROUP, name, "the same hash, and the take replays")
    def play(place):
        show, file = with_clock(place, lambda e: place.play(environment=e), before)
        show.tick(30)
        file.write_text(after + "\n")
        show.tick(60)
        return place.expect_end(show) + ", " + place.replays()


add_jump("the clock jumps a day ahead", "+0", "+1d")
add_jump("the clock jumps a year back", "+0", "-365d")


@row(GROUP, "the machine slept for two seconds (all threads stopped)", "the same hash")
def slept(place):
    import signal
    show = place.play()
    show.tick(20)
    show.signal(signal.SIGSTOP)
    time.sleep(2)
    show.signal(signal.SIGCONT)
    return place.expect_end(show)
