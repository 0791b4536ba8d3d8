"""Checks with mpirun of Open MPI and MPICH."""

import functools
import json
import os
import random
import re
import shutil
import signal
import subprocess
import time
from pathlib import Path

LIMIT = 300  # s, which only a failed check reaches
SCENE = """
params { { "push", 1, min = 0, max = 4 }, { "mass", 1, min = 0.5, max = 2, rerun = true } }
sim.gravity = vec3()
local part = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 0.1), { mass = params.mass })
sim:on_start(function() part:apply_impulse(vec3(params.push, 0, 0)) end)
result("distance", function() return part.position.x end, { min = 0, max = 4, cells = 30 })
result("noise", function() return rng:uniform() + part.position.x end)
"""
SWEEP = ["sweep", "push.lua", "--design", "latin", "--samples", "60", "--seeds", "1:2", "--duration", "0.2"]
GENERATIONS = 60
EVOLVE = ["evolve", "push.lua", "--maximize", "noise", "--descriptor", "distance", "--duration", "0.1",
          "--population", "8"]
FILES = ["elites.csv", "elites.presets.json", "state.json"]
CHILD = b"--evaluations-from-input"


class Failure(Exception):
    pass


class LeftOut(Exception):
    pass


def expect(condition, text):
    if not condition:
        raise Failure(text)


class Bench:
    """A folder with the scene, and the results of local processes."""

    def __init__(self, program):
        self.program = program
        self.folder = Path(os.environ["TMPDIR"]) / "jobs"
        self.folder.mkdir(exist_ok=True)
        (self.folder / "push.lua").write_text(SCENE)

    def start(self, words):
        return subprocess.Popen(words, cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True)

    def run(self, words, code=0):
        process = self.start(words)
        out, err = process.communicate(timeout=LIMIT)
        expect(process.returncode == code, f"{' '.join(words)} returned {process.returncode}\n{out}{err}")
        return out, err

    def evolve(self, out, *more, generations=GENERATIONS):
        return [self.program, *EVOLVE, "--generations", str(generations), "--out", out, *more]

    @functools.cached_property
    def table(self):
        """The table of local processes, which is the same for any number of them."""
        for count in "1", "2":
            self.run([self.program, *SWEEP, "--jobs", count, "--out", f"local{count}.csv", "--overwrite"])
        table = (self.folder / "local1.csv").read_bytes()
        expect(table == (self.folder / "local2.csv").read_bytes(), "the tables of 1 and 2 processes differ")
        return table

    @functools.cached_property
    def archive(self):
        for count in "1", "2":
            self.run(self.evolve(f"whole{count}", "--jobs", count, "--overwrite"))
        expect(self.files("whole1") == self.files("whole2"), "the archives of 1 and 2 processes differ")
        return self.files("whole1")

    def files(self, name):
        return [(self.folder / name / file).read_bytes() for file in FILES]

    def expect_archive(self, name):
        for file, mine, local in zip(FILES, self.files(name), self.archive):
            expect(mine == local, f"{name}/{file} differs from that of local processes")

    def generation(self, name):
        try:
            return json.loads(json.loads((self.folder / name / "state.json").read_text())["state"])["generation"]
        except FileNotFoundError:
            return 0


def descendants(pid):
    """Returns the processes that `pid` and its children have started: pairs of id and arguments."""
    children = {}
    for entry in Path("/proc").iterdir():
        try:
            if entry.name.isdigit():
                parent = int((entry / "stat").read_text().rsplit(")", 1)[1].split()[1])
                children.setdefault(parent, []).append((int(entry.name), (entry / "cmdline").read_bytes().split(b"\0")))
        except OSError:
            pass  # it has ended
    found, new = [], [pid]
    while new:
        next_ones = [child for parent in new for child in children.get(parent, [])]
        found += next_ones
        new = [child for child, _ in next_ones]
    return found


def ranks_of(process, program):
    return [pid for pid, words in descendants(process.pid)
            if words[0] == program.encode() and CHILD not in words]


def children_of(process):
    return [pid for pid, words in descendants(process.pid) if CHILD in words]


def kill(pid):
    try:
        os.kill(pid, signal.SIGKILL)
        return True
    except ProcessLookupError:
        return False


def wait_until(condition, what):
    end = time.monotonic() + LIMIT
    while not condition():
        expect(time.monotonic() < end, f"{what} did not happen within {LIMIT} s")
        time.sleep(0.001)


class Job:
    """mpirun of one implementation."""

    def __init__(self, bench, implementation):
        self.bench = bench
        self.implementation = implementation
        self.random = random.Random(1)
        self.launcher = shutil.which(f"mpirun.{implementation}")
        self.module = self.module_of(implementation)

    def module_of(self, implementation):
        """The module beside the program, else that of an installed one."""
        folder, name = Path(self.bench.program).parent, f"limber-mpi-{implementation}.so"
        return folder / name if (folder / name).exists() else folder.parent / "lib/limber" / name

    def words(self, count, words):
        if self.launcher is None or not self.module.exists():
            raise LeftOut(f"{self.implementation} or its headers are not installed")
        more = ["--oversubscribe"] if self.implementation == "openmpi" else []
        return [self.launcher, *more, "-n", str(count), *words]

    def table(self):
        for count in 1, 4:
            out = f"{self.implementation}{count}.csv"
            words = [self.bench.program, *SWEEP, "--out", out, "--overwrite"]
            _, err = self.bench.run(self.words(count, words))
            expect((self.bench.folder / out).read_bytes() == self.bench.table, f"{out} differs from the local table")
            expect(err.count("120 of 120 evaluations") == 1, f"other ranks than 0 report: {err}")

    def archive(self):
        for count in 1, 4:
            out = f"{self.implementation}{count}"
            self.bench.run(self.words(count, self.bench.evolve(out, "--overwrite")))
            self.bench.expect_archive(out)

    def killed_children(self):
        out, kills = f"{self.implementation}_children", 0
        process = self.bench.start(self.words(4, self.bench.evolve(out, "--overwrite")))
        seen = 0
        while process.poll() is None and kills < 20:
            generation = self.bench.generation(out)
            if generation == seen:
                time.sleep(0.0005)
                continue
            seen = generation
            found = children_of(process)
            kills += bool(found and kill(self.random.choice(found)))
        _, err = process.communicate(timeout=LIMIT)
        expect(process.returncode == 0, f"the search ended with {process.returncode}: {err}")
        expect(kills == 20, f"only {kills} children were killed; the search is too short")
        expect("restarted (reported once)" in err, f"no restart was reported: {err}")
        self.bench.expect_archive(out)
        return f": {kills} killed"

    def killed_ranks(self):
        """Kills a rank, which ends the job, and continues with another number of ranks."""
        out, kills, generation = f"{self.implementation}_ranks", 0, 0
        shutil.rmtree(self.bench.folder / out, ignore_errors=True)
        while kills < 8:
            resume = ["--resume"] if generation else []
            process = self.bench.start(self.words(2 + kills % 3, self.bench.evolve(out, *resume)))
            end = generation + 1 + self.random.randrange(3)
            wait_until(lambda: self.bench.generation(out) >= end or process.poll() is not None, "progress")
            time.sleep(self.random.uniform(0, 0.02))
            expect(process.poll() is None, "the search has too few generations")
            kills += kill(self.random.choice(ranks_of(process, self.bench.program)))
            process.communicate(timeout=LIMIT)
            expect(process.returncode != 0, "the job has not noticed that a rank was killed")
            generation = self.bench.generation(out)
        self.bench.run(self.words(4, self.bench.evolve(out, "--resume")))
        self.bench.expect_archive(out)
        return f": {kills} killed"

    def interrupted(self):
        """Ctrl+C keeps the rows; --resume continues, without MPI as well."""
        for number in signal.SIGINT, signal.SIGTERM:
            out = f"{self.implementation}_stopped.csv"
            table = self.bench.folder / out
            words = [self.bench.program, *SWEEP, "--out", out]
            table.unlink(missing_ok=True)
            process = self.bench.start(self.words(3, words))
            wait_until(lambda: table.exists() and table.read_bytes().count(b"\n") > 5, "a row")
            process.send_signal(number)
            process.communicate(timeout=LIMIT)
            expect(process.returncode != 0, "the job did not end")
            kept = table.read_bytes()
            expect(5 < kept.count(b"\n") < 121, "the table was not interrupted")
            self.bench.run([*words, "--resume"])
            expect(table.read_bytes() == self.bench.table, "the continued table differs")

    def errors(self):
        bench = self.bench
        full = [bench.program, *SWEEP, "--overwrite", "--out", "/dev/full"]
        process = bench.start(self.words(3, full))
        _, err = process.communicate(timeout=LIMIT)
        expect(process.returncode != 0 and "/dev/full can't be written: No space left on device" in err, err)
        _, err = bench.start(self.words(2, [bench.program, "sweep", "none.lua"])).communicate(timeout=LIMIT)
        expect(err.count("'none.lua' not found") == 1, err)
        _, err = bench.start(self.words(2, [bench.program, *SWEEP, "--jobs", "2"])).communicate(timeout=LIMIT)
        expect("--jobs: MPI determines the number of processes" in err, err)
        alone = bench.folder / "alone" / "limber"
        alone.parent.mkdir(exist_ok=True)
        shutil.copy(bench.program, alone)
        _, err = bench.start(self.words(2, [str(alone), *SWEEP, "--out", "alone.csv"])).communicate(timeout=LIMIT)
        expect(re.search(rf"rank [01] on \S+: the module limber-mpi-{self.implementation}.so is not beside", err), err)
        other = "mpich" if self.implementation == "openmpi" else "openmpi"
        if self.module_of(other).exists():
            words = [bench.program, *SWEEP, "--mpi", other, "--out", "alone.csv"]
            _, err = bench.start(self.words(2, words)).communicate(timeout=LIMIT)
            expect(f"the launcher started 2 ranks, but {other} sees 1" in err, err)
        expect(not (bench.folder / "alone.csv").exists(), "a run without MPI has written the table")

    def leaves_nothing(self):
        """Children of killed ranks end as well."""
        def left():
            found = []
            for entry in Path("/proc").iterdir():
                try:
                    inside = entry.name.isdigit() and os.readlink(entry / "cwd").startswith(str(self.bench.folder))
                    found += [entry.name] if inside and CHILD in (entry / "cmdline").read_bytes() else []
                except OSError:
                    pass  # it has ended, or belongs to another user
            return found
        wait_until(lambda: not left(), "the end of the children")


def checks(program):
    bench = Bench(program)
    for implementation in "openmpi", "mpich":
        job = Job(bench, implementation)
        for check in (job.table, job.archive, job.killed_children, job.killed_ranks, job.interrupted, job.errors,
                      job.leaves_nothing):
            yield f"{implementation}_{check.__name__}", check
