"""The camera for headsets in Cycles: views of both eyes, and metadata of the files."""

import json
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest
from firetwin_core import sensor
from scene_text import NO_PLANTS, NO_SMOKE

SCENE = (
    """\
run = "{run}"
[time]
frames = 2
"""
    + NO_PLANTS
    + NO_SMOKE
    + """\
[render]
resolution = [64, 64]
samples = 1
passes = ["rgb"]
[[cameras]]
kind = "vr"
name = "headset"
[[cameras.keys]]
latitude = 38.825
longitude = -120.56
height = 400
target = "point"
target_latitude = 38.825
target_longitude = -120.51
"""
)


@pytest.mark.slow
def test_stills_and_films_say_what_they_are(run_folder, tmp_path):
    (tmp_path / "scene.toml").write_text(SCENE.format(run=run_folder))
    line = ["render", tmp_path / "scene.toml", "--out", tmp_path / "out"]
    result = subprocess.run(
        [sys.executable, "-m", "firetwin", *map(str, line)], capture_output=True, text=True
    )
    assert result.returncode == 0, result.stderr
    still = tmp_path / "out" / "headset" / "rgb" / "headset_rgb_000002.png"
    assert np.asarray(sensor.read_image(still)).shape[:2] == (64, 64)
    data = still.read_bytes()
    xmp = data[data.index(b"<x:xmpmeta") : data.index(b"</x:xmpmeta>") + 12]
    (found,) = ElementTree.fromstring(xmp).iter("{http://www.w3.org/1999/02/22-rdf-syntax-ns#}Description")
    pano = "{http://ns.google.com/photos/1.0/panorama/}"
    assert found.attrib[f"{pano}FullPanoWidthPixels"] == "64"
    assert float(found.attrib[f"{pano}PoseHeadingDegrees"]) == pytest.approx(90.0, abs=0.1)  # east
    film = tmp_path / "out" / "headset" / "headset_rgb.mp4"
    probe = ["ffprobe", "-v", "error", "-select_streams", "v", "-count_frames", "-show_streams"]
    probe += ["-of", "json", film]
    (stream,) = json.loads(subprocess.run(probe, capture_output=True, check=True).stdout)["streams"]
    assert stream["nb_read_frames"] == "2"
    sides = {side["side_data_type"]: side for side in stream["side_data_list"]}
    assert sides["Stereo 3D"]["type"] == "top and bottom"
    assert sides["Spherical Mapping"]["projection"] == "equirectangular"
