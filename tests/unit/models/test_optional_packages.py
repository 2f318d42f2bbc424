"""Optional packages: a reader does not lock the file of a running model."""

import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("netCDF4")
WRITER = """
import sys
import netCDF4
data = netCDF4.Dataset(sys.argv[1], "w")
data.createDimension("time", None)
values = data.createVariable("flux", "f4", ("time",))
for time in range(2):
    values[time] = time + 1.0
    data.sync()
    print("written", flush=True)
    sys.stdin.readline()
data.close()
print("closed", flush=True)
"""
READER = """
import sys
from pathlib import Path
from firetwin.run.models import netcdf
file = netcdf.File(Path(sys.argv[1]))
print(file.read("flux").tolist(), flush=True)
sys.stdin.readline()
file.close()
"""


def start(code: str, path: Path) -> subprocess.Popen:
    return subprocess.Popen(
        [sys.executable, "-c", code, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
    )


def line(process: subprocess.Popen) -> str:
    return process.stdout.readline().strip()


def go_on(process: subprocess.Popen) -> None:
    process.stdin.write("\n")
    process.stdin.flush()


def test_a_model_that_writes_does_not_fail_while_its_file_is_read(tmp_path):
    """The reader opens the file between two writes, and holds it during the second."""

    with start(WRITER, tmp_path / "model.nc") as model:
        assert line(model) == "written"
        with start(READER, tmp_path / "model.nc") as reader:
            assert line(reader) == "[1.0]"
            go_on(model)
            assert line(model) == "written"
            go_on(reader)
        go_on(model)
        assert line(model) == "closed"
    assert model.returncode == reader.returncode == 0
