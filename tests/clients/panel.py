"""The remote panel in headless Chromium, steered by its debugging pipe; --shots FOLDER keeps pictures of it."""
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

PATIENCE = 60  # s; only a failing test waits as long
SCENE = """
params {
  { "wind", 2, min = 0, max = 10, unit = "N", doc = "How it blows." },
  { "where", vec3(0, 0, 1), min = -1, max = 2, unit = "m", doc = "A place." },
  { "lively", true, doc = "Whether." },
  { "style", "calm", choices = { "calm", "wild" }, doc = "How." },
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


def must(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")
    print(f"ok: {what}")


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
        must(self.osc and self.web, "the program plays")

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
        # out of the way of 3 and 4, which are the browser's
        reads, writes = fcntl.fcntl(to_browser, fcntl.F_DUPFD, 20), fcntl.fcntl(from_browser, fcntl.F_DUPFD, 20)

        def hand_over():
            os.dup2(reads, 3)
            os.dup2(writes, 4)
        self.process = subprocess.Popen(
            ["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
             "--disable-background-networking", "--disable-dev-shm-usage", "--remote-debugging-pipe",
             "--user-data-dir=" + folder, "about:blank"],
            close_fds=False, preexec_fn=hand_over, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
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
                sys.exit("FAILED: the browser went away")
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

    def until(self, text, what):
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if self.eval(text):
                return print(f"ok: {what}")
            self.eval("new Promise(r => setTimeout(r, 30))")
        shown = self.eval("document.body.innerText")
        sys.exit(f"FAILED: {what}\n{shown}")

    def size(self, width, height):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=width < 600)

    def shot(self, path):
        picture = self.call("Page.captureScreenshot", format="png")["data"]
        with open(path, "wb") as file:
            file.write(base64.b64decode(picture))

    def faults(self):
        said = []
        for event in self.events:
            if event.get("method") == "Runtime.exceptionThrown":
                said.append(str(event["params"]["exceptionDetails"]))
            if event.get("method") == "Log.entryAdded" and event["params"]["entry"]["level"] == "error":
                said.append(event["params"]["entry"]["text"])
        return [s for s in said if "ERR_CONNECTION_REFUSED" not in s and "ERR_CONNECTION_RESET" not in s]

    def asked(self):
        return [e["params"]["request"]["url"] for e in self.events if e.get("method") == "Network.requestWillBeSent"]

    def end(self):
        self.process.kill()
        self.process.wait()


# the row of a value, by its label in an open section
ROW = "[...document.querySelectorAll('#parameters .row')].find(r => r.querySelector('.label').textContent === '%s')"


def touch(browser, kind, *points):
    browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x, "y": y} for x, y in points])


def swipe(browser, start, by):
    """A finger that goes down, moves in steps and comes up; each step is a frame of the page's."""
    touch(browser, "touchStart", start)
    for step in range(1, 21):
        touch(browser, "touchMove", (start[0] + by[0] * step / 20, start[1] + by[1] * step / 20))
        browser.eval("new Promise(r => requestAnimationFrame(r))")
    touch(browser, "touchEnd")


def fingers(browser, limber):
    """Touch on a phone's screen: what scrolls sets nothing, what moves sideways sets."""
    browser.call("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=1)
    wind = ROW % "wind"
    limber.send("/scene/wind", 2)
    browser.until(f"{wind}.querySelector('.number').value === '2'", "a value before it is touched")
    browser.eval(f"{wind}.scrollIntoView({{ block: 'end' }})")
    browser.eval("new Promise(r => setTimeout(r, 100))")

    def place():
        return browser.eval(f"(() => {{ const b = {wind}.querySelector('.bar').getBoundingClientRect();"
                            " return [b.left, b.top + b.height / 2, b.width]; })()")
    x, y, width = place()
    browser.eval("window.heard = []; window.before = document.scrollingElement.scrollTop")
    swipe(browser, (x + 0.8 * width, y), (0, -200))
    browser.until("document.scrollingElement.scrollTop > before + 100", "a swipe up on a slider scrolls the page")
    x, y, width = place()
    touch(browser, "touchStart", (x + 0.8 * width, y))
    touch(browser, "touchEnd")
    browser.eval("new Promise(r => setTimeout(r, 300))")
    must(browser.eval("heard.every(v => v === 2)"), "and sets nothing, and neither does a tap")
    swipe(browser, (x + 0.3 * width, y), (0.4 * width + 8, 0))
    browser.until("Math.abs(heard[heard.length - 1] - 6) < 0.4", "a finger that moves sideways sets, by how far it moves")
    # the header
    browser.eval("link.send('/preset/store', 's', ['calm'])")
    browser.until("[...document.getElementById('presets').options].some(o => o.value === 'calm')", "presets are in the header")
    limber.send("/scene/wind", 9)
    browser.until("heard[heard.length - 1] === 9", "another value")
    browser.eval("(() => { const s = document.getElementById('presets'); s.value = 'calm'; s.dispatchEvent(new Event('change')); })()")
    browser.until("Math.abs(heard[heard.length - 1] - 6) < 0.4", "a preset is recalled")
    browser.eval("document.getElementById('panic').click()")
    browser.until("document.getElementById('panic').textContent === 'PANIC ON'", "PANIC is in the header")
    limber.send("/transport/panic_end")
    browser.until("document.getElementById('panic').textContent === 'PANIC'", "and shows when another hand ends it")
    browser.eval("document.getElementById('record').click()")
    browser.until("document.getElementById('take').textContent !== ''", "a take is recorded")
    browser.eval("document.getElementById('record').click()")
    browser.until("document.getElementById('take').textContent === ''", "and ended")
    must(browser.eval("document.documentElement.scrollWidth") <= 360, "the header fits a phone")
    browser.call("Emulation.setTouchEmulationEnabled", enabled=False)


def play(browser, limber, shots):
    home = f"http://127.0.0.1:{limber.web}/"
    browser.size(1280, 800)
    browser.call("Page.navigate", url=home)
    wind = ROW % "wind"
    browser.until(f"Boolean({wind})", "the scene's values are there")
    must(browser.eval(f"{wind}.querySelector('.number').value") == "2", "with the value of now")
    browser.until("parseInt(document.getElementById('tick').textContent) > 10", "time runs on the page")
    other = "new Promise(r => { const s = new WebSocket('ws://' + location.host); s.onopen = () => { s.send(JSON.stringify(" \
            "{COMMAND: 'LISTEN', DATA: '/scene/wind'})); window.heard = []; s.binaryType = 'arraybuffer'; " \
            "s.onmessage = e => { if (typeof e.data !== 'string') heard.push(osc.decode(e.data).args[0]); }; r(); }; })"
    browser.eval(other)
    browser.until("heard.length > 0", "another client listens")
    # a finger on the slider
    place = browser.eval(f"(() => {{ const b = {wind}.querySelector('input[type=range]').getBoundingClientRect();"
                         " return [b.left, b.top + b.height / 2, b.width]; })()")
    x, y, width = place
    browser.call("Input.dispatchMouseEvent", type="mousePressed", x=x + 0.2 * width, y=y, button="left", clickCount=1)
    for step in range(21, 71):
        browser.call("Input.dispatchMouseEvent", type="mouseMoved", x=x + step / 100 * width, y=y, button="left", buttons=1)
    browser.call("Input.dispatchMouseEvent", type="mouseReleased", x=x + 0.7 * width, y=y, button="left", clickCount=1)
    browser.until("Math.abs(heard[heard.length - 1] - 7) < 0.3", "the slider moves the value, another client hears it")
    limber.send("/scene/wind", 4.5)
    browser.until(f"{wind}.querySelector('.number').value === '4.5'", "a change over OSC shows")
    must(browser.eval(f"Number({wind}.querySelector('input[type=range]').value)") == 450, "the slider stands there too")
    # keys
    browser.eval(f"{wind}.querySelector('input[type=range]').focus()")
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key="End", code="End", windowsVirtualKeyCode=35)
    browser.until("heard[heard.length - 1] === 10", "the End key takes it to its end")
    browser.eval(f"{wind}.querySelector('.reset').click()")
    browser.until("heard[heard.length - 1] === 2", "and its button back to the default")
    # other kinds
    browser.eval(f"(() => {{ const s = ({ROW % 'style'}).querySelector('select'); s.value = 'wild'; s.dispatchEvent(new Event('change')); }})()")
    browser.until("fetch('/scene/style?VALUE').then(r => r.json()).then(j => j.VALUE[0] === 'wild')", "a choice is set")
    browser.eval(f"({ROW % 'lively'}).querySelector('input').click()")
    browser.until("fetch('/scene/lively?VALUE').then(r => r.json()).then(j => j.VALUE[0] === false)", "a truth is set")
    browser.eval("document.activeElement.blur()")
    for kind in ("keyDown", "keyUp"):
        browser.call("Input.dispatchKeyEvent", type=kind, key=" ", code="Space", text=" ", windowsVirtualKeyCode=32)
    browser.until("document.getElementById('play').getAttribute('aria-pressed') === 'true'", "space stands still")
    browser.eval("document.getElementById('play').click()")
    browser.until("document.getElementById('play').getAttribute('aria-pressed') === 'false'", "the button plays")
    # behaviours: toggled, opened, and shown as others set them
    push = "[...document.querySelectorAll('#behaviors .behavior')].find(b => b.innerText.includes('push'))"
    browser.until(f"Boolean({push})", "behaviours are listed")
    browser.until("document.getElementById('behaviors').innerText.includes('swarm')", "groups too")
    browser.eval(f"({push}).querySelector('input[type=checkbox]').click()")
    browser.until("fetch('/physics/body/arm%20one/behavior/push/active?VALUE').then(r => r.json()).then(j => j.VALUE[0] === false)",
                  "a behaviour is switched off")
    limber.send("/physics/body/arm%20one/behavior/push/active", 1)
    browser.until(f"({push}).querySelector('input[type=checkbox]').checked", "and shown when another hand switches it on")
    browser.eval(f"({push}).open = true")
    browser.until(f"[...({push}).querySelectorAll('.row')].some(r => r.innerText.includes('amp'))", "it opens to its parameters")
    # a colour
    browser.eval("document.querySelector('[data-path=\"/visuals\"]').open = true")
    background = ROW % "background"
    browser.until(f"Boolean({background})", "the picture's values are there")
    browser.eval(f"(() => {{ const c = ({background}).querySelector('input[type=color]'); c.value = '#ff0000';"
                 " c.dispatchEvent(new Event('input')); c.dispatchEvent(new Event('change')); })()")
    browser.until("fetch('/visuals/background?VALUE').then(r => r.json()).then(j => j.VALUE[1] > 0.99 && j.VALUE[2] > 0.99)",
                  "a colour is set")
    # things that come, and search
    browser.eval("document.querySelector('[data-path=\"/physics/body\"]').open = true")
    browser.until("Boolean(document.querySelector('[data-path=\"/physics/body/arm%20one\"]'))", "bodies are listed")
    limber.send("/more")
    browser.until("Boolean(document.querySelector('[data-path=\"/physics/body/two\"]'))", "a new body appears")
    browser.eval("(() => { const s = document.getElementById('search'); s.value = 'two tip mass'; s.dispatchEvent(new Event('input')); })()")
    browser.until("document.querySelectorAll('#found .row').length === 1", "search finds a value")
    browser.eval("(() => { const s = document.getElementById('search'); s.value = ''; s.dispatchEvent(new Event('input')); })()")
    browser.until("document.getElementById('found').hidden", "and is left again")
    limber.send("/scene/wimd", 1)
    browser.eval("link.send('/scene/wimd', 'f', [1])")
    browser.until("document.getElementById('messages').innerText.includes(\"did you mean\")", "a mistake is said")
    if shots:
        browser.shot(os.path.join(shots, "1280x800.png"))
    # a phone
    browser.size(360, 740)
    must(browser.eval("document.documentElement.scrollWidth") <= 360, "nothing is wider than a phone's 360 pixels")
    must(browser.eval("[...document.querySelectorAll('main button, main select, main input:not([type=checkbox])')]"
                      ".filter(e => e.getClientRects().length && !e.classList.contains('small'))"
                      ".every(e => e.getBoundingClientRect().height >= 30)"), "what is touched is large enough")
    fingers(browser, limber)
    if shots:
        browser.shot(os.path.join(shots, "360x740.png"))
        browser.eval("document.querySelector('[data-path=\"/physics/body/arm%20one\"]').open = true")
        browser.until("Boolean(document.querySelector('[data-path=\"/physics/body/arm%20one/motor\"]'))", "a body opens")
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
            # it goes away and comes back
            port = str(limber.web)
            limber.end()
            browser.until("document.getElementById('link').textContent === 'not connected'", "a lost connection is said")
            limber = Limber(program, folder, port)
            browser.until("document.getElementById('link').textContent === 'connected'", "it connects by itself")
            wind = ROW % "wind"
            limber.send("/scene/wind", 6)
            browser.until(f"{wind} && {wind}.querySelector('.number').value === '6'", "and follows again")
            must(all(url.startswith((home, "data:")) for url in browser.asked()), "nobody else was asked for anything")
            faults = browser.faults()
            must(not faults, f"no fault in the page's scripts {faults}")
        finally:
            browser.end()
            limber.end()


main()
