"""Measures how long `firetwin render --frames 1` plans: `python tests/benchmarks/planning.py [RUN]`.

A scene of 20 cameras and 10,000 frames (600,000 pictures in three passes), of which some are finished.
Without RUN the run is a small one.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "core"))

from firetwin.render import films, fingerprint, plan
from firetwin.render.picture import Picture
from firetwin.render.store import Store
from firetwin.shot.choice import Choice
from small_run import RUN_TOML, small_fields, write_field

CAMERAS, FRAMES = 20, 10_000
CAMERA = """[[cameras]]
name = "camera{}"
keys = [{{latitude = {}, longitude = {}, height = 400, target = "fire"}}]
"""


def main() -> None:
    """Print a line for each state of the output folder."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run = Path(sys.argv[1]).absolute() if len(sys.argv) > 1 else _small(folder / "run")
        place = (38.78, -120.6) if len(sys.argv) > 1 else (38.905, -120.593)
        cameras = "".join(CAMERA.format(i, *place) for i in range(CAMERAS))
        scene = folder / "scene.toml"
        scene.write_text(f'run = "{run}"\n[time]\nframes = {FRAMES}\n{cameras}', encoding="utf-8")
        for what in ("first", "again"):
            print(f"nothing finished, {what}: {_plan(scene, folder / 'out'):.3f} s")
        begun = time.perf_counter()
        count = _finish(scene, folder / "out", 2000)
        print(f"({count:,} pictures entered in {time.perf_counter() - begun:.1f} s)")
        for what in ("first", "again"):
            print(f"{count:,} finished, {what}: {_plan(scene, folder / 'out'):.3f} s")
        command = [sys.executable, "-c", _PROCESS, str(scene), str(folder / "out")]
        begun = time.perf_counter()
        told = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        took = time.perf_counter() - begun
        print(f"the same in a process of its own: {took:.3f} s, planning {told.strip()} s")


_PROCESS = f"""
import sys; sys.path.insert(0, {str(Path(__file__).parent)!r})
from pathlib import Path
import planning
print(round(planning._plan(Path(sys.argv[1]), Path(sys.argv[2])), 3))
"""


def _plan(scene: Path, out: Path) -> float:
    """Seconds that `jobs.render.run` takes until it starts a worker, or says that nothing is to do."""
    begun = time.perf_counter()
    shot = Choice(scene=str(scene)).shot()
    wanted = plan.pictures(shot, "1")
    made_with = fingerprint.of_pictures(shot, wanted)
    with Store(out) as store:
        plan.missing(store, wanted, made_with)
        any(films.missing(shot, store, made_with))
    return time.perf_counter() - begun


def _finish(scene: Path, out: Path, frames: int) -> int:
    """Enter pictures of the first frames without making them."""
    shot = Choice(scene=str(scene)).shot()
    wanted = plan.pictures(shot, f"1-{frames}")
    made_with = fingerprint.of_pictures(shot, wanted)
    with Store(out, create=True) as store:
        for pair, settings in made_with.items():
            entries = {
                path: {"bytes": 1, "sha256": "0" * 64, "camera": pair[0], "pass": pair[1], "frame": frame}
                for frame in range(1, frames + 1)
                for path in Picture(pair[0], frame, pair[1]).files()
            }
            store.add(settings, entries)
    return len(wanted)


def _small(folder: Path) -> Path:
    folder.mkdir()
    (folder / "run.toml").write_text(RUN_TOML, encoding="utf-8")
    for name, values in small_fields().items():
        write_field(folder, name, values, "npy")
    return folder


if __name__ == "__main__":
    main()
