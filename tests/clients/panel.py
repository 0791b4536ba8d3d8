"""Tests the remote panel in headless Chromium, controlled by its debugging pipe; --shots FOLDER saves screenshots."""
import base64
import fcntl
import json
import os
import re
import socket
import struct
import subprocess
import sys
import tempfile
import time

TIMEOUT = 60  # s; reached only by failing tests
SCENE = """
params {
  { "wind", 2, min = 0, max = 10, unit = "N", doc = "Wind speed." },
  { "where", vec3(0, 0, 1), min = -1, max = 2, unit = "m", doc = "A place." },
  { "lively", true, doc = "On or off." },
  { "style", "calm", choices = { "calm", "wild" }, doc = "The style." },
}
local shape = sim:add_sphere_shape("ball", 0.1)
local body = sim:add_body("arm one")
body:add_part("base", shape, { mass = 0, position = vec3(0, 0, 2) })
body:add_part("tip", shape, { position = vec3(0, 0, 1) })
body:add_motor(body:add_joint("elbow", "base", "tip", { position = vec3(0, 0, 2), axis = vec3(0, 1, 0) }))
body:add_behavior("force", "push", { parts = "tip" })
sim:add_group_behavior("cohesion", "swarm", { amount = 2 })
osc:on("/more", function() body:copy("two") end)
"""


def must(condition, name):
    if not condition:
        sys.exit(f"FAILED: {name}")
    print(f"ok: {name}")


class Limber:
    def __init__(self, program, folder, port="0"):
        scene = os.path.join(folder, "s.lua")
        with open(scene, "w", encoding="utf-8") as file:
            file.write(SCENE)
        self.process = subprocess.Popen(
            [program, scene, "--osc-in", "127.0.0.1:0", "--osc-out", "off", "--query", port],
            stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        self.osc = self.web = None
        for line in self.process.stderr:
            if found := re.search(r"OSC in 127.0.0.1:(\d+)", line):
                self.osc = int(found[1])
            if found := re.search(r"remote panel http://127.0.0.1:(\d+)/", line):
                self.web = int(found[1])
            if "playing headless" in line:
                break
        must(self.osc and self.web, "Limber is running")

    def send(self, address, value=None):
        def text(word):
            raw = word.encode() + b"\0"
            return raw + b"\0" * (-len(raw) % 4)
        packet = text(address) + (text(",") if value is None else text(",f") + struct.pack(">f", value))
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as udp:
            udp.sendto(packet, ("127.0.0.1", self.osc))

    def end(self):
        self.process.kill()
        self.process.wait()


class Browser:
    def __init__(self, folder):
        to_browser, from_us = os.pipe()
        to_us, from_browser = os.pipe()
        # not 3 and 4, which the browser uses
        reads, writes = fcntl.fcntl(to_browser, fcntl.F_DUPFD, 20), fcntl.fcntl(from_browser, fcntl.F_DUPFD, 20)

        def set_up_pipes():
            os.dup2(reads, 3)
            os.dup2(writes, 4)
        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-dev-shm-usage", "--remote-debugging-pipe",
             "--user-data-dir=" + folder, "about:blank"],
            close_fds=False, preexec_fn=set_up_pipes, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        self.write, self.read = os.fdopen(from_us, "wb", 0), os.fdopen(to_us, "rb", 0)
        self.number, self.buffer, self.events = 0, b"", []
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self.session = None
        self.session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(domain + ".enable")

    def receive(self):
        while b"\0" not in self.buffer:
            piece = self.read.read(65536)
            if not piece:
                sys.exit("FAILED: the browser has exited")
            self.buffer += piece
        line, self.buffer = self.buffer.split(b"\0", 1)
        return json.loads(line)

    def call(self, method, **params):
        self.number += 1
        command = {"id": self.number, "method": method, "params": params}
        if getattr(self, "session", None):
            command["sessionId"] = self.session
        self.write.write(json.dumps(command).encode() + b"\0")
        while True:
            message = self.receive()
            if message.get("id") == self.number:
                if "error" in message:
                    sys.exit(f"FAILED: {method}: {message['error']}")
                return message["result"]
            self.events.append(message)

    def eval(self, text):
        result = self.call("Runtime.evaluate", expression=text, awaitPromise=True, returnByValue=True)
        if "exceptionDetails" in result:
            sys.exit(f"FAILED: {text}: {result['exceptionDetails']}")
        return result["result"].get("value")

    def until(self, text, name):
        end = time.monotonic() + TIMEOUT
        while time.monotonic() < end:
            if self.eval(text):
                return print(f"ok: {name}")
            self.eval("new Promise(r => setTimeout(r, 30))")
        shown = self.eval("document.body.innerText")
        sys.exit(f"FAILED: {name}\n{shown}")

    def size(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)

    def shot(self, path):
        image = self.call("Page.captureScreenshot", format="png")["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(image))

    def errors(self):
        errors = []
        for event in self.events:
            if event.get("method") == "Runtime.exceptionThrown":
                errors.append(str(event["params"]["exceptionDetails"]))
            if event.get("method") == "Log.entryAdded" and event["params"]["entry"]["level"] == "error":
                errors.append(event["params"]["entry"]["text"])
        return [s for s in errors if "ERR_CONNECTION_REFUSED" not in s and "ERR_CONNECTION_RESET" not in s]

    def requested_urls(self):
        return [e["params"]["request"]["url"] for e in self.events if e.get("method") == "Network.requestWillBeSent"]

    def end(self):
        self.process.kill()
        self.process.wait()


# the row of a property, by its label in an expanded section
ROW = "[...document.querySelectorAll('#parameters .row')].find(r => r.querySelector('.label').textContent === '%s')"


def touch(browser, kind, *points):
    browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y} for x, y in points])


def swipe(browser, start, by):
    """Swipes with one finger; each step takes a frame of the page."""
    touch(browser, "touchStart", start)
    for step in range(1, 21):
        touch(browser, "touchMove", (start[0] + by[0] * step / 20, start[1] + by[1] * step / 20))
        browser.eval("new Promise(r => requestAnimationFrame(r))")
    touch(browser, "touchEnd")


def test_touch(browser, limber):
    """Tests touch input on a phone: vertical swipes scroll, sideways swipes set values."""
    browser.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=1)
    wind = ROW % "wind"
    limber.send("/scene/wind", 2)
    browser.until(f"{wind}.querySelector('.number').value === '2'", "the initial value")
    browser.eval(f"{wind}.scrollIntoView({{ block: 'end' }})")
    browser.eval("new Promise(r => setTimeout(r, 100))")

    def place():
        return browser.eval(f"(() => {{ const b = {wind}.querySelector('.bar').getBoundingClientRect();"
                            " return [b.left, b.top + b.height / 2, b.width]; })()")
    x, y, width = place()
    browser.eval("window.received = []; window.before = document.scrollingElement.scrollTop")
    swipe(browser, (x + 0.8 * width, y), (0, -200))
    browser.until("document.scrollingElement.scrollTop > before + 100", "a swipe up on a slider scrolls the page")
    x, y, width = place()
    touch(browser, "touchStart", (x + 0.8 * width, y))
    touch(browser, "touchEnd")
    browser.eval("new Promise(r => setTimeout(r, 300))")
    must(browser.eval("received.every(v => v === 2)"), "a vertical swipe and a tap set nothing")
    swipe(browser, (x + 0.3 * width, y), (0.4 * width + 8, 0))
    browser.until("Math.abs(received[received.length - 1] - 6) < 0.4", "a sideways swipe sets the value relatively")
    # the header
    browser.eval("link.send('/preset/store', 's', ['calm'])")
    browser.until("[...document.getElementById('presets').options].some(o => o.value === 'calm')", "the header lists presets")
    limber.send("/scene/wind", 9)
    browser.until("received[received.length - 1] === 9", "another value is set")
    browser.eval("(() => { const s = document.getElementById('presets'); s.value = 'calm'; s.dispatchEvent(new Event('change')); })()")
    browser.until("Math.abs(received[received.length - 1] - 6) < 0.4", "a preset is recalled")
    browser.eval("document.getElementById('panic').click()")
    browser.until("document.getElementById('panic').textContent === 'PANIC ON'", "the panic button works")
    limber.send("/transport/panic_end")
    browser.until("document.getElementById('panic').textContent === 'PANIC'", "the panic button shows the end by another controller")
    browser.eval("document.getElementById('record').click()")
    browser.until("document.getElementById('take').textContent !== ''", "a take is recorded")
    browser.eval("document.getElementById('record').click()")
    browser.until("document.getElementById('take').textContent === ''", "the take is stopped")
    must(browser.eval("document.documentElement.scrollWidth") <= 360, "the header fits a phone")
    browser.call("Emulation.setTouchEmulationEnabled", enabled=False)


def play(browser, limber, shots):
    home = f"http://127.0.0.1:{limber.web}/"
    browser.size(1280, 800)
    browser.call("Page.navigate", url=home)
    wind = ROW % "wind"
    browser.until(f"Boolean({wind})", "the scene's properties are shown")
    must(browser.eval(f"{wind}.querySelector('.number').value") == "2", "with the current value")
    browser.until("parseInt(document.getElementById('tick').textContent) > 10", "the tick counter runs")
    other = "new Promise(r => { const s = new WebSocket('ws://' + location.host); s.onopen = () => { s.send(JSON.stringify(" \
            "{COMMAND: 'LISTEN', DATA: '/scene/wind'})); window.received = []; s.binaryType = 'arraybuffer'; " \
            "s.onmessage = e => { if (typeof e.data !== 'string') received.push(osc.decode(e.data).args[0]); }; r(); }; })"
    browser.eval(other)
    browser.until("received.length > 0", "another client listens")
    # drag the slider
    place = browser.eval(f"(() => {{ const b = {wind}.querySelector('input[type=range]').getBoundingClientRect();"
                         " return [b.left, b.top + b.height / 2, b.width]; })()")
    x, y, width = place
    browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x + 0.2 * width, y=y, button="left", clickCount=1)
    for step in range(21, 71):
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + step / 100 * width, y=y, button="left", buttons=1)
    browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x + 0.7 * width, y=y, button="left", clickCount=1)
    browser.until("Math.abs(received[received.length - 1] - 7) < 0.3", "the slider sets the value, another client receives it")
    limber.send("/scene/wind", 4.5)
    browser.until(f"{wind}.querySelector('.number').value === '4.5'", "a change by OSC is shown")
    must(browser.eval(f"Number({wind}.querySelector('input[type=range]').value)") == 450, "the slider shows it too")
    # keyboard
    browser.eval(f"{wind}.querySelector('input[type=range]').focus()")
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key="End", code="End", windowsVirtualKeyCode=35)
    browser.until("received[received.length - 1] === 10", "the End key sets the maximum")
    browser.eval(f"{wind}.querySelector('.reset').click()")
    browser.until("received[received.length - 1] === 2", "the reset button sets the default")
    # other types
    browser.eval(f"(() => {{ const s = ({ROW % 'style'}).querySelector('select'); s.value = 'wild'; s.dispatchEvent(new Event('change')); }})()")
    browser.until("fetch('/scene/style?VALUE').then(r => r.json()).then(j => j.VALUE[0] === 'wild')", "a choice is set")
    browser.eval(f"({ROW % 'lively'}).querySelector('input').click()")
    browser.until("fetch('/scene/lively?VALUE').then(r => r.json()).then(j => j.VALUE[0] === false)", "a boolean is set")
    browser.eval("document.activeElement.blur()")
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key=" ", code="Space", text=" ", windowsVirtualKeyCode=32)
    browser.until("document.getElementById('play').getAttribute('aria-pressed') === 'true'", "space pauses")
    browser.eval("document.getElementById('play').click()")
    browser.until("document.getElementById('play').getAttribute('aria-pressed') === 'false'", "the button resumes")
    # behaviors: toggled, expanded, and updated by other controllers
    push = "[...document.querySelectorAll('#behaviors .behavior')].find(b => b.innerText.includes('push'))"
    browser.until(f"Boolean({push})", "behaviors are listed")
    browser.until("document.getElementById('behaviors').innerText.includes('swarm')", "groups are listed")
    browser.eval(f"({push}).querySelector('input[type=checkbox]').click()")
    browser.until("fetch('/physics/body/arm%20one/behavior/push/active?VALUE').then(r => r.json()).then(j => j.VALUE[0] === false)",
                  "a behavior is deactivated")
    limber.send("/physics/body/arm%20one/behavior/push/active", 1)
    browser.until(f"({push}).querySelector('input[type=checkbox]').checked", "its activation by another controller is shown")
    browser.eval(f"({push}).open = true")
    browser.until(f"[...({push}).querySelectorAll('.row')].some(r => r.innerText.toLowerCase().includes('amp'))", "it expands to its parameters")
    # a color
    browser.eval("document.querySelector('[data-path=\"/visuals\"]').open = true")
    background = ROW % "background"
    browser.until(f"Boolean({background})", "the properties of the view are shown")
    browser.eval(f"(() => {{ const c = ({background}).querySelector('input[type=color]'); c.value = '#ff0000';"
                 " c.dispatchEvent(new Event('input')); c.dispatchEvent(new Event('change')); })()")
    browser.until("fetch('/visuals/background?VALUE').then(r => r.json()).then(j => j.VALUE[1] > 0.99 && j.VALUE[2] > 0.99)",
                  "a color is set")
    # MIDI: a touched control is learned and keeps its value
    browser.eval("document.getElementById('midi').click()")
    browser.eval(f"({ROW % 'lively'}).querySelector('input').click()")
    browser.until("document.getElementById('midi-state').textContent === 'Move the MIDI control for /scene/lively'",
                  "a touched control is learned")
    browser.until("fetch('/scene/lively?VALUE').then(r => r.json()).then(j => j.VALUE[0] === false)", "it keeps its value")
    browser.eval("document.getElementById('midi').click()")
    browser.until("fetch('/midi/learning?VALUE').then(r => r.json()).then(j => j.VALUE[0] === '')", "learning is canceled")
    # added objects, and search
    browser.eval("document.querySelector('[data-path=\"/physics/body\"]').open = true")
    browser.until("Boolean(document.querySelector('[data-path=\"/physics/body/arm%20one\"]'))", "bodies are listed")
    limber.send("/more")
    browser.until("Boolean(document.querySelector('[data-path=\"/physics/body/two\"]'))", "a new body appears")
    browser.eval("(() => { const s = document.getElementById('search'); s.value = 'two tip mass'; s.dispatchEvent(new Event('input')); })()")
    browser.until("document.querySelectorAll('#found .row').length === 1", "search finds a value")
    browser.eval("(() => { const s = document.getElementById('search'); s.value = ''; s.dispatchEvent(new Event('input')); })()")
    browser.until("document.getElementById('found').hidden", "clearing the search shows the tree")
    limber.send("/scene/wimd", 1)
    browser.eval("link.send('/scene/wimd', 'f', [1])")
    browser.until("document.getElementById('messages').innerText.includes(\"did you mean\")", "an error is shown")
    if shots:
        browser.shot(os.path.join(shots, "1280x800.png"))
    # a phone
    browser.size(360, 740)
    must(browser.eval("document.documentElement.scrollWidth") <= 360, "nothing is wider than a phone's 360 pixels")
    must(browser.eval("[...document.querySelectorAll('main button, main select, main input:not([type=checkbox])')]"
                      ".filter(e => e.getClientRects().length && !e.classList.contains('small'))"
                      ".every(e => e.getBoundingClientRect().height >= 30)"), "touch targets are large enough")
    test_touch(browser, limber)
    if shots:
        browser.shot(os.path.join(shots, "360x740.png"))
        browser.eval("document.querySelector('[data-path=\"/physics/body/arm%20one\"]').open = true")
        browser.until("Boolean(document.querySelector('[data-path=\"/physics/body/arm%20one/motor\"]'))", "a body expands")
        browser.eval("document.querySelector('[data-path=\"/physics/body/arm%20one\"]').scrollIntoView()")
        browser.shot(os.path.join(shots, "360x740-body.png"))
    return home


def main():
    program = sys.argv[1]
    shots = sys.argv[3] if sys.argv[2:3] == ["--shots"] else None
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        limber = Limber(program, folder)
        browser = Browser(profile)
        try:
            home = play(browser, limber, shots)
            # restart Limber
            port = str(limber.web)
            limber.end()
            browser.until("document.getElementById('link').textContent === 'Not connected'", "a lost connection is shown")
            limber = Limber(program, folder, port)
            browser.until("document.getElementById('link').textContent === 'Connected'", "it reconnects automatically")
            wind = ROW % "wind"
            limber.send("/scene/wind", 6)
            browser.until(f"{wind} && {wind}.querySelector('.number').value === '6'", "values are updated again")
            must(all(url.startswith((home, "data:")) for url in browser.requested_urls()), "no other server was contacted")
            faults = browser.errors()
            must(not faults, f"no errors in the page's scripts {faults}")
        finally:
            browser.end()
            limber.end()


main()
