"""Samples of a plan without Blender: pictures of one value by the number of the sample."""

import os
import sys
import time
from dataclasses import replace
from pathlib import Path

import labelled
import numpy as np
import plain_samples
from firetwin import leases, written
from firetwin.dataset import files, plan_file, produce, sensor
from firetwin.dataset.run_scene import RunScene
from firetwin.dataset.truth import Truth

PAUSE = float(os.environ.get("FAKE_PAUSE", "0"))


def write(folder, drawn):
    """Write all files of a sample."""
    rendered = plain_samples.plane(plain_samples.looking(-20.0, size=(16, 12)))
    rendered = replace(rendered, rgb=np.full_like(rendered.rgb, drawn.index / 1000.0))
    nothing = np.zeros(rendered.depth.shape, np.uint8)
    seeds = {name: drawn.random_seed(name) for name in ("noise", "thermal noise")}
    sensed = sensor.apply(rendered, sensor.SensorSettings.of(drawn.values), seeds)
    labels = Truth(
        index=drawn.index,
        camera=labelled.camera(drawn.index),
        utc=drawn.utc.isoformat(),
        model_time_s=drawn.time,
        groups={"place": drawn.place, "run": drawn.run, "camera": f"{drawn.run}/{drawn.camera.site}"},
        split=drawn.split,
        draw=drawn.plain(),
    )
    files.write(folder, labels, files.Masks(nothing, nothing, nothing), rendered, sensed)


def make(plan, visit, missing, out, progress, tell):
    """Make samples (`produce.Maker`), and note each in a log next to the data set."""
    for done, drawn in enumerate((each for each in visit.draws if each.index in missing), 1):
        write(out, drawn)
        with (out.parent / "log").open("a") as log:
            log.write(f"{drawn.index}\n")
        time.sleep(PAUSE)
        progress(done, len(missing), produce.SAMPLES)


def log(out):
    """Return the numbers of the samples in the order in which they were made."""
    path = out.parent / "log"
    return [int(line) for line in path.read_text().split()] if path.exists() else []


def content(out):
    """Return the bytes of all files of a data set by their path, without leases and the record of hashes."""
    found = sorted(path for path in out.rglob("*") if path.is_file() and produce.WORK not in path.parts)
    found = [path for path in found if path.name != written.NAME]
    return {path.relative_to(out).as_posix(): path.read_bytes() for path in found}


if __name__ == "__main__":
    leases.HEARTBEAT, leases.PATIENCE = 0.2, 1.5
    RunScene.veil = lambda *_: 0.0  # solve no smoke
    plan, out = plan_file.read(sys.argv[1]), Path(sys.argv[2])
    produce.run(produce.prepare(plan, out), make)
