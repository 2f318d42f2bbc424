"""How fast a flow of the example's size is solved; `firetwin bench` has a smaller step beside NumPy's.

    .venv/bin/python tests/benchmarks/flow.py [--threads 2] [--steps 6] [--json]

A box as the example's (192 x 192 x 44 cells of 200 m) and a nest in it (180 x 180 x 56 of 67 m), both under
a fire of 40 GW, with water vapour. Prints cells x steps per second of wall time, the processors' seconds of a
step, which say what an idle machine would take, and the memory that the process has held at most.
"""

from __future__ import annotations

import argparse
import json
import resource
import time

import firetwin_core
import numpy as np
from firetwin_core import flow
from numpy.typing import NDArray


def levels(lowest: float, highest: float, count: int) -> NDArray[np.float64]:
    """Heights of `count` levels whose depth grows evenly."""
    k = np.arange(count + 1)
    return lowest * k + 0.5 * (highest - lowest) / count * k * k


def example() -> tuple[flow.Solver, flow.Solver]:
    """The box and its nest, five minutes after the fire began."""
    x = np.arange(192)
    ground = 150 * np.sin(x / 9)[:, None] * np.cos(x / 7)
    heights = [0.0, 3300.0, 9000.0]
    box = flow.Solver(
        levels(60, 270, 44),
        (192, 192),
        200.0,
        heights,
        [302.0, 303.0, 329.0],
        [[8.0, 3.0], [12.0, 5.0], [15.0, 7.0]],
        water=[0.008, 0.005, 0.0002],
        pressure=9e4,
        ground=ground,
        gust_strength=0.6,
    )
    rng = np.random.default_rng(0)
    place = rng.uniform([12000, 14000], [16000, 15000], (4000, 2))
    fire = place, np.full(4000, 1e7), np.full(4000, 0.015)
    box.set_sources(*fire)
    box.step(10.0, 30)
    finer = levels(36, 222, 56)
    nest = box.nest(
        finer * min(1.0, box.levels[-1] / finer[-1]), (180, 180), 200 / 3, (9000.0, 9000.0), gust_strength=0.6
    )
    nest.set_sources(*fire)
    return box, nest


def measured(steps: int) -> dict[str, float]:
    """All numbers."""
    box, nest = example()
    seconds = {"box": 0.0, "nest": 0.0}
    work = {"box": 0.0, "nest": 0.0}
    for _ in range(steps):
        for name, solver, dt, count in (("box", box, 10.0, 1), ("nest", nest, 10.0 / 3, 3)):
            start, processors = time.perf_counter(), time.process_time()
            solver.step(dt, count)
            seconds[name] += (time.perf_counter() - start) / (count * steps)
            work[name] += (time.process_time() - processors) / (count * steps)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return {
        "box_s_per_step": seconds["box"],
        "box_cells_steps_per_s": np.prod(box.shape) / seconds["box"],
        "nest_s_per_step": seconds["nest"],
        "nest_cells_steps_per_s": np.prod(nest.shape) / seconds["nest"],
        "box_processor_s_per_step": work["box"],
        "nest_processor_s_per_step": work["nest"],
        "substeps": box.substeps,
        "memory_mb": memory,
        "example_s": 390 * seconds["box"] + 180 * seconds["nest"],
        "example_processor_s": 390 * work["box"] + 180 * work["nest"],
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--threads", type=int, default=0)
    parser.add_argument("--steps", type=int, default=6)
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    firetwin_core.set_threads(options.threads)
    result = {key: float(value) for key, value in measured(options.steps).items()}
    if options.json:
        print(json.dumps(result))
        return
    for key, value in result.items():
        print(f"{key:28} {value:14,.3f}")


if __name__ == "__main__":
    main()
