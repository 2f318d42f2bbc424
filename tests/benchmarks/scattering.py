"""What few bounces traced in smoke cost the picture, and what noise does: FLIP and processors' seconds.

    python tests/benchmarks/scattering.py SCENE.toml [--bounces] [--noise] [--frame 1] [--width 256]

Renders one frame of a scene's first camera, whose smoke is baked if it is not yet; examples/views has scenes
(`firetwin bench` does so for a plume of its own). With --bounces, which is what it does by itself, each
number of them at 24 samples, as the material has it or with nearly even scattering, beside 32 bounces of
light that goes forwards; with --noise, ways to sample and denoise at 3 and 4 samples beside 64 samples.
FLIP (Andersson et al. 2020, doi 10.1145/3406183) and the root of the mean square of the picture's colours,
both from 0 to 1.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import bpy
import flip_evaluator
import numpy as np
from firetwin.jobs import worker_scene
from firetwin.render import layers
from firetwin.scene.smoke import flow_material
from firetwin.shot.settings import scene_file
from firetwin.shot.shot import Shot
from firetwin.smoke import bake
from firetwin_core import run
from numpy.typing import NDArray

Array = NDArray[np.float32]


class Bench:
    """One frame that is rendered again and again."""

    def __init__(self, scene: Path, frame: int, width: int, folder: Path) -> None:
        settings = scene_file.read(scene)
        size = width, round(width * 9 / 32) * 2
        settings = replace(
            settings,
            smoke=replace(settings.smoke, lighting="traced"),
            render=replace(settings.render, resolution=size, passes=("rgb",)),
        )
        self.shot = Shot(settings, run.open(settings.run)).of(settings.cameras[0].name)
        self.scene = worker_scene.build_scene(self.shot, lambda *_: None, lambda _: None).scene
        self.scene.camera = next(thing for thing in self.scene.objects if thing.type == "CAMERA")
        bake.bake(self.shot, frames=[frame])
        layers.select(self.scene, ["rgb"])
        self.scene.frame_set(frame)
        self.folder, self.count = folder, 0
        nodes = bpy.data.materials["Firetwin Smoke"].node_tree.nodes
        shown = next(node for node in nodes if node.type == "GROUP")
        self.light, self.scatter = shown.inputs["Light Density"], [shown.inputs["Anisotropy"]]
        self.usual = self.light.default_value, self.scatter[0].default_value

    def picture(self, samples: int, denoise: bool, tweak: Callable[[Bench], None]) -> tuple[Array, float]:
        """Colours (height, width, 3), 0 to 1, and the processors' seconds that they took."""
        cycles = self.scene.cycles
        cycles.samples, cycles.use_denoising = samples, denoise
        for layer in self.scene.view_layers:
            layer.cycles.use_denoising = denoise
        tweak(self)
        self.count += 1
        path = self.folder / f"{self.count:02d}.png"
        self.scene.render.filepath = str(path)
        begin = time.process_time()
        bpy.ops.render.render(write_still=True, scene=self.scene.name)
        seconds = time.process_time() - begin
        image = bpy.data.images.load(str(path))
        image.colorspace_settings.name = "Non-Color"
        pixels = np.array(image.pixels, np.float32).reshape(*reversed(image.size[:]), 4)
        bpy.data.images.remove(image)
        return np.ascontiguousarray(pixels[..., :3]), seconds


def bounces(
    count: int, extinction: float | None = None, forward: float | None = None
) -> Callable[[Bench], None]:
    """Scattering inside smoke so often; light's extinction over the whole, and anisotropy."""

    def tweak(bench: Bench) -> None:
        bench.scene.cycles.volume_bounces = count
        bench.scene.cycles.max_bounces = max(4, count)
        bench.light.default_value = bench.usual[0] if extinction is None else extinction
        for socket in bench.scatter:
            socket.default_value = bench.usual[1] if forward is None else forward

    return tweak


def sampled(**settings: object) -> Callable[[Bench], None]:
    """Cycles with these settings, `step` times the step through smoke, `way` through it."""

    def tweak(bench: Bench) -> None:
        usual = {
            "sampling_pattern": "TABULATED_SOBOL",
            "denoising_input_passes": "RGB_ALBEDO_NORMAL",
            "denoising_prefilter": "ACCURATE",
            "sample_clamp_direct": 0.0,
            "volume_bounces": 1,
            "volume_step_rate": 1.0,
            "way": "DISTANCE",
        }
        for name, value in (usual | settings).items():
            if name == "way":
                bpy.data.materials["Firetwin Smoke"].cycles.volume_sampling = value
            else:
                setattr(bench.scene.cycles, name, value)

    return tweak


BOUNCES = {f"{count} bounces": bounces(count) for count in (0, 1, 2)} | {
    f"{count} bounces, as if even": bounces(count, 1.0, 0.15) for count in (0, 1, 2, 4)
}
NOISE = {
    "as it is": sampled(),
    "blue noise": sampled(sampling_pattern="BLUE_NOISE"),
    "guide: colour alone": sampled(denoising_input_passes="RGB"),
    "guide: albedo": sampled(denoising_input_passes="RGB_ALBEDO"),
    "prefilter fast": sampled(denoising_prefilter="FAST"),
    "no prefilter": sampled(denoising_prefilter="NONE"),
    "equiangular": sampled(way="EQUIANGULAR"),
    "both ways": sampled(way="MULTIPLE_IMPORTANCE"),
    "steps of half": sampled(volume_step_rate=0.5),
    "steps of twice": sampled(volume_step_rate=2.0),
    "no bounces": sampled(volume_bounces=0),
    "direct light clamped at 2": sampled(sample_clamp_direct=2.0),
}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("scene", type=Path)
    parser.add_argument("--frame", type=int, default=1)
    parser.add_argument("--width", type=int, default=256)
    parser.add_argument("--bounces", action="store_true", help="compare bounces, not noise")
    parser.add_argument("--noise", action="store_true", help="compare noise and denoisers, not bounces")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(options.scene, options.frame, options.width, Path(folder))
        if options.bounces or not options.noise:
            truth, seconds = bench.picture(24, True, bounces(32, 1.0, flow_material.FORWARD))
            compare(bench, "32 bounces", truth, seconds, BOUNCES, 24)
        if options.noise:
            truth, seconds = bench.picture(64, False, sampled())
            for samples in (3, 4):
                compare(bench, "64 samples", truth, seconds, NOISE, samples)


def compare(
    bench: Bench,
    name: str,
    truth: Array,
    seconds: float,
    ways: dict[str, Callable[[Bench], None]],
    samples: int,
) -> None:
    """Print what each way costs and misses of the truth."""
    print(f"{'samples, way':28} {'FLIP':>8} {'rms':>8} {'cpu-s':>8}\n{name:28} {'':8} {'':8} {seconds:8.1f}")
    for way, tweak in ways.items():
        found, seconds = bench.picture(samples, True, tweak)
        flip = flip_evaluator.evaluate(truth, found, "LDR")[1]
        error = np.sqrt(((found - truth) ** 2).mean())
        print(f"{samples:2} {way:25} {flip:8.4f} {error:8.4f} {seconds:8.1f}", flush=True)


if __name__ == "__main__":
    main()
