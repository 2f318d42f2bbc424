"""The scripts in examples/, with a `firetwin` that only writes down its arguments."""

import shutil
import subprocess
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
FIRETWIN = """\
#!/usr/bin/env bash
echo "$*" >>../calls.txt
echo "listed by $1"
"""


@pytest.fixture
def script(tmp_path):
    """Run examples/king_fire.sh in a checkout that is set up already: script(arguments) -> its result."""
    examples, firetwin = tmp_path / "examples", tmp_path / ".venv/bin/firetwin"
    (examples / "out/sample").mkdir(parents=True)
    (examples / "out/sample/run.toml").touch()
    firetwin.parent.mkdir(parents=True)
    for path, text in ((firetwin, FIRETWIN), (examples / "sample.sh", "#!/usr/bin/env bash\n")):
        path.write_text(text)
        path.chmod(0o755)
    shutil.copy(EXAMPLES / "king_fire.sh", examples)

    def run(*arguments):
        command = [examples / "king_fire.sh", *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=60)

    return run


def _calls(folder):
    path = folder / "calls.txt"
    return path.read_text().splitlines() if path.exists() else []


@pytest.mark.parametrize("arguments", [("--stil",), ("still",), ("--all", "extra"), ("",)])
def test_what_it_does_not_know_ends_in_its_usage(script, tmp_path, arguments):
    result = script(*arguments)
    assert (result.returncode, result.stdout) == (2, "")
    assert result.stderr == "usage: examples/king_fire.sh [--still] [--all]\n"
    assert _calls(tmp_path) == []


def test_a_still_is_the_first_picture_of_the_drone(script, tmp_path):
    result = script("--still")
    assert result.returncode == 0, result.stderr
    assert _calls(tmp_path) == ["render king_fire.toml --out out/film --frames 1 --camera drone --resume"]
    assert result.stdout == f"{tmp_path}/examples/out/film/drone/rgb/drone_rgb_000001.png\n"


def test_the_film_is_told_before_its_scene_is_written(script, tmp_path):
    result = script()
    assert result.returncode == 0, result.stderr
    calls = _calls(tmp_path)
    assert sorted(calls[:2]) == ["info out/sample", "maps out/sample --out out/maps"]  # at the same time
    assert calls[2:] == [
        "render king_fire.toml --out out/film --camera drone --frames 1-24 --resume",
        "render king_fire.toml --out out/film --camera satellite --resume",
        "build king_fire.toml -o out/king_fire.blend",
    ]
    assert f"the film is finished: {tmp_path}/examples/out/film/drone/drone_rgb.mp4" in result.stderr
    assert "without its smoke volumes" in result.stderr.split("the film is finished")[1]
    assert "firetwin bake --volumes examples/king_fire.toml" in result.stdout


def test_all_frames_are_rendered_on_request(script, tmp_path):
    assert script("--all").returncode == 0
    assert "render king_fire.toml --out out/film --camera drone --frames 1-48 --resume" in _calls(tmp_path)


def test_maps_that_fail_are_reported(script, tmp_path):
    firetwin = tmp_path / ".venv/bin/firetwin"
    firetwin.write_text(FIRETWIN + '[[ $1 != maps ]] || { echo "no maps" >&2; exit 1; }\n')
    result = script()
    assert result.returncode == 1
    assert "no maps" in result.stderr


def test_nothing_is_announced_that_is_there_already(script, tmp_path):
    for name in ("maps/intensity.png", "king_fire.blend"):
        path = tmp_path / "examples/out" / name
        path.parent.mkdir(exist_ok=True)
        path.touch()
    result = script()
    assert [call.split()[0] for call in _calls(tmp_path)] == ["info", "render", "render"]
    assert "the film is finished" not in result.stderr
