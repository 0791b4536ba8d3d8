"""The environment of a show: its own folder and user, and the registry of rows.

A row has a group, a name, a description of the expected result, and a function of a Place that returns a description of the
observed result or raises Unexpected. If the table is run as root, the shows run as the user "nobody", else as the same user.
The machine is not changed: full disks are small tmpfs in a separate mount namespace.
"""
import contextlib
import os
import pathlib
import pty
import re
import resource
import select
import shutil
import signal
import subprocess
import tempfile
import termios
import time

import osc

TIMEOUT = 60  # s; only failing rows reach it
TICKS = 150  # length of a show: two and a half seconds
NOBODY = 65534
ROOT = os.geteuid() == 0

# Prints, moves, and uses random numbers; OSC messages don't change its hash, unless a row intends that.
SCENE = """
sim.seed = 7
local floor = sim:add_body("floor")
floor:add_part("floor", sim:add_plane_shape("floor"), { friction = 0.8 })
local pile = sim:add_body("pile")
local parts = {}
for i = 1, 6 do
  parts[i] = pile:add_part("b" .. i, sim:add_sphere_shape("s" .. i, 0.1), { position = vec3(0.05 * i, 0, 0.3 * i) })
end
osc:on("/heard", function() end)
for i = 1, 200 do print("line", i, ("x"):rep(200)) end
local n = 0
sim:on_step(function()
  n = n + 1
  print("step", n)
  if n % 7 == 0 then warn(("w"):rep(n % 90) .. n) end
  parts[1 + n % 6]:apply_impulse(vec3(math.random() - 0.5, math.random() - 0.5, math.random()))
end)
"""


class Unexpected(Exception):
    """Describes an observation that differs from the expectation."""


def expect(condition, observed):
    if not condition:
        raise Unexpected(observed)


ROWS = []  # (group, name, expected, function)


def row(group, name, expected):
    def register(function):
        ROWS.append((group, name, expected, function))
        return function
    return register


def until(description, holds, timeout=TIMEOUT):
    """Waits until holds() returns a true value, and returns it."""
    end = time.monotonic() + timeout
    while time.monotonic() < end:
        value = holds()
        if value:
            return value
        time.sleep(0.01)
    raise Unexpected(f"timed out waiting for {description}")


def program_for_all(given):
    """Copies the program so that every user can run it."""
    folder = pathlib.Path(tempfile.mkdtemp(prefix="limber_program_"))
    folder.chmod(0o755)
    copy = folder / "limber"
    shutil.copy(given, copy)
    copy.chmod(0o755)
    return copy


class Stopped:
    """A terminal with stopped output, as after Ctrl+S."""

    def __init__(self):
        self.master, self.slave = pty.openpty()
        termios.tcflow(self.slave, termios.TCOOFF)

    def hang_up(self):
        os.close(self.slave)
        os.close(self.master)


class Show:
    """A running program. Its outputs are files of its place unless the row redirects them."""

    def __init__(self, place, process, out, err):
        self.place, self.process, self.out_file, self.err_file = place, process, out, err

    @property
    def out(self):
        return self.out_file.read_text(errors="replace") if self.out_file else ""

    @property
    def err(self):
        return self.err_file.read_text(errors="replace") if self.err_file else ""

    def wait_for(self, text):
        until(f"'{text}'", lambda: text in self.err or self.gone())
        expect(text in self.err, f"it ended with {self.process.returncode}: {self.err[-300:]}")

    def gone(self):
        return self.process.poll() is not None

    def port(self, service="OSC in"):
        found = until(f"the port of {service}", lambda: re.search(service + r"[^\n]*127\.0\.0\.1:(\d+)", self.err) or
                      (self.gone() and self.fail()))
        return int(found.group(1))

    def fail(self):
        raise Unexpected(f"it ended with {self.process.returncode}: {self.err[-300:]}")

    def osc(self):
        return osc.Client(self.port())

    def signal(self, number):
        self.process.send_signal(number)

    def console(self, text):
        """Evaluates text in the show's console; returns None if there is no reply."""
        asked = self.place.run("console", "-e", text)
        return asked.out.strip() if asked.code == 0 else None

    def tick(self, number):
        """Waits until the show has reached this tick."""
        def now():
            answer = self.console("sim.tick")
            return answer is not None and float(answer) >= number
        until(f"tick {number}", lambda: now() or (self.gone() and self.fail()))

    def end(self, number=None, within=TIMEOUT):
        """Sends signal `number` and returns the exit code, -N if signal N ended the program."""
        if number:
            self.signal(number)
        try:
            self.code = self.process.wait(within)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            raise Unexpected(f"it did not end within {within} s")
        return self.code


class Place:
    def __init__(self, program, hash_expected=None):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="limber_environment_"))
        self.program, self.hash_expected = program, hash_expected
        self.show_folder = self.folder / "show"
        self.shows, self.closers, self.count = [], [], 0
        for name in ("show", "home", "run", "tmp"):
            (self.folder / name).mkdir(mode=0o700)
            self.own(self.folder / name)
        self.own(self.folder)
        self.environment = {
            "PATH": "/usr/bin:/bin", "HOME": f"{self.folder}/home", "XDG_RUNTIME_DIR": f"{self.folder}/run",
            "XDG_STATE_HOME": f"{self.folder}/home/state", "XDG_CONFIG_HOME": f"{self.folder}/home/config",
            "TMPDIR": f"{self.folder}/tmp", "LC_ALL": "C.UTF-8", "LIBGL_ALWAYS_SOFTWARE": "1"}
        self.scene = self.write("show/scene.lua", SCENE)

    @staticmethod
    def own(path):
        if ROOT:
            os.chown(path, NOBODY, NOBODY, follow_symlinks=False)

    def write(self, name, text, mode=0o644):
        path = self.folder / name
        for parent in reversed(path.parents):
            if self.folder in parent.parents and not parent.exists():
                parent.mkdir()
                self.own(parent)
        path.write_text(text)
        path.chmod(mode)
        self.own(path)
        return path

    def later(self, function):
        self.closers.append(function)

    def close(self):
        for show in self.shows:
            if not show.gone():
                with contextlib.suppress(OSError):
                    show.signal(signal.SIGCONT)
                show.process.kill()
                show.process.wait()
        for function in reversed(self.closers):
            function()
        subprocess.run(["chmod", "-R", "u+rwX", self.folder], check=False, stderr=subprocess.DEVNULL)
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self, *words, out=None, err=None, into=subprocess.DEVNULL, environment=None, limits=(), before=(),
              disk=None, cwd=None, closed=(), session=False, umask=0o022, program=None):
        """Starts a program with these arguments.

        out, err: a file descriptor or a path; default: a file of this place. limits: (resource, maximum). before: prefix
        of the command. disk: (folder, size in KiB, used KiB) of a separate file system. closed: file descriptors to
        close. program: another program, such as a shell.
        """
        self.count += 1
        files = []
        opened = []
        for name, target in (("out", out), ("err", err)):
            path = self.folder / f"{name}.{self.count}" if target is None else None
            if target is None or isinstance(target, (str, pathlib.Path)):
                target = os.open(path or target, os.O_WRONLY | (os.O_CREAT if path else 0) | os.O_NOCTTY, 0o666)
                opened.append(target)
            files.append((path, target))

        def prepare():
            os.umask(umask)
            for limit, maximum in limits:
                resource.setrlimit(limit, (maximum, maximum))
            if ROOT and not disk:
                os.setgroups([])
                os.setgid(NOBODY)
                os.setuid(NOBODY)
            for descriptor in closed:
                os.close(descriptor)

        argv = [*self.mounted(disk), *before, program or self.program, *map(str, words)]
        process = subprocess.Popen(argv, stdin=into, stdout=files[0][1], stderr=files[1][1], preexec_fn=prepare,
                                   env=self.environment if environment is None else environment,
                                   cwd=cwd or self.show_folder, start_new_session=session)
        for descriptor in opened:
            os.close(descriptor)
        show = Show(self, process, files[0][0], files[1][0])
        self.shows.append(show)
        return show

    @staticmethod
    def mounted(disk):
        """Returns the command prefix that mounts a separate file system and drops the privileges needed for it."""
        if not disk:
            return []
        folder, size, full = disk
        script = ('mount -t tmpfs -o size="$2"k,mode=0777,nosuid none "$1" || exit 97; '
                  'head -c "$3"k /dev/zero >"$1/fill" 2>/dev/null; chmod 666 "$1/fill"; shift 3; exec "$@"')
        user = [] if ROOT else ["-U", "-r"]
        drop = [f"--reuid={NOBODY}", f"--regid={NOBODY}", "--clear-groups"] if ROOT else []
        return ["unshare", *user, "-m", "--propagation", "private", "sh", "-c", script, "sh", str(folder), str(size),
                str(full), "setpriv", *drop, "--bounding-set=-all", "--inh-caps=-all"]

    def inside(self, show, path):
        """Returns the path as seen by a show with a separate file system."""
        return pathlib.Path(f"/proc/{show.process.pid}/root{path}")

    def play(self, *more, ticks=TICKS, take=True, scene=None, window=False, query="127.0.0.1:0", **how):
        """Starts a show in real time; ticks=None: without an end."""
        words = ["play", scene or self.scene, "--osc-in", "127.0.0.1:0", "--osc-out", "off", "--query", query]
        if not window:
            words.append("--headless")
        if ticks:
            words += ["--ticks", ticks, "--hash"]
        if take:
            words += ["--record", take if isinstance(take, (str, pathlib.Path)) else self.folder / "tmp/show.take"]
        return self.start(*words, *more, **how)

    def run(self, *words, **how):
        """Runs a program to its end."""
        show = self.start(*words, **how)
        show.end()
        self.shows.remove(show)
        return show

    def hash_of(self, show, take=True):
        """Returns the final hash from the show's output or, if that was lost, from its take."""
        found = re.search(r"hash ([0-9a-f]{16}) tick \d+", show.out)
        if not found and take:
            info = self.run("take", "info", take if isinstance(take, pathlib.Path) else self.folder / "tmp/show.take")
            expect(info.code == 0, f"its take can't be read: {info.err[-200:]}")
            found = re.search(r"hash ([0-9a-f]{16}) tick \d+", info.out)
        expect(found, f"no hash; exit code {show.process.returncode}: {show.err[-300:]}")
        return found.group(1)

    def expect_end(self, show, code=0, says=None, take=True):
        """Expects that a show of TICKS ticks ends with this code and the hash of an undisturbed show."""
        got = show.end()
        seen = self.hash_of(show, take)
        expect(got == code, f"exit code {got}: {show.err[-300:]}")
        expect(seen == self.hash_expected, f"another hash: {seen}")
        if says:
            line = next((l for l in show.err.splitlines() if re.search(says, l)), None)
            expect(line, f"no message matches '{says}': {show.err[-300:]}")
            return f"same hash, exit code {code}; \"{self.short(line)}\""
        return f"same hash, exit code {code}"

    def replays(self, take=None):
        """Expects that a take replays to its own hashes."""
        done = self.run("--replay", take or self.folder / "tmp/show.take", "--fast", "--hash", "--headless")
        expect(done.code == 0 and "all hashes match the take" in done.err, f"replay: {done.code} {done.err[-300:]}")
        return "the take replays to its hash"

    def short(self, text):
        return text.replace(str(self.folder), "…").strip()[:160]


def filled_pipe():
    """Returns both ends of a full pipe."""
    reading, writing = os.pipe()
    os.set_blocking(writing, False)
    with contextlib.suppress(BlockingIOError):
        while True:
            os.write(writing, b"x" * 4096)
    os.set_blocking(writing, True)
    return reading, writing


def ready(descriptor):
    return bool(select.select([descriptor], [], [], 0)[0])
