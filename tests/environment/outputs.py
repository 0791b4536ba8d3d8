"""Outputs that are full, closed, slow or unread: as standard output, standard error, and both."""
import os
import pty
import signal
import threading

from place import Stopped, expect, filled_pipe, row, until

GROUP = "Outputs"


def full(place):
    return os.open("/dev/full", os.O_WRONLY)


def unread(place):
    reading, writing = filled_pipe()
    place.later(lambda: os.close(reading))
    return writing


def reader_left(place):
    reading, writing = os.pipe()
    os.close(reading)
    return writing


def slow(place):
    reading, writing = os.pipe()

    def read():
        import time
        while os.read(reading, 512):
            time.sleep(0.05)
        os.close(reading)
    threading.Thread(target=read, daemon=True).start()
    return writing


def stopped(place):
    terminal = Stopped()
    place.later(lambda: os.close(terminal.master))
    return terminal.slave


def hung_up(place):
    master, slave = pty.openpty()
    os.close(master)
    return slave


# writing a result blocks until it is read, as in any program; a signal ends the wait
WAITS = None
# description, factory, exit code if it is standard output
KINDS = [
    ("full (/dev/full)", full, 3),
    ("a full, unread pipe", unread, WAITS),
    ("a pipe with a closed reader", reader_left, 0),
    ("a pipe that is read slowly", slow, 0),
    ("a terminal stopped by Ctrl+S", stopped, WAITS),
    ("a terminal that hung up", hung_up, 3),
]


def add(kind, make, code, names):
    streams = " and ".join({"out": "standard output", "err": "standard error"}[n] for n in names)
    note = ""
    if "out" in names and code != 0:
        note = "; the hash can't be printed: exit code 3" if code else "; the hash waits until SIGTERM: exit code 3"

    @row(GROUP, f"{streams}: {kind}", f"plays to its end with the same hash{note}")
    def play(place):
        target = make(place)
        show = place.play(**{name: target for name in names})
        os.close(target)
        if "out" in names and code is WAITS:
            take = place.folder / "tmp/show.take"
            until("a whole take", lambda: f"hash {place.hash_expected}" in place.run("take", "info", take).out)
            expect(not show.gone(), "it did not wait")
            show.signal(signal.SIGTERM)
            return place.expect_end(show, code=3)
        return place.expect_end(show, code=code if "out" in names else 0)


for kind, make, code in KINDS:
    for names in (["out"], ["err"], ["out", "err"]):
        add(kind, make, code, names)


def add_closed(names, numbers, code):
    @row(GROUP, f"{names}: closed", "plays to its end with the same hash" + (
        "; the hash can't be printed: exit code 3" if code else ""))
    def play(place):
        return place.expect_end(place.play(closed=numbers), code=code)


add_closed("standard output", [1], 3)
add_closed("standard error", [2], 0)
add_closed("standard input, output and error", [0, 1, 2], 3)


@row(GROUP, "both on a full disk that has space again later", "plays to its end with the same hash; the log continues")
def disk_full_for_a_while(place):
    folder = place.folder / "tmp/disk"
    folder.mkdir()
    show = place.start("-c", 'exec "$0" play "$1" --headless --osc-in off --query off --osc-out off --ticks 300 --hash '
                       '--record "$2" >"$3/log" 2>&1', place.program, place.scene, place.folder / "tmp/show.take",
                       folder, program="sh", disk=(folder, 64, 64))
    show.tick(60)
    place.inside(show, folder / "fill").unlink()
    show.tick(200)
    log = place.inside(show, folder / "log").read_text(errors="replace")
    show.place.shows.remove(show)
    expect(show.end() == 0, f"exit code {show.code}")
    expect("step" in log, f"its log did not continue: {log[-200:]}")
    place.replays()
    return "exit code 0, the log continued, the take replays"


@row(GROUP, "a terminal with tostop, in the background", "plays to its end with the same hash; SIGTTOU does not stop it")
def background(place):
    master, slave = pty.openpty()
    place.later(lambda: os.close(master))
    threading.Thread(target=lambda: swallow(master), daemon=True).start()
    words = f'stty tostop; "{place.program}" play "{place.scene}" --headless --osc-in off --query off --osc-out off ' \
            f'--ticks 150 --record "{place.folder}/tmp/show.take" & wait $!; echo $? >"{place.folder}/tmp/code"'
    shell = place.start("-m", "-c", words, before=["setsid", "-c"], program="bash", into=slave, out=slave, err=slave)
    os.close(slave)
    shell.end()
    code = (place.folder / "tmp/code").read_text().strip()
    expect(code == "0", f"exit code {code}")
    info = place.run("take", "info", place.folder / "tmp/show.take")
    expect(place.hash_expected in info.out, f"another end: {info.out[-200:]}")
    return "same hash, exit code 0"


def swallow(descriptor):
    try:
        while os.read(descriptor, 4096):
            pass
    except OSError:
        pass


RESULTS = {
    "limber describe": ["describe"],
    "limber inspect": ["inspect", "MODEL"],
    "limber annotate": ["annotate", "/dev/stdout"],
    "limber man": ["man"],
    "limber completion bash": ["completion", "bash"],
    "limber take info": ["take", "info", "TAKE"],
    "limber doctor": ["doctor"],
    "limber --version": ["--version"],
    "limber play --help": ["play", "--help"],
    "limber play --fast --hash": ["SCENE", "--fast", "--ticks", "10", "--hash"],
}


def add_result(name, words):
    @row(GROUP, f"{name} >/dev/full", "exit code 3 and a message")
    def run(place):
        if "TAKE" in words:
            expect(place.play(ticks=5).end() == 0, "no take")
        model = place.write("m.urdf", '<robot name="m"><link name="a"/></robot>')
        known = {"TAKE": place.folder / "tmp/show.take", "SCENE": place.scene, "MODEL": model}
        ran = place.run(*[known.get(w, w) for w in words], out="/dev/full")
        expect(ran.code == 3 and ran.err.strip(), f"exit code {ran.code}: {ran.err[-200:]}")
        return f"exit code 3; \"{place.short(ran.err.splitlines()[-1])}\""


for name, words in RESULTS.items():
    add_result(name, words)


@row(GROUP, "limber describe | head -n 1", "ends quietly")
def describe_head(place):
    ran = place.run("-c", '"$0" describe | head -n 1; echo code ${PIPESTATUS[0]}', place.program, program="bash")
    expect(ran.out.strip().endswith("code 0") and not ran.err, f"{ran.out[-100:]} {ran.err[-200:]}")
    return "exit code 0, no message"
