"""Stories: a complete film of cards and a map, and the cut of an artist in its project."""

import re
import shutil
import subprocess

import bpy
import pytest
import whole_run
from firetwin import cli
from firetwin.story import story_file


@pytest.fixture
def told(tmp_path):
    """Command line of a story of a card, a map and a card, each of a second, with its folder."""
    run, out = whole_run.write(tmp_path / "run", cells=32), tmp_path / "out"
    words = ["story", str(run), "--out", str(out), "--size", "64x36", "--resume"]
    assert cli.main([*words, "--storyboard"]) == 0
    path = out / story_file.NAME
    blocks = path.read_text().split("\n\n")
    kept = [block for block in blocks if "[[" not in block or re.search('name = "(title|growth|end)"', block)]
    path.write_text(re.sub(r"(?m)^seconds = [\d.]+", "seconds = 1.0", "\n\n".join(kept)) + "\n")
    return words, out


def _probed(film):
    """Size, number of frames and timecode of a film, by ffprobe."""
    entries = "stream=width,height,nb_frames:stream_tags=timecode"
    words = ["ffprobe", "-v", "error", "-select_streams", "v", "-show_entries", entries, "-of", "csv=p=0"]
    return subprocess.run([*words, film], capture_output=True, text=True, check=True).stdout.strip()


def test_a_story_becomes_a_film_and_a_project_whose_cut_stays(told, capsys):
    words, out = told
    assert cli.main(words) == 0
    if shutil.which("ffprobe"):
        assert _probed(out / "story.mp4") == "64,36,48,01:00:00:00"  # three seconds, less two dissolves
    assert {".otio", ".xml", ".edl"} <= {path.suffix for path in out.glob("story.*")}
    maps = sorted((out / "shots" / "growth" / "map").glob("*.png"))
    assert len(maps) == 12
    drawn = [path.stat().st_mtime_ns for path in maps]

    bpy.ops.wm.open_mainfile(filepath=str(out / "story.blend"))
    strips = bpy.data.scenes["Story"].sequence_editor.strips
    assert {"title", "growth", "end", "growth facts 1", "mark"} <= {each.name for each in strips}
    assert strips["growth"].directory.startswith("//shots/growth/map")
    strips["end"].frame_start += 12
    bpy.ops.wm.save_mainfile()

    assert cli.main(words) == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "story.blend"))
    assert bpy.data.scenes["Story"].sequence_editor.strips["end"].frame_final_start == 37
    assert [path.stat().st_mtime_ns for path in maps] == drawn
    assert "it is now story.blend1" in capsys.readouterr().err
