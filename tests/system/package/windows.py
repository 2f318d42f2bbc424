"""Try the installed Firetwin as a user of Windows would: ``windows.py film|names|locks FOLDER``.

FOLDER is new, such as ``D:\\film``. `film` also runs on Linux, and ``compare FOLDER FOLDER`` compares two
films. The first fault ends it with an error.
"""

from __future__ import annotations

import contextlib
import hashlib
import io
import locale
import os
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from firetwin import cli, files
from firetwin.errors import InputError
from firetwin_core import sensor

WINDOWS = sys.platform == "win32"
SCENE = """\
run = "run"
cache = "{cache}"
time = {{ start = 2014-09-17T23:12:00Z, frames = {frames}, speed = 15.0, fps = 12 }}
forest = {{ draw_distance = 3000.0 }}
smoke = {{ spin_up = 60.0 }}
render = {{ resolution = {resolution}, samples = 4 }}
[[cameras]]
name = "drone"
keys = [{{ latitude = 38.977, longitude = -120.572, height = 150.0, target = "head" }}]
"""
GOOD = ("a folder", "Straße", "火事", "50% & (1) ^!", "n" * 100)
ODD = ("CON", "nul.toml", "name.", "name ", "a?b", "x" * 300)


def command(*words: object) -> list[str]:
    """Compose the command line of Firetwin."""
    return [sys.executable, "-m", "firetwin", *map(str, words)]


def firetwin(*words: object) -> str:
    """Run Firetwin in a process; returns what it said."""
    began = time.monotonic()
    done = subprocess.run(
        command(*words), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT
    )
    said = done.stdout.decode("utf-8", "replace")
    assert done.returncode == 0, f"{words} ended with {done.returncode}:\n{said}"
    print(f"{time.monotonic() - began:.0f} s: firetwin {' '.join(map(str, words))}", flush=True)
    return said


def prepare(folder: Path, frames: int, resolution: str, cache: str = "cache") -> Path:
    """Write the sample run and a scene file into a folder."""
    folder.mkdir(parents=True)
    assert call("sample", folder / "run", "--frames", "3") == (0, "")
    scene = folder / "scene.toml"
    text = SCENE.format(cache=cache, frames=frames, resolution=resolution)
    scene.write_text(text, encoding="utf-8")
    return scene


def call(*words: object) -> tuple[int, str]:
    """Run a command in this process; returns its status, and the last line of an error."""
    said = io.StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(io.StringIO()):
        status = cli.main([str(word) for word in words])
    return status, said.getvalue().strip().rsplit("\n", 1)[-1] if status else ""


def film(folder: Path) -> None:
    """Film the sample run with a cache on another drive, and resume the film."""
    cache = folder / "cache"
    if WINDOWS:
        cache = Path("C:/firetwin_cache") / folder.name
    scene = prepare(folder, 3, "[160, 90]", cache.as_posix())
    words = ("render", scene, "--out", folder / "film", "--passes", "rgb,thermal")
    firetwin(*words, "--frames", "1")
    before = {path: path.stat().st_mtime_ns for path in (folder / "film").rglob("*_000001.*")}
    assert len(before) == 4, before
    firetwin(*words, "--resume")
    assert before == {path: path.stat().st_mtime_ns for path in before}, (
        "a finished picture was rendered again"
    )
    films = {path.name: path.stat().st_size for path in (folder / "film").rglob("*.mp4")}
    assert films.keys() == {"drone_rgb.mp4", "drone_thermal.mp4"}, films
    with (folder / "hashes.txt").open("w", encoding="utf-8", newline="\n") as out:
        for path in sorted([*cache.rglob("moment_*.npz"), *(folder / "run").glob("*.npy")]):
            print(f"{path.parent.name}/{path.name}", hashlib.sha256(path.read_bytes()).hexdigest(), file=out)
    print(f"films: {films}", flush=True)


def compare(folder: Path, other: Path) -> None:
    """Compare the pictures of two films: FLIP, and the largest difference; and their data, byte for byte."""
    import flip_evaluator

    pictures = sorted(path.relative_to(folder) for path in (folder / "film").rglob("*.png"))
    assert len(pictures) == 6, pictures
    for name in pictures:
        one, two = (sensor.read_image(each / name)[..., :3] for each in (folder, other))
        _, flip, _ = flip_evaluator.evaluate(one, two, "LDR")
        difference = 255.0 * np.abs(one - two)
        print(
            f"{name.name}: mean FLIP {flip:.5f}, largest difference {difference.max():.0f} of 255, "
            f"mean {difference.mean():.4f}, equal pixels {(difference == 0).all(axis=2).mean():.4f}"
        )
    one, two = (
        dict(line.split() for line in (each / "hashes.txt").read_text().splitlines())
        for each in (folder, other)
    )
    differ = sorted(name for name in one.keys() | two.keys() if one.get(name) != two.get(name))
    print(f"data: {len(one)} files, {len(differ)} of them differ: {', '.join(differ)}")


def names(folder: Path) -> None:
    """Work in folders with hostile names: by each name the run is read again, or one line refuses it."""
    print(f"code page: {locale.getpreferredencoding(False)}")
    for name in (*GOOD, *ODD):
        run = folder / name
        status, said = call("sample", run, "--frames", "3")
        if status == 0:
            status, said = call("info", run)
        print(f"{name[:20]!r}, {len(name)} characters: {said or 'written and read'}", flush=True)
        assert status == 0 if name in GOOD else "unexpected" not in said, said


def locks(folder: Path) -> None:
    """A file is replaced once another program closes it, and named in the error if it stays open."""
    folder.mkdir(parents=True)
    path = folder / "open.txt"
    path.write_text("old")
    with opened(path, 0.4):
        files.write_text(path, "new")
    assert path.read_text() == "new"
    with path.open(), contextlib.suppress(InputError):
        files.write_text(path, "newer")
        raise AssertionError("an open file was replaced")
    assert [each.name for each in folder.iterdir() if each.suffix == ".part"] == []
    print("a file that is open is replaced later, or the error names it", flush=True)


@contextlib.contextmanager
def opened(path: Path, seconds: float) -> Iterator[None]:
    """Have a file open for some seconds, as a virus scanner has."""
    file = path.open()
    timer = threading.Timer(seconds, file.close)
    timer.start()
    yield
    timer.join()


if __name__ == "__main__":
    sys.stdout.reconfigure(encoding="utf-8")
    try:
        what, *folders = sys.argv[1:]
        {"film": film, "compare": compare, "names": names, "locks": locks}[what](*map(Path, folders))
    except BaseException:
        import traceback

        traceback.print_exc()
        sys.stderr.flush()
        os._exit(1)
    sys.stdout.flush()
    os._exit(0)  # Python's own end can hang with `bpy` loaded
