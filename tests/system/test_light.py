import json
import os
import subprocess
import sys

import pytest

_CONFIGURATION = """ocio_profile_version: 2
search_path: ""
roles: {{reference: Linear, scene_linear: Linear, default: Linear, data: Linear, color_picking: sRGB}}
displays:
  sRGB: [{views}]
active_displays: [sRGB]
active_views: []
colorspaces:
  - !<ColorSpace> {{name: Linear, encoding: scene-linear, isdata: false}}
  - !<ColorSpace>
    name: sRGB
    isdata: false
    from_reference: !<ExponentTransform> {{value: [2.2, 2.2, 2.2, 1]}}
"""
_BUILD = """
import json, sys
import bpy
sys.path[:0] = {path!r}
from firetwin.scene.light import build as light
bpy.ops.wm.read_factory_settings(use_empty=True)
view = bpy.context.scene.view_settings
print(json.dumps([light._set_view_transform(view), view.view_transform, view.look]))
"""


@pytest.mark.parametrize("views", [("Raw",), ("Standard", "Filmic"), ("Standard", "AgX")])
def test_colours_without_agx_fall_back_and_say_so_once(tmp_path, views):
    described = ", ".join(f"!<View> {{name: {view}, colorspace: sRGB}}" for view in views)
    (tmp_path / "config.ocio").write_text(_CONFIGURATION.format(views=described))
    done = subprocess.run(
        [sys.executable, "-c", _BUILD.format(path=sys.path)],
        env={**os.environ, "OCIO": str(tmp_path / "config.ocio")},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    # Blender's own lines come before or after it, as Python buffers its output or not.
    said = next(line for line in done.stdout.splitlines() if line.startswith("[["))
    sentences, transform, look = json.loads(said)
    best = next(view for view in ("AgX", "Filmic", "Standard", "Raw") if view in views)
    missing = "AgX - Medium High Contrast" if best == "AgX" else "AgX"
    assert (transform, look) == (best, "None")
    assert len(sentences) == 1
    assert f'"{missing}"' in sentences[0]
    assert f'"{best}"' in sentences[0]
