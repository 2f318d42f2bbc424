"""Settings of a scene file: its sections, cameras, render settings and comparison runs."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ...did_you_mean import suggestion
from .. import passes
from ..cameras import rigs
from ..frames import part_of
from ..schema import Where, fields, key, kind_of, one_of
from ..schema.bounds import file_name, twice
from ..schema.frame_list import FrameList
from ..sections import LARGEST_SEED, SceneSettings

MOST_RUNS = 3  # comparison runs, in addition to the first run


def _even(value: tuple[int, int] | None) -> str | None:
    if value is None or all(side % 2 == 0 for side in value):
        return None
    return "must be two even numbers of pixels (video needs even ones)"


def _at_least_one(value: tuple[str, ...]) -> str | None:
    return None if value else 'is empty; name at least one, such as "rgb"'


@dataclass(frozen=True)
class Camera:
    """A camera: its passes, and its rig (the kind of camera, with position and motion)."""

    name: str = key("drone", "name of the camera, its folder and its files", check=file_name, affects=())
    rig: Any = one_of(rigs.kinds, "kind of camera", tag="kind", default_kind=rigs.USUAL)
    passes: tuple[str, ...] = key(
        (), 'passes, such as ["rgb"]; empty: as in [render]', choices=passes.helps, affects=("sidecar",)
    )
    frames: FrameList = key(FrameList(), 'frames, such as "24" or "1-48:4"; empty: all')
    resolution: tuple[int, int] | None = key(
        None,
        "picture width and height, both even; default: as in [render]",
        unit="pixels",
        at_least=16,
        at_most=16384,
        check=_even,
    )

    @property
    def kind(self) -> str:
        """Name of the kind of camera."""
        rig = next(part for part in fields(Camera) if part.name == "rig")
        return kind_of(rig.key, self.rig)

    def validate(self) -> tuple[Where, str] | None:
        """Validate its rig."""
        invalid = self.rig.validate()
        return (invalid[0], f'camera "{self.name}" {invalid[1]}') if invalid else None


@dataclass(frozen=True)
class OtherRun:
    """Another run of the same place and time, filmed by the same cameras."""

    name: str = key(
        "what-if", 'name of the run; its camera "drone" is called drone@what-if', check=file_name, affects=()
    )
    path: Path = key(Path("what-if"), "folder of the run", affects=())


@dataclass(frozen=True)
class Render:
    """How frames are rendered."""

    engine: str = key(
        "cycles",
        "render engine",
        choices={"cycles": "path tracing", "eevee": "rasterizing: faster, needs OpenGL"},
        affects=("picture",),
    )
    device: str = key(
        "auto",
        "device of Cycles",
        choices={"auto": "the faster of GPU and processor", "cpu": "the processor", "gpu": ""},
        affects=(),
    )
    resolution: tuple[int, int] = key(
        (640, 360),
        "width and height, both even",
        unit="pixels",
        at_least=16,
        at_most=16384,
        check=_even,
        affects=("picture",),
    )
    samples: int = key(
        6,
        "samples per pixel; 3: a quick film, 12 to 24: a final picture",
        at_least=1,
        at_most=65536,
        affects=("grain",),
    )
    denoise: bool = key(
        True, "denoise the picture; depth and temperatures are never denoised", affects=("grain",)
    )
    motion_blur: float = key(
        0.0,
        "exposure of a moving camera, frame intervals; 0: sharp, 0.5: as film cameras; rgb only",
        at_least=0,
        at_most=2,
        affects=("grain",),
    )
    exr_space: str = key(
        "rec709",
        "linear colour space of rgb and comp EXR",
        choices={"rec709": "sRGB primaries", "acescg": "AP1"},
        affects=("colour",),
    )
    passes: tuple[str, ...] = key(
        ("rgb", "depth", "thermal"),
        "passes that cameras record",
        choices=passes.helps,
        check=_at_least_one,
        affects=("sidecar",),
    )
    video: bool = key(True, "write films of cameras with more than one frame", affects=())
    film: str = key(
        "review",
        "kind of the films",
        choices={"review": "with captions, H.264", "clean": "without", "both": "two"},
        affects=(),
    )
    film_codec: str = key(
        "h264",
        "codec of clean films",
        choices={"h264": "8 bits", "h265": "10 bits", "prores": "422 HQ, .mov"},
        affects=(),
    )
    slate: str = key("", "slate before review films: show and version; empty: none", affects=())
    seed: int = key(
        0, "random seed of the render noise", at_least=0, at_most=LARGEST_SEED, affects=("grain",)
    )
    cull: bool = True  # frustum and occlusion culling, level of detail, forest.budget; False in comparisons
    chunk: int = key(
        480,
        "build chunk: frames of a film built together; fewer need less memory, 0: all at once",
        at_least=0,
        at_most=LARGEST_SEED,
        affects=("terrain", "forest", "fire"),
    )
    thermal_low: float | None = key(
        None,
        "lower end of the thermal palette; default: the coldest ground of the frame",
        unit="K",
        above=0,
        at_most=10_000,
        affects=("thermal",),
    )
    thermal_high: float = key(
        800.0, "upper end of the thermal palette", unit="K", affects=("thermal",), above=0, at_most=10_000
    )

    def validate(self) -> tuple[Where, str] | None:
        """Check that the thermal palette has a range."""
        if self.thermal_low is not None and self.thermal_high <= self.thermal_low:
            return ("thermal_high",), "render.thermal_high must be above render.thermal_low"
        return None


@dataclass(frozen=True)
class Settings(SceneSettings):
    """All settings of one scene file."""

    render: Render = key(default_factory=Render, help="how frames are rendered")
    runs: tuple[OtherRun, ...] = key(
        (), "another run, filmed by the same cameras at the same times; at most 3"
    )
    cameras: tuple[Camera, ...] = key((), "a camera and its passes", affects=("camera",))

    def chunk_size(self, camera: Camera) -> int:
        """Chunk size of a camera: `render.chunk`, or 0 if all its frames are built together."""
        size = self.render.chunk
        listed = FrameList(camera.frames).frames(self.time.frames)
        return size if part_of(listed[0], size) != part_of(listed[-1], size) else 0

    def validate(self) -> tuple[Where, str] | None:
        """Check that camera names are unique, and that their frames exist."""
        i = twice([camera.name for camera in self.cameras])
        if i is not None:
            reason = (
                f'a second camera is named "{self.cameras[i].name}"; names must differ, not by capitals alone'
            )
            return ("cameras", i, "name"), reason
        for i, camera in enumerate(self.cameras):
            try:
                FrameList(camera.frames).frames(self.time.frames)
            except ValueError as error:
                return ("cameras", i, "frames"), f"cameras.frames: {error}"
        return self._unknown_followed() or self._impossible() or self._comparison_fault()

    def _comparison_fault(self) -> tuple[Where, str] | None:
        """Check the comparison runs, and passes that need them."""
        names = [run.name for run in self.runs]
        i = twice(names)
        if i is not None:
            reason = f'a second run is named "{names[i]}"; names must differ, not by capitals alone'
            return ("runs", i, "name"), reason
        if len(names) > MOST_RUNS:
            reason = f"runs has {len(names)} tables; use at most {MOST_RUNS}, in addition to the first run"
            return ("runs", MOST_RUNS), reason
        if (same := self._same_files()) is not None:
            return same
        for where, listed in (
            (("render", "passes"), self.render.passes),
            *((("cameras", i, "passes"), camera.passes) for i, camera in enumerate(self.cameras)),
        ):
            if not names and (comparing := [name for name in listed if passes.compares(name)]):
                return (
                    where,
                    f'passes has "{comparing[0]}", which compares runs; add [[runs]] or leave it out',
                )
        return None

    def _same_files(self) -> tuple[Where, str] | None:
        """Check that no view of a comparison run has the files of another view."""
        views = [
            (i, each.name, passes.view_of(each.name, run.name))
            for i, run in enumerate(self.runs)
            for each in self.cameras
        ]
        stems = [
            passes.file_stem(name) for name in [each.name for each in self.cameras] + [v for *_, v in views]
        ]
        k = twice(stems)
        if k is None:
            return None
        i, _, view = views[k - len(self.cameras)]
        reason = f'"{view}" and another view would write the files "{stems[k]}"; rename the camera or the run'
        return ("runs", i, "name"), reason

    def _impossible(self) -> tuple[Where, str] | None:
        """Check that cameras suit the engine and their resolution."""
        for i, camera in enumerate(self.cameras):
            width, height = camera.resolution or self.render.resolution
            if camera.rig.around and self.render.engine != "cycles":
                reason = f'camera "{camera.name}" is a panorama, which EEVEE cannot render; use Cycles'
                return ("cameras", i, "kind"), reason
            for each in passes.of_camera(self, camera):
                if reason := passes.refused(each, camera, self):
                    return ("cameras", i, "passes") if camera.passes else ("render", "passes"), reason
            if camera.rig.around and width != height:
                reason = (
                    f'camera "{camera.name}" needs a square resolution, such as [2048, 2048]: two pictures '
                    f"one above the other, each twice as wide as high; it has {width} x {height}"
                )
                return ("cameras", i, "resolution"), reason
        return None

    def _unknown_followed(self) -> tuple[Where, str] | None:
        for i, camera in enumerate(self.cameras):
            name = getattr(camera.rig, "follows", "")
            if name and camera.rig.followed(self.cameras) is None:
                others = [each.name for each in self.cameras if not hasattr(each.rig, "follows")]
                reason = f'camera "{camera.name}" follows "{name}", and no other camera has this name'
                return ("cameras", i, "follows"), reason + suggestion(name, others)
        return None
