"""The .npy reader: NumPy's own files, and headers that lie."""

import io

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core.run import read_grid


def npy_bytes(header: str, data: bytes = b"", version: tuple[int, int] = (1, 0)) -> bytes:
    text = header.encode("latin1")
    size = len(text).to_bytes(2 if version[0] == 1 else 4, "little")
    return b"\x93NUMPY" + bytes(version) + size + text + data


GOOD = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }"
DATA = np.arange(6, dtype="<f4").tobytes()


@pytest.fixture
def grid_of(tmp_path):
    path = tmp_path / "grid.npy"

    def read(content: bytes):
        path.write_bytes(content)
        return read_grid(path)

    return read


@pytest.mark.parametrize("dtype", ["<f4", "<f8"])
@pytest.mark.parametrize("version", [(1, 0), (2, 0), (3, 0)])
def test_reads_what_numpy_writes(grid_of, dtype, version):
    array = np.random.default_rng(6).normal(size=(7, 5)).astype(dtype)
    stream = io.BytesIO()
    np.lib.format.write_array(stream, array, version=version)
    np.testing.assert_array_equal(grid_of(stream.getvalue()), array.astype(np.float32))


def test_is_told_by_content_not_by_name(tmp_path):
    path = tmp_path / "grid.txt"
    path.write_bytes(npy_bytes(GOOD, DATA))
    np.testing.assert_array_equal(read_grid(path), [[0, 1, 2], [3, 4, 5]])


def test_keys_in_any_order_and_quotes(grid_of):
    header = '{"shape":(2,3,),"fortran_order":False,"descr":"<f4"}\n'
    assert grid_of(npy_bytes(header, DATA)).shape == (2, 3)


@pytest.mark.parametrize(
    ("content", "reason"),
    [
        (b"", "is not a .npy file"),
        (b"\x93NUMP", "is not a .npy file"),
        (b"\x93NUMPY\x01\x00", "is not a .npy file"),
        (b"PK\x03\x04 something else", "is not a .npy file"),
        (npy_bytes(GOOD, DATA, (9, 0)), "unknown .npy version"),
        (npy_bytes(GOOD, DATA)[:40], "truncated"),
        (b"\x93NUMPY\x02\x00\xff\xff\xff\xff", "truncated"),
        (npy_bytes(GOOD, DATA[:-1]), r"says \(2, 3\) of 4 bytes each, but 23 bytes"),
        (npy_bytes(GOOD, DATA + b"\0"), "25 bytes of data follow"),
        (npy_bytes(GOOD.replace("2, 3", "18446744073709551615, 3"), DATA), "says"),
        (npy_bytes(GOOD.replace("2, 3", "99999999999999999999, 3"), DATA), "damaged"),
        (npy_bytes(GOOD.replace("2, 3", "4611686018427387904, 4"), b""), "says"),
        (npy_bytes(GOOD.replace("2, 3", "-2, 3"), DATA), "damaged"),
        (npy_bytes(GOOD.replace("2, 3", "0, 3"), b""), "holds no numbers"),
        (npy_bytes(GOOD.replace("2, 3", ""), DATA[:4]), "two dimensions"),
        (npy_bytes(GOOD.replace("2, 3", "1, 2, 3"), DATA), "two dimensions"),
        (npy_bytes(GOOD.replace("<f4", "|O"), DATA), "Python objects"),
        (npy_bytes(GOOD.replace("'<f4'", "[('a', '<f4')]"), DATA), "holds records"),
        (npy_bytes(GOOD.replace("'shape'", "'shapes'"), DATA), "damaged"),
        (npy_bytes(GOOD.replace("'shape': (2, 3), ", ""), DATA), "damaged"),
        (npy_bytes(GOOD.replace("}", "'shape': (2, 3)}"), DATA), "damaged"),
        (npy_bytes(GOOD + "; import os", DATA), "damaged"),
        (npy_bytes("", DATA), "damaged"),
        (npy_bytes("{'descr': '<f4", DATA), "damaged"),
    ],
)
def test_headers_that_lie(grid_of, content, reason):
    with pytest.raises(core.InputError, match=reason):
        grid_of(content)


def test_doubles_too_large_for_a_float(grid_of, tmp_path):
    for value, ok in ((3.4028235e38, True), (3.4028236e38, False), (np.inf, True), (np.nan, True)):
        np.save(tmp_path / "wide.npy", np.array([[0.0, value]]))
        if ok:
            with np.errstate(over="ignore"):
                np.testing.assert_array_equal(read_grid(tmp_path / "wide.npy")[0, 1], np.float32(value))
        else:
            with pytest.raises(core.InputError, match=r"value 1 .* too large"):
                read_grid(tmp_path / "wide.npy")
