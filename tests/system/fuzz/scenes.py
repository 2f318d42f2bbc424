"""Fuzz scene files: each is checked and planned, some are built in Blender; a crash or a hang is a finding.

    .venv/bin/python tests/system/fuzz/scenes.py [--cases 20000] [--builds 300] [--jobs 2] [--seconds 0]

A scene that is neither built nor refused in one polite line is left in build/fuzz/findings; exit status 1.
After so many seconds (0: never) no further scene is tried.
"""

import argparse
import contextlib
import json
import random
import select
import subprocess
import sys
import tempfile
import time
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parents[3]
sys.path.insert(0, str(ROOT / "tests/helpers"))

import hypothesis  # noqa: E402
import polite  # noqa: E402
import scene_fuzz  # noqa: E402

FINDINGS = ROOT / "build/fuzz/findings"
LIMIT = 120.0  # s for a scene
AT_ONCE = 250  # scenes, between two looks at the clock
SETTINGS = hypothesis.settings(
    database=None,
    deadline=None,
    phases=[hypothesis.Phase.generate],
    suppress_health_check=list(hypothesis.HealthCheck),
)


class Child:
    """A process with Blender in it that tries scenes, and is made again when one ends it."""

    def __init__(self, folder):
        self.folder, self.process = folder, None

    def tried(self, text, build):
        """The last stage of a scene, the line of its error, and the fault of this line."""
        (self.folder / "scene.toml").write_text(text, encoding="utf-8")
        if self.process is None:
            command = [sys.executable, __file__, "--child", self.folder]
            pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
            self.process = subprocess.Popen(command, text=True, **pipes)
        self.process.stdin.write(f"{int(build)}\n")
        self.process.stdin.flush()
        ready, _, _ = select.select([self.process.stdout], [], [], LIMIT)
        answer = self.process.stdout.readline() if ready else ""
        if answer:
            return json.loads(answer)
        self.process.kill()
        code, self.process = self.process.wait(), None
        return ["end", "", f"ended with {code}" if ready else f"no answer in {LIMIT:.0f} s"]


def serve(folder):
    """The child's side: a line for each scene."""
    import os

    channel = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    import bpy  # noqa: F401 (before the core)
    from firetwin.jobs import worker_scene
    from firetwin.smoke import bake

    def build(shot):
        if shot.settings.smoke.enabled:
            bake.bake(shot)
        worker_scene.build_scene(shot, lambda *_: None, lambda _: None)

    os.chdir(folder)
    for asked in sys.stdin:
        stage, line = scene_fuzz.outcome(folder / "scene.toml", build if int(asked) else None)
        print(json.dumps([stage, line, polite.rude(line)]), file=channel, flush=True)
    os._exit(0)


def work(cases, builds, seed, seconds):
    """Try so many scenes; how many came to which stage, and how many kinds of findings there are."""
    ends, findings, chance = Counter(), set(), random.Random(seed)
    over = time.monotonic() + (seconds or 1e9)
    with tempfile.TemporaryDirectory() as folder:
        child = Child(scene_fuzz.whole(Path(folder)))

        def one(text):
            nonlocal builds
            build = builds > 0 and chance.random() < 0.1
            stage, line, wrong = child.tried(text, build)
            builds -= stage in ("build", "end")
            ends[f"{stage}: {'refused' if line else wrong or 'done'}"] += 1
            if wrong and (stage, wrong, line[:60]) not in findings:
                findings.add((stage, wrong, line[:60]))
                path = FINDINGS / f"scene-{seed}-{len(findings)}.toml"
                path.write_text(text, encoding="utf-8")
                print(f"fuzz: {path}: {stage}: {wrong} {line[:300]!r}", flush=True)

        for number in range(0, cases, AT_ONCE):
            if time.monotonic() > over:
                break
            few = hypothesis.settings(SETTINGS, max_examples=min(AT_ONCE, cases - number))
            with contextlib.suppress(hypothesis.errors.Unsatisfiable):
                hypothesis.seed(seed * 1_000_000 + number)(few(hypothesis.given(scene_fuzz.scenes())(one)))()
    return ends, len(findings)


def main():
    """Share the scenes out, and tell."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("cases", 20_000), ("builds", 300), ("jobs", 2), ("seed", 0), ("seconds", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.child:
        serve(asked.child)
    share = range(asked.jobs)
    FINDINGS.mkdir(parents=True, exist_ok=True)
    with ProcessPoolExecutor(asked.jobs) as pool:
        outcomes = list(
            pool.map(
                work,
                [asked.cases // asked.jobs for _ in share],
                [asked.builds // asked.jobs for _ in share],
                [asked.jobs * asked.seed + job for job in share],
                [asked.seconds for _ in share],
            )
        )
    for end, count in sorted(sum((ends for ends, _ in outcomes), Counter()).items()):
        print(f"fuzz: {count:6} {end}")
    return 1 if any(count for _, count in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
