"""Displays that are missing, lost or unusual, and keyboard layouts of several countries."""
import os
import signal
import subprocess
import time

from place import expect, row, until

GROUP = "Displays"


class Display:
    """An X server without a screen, and the environment variables of programs that use it."""

    def __init__(self, place, screen="640x480x24"):
        reading, writing = os.pipe()
        self.process = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", screen, "-nolisten", "tcp",
                                         "-noreset"], pass_fds=[writing], stderr=subprocess.DEVNULL)
        os.close(writing)
        with os.fdopen(reading) as number:
            self.name = ":" + number.readline().strip()
        expect(self.name != ":", "Xvfb does not start: apt-get install xvfb")
        self.environment = {**place.environment, "DISPLAY": self.name}
        place.later(self.end)

    def end(self):
        self.process.send_signal(signal.SIGCONT)
        self.process.kill()
        self.process.wait()

    def tool(self, *words):
        return subprocess.run(words, env={**os.environ, "DISPLAY": self.name}, capture_output=True, text=True, check=True)

    def window(self):
        def found():
            ran = subprocess.run(["xdotool", "search", "--name", "limber|scene"], text=True, capture_output=True,
                                 env={**os.environ, "DISPLAY": self.name})
            return ran.stdout.split()
        return until("a window", found)[0]


def windowed(place, display, **how):
    return place.play("--size", "320x240", "--quality", "low", window=True, environment=display.environment, **how)


@row(GROUP, "a window", "the same hash")
def window(place):
    return place.expect_end(windowed(place, Display(place)))


@row(GROUP, "DISPLAY is not set", "the same hash, without a window")
def none(place):
    return place.expect_end(place.play(window=True))


@row(GROUP, "DISPLAY is invalid", "the same hash, without a window")
def wrong(place):
    return place.expect_end(place.play(window=True, environment={**place.environment, "DISPLAY": ":9999"}))


@row(GROUP, "WAYLAND_DISPLAY is invalid", "the same hash, without a window")
def wayland(place):
    return place.expect_end(place.play(window=True, environment={**place.environment, "WAYLAND_DISPLAY": "none"}))


@row(GROUP, "the display server is killed", "plays on to its end with the same hash; reported")
def killed(place):
    display = Display(place)
    show = windowed(place, display)
    display.window()
    show.tick(30)
    display.process.kill()
    return place.expect_end(show, says="display")


@row(GROUP, "the display server hangs for a second", "plays on to its end with the same hash")
def hangs(place):
    display = Display(place)
    show = windowed(place, display)
    display.window()
    show.tick(30)
    display.process.send_signal(signal.SIGSTOP)
    time.sleep(1)
    display.process.send_signal(signal.SIGCONT)
    return place.expect_end(show)


@row(GROUP, "the display server hangs until the end", "plays on; ends at SIGTERM")
def hangs_on(place):
    display = Display(place)
    show = windowed(place, display, ticks=None)
    display.window()
    show.tick(30)
    display.process.send_signal(signal.SIGSTOP)
    show.tick(90)
    code = show.end(signal.SIGTERM, 20)
    return f"it played on; exit code {code}; " + place.replays()


@row(GROUP, "its window is closed by another program (XKillClient)", "plays on to its end with the same hash")
def window_killed(place):
    display = Display(place)
    show = windowed(place, display)
    window = display.window()
    show.tick(20)
    display.tool("xdotool", "windowkill", window)
    return place.expect_end(show)


def add_screen(name, screen):
    @row(GROUP, f"a screen of {name}", "the same hash")
    def play(place):
        return place.expect_end(windowed(place, Display(place, screen)))


add_screen("16 bits", "640x480x16")
add_screen("8 bits", "640x480x8")
add_screen("64 by 48 pixels", "64x48x24")


@row(GROUP, "no OpenGL driver", "the same hash, without a window; reported")
def no_driver(place):
    display = Display(place)
    display.environment.update(LIBGL_DRIVERS_PATH="/nonexistent", GBM_BACKENDS_PATH="/nonexistent",
                               __EGL_VENDOR_LIBRARY_DIRS="/nonexistent", __GLX_VENDOR_LIBRARY_NAME="none")
    return place.expect_end(windowed(place, display))


KEYBOARDS = "Keyboards"


def add_keyboard(layout, variant, name):
    @row(KEYBOARDS, f"{name} ({layout}{' ' + variant if variant else ''}): F12", "panic, and nothing else")
    def play(place):
        display = Display(place)
        display.tool("setxkbmap", layout, *([variant] if variant else []))
        show = windowed(place, display, ticks=None)
        window = display.window()
        show.tick(10)
        display.tool("xdotool", "mousemove", "--window", window, "160", "120")
        display.tool("xdotool", "windowfocus", window)
        display.tool("xdotool", "key", "F12")
        until("a panic", lambda: show.console("sim.panicked") == "true")
        expect(show.console("sim.paused") != "true", "it is paused, too")
        code = show.end(signal.SIGTERM, 20)
        expect(code == 0, f"exit code {code}")
        return "panicked; " + place.replays()


for layout, variant, name in (("us", "", "American"), ("fr", "", "French AZERTY"), ("de", "", "German QWERTZ"),
                              ("us", "dvorak", "Dvorak"), ("ru", "", "Russian"), ("gr", "", "Greek"), ("tr", "f", "Turkish F"),
                              ("jp", "", "Japanese")):
    add_keyboard(layout, variant, name)
