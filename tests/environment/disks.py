"""Full disks, folders that disappear, special files in place of regular ones, and links."""
import os
import pathlib
import shutil
import socket

from place import SCENE, expect, row, until

GROUP = "Disks, files and links"


@row(GROUP, "a full disk for the take", "plays to its end with the same hash; the take is reported, once")
def take_full(place):
    folder = place.folder / "tmp/disk"
    folder.mkdir()
    show = place.play(take=folder / "a.take", disk=(folder, 8, 8))
    seen = place.expect_end(show, take=False, says="a.take", code=show.end())
    expect(show.err.count("a.take") == 1, f"reported {show.err.count('a.take')} times")
    return seen


@row(GROUP, "a disk that fills up after the first second of a take", "plays to its end with the same hash; the take is "
     "reported, and replays as far as it goes")
def take_grows(place):
    folder = place.folder / "tmp/disk"
    folder.mkdir()
    show = place.play("--duration", "6", ticks=None, take=folder / "a.take", disk=(folder, 12, 0))
    client = show.osc()
    for i in range(3000):
        client.send("/heard", i)
        if "writing failed" in show.err:
            break
        if i % 20 == 0:
            until("ticks", lambda: client.ping() or show.gone())
    show.wait_for("writing failed")
    copy = place.folder / "tmp/copy.take"
    shutil.copy(place.inside(show, folder / "a.take"), copy)
    place.own(copy)
    expect(show.end() == 0, f"exit code {show.code}")
    done = place.run("--replay", copy, "--fast", "--headless")
    expect("all hashes match the take" in done.err, f"replay: {done.code} {done.err[-300:]}")
    return "exit code 0, the take ends there and replays"


@row(GROUP, "a full disk for presets and recovery files", "plays to its end with the same hash; both are reported")
def state_full(place):
    folder = place.folder / "tmp/disk"
    folder.mkdir()
    scene = place.folder / "tmp/disk/scene.lua"
    source = place.write("show/source.lua", SCENE)
    show = place.start("-c", 'cp "$1" "$2" && rm "$3/fill" && head -c 1000k /dev/zero >"$3/fill" 2>/dev/null; exec "$0" play '
                       '"$2" --headless --osc-in 127.0.0.1:0 --query off --osc-out off --ticks 400 --hash',
                       place.program, source, scene, folder, program="sh", disk=(folder, 64, 0),
                       environment={**place.environment, "XDG_STATE_HOME": str(folder)})
    client = show.osc()
    client.send("/preset/store", "lost")
    show.wait_for("No space left")
    expect(show.end() == 0, f"exit code {show.code}: {show.err[-300:]}")
    line = next(l for l in show.err.splitlines() if "No space left" in l)
    return f"exit code 0; \"{place.short(line)}\""


@row(GROUP, "the show's folder can't be written", "plays to its end with the same hash; a preset that can't be saved is reported")
def read_only(place):
    place.show_folder.chmod(0o555)
    show = place.play()
    client = show.osc()
    client.send("/preset/store", "kept")
    return place.expect_end(show, says="Permission denied|can't be written")


@row(GROUP, "the show's folder is deleted while it plays", "plays to its end with the same hash")
def folder_gone(place):
    show = place.play()
    show.tick(20)
    shutil.rmtree(place.show_folder)
    return place.expect_end(show)


@row(GROUP, "the show's folder is replaced by another release", "the new scene plays")
def folder_replaced(place):
    show = place.play(ticks=None)
    show.tick(20)
    other = place.folder / "other"
    other.mkdir()
    place.own(other)
    place.write("other/scene.lua", 'print("another release")\n' + SCENE)
    place.show_folder.rename(place.folder / "old")
    other.rename(place.show_folder)
    until("the other release", lambda: "another release" in show.out)
    expect(show.end(2) == 0, f"exit code {show.code}")
    return "it plays; exit code 0 at SIGINT"


@row(GROUP, "the scene is deleted while it plays, then restored", "plays on; the restored scene runs")
def scene_gone(place):
    show = place.play(ticks=None)
    show.tick(20)
    place.scene.unlink()
    show.tick(60)
    place.write("show/scene.lua", 'print("it is back")\n' + SCENE)
    until("the scene", lambda: "it is back" in show.out)
    return f"it is back; exit code {show.end(2)}"


def add_scene(name, make, expected="plays on with the same hash; reported"):
    @row(GROUP, f"the scene is saved as {name}", expected)
    def play(place):
        show = place.play()
        show.tick(20)
        make(place.scene)
        return place.expect_end(show)


def replaced(path, make):
    path.unlink()
    make(path)


add_scene("an empty folder", lambda p: replaced(p, lambda q: q.mkdir()))
add_scene("a named pipe without a writer", lambda p: replaced(p, os.mkfifo))
add_scene("a link to /dev/zero", lambda p: replaced(p, lambda q: q.symlink_to("/dev/zero")))
add_scene("a link to itself", lambda p: replaced(p, lambda q: q.symlink_to(q)))
add_scene("a file that can't be read", lambda p: p.chmod(0))
add_scene("a megabyte of zeros", lambda p: p.write_bytes(bytes(1 << 20)))
add_scene("half a file", lambda p: p.write_text(SCENE[:len(SCENE) // 2 + 3]))


def add_preset_file(name, make, says):
    @row(GROUP, f"its file of presets is {name}", "plays to its end with the same hash; reported, and the file is unchanged")
    def play(place):
        file = place.show_folder / "scene.presets.json"
        outside = place.write("home/outside.txt", "mine\n")
        make(file, outside)
        show = place.play()
        show.osc().send("/preset/store", "kept")
        seen = place.expect_end(show, says=says)
        expect(outside.read_text() == "mine\n", "a file outside was overwritten")
        expect(file.is_symlink() or not file.is_file(), "it was replaced")
        return seen


add_preset_file("a link to a file outside", lambda f, o: f.symlink_to(o), "presets")
add_preset_file("a folder", lambda f, o: f.mkdir(), "presets")
add_preset_file("a named pipe", lambda f, o: os.mkfifo(f), "presets")
add_preset_file("a link to /dev/zero", lambda f, o: f.symlink_to("/dev/zero"), "presets")


@row(GROUP, "its folder of takes is a link to a folder outside", "nothing is written outside; reported")
def takes_link(place):
    outside = place.folder / "home/outside"
    outside.mkdir()
    place.own(outside)
    (place.show_folder / "takes").symlink_to(outside)
    show = place.play(take=False)
    answer = show.osc().ask("/take/record")
    expect(answer and answer[0] == "/error" and "link" in answer[1][1], f"answered {answer}")
    expect(not list(outside.iterdir()), "a take was written outside")
    return place.expect_end(show, take=False) + f"; answered \"{answer[1][1]}\""


@row(GROUP, "a recovery file that is a named pipe", "plays to its end with the same hash; reported")
def recovery_pipe(place):
    expect(place.play(ticks=5, take=False).end() == 0, "no first run")
    folder = place.folder / "home/state/limber/recovery"
    show = place.play(ticks=None, take=False)
    client = show.osc()
    client.send("/physics/sim/gravity", 0.0, 0.0, -1.0)
    until("a recovery file", lambda: [f for f in folder.iterdir() if f.stat().st_size > 0])
    show.end(9)
    for file in folder.iterdir():
        file.unlink()
        for name in (file, file.with_suffix(".lost")):
            if not name.exists():
                os.mkfifo(name)
                place.own(name)
    return place.expect_end(place.play(take=False), take=False)


@row(GROUP, "two programs play one show", "the second reports it, and writes neither presets nor recovery files")
def two(place):
    first = place.play(ticks=None, take=False)
    first.tick(5)
    second = place.play()
    second.wait_for("another")
    seen = place.expect_end(second, says="another")
    expect(first.end(2) == 0, f"the first ended with {first.code}")
    return seen


@row(GROUP, "killed (SIGKILL), then started again", "the take replays; the start offers the lost values")
def killed(place):
    show = place.play(ticks=None)
    show.osc().send("/physics/sim/gravity", 0.0, 0.0, -1.0)
    folder = place.folder / "home/state/limber/recovery"
    until("a recovery file", lambda: folder.exists() and [f for f in folder.iterdir() if f.stat().st_size > 0])
    show.tick(60)
    show.end(9)
    done = place.run("--replay", place.folder / "tmp/show.take", "--fast", "--headless")
    expect(done.code == 0, f"replay: {done.err[-300:]}")
    return place.expect_end(place.play(take=False), take=False, says="--recover")


@row(GROUP, "a console socket left by a crashed program", "plays with its own console")
def stale_socket(place):
    stale = socket.socket(socket.AF_UNIX)
    stale.bind(f"{place.folder}/run/limber-1.sock")
    stale.close()
    place.own(pathlib.Path(f"{place.folder}/run/limber-1.sock"))
    show = place.play()
    show.tick(10)
    return place.expect_end(show)
