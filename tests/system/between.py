"""A scene built and saved by one Blender, opened by another: settings, operators and a picture.

    between.py save RUN FOLDER    build it, save FOLDER/VERSION.blend and its settings
    between.py open FOLDER        open what other Blenders saved there, and use it

With the Python that has Firetwin and Blender. Exit status 1: something is not as it should be.
"""

from __future__ import annotations

import sys
from pathlib import Path

import bpy
import firetwin
import numpy as np
from firetwin.blender import compat, owned
from firetwin.shot.settings import scene_file as file
from firetwin.ui import navigation, scene_file
from firetwin_core import sensor
from mathutils import Euler, Matrix

VERSION = ".".join(map(str, bpy.app.version[:2]))
SCENE = """\
run = "{run}"
[time]
start = 2014-09-17T16:00:00-07:00
end = 2014-09-17T16:24:00-07:00
frames = 3
[terrain]
near_radius = 0.0
apron = 20000.0
[forest]
budget = 2000
understorey = 300
draw_distance = 1500.0
[smoke]
enabled = false
[light]
haze = 0.7
[labels]
enabled = true
[render]
resolution = [64, 36]
samples = 1
denoise = false
[[cameras]]
name = "drone"
keys = [
    {{at = 0, latitude = 38.984, longitude = -120.558, height = 600, target = "head"}},
    {{at = 1, latitude = 38.980, longitude = -120.550, height = 500, target = "head"}},
]
"""
EYE = Matrix.Translation((-500.0, -2500.0, 2400.0)) @ Euler((1.2, 0.0, -0.2)).to_matrix().to_4x4()
failures: list[str] = []


def check(good: bool, text: str) -> None:
    """Say whether something is as it should be."""
    print(f"between: {'ok' if good else 'FAILED'}: {text}", file=sys.stderr)
    if not good:
        failures.append(text)


def settings() -> str:
    """Return the panel's settings as a scene file without comments; names of folders differ elsewhere."""
    lines = file.text(scene_file.read_settings(bpy.context.scene)).splitlines()
    bare = (line.partition("#")[0].rstrip() for line in lines)
    return "\n".join(line for line in bare if not line.startswith(("run = ", "cache = ")))


def blends(folder: Path, name: str) -> tuple[Path, Path]:
    """A scene of `folder` and its settings."""
    return folder / f"{name}.blend", folder / f"{name}.toml"


def save(run: Path, folder: Path) -> None:
    """Build the scene by the panel, change some of it by hand, and save it."""
    folder.mkdir(parents=True, exist_ok=True)
    blend, beside = blends(folder, VERSION)
    beside.write_text(SCENE.format(run=run.resolve()), encoding="utf-8")
    panel = bpy.context.scene.firetwin
    panel.scene_file = str(beside)
    bpy.ops.firetwin.build()
    keep(blend, beside)
    panel.scene_file, panel.output = "", f"//{VERSION}"
    panel.run = bpy.path.relpath(str(run.resolve()))
    keep(blend, beside)


def keep(blend: Path, beside: Path) -> None:
    """Save the open file and its settings."""
    bpy.context.scene.objects["Firetwin Trees"].location.x = 3.0
    beside.write_text(settings(), encoding="utf-8")
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))


def look(blend: Path, beside: Path) -> None:
    """Open a scene of another Blender, and use it."""
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    scene, panel = bpy.context.scene, bpy.context.scene.firetwin
    stage = owned.stage(scene)
    check(settings() == beside.read_text(encoding="utf-8"), "its settings have not changed")
    check(owned.is_ours(scene) and stage.camera("drone") == scene.camera, "scene and camera are ours")
    check(scene.objects["Firetwin Trees"].location.x == 3.0, "objects moved by hand stay")
    check(composited(scene), "the compositor has our nodes")
    before, cameras = picture(scene, blend, "as-it-is"), len(panel.cameras)
    for call, options in (
        (bpy.ops.firetwin.inspect, {}),
        (bpy.ops.firetwin.camera_add, {"kind": "poses"}),
        (bpy.ops.firetwin.camera_key, {}),
        (bpy.ops.firetwin.camera_lens, {"preset": "thermal_hand"}),
        (bpy.ops.firetwin.camera_aim, {"target": "head"}),
        (bpy.ops.firetwin.camera_copy, {}),
        (bpy.ops.firetwin.build, {"part": "forest"}),
        (bpy.ops.firetwin.jump, {"moment": "2014-09-17T16:12:00-07:00"}),
        (bpy.ops.firetwin.build, {}),
        (bpy.ops.firetwin.f12_files, {}),
    ):
        check(call(**options) == {"FINISHED"}, f"{call.idname_py()} {options}")
    check(len(panel.cameras) == cameras + 2, "the cameras are added")
    scene.camera = owned.stage(scene).camera("drone")
    bpy.ops.firetwin.f12_files(on=False)
    after = picture(scene, blend, "built-again")
    away = float(np.abs(_blurred(before) - _blurred(after)).max())
    check(away < 0.1, f"built again it shows the same, but for grain: {away:.3f} of 1 at most")
    keep(*blends(blend.parent, f"{blend.stem}-{VERSION}"))
    bpy.ops.firetwin.remove()
    left = [block.name for block in owned._blocks() if owned.is_ours(block)]
    check(not left, f"no data of Firetwin is left after removal: {left}")
    tree = compat.compositor(scene)
    check(tree is None or not tree.nodes, "nor a compositor without a picture")


def _blurred(pixels: np.ndarray) -> np.ndarray:
    """Means of 9 by 16 pixels."""
    return pixels.reshape(4, 9, 4, 16, 3).mean(axis=(1, 3))


def composited(scene: bpy.types.Scene) -> bool:
    """Return True if the compositor writes our passes."""
    nodes = compat.compositor(scene)
    return nodes is not None and any(owned.is_ours(node) for node in nodes.nodes)


def picture(scene: bpy.types.Scene, blend: Path, name: str) -> np.ndarray:
    """The frame in the middle as F12 renders it."""
    scene.frame_set(2)
    path = blend.parent / f"{blend.stem}-{VERSION}-{name}.png"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    pixels = np.asarray(sensor.read_image(path))[..., :3]
    check(pixels.std() > 0.03, f"{path.name} shows something: {pixels.std():.3f}")
    return pixels


if __name__ == "__main__":
    verb, *paths = sys.argv[1:]
    bpy.ops.wm.read_factory_settings()
    firetwin.register()
    navigation.camera_from_view = lambda context: (EYE.copy(), 30.0, 36.0)  # there is no view here
    if verb == "save":
        save(*map(Path, paths))
    else:
        found = [path for path in sorted(Path(paths[0]).glob("*.blend")) if not path.stem.endswith(VERSION)]
        for path in found:
            print(f"between: Blender {VERSION} opens {path.name}", file=sys.stderr)
            look(path, path.with_suffix(".toml"))
        check(bool(found), f"{len(found)} files of other Blenders")
    sys.stderr.flush()
    firetwin.unregister()
    sys.exit(bool(failures))
