"""Fuzz scene files: each is checked and planned, some are built in Blender; a crash or a hang is a finding.

    .venv/bin/python tests/system/fuzz/scenes.py [--cases 20000] [--builds 300] [--jobs 2] [--seed 0]

A scene that is neither built nor refused in one polite line is left in build/fuzz/findings; exit status 1.
"""

import argparse
import contextlib
import json
import random
import select
import subprocess
import sys
import tempfile
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


class Child:
    """A process with Blender in it that tries scenes, and is made again when one ends it."""

    def __init__(self, folder):
        self.folder, self.process = folder, None

    def tried(self, text, build):
        """The stage that a scene came to, the line that refused it, and what is wrong with that."""
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
    from firetwin.jobs import setting
    from firetwin.scene.smoke import bake

    def build(shot):
        if shot.settings.smoke.enabled:
            bake.bake(shot)
        setting.build_scene(shot, lambda *_: None, lambda _: None)

    os.chdir(folder)
    for asked in sys.stdin:
        stage, line = scene_fuzz.outcome(folder / "scene.toml", build if int(asked) else None)
        print(json.dumps([stage, line, polite.rude(line)]), file=channel, flush=True)
    os._exit(0)


def work(cases, builds, seed):
    """Try so many scenes; how many came to which stage, and the findings."""
    ends, findings, chance = Counter(), {}, random.Random(seed)
    with tempfile.TemporaryDirectory() as folder:
        child = Child(scene_fuzz.whole(Path(folder)))

        @hypothesis.seed(seed)
        @hypothesis.settings(
            max_examples=cases,
            database=None,
            deadline=None,
            phases=[hypothesis.Phase.generate],
            suppress_health_check=list(hypothesis.HealthCheck),
        )
        @hypothesis.given(scene_fuzz.scenes())
        def one(text):
            nonlocal builds
            build = builds > 0 and chance.random() < 0.1
            stage, line, wrong = child.tried(text, build)
            builds -= stage in ("build", "end")
            ends[f"{stage}: {'refused' if line else wrong or 'done'}"] += 1
            if wrong:
                findings.setdefault((stage, wrong, line[:60]), (text, line))

        with contextlib.suppress(hypothesis.errors.Unsatisfiable):
            one()
    return ends, findings


def main():
    """Share the scenes out, and tell."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("cases", 20_000), ("builds", 300), ("jobs", 2), ("seed", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("--child", type=Path, help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.child:
        serve(asked.child)
    share = range(asked.jobs)
    with ProcessPoolExecutor(asked.jobs) as pool:
        found = list(
            pool.map(
                work,
                [asked.cases // asked.jobs for _ in share],
                [asked.builds // asked.jobs for _ in share],
                [asked.jobs * asked.seed + job for job in share],
            )
        )
    for end, count in sorted(sum((ends for ends, _ in found), Counter()).items()):
        print(f"fuzz: {count:6} {end}")
    findings = {key: value for _, each in found for key, value in each.items()}
    FINDINGS.mkdir(parents=True, exist_ok=True)
    for number, ((stage, wrong, _), (text, line)) in enumerate(findings.items()):
        path = FINDINGS / f"scene-{asked.seed}-{number}.toml"
        path.write_text(text, encoding="utf-8")
        print(f"fuzz: {path}: {stage}: {wrong} {line[:300]!r}")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main())
