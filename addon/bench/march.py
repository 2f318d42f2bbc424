"""Ray marching through smoke against a quarter of its step, and a frame's passes against Cycles' volume.

The frame is one time of the sample run with solved smoke: picture, infrared and depth, with all
post-processing. Its error is the mean FLIP of the picture (Andersson et al. 2020) against a reference that
Cycles renders with a quarter of the step, many samples and no denoiser. Each is rendered once.
"""

from __future__ import annotations

import os
import tempfile
from datetime import UTC, datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core import volume
from numpy.typing import NDArray

from ..jobs import worker
from ..progress import MessageCallback, Progress, no_message, silent
from ..shot import sections, settings
from ..shot.cameras.rigs.drone import CameraKey, Drone
from ..shot.light import sky
from ..shot.passes import file_of
from ..shot.shot import Shot
from .harness import OURS, Bench
from .timing import Runner, Stopwatch, Times

SIDE, VOXEL, SIZE = 144, 20.0, (320, 180)  # m
STEPS = {OURS: 0.5, "a quarter of the step": 0.125}
EXACT = "a quarter of the step"
LIMIT = 0.005  # relative
MOST = 1.1  # of the difference of Cycles' volume; the ratio was 0.97 on one machine, 1.04 on another
VOLUME, REFERENCE = "Cycles' volume", "reference"
FRAME, SAMPLES, MANY = (160, 90), 3, 24  # pixels; samples of the frame, and of the reference
MOMENT = datetime(2014, 9, 17, 23, 12, tzinfo=UTC)
VIEW = CameraKey(0.0, 38.990, -120.5505, 600.0, "head")  # 2 km off the head of the fire
MODEL_TIMES = 25  # of the sample; arrival times cover all
PASSES = ("rgb", "thermal", "depth")
_CAMERA = settings.Camera().name


def run(bench: Bench) -> None:
    """Measure the ray march, then render frames."""
    _march(bench)
    _frame(bench)


def _march(bench: Bench) -> None:
    smoke, rays, lit = _smoke(), _rays(), light()

    def marched(length: float) -> NDArray[np.float32]:
        return volume.march([smoke], *rays, lit, step=length)

    exact = marched(STEPS[EXACT])
    errors = {
        name: float(np.abs(marched(length) - exact)[..., :3].mean() / exact[..., :3].mean())
        for name, length in STEPS.items()
    }
    tools = [
        Runner(name, partial(marched, length), threads, None if name == EXACT else errors[name])
        for name, length in STEPS.items()
        for threads in ((1, 2) if name == OURS else (2,))
    ]
    bench.race(f"marching {SIZE[0]} by {SIZE[1]} rays", tools, len(rays[1]), "ray")
    quantity = "Radiance error of the ray march against a quarter of its step, relative"
    bench.target(quantity, errors[OURS], LIMIT, "", most=True)


def _smoke() -> volume.Bricks:
    """Make a noisy ring of smoke in empty air."""
    x, y, z = np.mgrid[:SIDE, :SIDE, : SIDE // 3] / SIDE - 0.5
    noise = np.random.default_rng(6).random(x.shape)
    density = np.where((np.abs(np.hypot(x, y) - 0.3) < 0.15) & (z < 0), 1.0 + noise, 0.0).astype(np.float32)
    density *= 0.01 / density.max()
    even = np.ones_like(density)
    return volume.Bricks(density, 0.5 * even, 0.8 * even, 0.7 * even, None, VOXEL, (0.0, 0.0, 0.0))


def _rays() -> tuple[NDArray, NDArray, NDArray]:
    """Return the rays of a camera that looks down on the smoke."""
    width, height = SIZE
    x, y = np.meshgrid(np.linspace(-0.6, 0.6, width), np.linspace(0.34, -0.34, height))
    local = np.stack([x, np.ones_like(x), y - 0.3], axis=-1).reshape(-1, 3)
    toward = local / np.linalg.norm(local, axis=1, keepdims=True)
    middle = 0.5 * SIDE * VOXEL
    return np.array([middle, -middle, middle]), toward, np.full((len(toward), 1), 1.0e9, np.float32)


def light() -> volume.Illumination:
    """Return the light of a summer afternoon."""
    return volume.Illumination(
        density=1.0,
        fresh=(0.36, 0.315, 0.275),
        old=(0.95, 0.945, 0.94),
        sun=(9.0, 8.0, 7.0),
        sky=(0.3, 0.35, 0.4),
        sun_direction=(0.6, 0.0, 0.8),
        anisotropy=0.375,
        multiple_scattering=(0.5, 0.3),
        glow=(0.0, 0.0, 0.0),
        thin=0.1,
        air=(0.25, 0.3, 0.38),
        horizon=(0.7, 0.8, 0.9),
        thick_haze=sky.THICK_HAZE,
        haze=(sky.HAZE, sky.HAZE * sky.LOW_HAZE),
        haze_height=(sky.HAZE_HEIGHT, sky.LOW_HEIGHT),
    )


def _frame(bench: Bench) -> None:
    flip = bench.flip()
    if flip is None:
        return
    with tempfile.TemporaryDirectory() as folder:
        results = worker.run(partial(frames_in_blender, folder))
        exact = _picture(Path(folder), REFERENCE)
        errors = {name: flip.evaluate(exact, _picture(Path(folder), name), "LDR")[1] for name in results}
    for name, spent in results.items():
        bench.row(
            f"a frame of {FRAME[0]} by {FRAME[1]} pixels, {len(PASSES)} passes",
            name,
            Times((spent,)),
            FRAME[0] * FRAME[1],
            "pixel",
            error=errors[name],
            error_unit="FLIP",
            threads=os.cpu_count() or 1,
        )
    quantity = "Image difference of a frame from its reference / of a frame with Cycles' volume"
    bench.target(quantity, errors[OURS] / errors[VOLUME], MOST, "x", most=True)


def _picture(folder: Path, name: str) -> str:
    return str(folder / name / file_of(_CAMERA, "rgb", 1, "png"))


# The following functions run in the worker process, where Blender is.


def frames_in_blender(
    folder: str, progress: Progress = silent, tell: MessageCallback = no_message
) -> dict[str, float]:
    """Render a frame once by both methods, and its reference; return the seconds of each method."""
    import bpy

    bpy.ops.wm.read_factory_settings(use_empty=True)
    frames = {name: _Frame(Path(folder), name) for name in (OURS, VOLUME)}
    spent = {name: frame.draw(name) for name, frame in frames.items()}
    frames[VOLUME].draw(REFERENCE, MANY)
    return spent


class _Frame:
    """A scene of the sample's smoke, for one rendering method."""

    def __init__(self, folder: Path, way: str) -> None:
        from ..blender import owned
        from ..data import sample
        from ..render import engine, layers
        from ..run import opening as runs
        from ..scene import build
        from ..smoke import bake, sources

        file = _file(folder, "volume" if way == VOLUME else "integrated")
        if not file.run.exists():
            sample.write(file.run, MODEL_TIMES, "npy")
        self.folder, self.shot = folder, Shot(file, runs.open(file.run))
        self.smoke: Any = None
        if way == VOLUME:
            bake.bake(self.shot)
        else:
            self.smoke = sources.select(self.shot).bricks(1)
        self.stage = owned.stage(owned.new_scene())
        build.build(self.shot, self.stage.scene)
        layers.build(file, self.stage)
        engine.apply(file, self.stage.scene)

    def draw(self, name: str, rays: int = 0) -> float:
        """Render and return wall-clock seconds; `rays` sets a number of samples, with short steps."""
        from ..render import pictures
        from ..render.picture import Picture
        from ..render.sharing import open_session

        cycles = self.stage.scene.cycles
        if rays:
            cycles.samples, cycles.use_denoising, cycles.volume_step_rate = rays, False, 0.25
            cycles.seed = 7
        out = self.folder / name
        out.mkdir(exist_ok=True)
        wanted = [Picture(_CAMERA, 1, each) for each in (PASSES[:1] if rays else PASSES)]
        with open_session(out, {(_CAMERA, name): {"pass": name} for name in PASSES}) as here:
            watch = Stopwatch()
            pictures.render(self.shot, self.stage, here, wanted, ready=lambda _frame, _after: self.smoke)
            return watch.read().seconds


def _file(folder: Path, draw: str) -> settings.Settings:
    """Describe one frame of the sample's solved smoke from a drone."""
    return settings.Settings(
        path=folder / "scene.toml",
        run=folder / "sample",
        cache=folder / "cache",
        time=sections.Time(start=MOMENT, frames=1),
        smoke=sections.SmokeSettings(spin_up=300.0, draw=draw),
        forest=sections.Forest(budget=20_000),
        cameras=(settings.Camera(rig=Drone(keys=(VIEW,))),),
        render=settings.Render(resolution=FRAME, samples=SAMPLES, denoise=True, passes=PASSES),
    )
