"""Disturb processes that share work at random; at the end every file must equal those of undisturbed work.

    .venv/bin/python tests/system/chaos/chaos.py [--minutes 5] [--seed N] [--keep FOLDER]

Jobs: a render, the tasks of a farm, a render with tiles of a server, an export, a delivery, a watch of a
model, a data set and a storyboard, each by two processes, and a third that watches. Faults: SIGKILL of a
process with or without its children, SIGSTOP, a full disk, a read-only disk, clocks that jump by hours, lost
file locks, and a process of another version with the same cache. A process may end with a message, and is
started again. A finding is a traceback, a crash, a process that does not end after the faults, or a file
that differs. Exit status 1 if there are findings. The disk is disturbed if this program may mount one (as
root, or in a user namespace).
"""

import argparse
import contextlib
import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "helpers"))

import disk
import firetwin
import shared_jobs
from process import Process, run
from small_scene import write_run

FAULTS = 12  # of a round
PAUSE = (0.02, 0.15)  # between two faults, of the duration of an undisturbed render
STOPPED = (0.5, 20.0)  # s; leases expire after 16
BROKEN = (0.05, 0.3)  # of that duration: a full or read-only disk
OTHER = {
    "smoke/atmosphere.py": "WIND = 0.5\n",
    "render/engine.py": """
_cycles_before = _cycles
def _cycles(settings, scene):
    _cycles_before(settings, scene)
    scene.cycles.seed += 1
""",
}
"""Code at the end of modules of the other version: its smoke and its pictures differ."""
MACHINES = ("sound", "sound", "clock", "locks", "version")
DISTURBANCES = ("kill", "kill", "kill parent", "stop", "full disk", "read-only disk", "watch")


class Round:
    """One job by two processes, with faults.

    Parameters
    ----------
    tools
        Folder made by `prepare`.
    small
        The disk that `place` is on; None if it must not be disturbed.
    """

    def __init__(
        self, chance: random.Random, job: shared_jobs.Job, place: Path, tools: Path, small: disk.Disk | None
    ):
        self.chance, self.job, self.place, self.tools, self.small = chance, job, place, tools, small
        self.faults: Counter[str] = Counter()
        self.findings: list[str] = []
        self.processes: list[Process] = []

    def run(self) -> int:
        """Disturb the job, let it end, and compare its files; returns how many were compared."""
        self.job.prepare(self.place)
        try:
            if self.job.before:
                run(self.job.before, self.place)
            self._disturb_all()
            for process in self.processes:
                self._end(process)
            run(self.job.work, self.place)
            if self.job.after:
                run(self.job.after, self.place)
            return self._compare()
        except (RuntimeError, OSError, ValueError) as error:
            self.findings.append(str(error))
            return 0
        finally:
            for process in self.processes:
                process.kill()

    def _disturb_all(self) -> None:
        self.processes = [self._start(), self._start()]
        for _ in range(FAULTS):
            time.sleep(self.chance.uniform(*PAUSE) * self.job.seconds)
            self._disturb(self.chance.choice(DISTURBANCES))
            if all(process.status == 0 for process in self.processes):
                return
            for number, process in enumerate(self.processes):
                if process.status:
                    self._end(process)
                    self.processes[number] = self._start()

    def _start(self) -> Process:
        """Start a process on a machine that may be faulty."""
        machine = self.chance.choice([each for each in MACHINES if self.job.mixed or each != "version"])
        self.faults[machine] += machine != "sound"
        self.faults["processes"] += 1
        hours = self.chance.choice((-30, -3, 3, 30))
        faulty = {
            "sound": {},
            "clock": {"LD_PRELOAD": self.tools / "faults.so", "CHAOS_CLOCK": hours * 3600},
            "locks": {"LD_PRELOAD": self.tools / "faults.so", "CHAOS_LOCKS": 5},
            "version": {"PYTHONPATH": before_others(self.tools / "other")},
        }
        return Process(self.job.work, self.place, **faulty[machine])

    def _disturb(self, fault: str) -> None:
        process = self.chance.choice(self.processes)
        seconds = self.chance.uniform(*BROKEN) * self.job.seconds
        if fault in ("kill", "kill parent"):
            if happened := process.status is None:
                process.kill(alone=fault == "kill parent")
        elif fault == "stop":
            if happened := process.status is None:
                process.send(signal.SIGSTOP)
                time.sleep(self.chance.uniform(*STOPPED))
                process.send(signal.SIGCONT)
        elif fault == "watch":
            run(self.job.watch, self.place)
            happened = True
        else:
            broken = self.small and (self.small.fill if fault == "full disk" else self.small.write_protect)
            happened = bool(broken and broken(seconds))
        self.faults[fault] += happened

    def _end(self, process: Process) -> None:
        """Wait for a process, and note what must not happen."""
        if not process.wait():
            self.findings.append(f"{process.arguments} does not end: {process.messages()[-4000:]}")
        elif found := process.fault():
            self.findings.append(found)

    def _compare(self) -> int:
        found, wanted = self.job.contents(self.place / "out"), self.job.wanted
        names = found.keys() | wanted.keys()
        different = sorted(name for name in names if found.get(name) != wanted.get(name))
        if different:
            self.findings.append(f"different files: {', '.join(different)}")
        return len(names)


def before_others(folder: Path) -> str:
    """Return a PYTHONPATH that begins with this folder."""
    return os.pathsep.join(filter(None, (str(folder), os.environ.get("PYTHONPATH"))))


def prepare(tools: Path) -> None:
    """Build the faults, and copy this version and the other version of the package."""
    tools.mkdir()
    source, library = Path(__file__).with_name("faults.c"), tools / "faults.so"
    options = ["-shared", "-fPIC", "-O1", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    subprocess.run(["cc", *options, "-o", library, source, "-ldl"], check=True)
    ignored = shutil.ignore_patterns("__pycache__")
    for copy in (tools / "this" / "firetwin", tools / "other" / "firetwin"):  # nobody edits these meanwhile
        for place in map(Path, firetwin.__path__):
            if (place / "scene").is_dir():
                shutil.copytree(place, copy, ignore=ignored)
            if (place / "data").is_dir():
                shutil.copytree(place / "data", copy / "data", ignore=ignored, dirs_exist_ok=True)
    for module, change in OTHER.items():
        with (copy / module).open("a") as file:
            file.write(change)


def disturb(root: Path, seconds: float, seed: int, mounts: bool) -> int:
    """Disturb all jobs in turn, from one by chance, print what happened, and count the findings."""
    write_run(root / "run")
    prepare(root / "tools")
    os.environ["PYTHONPATH"] = before_others(root / "tools" / "this")
    jobs = shared_jobs.all_jobs(root / "run", root)
    random.Random(seed).shuffle(jobs)
    small = disk.Disk(root / "disk") if mounts else None
    faults: Counter[str] = Counter()
    findings = compared = rounds = 0
    begun = time.monotonic()
    while not rounds or time.monotonic() - begun < seconds:
        job, place = jobs[rounds % len(jobs)], root / "disk" / f"round-{rounds}"
        disturbed = Round(random.Random(f"{seed}.{rounds}"), job, place, root / "tools", small)
        compared += disturbed.run()
        faults += disturbed.faults
        findings += len(disturbed.findings)
        hours = (time.monotonic() - begun) / 3600.0
        print(f"round {rounds}, {job.name}, minute {60.0 * hours:.1f}: {list_counts(disturbed.faults)}")
        print(*(f"FOUND {each}\n" for each in disturbed.findings), sep="", end="", flush=True)
        shutil.rmtree(place, ignore_errors=True)
        rounds += 1
    if small:
        small.close()
    else:
        print("disks were not disturbed: this program may not mount one")
    print(f"{hours:.2f} hours, {rounds} rounds, {compared} files compared, {findings} findings")
    print(list_counts(faults))
    return findings


def list_counts(counts: Counter[str]) -> str:
    """Format counts: ``2 clock, 5 kill``."""
    return ", ".join(f"{number} {name}" for name, number in sorted(counts.items()) if number)


def main() -> int:
    """Parse the arguments and disturb; returns the exit status."""
    plain = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=plain)
    parser.add_argument("--minutes", type=float, default=5.0, help="duration of the faults")
    parser.add_argument("--seed", type=int, default=int.from_bytes(os.urandom(3)))
    parser.add_argument("--keep", type=Path, help="new folder for the jobs, not removed at the end")
    chosen = parser.parse_args()
    mounts = disk.own_mounts()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))
    print(f"seed {chosen.seed}", flush=True)
    with contextlib.ExitStack() as stack:
        if chosen.keep:
            root = chosen.keep.resolve()
        else:
            temporary = tempfile.TemporaryDirectory(prefix="firetwin-chaos-", ignore_cleanup_errors=True)
            root = Path(stack.enter_context(temporary))
        (root / "run").mkdir(parents=True)
        return bool(disturb(root, 60.0 * chosen.minutes, chosen.seed, mounts))


if __name__ == "__main__":
    sys.exit(main())
