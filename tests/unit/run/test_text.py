"""Text grids: exact values, everything the format allows, and a clear error for the rest."""

from fractions import Fraction

import firetwin_core as core
import numpy as np
import pytest
from firetwin_core.run import read_grid
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples


@pytest.fixture(scope="module")
def grid_of(tmp_path_factory):
    path = tmp_path_factory.mktemp("text") / "grid.txt"

    def read(content):
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_grid(path)

    return read


def nearest_float32(text: str) -> np.float32:
    """The float32 nearest to a decimal text in exact arithmetic, ties to even."""
    exact = Fraction(text)
    guess = np.float32(float(exact))
    with np.errstate(over="ignore"):
        near = [np.nextafter(guess, np.float32(-np.inf)), guess, np.nextafter(guess, np.float32(np.inf))]
    return min(
        filter(np.isfinite, near), key=lambda f: (abs(Fraction(float(f)) - exact), int(f.view(np.uint32)) & 1)
    )


@settings(deadline=None, max_examples=examples(300))
@given(st.decimals(-(10**30), 10**30, allow_nan=False, allow_infinity=False) | st.floats(-1e30, 1e30))
@example(1 + 2**-24)
@example("1.00000005960464477539062500000000000000000000000000001")
@example("0.1")
@example("16777217")
@example("1.401298464324817e-45")
@example("1e-45")
@example("5e-46")
@example("3.4028235e38")
def test_every_value_is_the_nearest_float32(grid_of, number):
    text = str(number)
    assert grid_of(text)[0, 0] == nearest_float32(text)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        ("1 2\n3 4\n", [[1, 2], [3, 4]]),
        ("1 2\n3 4", [[1, 2], [3, 4]]),
        ("1\t2\r\n3\t4\r\n", [[1, 2], [3, 4]]),
        ("1,2\n3 , 4\n", [[1, 2], [3, 4]]),
        ("# head\n\n  1 2 # tail\n   \n3 4\n#end", [[1, 2], [3, 4]]),
        ("1.0D+03 -2.5d-1 +3 .5 6.", [[1000, -0.25, 3, 0.5, 6]]),
        (b"\xef\xbb\xbf7", [[7]]),
        ("nan -NaN inf -Infinity", [[np.nan, np.nan, np.inf, -np.inf]]),
        ("1e-400 -1e-400 1D-400 0e999999999", [[0, 0, 0, 0]]),
        ("1e38 0.00000000000000000000000000000000000000000000000001e-10", [[1e38, 0]]),
    ],
)
def test_what_the_format_allows(grid_of, content, expected):
    np.testing.assert_array_equal(grid_of(content), np.array(expected, np.float32))


def test_signs_of_zeros_stay(grid_of):
    assert np.signbit(grid_of("-0 0 -1e-400 1e-400")).tolist() == [[True, False, True, False]]


@pytest.mark.parametrize(
    ("content", "line", "column", "reason"),
    [
        ("", 0, 0, "holds no numbers"),
        ("# only a comment\n", 0, 0, "holds no numbers"),
        ("1 2\n3 x4\n", 2, 3, "'x4' is not a number"),
        ("1 2\n3 4x\n", 2, 3, "'4x' is not a number"),
        ("1 2\n3\n", 2, 1, "1 values where the first has 2"),
        ("1 2\n3 4 5\n", 2, 1, "3 values where the first has 2"),
        ("1,,2\n", 1, 3, "a value is missing"),
        (",1\n", 1, 1, "a value is missing"),
        ("1,2,,\n", 1, 5, "a value is missing"),
        ("12 ****\n", 1, 4, "Fortran format"),
        ("1e400\n", 1, 1, "too large"),
        ("1 -1e39\n", 1, 3, "too large"),
        ("1.0D+400", 1, 1, "too large"),
        ("1.0D+\n", 1, 1, "is not a number"),
        ("1e5D3\n", 1, 1, "is not a number"),
        ("+-1\n", 1, 1, "is not a number"),
        ("--1\n", 1, 1, "is not a number"),
        ("0x10\n", 1, 1, "is not a number"),
        ("1;2\n", 1, 1, "is not a number"),
        ("1 2\r3 4\n", 1, 3, "is not a number"),
        (b"1 \x00\n", 1, 3, r"\\x00"),
        (b"\xff\xfe1\x002\x00", 1, 1, r"\\xff"),
        ("1 " + "9" * 100 + "z", 1, 3, "is not a number"),
    ],
)
def test_everything_else_is_an_error_with_its_place(grid_of, content, line, column, reason):
    with pytest.raises(core.InputError, match=reason) as caught:
        grid_of(content)
    assert (caught.value.line, caught.value.column) == (line, column)
    assert caught.value.path.endswith("grid.txt")
    assert "\n" not in str(caught.value)


def test_same_as_numpy_on_a_large_grid(tmp_path):
    values = np.random.default_rng(5).lognormal(5, 3, (720, 720)).astype(np.float32)
    np.savetxt(tmp_path / "large.txt", values, fmt="%.9g")
    np.testing.assert_array_equal(read_grid(tmp_path / "large.txt"), values)


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(core.InputError, match="the file is missing"):
        read_grid(tmp_path / "none.txt")
    with pytest.raises(core.InputError, match="not a regular file"):
        read_grid(tmp_path)
