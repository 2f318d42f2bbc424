"""Renders the gallery's pictures of a fire, each scene once, and measures what its smoke's flow costs."""

from __future__ import annotations

import json
import re
import resource
import shutil
import subprocess
import sys
import time
import tomllib
from dataclasses import dataclass
from pathlib import Path

import gallery_clock

_DRONE = "chase"  # the drone's camera
_SOLVE, _SOLVED = "solve", "solve here"
_CLEAR = ("overview", "satellite")  # views that are rendered without smoke too
_DEPTHS = {
    "optical_depth": re.compile(r"optical depth from above ([\d.e+]+) .*?, ([\d.e+]+) over a kilometre"),
    "published": re.compile(r"measured [^:]*: ([\d.]+) to ([\d.]+)"),
}
_SEEN = re.compile(r"(\d+) % of the front")


@dataclass(frozen=True)
class How:
    """Of all pictures of a fire.

    Attributes
    ----------
    width
        px; heights are 9/16 of it.
    night
        Whether the fire burns by night anyhow.
    through
        Words before each command, such as ``nice``.
    """

    width: int
    samples: int
    night: bool
    through: tuple[str, ...] = ()


def made(name: str, run: Path, out: Path, how: How) -> dict[str, object]:
    """Render what is missing of a fire; seconds and memory of its flow, and what its scene says."""
    work = out / "work" / name
    facts_file = work / "facts.json"
    facts: dict[str, object] = {}
    if facts_file.exists():
        facts = json.loads(facts_file.read_text(encoding="utf-8"))
    day = _by_day(work, run, how)
    if "flow" not in facts:
        facts["flow"] = _flow(how, day)
    facts["front_seen"] = _front_seen(day)
    if not (out / f"{name}_overview.png").exists():
        facts["day"] = _render(how, day, "rgb,thermal")
        for view, camera in _cameras(day).items():
            _keep(work / "day", camera, "rgb", out / f"{name}_{view}")
        _keep(work / "day", "overview", "thermal", out / f"{name}_thermal")
    if not (out / f"{name}_overview_clear.exr").exists():
        clear = _without_smoke(day, work / "clear.toml")
        for view in _CLEAR:
            _render(how, clear, "rgb", view)
            _keep(work / "clear", view, "rgb", out / f"{name}_{view}_clear")
    if not (out / f"{name}_night.png").exists():
        if how.night:
            for end in ("png", "exr"):
                shutil.copyfile(out / f"{name}_overview.{end}", out / f"{name}_night.{end}")
        else:
            night = _moved(work / "fitted.toml", run, work / "night.toml", gallery_clock.NIGHT)
            facts["night"] = _render(how, night, "rgb", "overview")
            _keep(work / "night", "overview", "rgb", out / f"{name}_night")
    facts_file.write_text(json.dumps(facts, indent=1), encoding="utf-8")
    return facts


def _by_day(work: Path, run: Path, how: How) -> Path:
    """The scene that fits; unless the fire is one of the night, its clock is moved to the day."""
    scene, day = _scene(work / "fitted.toml", run, how), work / "day.toml"
    start = tomllib.loads(scene.read_text(encoding="utf-8"))["time"]["start"]
    if not day.exists():
        if how.night or gallery_clock.is_day(run, start):
            shutil.copyfile(scene, day)
        else:
            _moved(scene, run, day, gallery_clock.DAY)
    return day


def _scene(path: Path, run: Path, how: How) -> Path:
    """The scene that `firetwin new` writes, with the gallery's size and samples."""
    if path.exists():
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    _firetwin(how, "new", run.resolve(), "-o", path)
    text = path.read_text(encoding="utf-8")
    size = f"resolution = [{how.width}, {how.width * 9 // 16}]"
    text = re.sub(r"^resolution = \[.*?\]", size, text, flags=re.MULTILINE)
    text = re.sub(r"^samples = \d+", f"samples = {how.samples}", text, flags=re.MULTILINE)
    path.write_text(text, encoding="utf-8")
    return path


def _without_smoke(scene: Path, path: Path) -> Path:
    """The same scene with its smoke switched off."""
    lines = scene.read_text(encoding="utf-8").splitlines()
    lines = [line for line in lines if not line.startswith("enabled = ")]
    if "[smoke]" not in [line.split("#")[0].strip() for line in lines]:
        first = next(k for k, line in enumerate(lines) if line.startswith("["))
        lines.insert(first, "[smoke]")
    at = next(k for k, line in enumerate(lines) if line.startswith("[smoke]"))
    lines.insert(at + 1, "enabled = false")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _moved(scene: Path, run: Path, path: Path, hour: float) -> Path:
    """The same scene of the same fire, its clock moved to an hour of the sun."""
    text = scene.read_text(encoding="utf-8")
    window = tomllib.loads(text)["time"]
    moved = path.with_suffix(".run")
    by = gallery_clock.moved(run, moved, window["start"], hour)
    text = re.sub(r"^run = .*$", f'run = "{moved.resolve()}"', text, count=1, flags=re.MULTILINE)
    for key in ("start", "end"):
        if key in window:
            later = (window[key] + by).isoformat()
            text = re.sub(rf"^{key} = .*$", f"{key} = {later}", text, count=1, flags=re.MULTILINE)
    path.write_text(text, encoding="utf-8")
    return path


def _cameras(scene: Path) -> dict[str, str]:
    """View: the scene's camera of it."""
    named = [each["name"] for each in tomllib.loads(scene.read_text(encoding="utf-8"))["cameras"]]
    views = {("drone" if name == _DRONE else name): name for name in named}
    return {view: views[view] for view in ("overview", "drone", "flank", "satellite") if view in views}


def _front_seen(scene: Path) -> dict[str, float]:
    """View: the share of the front that its camera shows, as the scene's remarks say."""
    found: dict[str, float] = {}
    said = ""
    names = {camera: view for view, camera in _cameras(scene).items()}
    for line in scene.read_text(encoding="utf-8").splitlines():
        if line.startswith("#"):
            said += line.removeprefix("#")
        elif line.startswith("name = ") and (share := _SEEN.search(said)):
            found[names.get(line.split('"')[1], line.split('"')[1])] = int(share[1]) / 100.0
        elif not line.startswith("[[cameras]]"):
            said = ""
    return found


def _render(how: How, scene: Path, passes: str, camera: str = "") -> dict[str, object]:
    """Render the last frame of a scene beside it; seconds, and the peak memory (MB)."""
    frames = tomllib.loads(scene.read_text(encoding="utf-8"))["time"].get("frames", 1)
    words = [
        "render",
        scene,
        "--out",
        scene.with_suffix(""),
        "--frames",
        frames,
        "--passes",
        passes,
    ]
    return _firetwin(how, *words, *(["--camera", camera] if camera else []))


def _flow(how: How, scene: Path) -> dict[str, object]:
    """Seconds and peak memory (MB) of solving the flow for all cameras."""
    return _firetwin(how, _SOLVE, scene)


def _keep(folder: Path, camera: str, name: str, to: Path) -> None:
    """Copy the last picture of a camera's pass, and its light where it is kept."""
    for end in ("png", "exr"):
        files = sorted((folder / camera / name).glob(f"*_{name}_*.{end}"))
        if files:
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(files[-1], to.with_suffix(f".{end}"))


def _firetwin(how: How, *words: object) -> dict[str, object]:
    """Run a command; seconds, the most memory (MB) of one of its processes, and what it said of smoke."""
    command = [*how.through, sys.executable, __file__, *map(str, words)]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def _timed(words: list[str]) -> int:
    """Run a command, print what it took, and return its status."""
    begun = time.monotonic()
    command = [sys.executable, "-m", "firetwin", *words]
    if words[0] == _SOLVE:
        command = [sys.executable, __file__, _SOLVED, *words[1:]]
    said: dict[str, object] = {}
    with subprocess.Popen(command, stdout=sys.stderr, stderr=subprocess.PIPE, text=True) as process:
        for line in process.stderr or ():
            sys.stderr.write(line)
            if "of smoke in" in line:
                said |= smoke_said(line)
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
    print(json.dumps({"seconds": time.monotonic() - begun, "megabytes": most} | said))
    return process.returncode


def smoke_said(line: str) -> dict[str, object]:
    """Optical depths over a fire, and the range that was published of such smoke, from what is said of it."""
    said: dict[str, object] = {"smoke": line.removeprefix("firetwin: ").strip()}
    for name, pattern in _DEPTHS.items():
        if found := pattern.search(line):
            said[name] = [float(each) for each in found.groups()]
    return said


def _solve(scene: str) -> int:
    """Solve the flow of a scene's smoke up to its last frame, as each camera has it."""
    from firetwin.shot.source import ShotSource
    from firetwin.smoke.flow import Flow

    shot = ShotSource(scene=scene).shot()
    for camera in shot.settings.cameras:
        Flow(shot.for_camera(camera.name)).solve([shot.frames.count])
    return 0


if __name__ == "__main__":
    known = sys.argv[1:2] == [_SOLVED]
    sys.exit(_solve(sys.argv[2]) if known else _timed(sys.argv[1:]))
