"""Checks with a Slurm of one node: munged, slurmctld and slurmd of the user who runs them."""

import os
import re
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

from jobs import LIMIT, Bench, LeftOut, SWEEP, expect, wait_until

PAGE = Path(__file__).parents[2] / "docs/howto/clusters.md"
PROGRAMS = ["munged", "slurmctld", "slurmd", "srun", "sbatch", "scancel", "sinfo"]
CONFIGURATION = """ClusterName=limber
SlurmctldHost={host}({address})
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.sock
CredType=cred/munge
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
KillWait=5
MpiDefault=none
NodeName={host} NodeAddr={address} CPUs=4
PartitionName=all Nodes={host} Default=YES
"""


def batch_script():
    """Returns the script of the page on clusters."""
    found = re.search(r"```bash limber\.sbatch\n(.*?)```", PAGE.read_text(), re.S)
    expect(found, f"{PAGE} has no limber.sbatch")
    return found.group(1)


class Slurm:
    def __init__(self, program, address):
        self.bench = Bench(program)
        self.address = address
        self.folder = Path(os.environ["TMPDIR"]) / "slurm"
        self.started = []

    def start(self, name, *words):
        """Starts a service in the foreground."""
        log = open(self.folder / f"{name}.out", "wb")
        process = subprocess.Popen([shutil.which(name), *words], stdin=subprocess.DEVNULL, stdout=log, stderr=log)
        self.started.append(process)
        return process

    def output(self, *words):
        result = subprocess.run(words, cwd=self.bench.folder, capture_output=True, text=True, timeout=LIMIT)
        return result.stdout + result.stderr

    def open(self):
        os.environ["PATH"] += ":/usr/sbin:/sbin"
        missing = [name for name in PROGRAMS if shutil.which(name) is None]
        if missing:
            raise LeftOut(f"{', '.join(missing)} not found")
        for name in "state", "spool":
            (self.folder / name).mkdir(parents=True, exist_ok=True)
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(1024))
        key.chmod(0o600)
        user = subprocess.run(["id", "-un"], capture_output=True, text=True).stdout.strip()
        values = {"host": socket.gethostname().split(".")[0], "address": self.address, "user": user,
                  "folder": self.folder}
        (self.folder / "slurm.conf").write_text(CONFIGURATION.format(**values))
        (self.folder / "cgroup.conf").write_text("")
        os.environ["SLURM_CONF"] = str(self.folder / "slurm.conf")
        self.start("munged", "--foreground", f"--key-file={key}", f"--socket={self.folder}/munge.sock",
                   f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                   f"--seed-file={self.folder}/munged.seed")
        wait_until(lambda: self.ready((self.folder / "munge.sock").exists()), "the start of munged")
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        end = time.monotonic() + 60
        while "idle" not in self.output("sinfo", "--noheader", "--format=%T"):
            self.ready(True)
            if time.monotonic() > end:
                raise LeftOut(f"slurmd is not ready: {self.logs()}")
            time.sleep(0.2)

    def ready(self, condition):
        """Returns the condition. Reports a service that has ended."""
        for process in self.started:
            if process.poll() is not None:
                raise LeftOut(f"{Path(process.args[0]).name} can't start here: {self.logs()}")
        return condition

    def logs(self):
        lines = []
        for log in [*self.folder.glob("*.out"), *self.folder.glob("*.log")]:
            lines += [f"{log.name}: {line}" for line in log.read_text(errors="replace").splitlines()[-2:]]
        return "; ".join(lines)

    def close(self):
        for process in reversed(self.started):
            process.terminate()
        for process in self.started:
            try:
                process.wait(30)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGKILL)

    def batch(self, *words, mpi="pmix", tasks=3):
        """Runs the script of the documentation; returns its output."""
        (self.bench.folder / "limber.sbatch").write_text(batch_script())
        environment = f"--export=ALL,LIMBER_MPI={mpi}"
        command = ["sbatch", "--wait", f"--ntasks={tasks}", environment, "--output=job.out", "limber.sbatch", *words]
        said = self.output(*command)
        out = self.bench.folder / "job.out"
        expect(out.exists(), f"the job has no output: {said}; {self.logs()}")
        return out.read_text()

    def run(self):
        """The batch script of the documentation gives the local table, with both MPIs, and continues after a stop."""
        table = self.bench.table
        try:
            self.open()
            os.environ["PATH"] = f"{Path(self.bench.program).parent}:{os.environ['PATH']}"
            done = []
            for mpi, implementation in ("pmix", "openmpi"), ("pmi2", "mpich"):
                if not (Path(self.bench.program).parent / f"limber-mpi-{implementation}.so").exists():
                    continue
                out = self.bench.folder / f"{mpi}.csv"
                said = self.batch(*SWEEP, "--out", out.name, "--overwrite", mpi=mpi)
                expect(out.exists(), f"no table: {said}")
                expect(out.read_bytes() == table, f"the table of Slurm with {mpi} differs: {said}")
                done.append(mpi)
            if not done:
                raise LeftOut("no MPI is installed")
            self.stopped(table, done[0])
            said = self.batch(*SWEEP, "--out", "none.csv", mpi="none")
            expect("srun started 3 tasks without MPI" in said, said)
            expect(not (self.bench.folder / "none.csv").exists(), "tasks without MPI have written the table")
            return f": {', '.join(done)}"
        finally:
            self.close()

    def stopped(self, table, mpi):
        """A canceled job keeps its rows, and the same script with --resume continues it."""
        out = self.bench.folder / "stopped.csv"
        out.unlink(missing_ok=True)
        said = self.output("sbatch", "--parsable", "--ntasks=2", f"--export=ALL,LIMBER_MPI={mpi}",
                           "--output=stopped.out", "limber.sbatch", *SWEEP, "--out", out.name)
        job = said.split()[0]
        wait_until(lambda: out.exists() and out.read_bytes().count(b"\n") > 5, "a row of a job")
        self.output("scancel", job)
        wait_until(lambda: job not in self.output("squeue", "--noheader", "--format=%i").split(), "the end of the job")
        kept = out.read_bytes().count(b"\n")
        expect(5 < kept < 121, f"the job was not stopped in time: {kept} rows")
        said = self.batch(*SWEEP, "--out", out.name, "--resume", mpi=mpi)
        expect(out.read_bytes() == table, f"the continued table differs: {said}")


def checks(program, address):
    slurm = Slurm(program, address)
    yield "slurm", slurm.run
