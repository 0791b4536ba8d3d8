"""Resource limits of the system, and unusual process environments."""
import os
import resource
import subprocess
import sys

from place import expect, row

GROUP = "Limits"


def plays_or_fails(place, show, says):
    """Expects either the same hash, or exit code 3 and this message."""
    code = show.end()
    if code == 0:
        expect(place.hash_of(show) == place.hash_expected, "another hash")
        return "same hash, exit code 0"
    expect(code == 3 and says in show.err, f"exit code {code}: {show.err[-300:]}")
    return f"exit code 3; \"{place.short(show.err.strip().splitlines()[-1])}\""


def add_limit(name, limits, says, expected):
    @row(GROUP, name, expected)
    def play(place):
        return plays_or_fails(place, place.play(limits=limits), says)


FEW = "plays with the same hash, or exit code 3 and a message that names the limit"
for count in (5, 8, 12, 16, 20, 24, 32, 64):
    add_limit(f"{count} file descriptors", [(resource.RLIMIT_NOFILE, count)], "more files and sockets can be opened", FEW)
add_limit("a stack of 64 KiB", [(resource.RLIMIT_STACK, 65536)], "stack is limited", FEW)
add_limit("a stack of 256 KiB", [(resource.RLIMIT_STACK, 262144)], "stack is limited", FEW)
for megabytes in (64, 128, 256, 1024):
    add_limit(f"{megabytes} MB of address space", [(resource.RLIMIT_AS, megabytes << 20)], "ulimit -v", FEW)
add_limit("no locked memory, no real-time priority, no core files",
          [(resource.RLIMIT_MEMLOCK, 0), (resource.RLIMIT_RTPRIO, 0), (resource.RLIMIT_CORE, 0)], "-", "the same hash")


@row(GROUP, "no more processes or threads", "exit code 3 and a message")
def threads(place):
    return plays_or_fails(place, place.play(limits=[(resource.RLIMIT_NPROC, 1)]), "thread")


@row(GROUP, "files of at most 1 KiB (SIGXFSZ)", "plays to its end; the take that does not fit is reported")
def small_files(place):
    log = os.open("/dev/null", os.O_WRONLY)
    reading, writing = os.pipe()
    show = place.play(limits=[(resource.RLIMIT_FSIZE, 1024)], out=writing, err=writing)
    os.close(writing)
    os.close(log)
    text = b""
    while True:
        got = os.read(reading, 65536)
        if not got:
            break
        text += got
    os.close(reading)
    code = show.end()
    text = text.decode(errors="replace")
    expect(f"hash {place.hash_expected}" in text, f"exit code {code}: {text[-300:]}")
    line = next((l for l in text.splitlines() if "show.take" in l and ("large" in l or "written" in l)), None)
    expect(line, f"nothing about the take: exit code {code}")
    return f"same hash, exit code {code}; \"{place.short(line)}\""


def add_environment(name, change, expected="the same hash", **how):
    @row(GROUP, name, expected)
    def play(place):
        environment = dict(place.environment)
        change(environment)
        return place.expect_end(place.play(environment=environment, **how))


add_environment("an empty environment", lambda e: e.clear())
add_environment("HOME unset", lambda e: [e.pop(k) for k in ("HOME", "XDG_STATE_HOME", "XDG_CONFIG_HOME")])
add_environment("HOME does not exist", lambda e: (e.update(HOME="/nonexistent"), e.pop("XDG_STATE_HOME")))
add_environment("HOME can't be written", lambda e: (e.update(HOME="/proc"), e.pop("XDG_STATE_HOME")))
add_environment("XDG_RUNTIME_DIR does not exist", lambda e: e.update(XDG_RUNTIME_DIR="/nonexistent/run"))
add_environment("XDG_RUNTIME_DIR unset", lambda e: e.pop("XDG_RUNTIME_DIR"))
add_environment("TMPDIR does not exist", lambda e: e.update(TMPDIR="/nonexistent/tmp"))
add_environment("a locale that does not exist", lambda e: e.update(LC_ALL="xx_YY.UTF-16", LANG="zz"))
add_environment("TZ is invalid", lambda e: e.update(TZ=":\x01/../../etc/passwd"))
add_environment("standard input is endless (/dev/zero)", lambda e: None, into=os.open("/dev/zero", os.O_RDONLY))
add_environment("standard input is closed", lambda e: None, closed=[0])
add_environment("umask 0777", lambda e: None, umask=0o777, take=False)
add_environment("the lowest priority (nice 19)", lambda e: None, before=["nice", "-n", "19"])
add_environment("one processor", lambda e: None, before=["taskset", "-c", "0"])
add_environment("the batch scheduler", lambda e: None, before=["chrt", "--batch", "0"])


@row(GROUP, "a runtime folder with a path too long for a socket", "the same hash; the missing console is reported")
def long_path(place):
    folder = place.folder / "run" / ("d" * 100)
    folder.mkdir(mode=0o700)
    place.own(folder)
    return place.expect_end(place.play(environment={**place.environment, "XDG_RUNTIME_DIR": str(folder)}), says="console")


@row(GROUP, "its working folder has been deleted", "the same hash")
def no_folder(place):
    folder = place.folder / "tmp/gone"
    folder.mkdir()
    place.own(folder)
    show = place.start("-c", 'rmdir "$PWD"; exec "$0" play "$1" --headless --osc-in off --query off --osc-out off '
                       '--ticks 150 --hash', place.program, place.scene, program="sh", cwd=folder)
    return place.expect_end(show, take=False)


@row(GROUP, "a busy machine: two endless programs at normal priority", "the same hash")
def busy(place):
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(2)]
    for other in others:
        place.later(other.wait)
        place.later(other.kill)
    return place.expect_end(place.play())
