"""The example's drone frame by one Blender, and how far the frames of several Blenders differ.

picture.py render RUN OUT         with the Python that has Firetwin and Blender
    picture.py compare OUT OUT ...    with one that has flip-evaluator; the first is what others are held to
"""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

EXAMPLE = Path(__file__).parents[2] / "examples" / "king_fire.toml"
FRAME = 24
SETTINGS = {
    "method": '"preview"',
    "resolution": "[320, 180]",
    "samples": "12",
    "video": "false",
    "cache": '"cache"',
}
PICTURE = f"drone/rgb/drone_rgb_{FRAME:06d}.png"
LIMIT = 0.05  # mean FLIP: 0 the same, 1 as different as black and white


def render(run: Path, out: Path) -> None:
    """Render the frame, unless it exists and matches; its scene file and smoke are in the same folder."""
    text = EXAMPLE.read_text(encoding="utf-8")
    for name, value in (SETTINGS | {"run": f'"{run.resolve()}"'}).items():
        text, count = re.subn(rf"(?m)^{name} = [^#\n]*", f"{name} = {value} ", text)
        assert count == 1, f"{EXAMPLE} has {count} lines of {name}"
    out.mkdir(parents=True, exist_ok=True)
    scene = out / "scene.toml"
    scene.write_text(text, encoding="utf-8")
    options = ["--camera", "drone", "--frames", str(FRAME), "--passes", "rgb", "--resume"]
    command = [sys.executable, "-m", "firetwin", "render", scene, "--out", out, *options]
    sys.exit(subprocess.run(command).returncode)


def compare(folders: list[Path]) -> None:
    """Print the mean FLIP of each picture against the first; exit status 1 at or above the limit."""
    import flip_evaluator

    first, *others = folders
    worst = 0.0
    for other in others:
        _, mean, _ = flip_evaluator.evaluate(str(first / PICTURE), str(other / PICTURE), "LDR")
        worst = max(worst, mean)
        print(f"{other.name} against {first.name}: mean FLIP {mean:.4f} (below {LIMIT})")
    sys.exit(worst >= LIMIT)


if __name__ == "__main__":
    verb, *paths = sys.argv[1:]
    if verb == "render":
        render(*map(Path, paths))
    else:
        compare([Path(path) for path in paths])
