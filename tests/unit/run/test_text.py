"""Text grids: exact values, everything the format allows, and a clear error for the rest."""

import re
from fractions import Fraction

import firetwin_core as core
import numpy as np
import pytest
from firetwin.run import opening as runs
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


def test_files_that_cannot_be_read(tmp_path):
    with pytest.raises(core.InputError, match="the file is missing"):
        read_grid(tmp_path / "none.txt")
    with pytest.raises(core.InputError, match="not a regular file"):
        read_grid(tmp_path)


# Short numbers, which the reader reads in a special way.

AFTER = "\n# the end of a file is read in the plain way; this keeps it away from the numbers\n"


def read_short(grid_of, words):
    return grid_of(" ".join(words) + AFTER)[0]


@st.composite
def words(draw):
    """Numbers of up to 20 digits, with a point anywhere and an exponent in any spelling."""
    digits = draw(st.text("0123456789", min_size=1, max_size=20))
    point = draw(st.integers(0, len(digits)))
    body = draw(st.sampled_from([digits, f"{digits[:point]}.{digits[point:]}"]))
    power = draw(st.integers(-30, 15))
    exponent = draw(st.sampled_from(["", f"e{power:+03d}", f"E{power:d}", f"e{power:+04d}", f"e{power:02d}"]))
    return draw(st.sampled_from(["", "-"])) + body + exponent


@settings(deadline=None, max_examples=examples(300))
@given(st.lists(words(), min_size=1, max_size=30))
@example(["8.406433e+03", "-0.000000e+00", "0", ".5", "5.", "5.e+01", ".5E-3", "123456789012345", "1e22"])
@example(["16777217", "16777217.0000001", "16777216.9999999", "1e-22", "999999999999999e+22", "1e-023"])
def test_every_short_value_is_the_nearest_float32(grid_of, numbers):
    found = read_short(grid_of, numbers)
    np.testing.assert_array_equal(found, [nearest_float32(word) for word in numbers])
    assert np.signbit(found).tolist() == [word.startswith("-") for word in numbers]


def test_numbers_whose_nearest_double_lies_between_two_floats(grid_of):
    """Rounding by way of a double goes wrong for half of these."""
    random = np.random.default_rng(2)
    words = []
    for _ in range(4000):
        low = np.float32(random.uniform(1.0, 10.0) * 10.0 ** random.integers(-7, 22))
        middle = (float(low) + float(np.nextafter(low, np.float32(np.inf)))) / 2.0
        word = f"{middle:.14e}"
        if float(word) == middle and Fraction(word) != Fraction(middle):
            words.append(word)
    assert len(words) > 50
    expected = [nearest_float32(word) for word in words]
    assert sum(np.float32(float(word)) != value for word, value in zip(words, expected, strict=True)) > 10
    np.testing.assert_array_equal(read_short(grid_of, words), expected)


@pytest.mark.parametrize("word", ["1e+", "1e", "1.e+x1", "--1", "-", ".", "1e+01x", "1.2.3", "1e1.5", "0x10"])
def test_what_only_begins_like_a_number_is_an_error(grid_of, word):
    with pytest.raises(core.InputError, match=f"'{re.escape(word)}' is not a number"):
        read_short(grid_of, ["1.5", word])


def test_axes_are_the_nearest_doubles(make_run):
    """They are read as float64, straight from the text."""
    folder = make_run("text")
    axes = {
        "latitude": [f"{38.9 + 0.0031 * i:.12f}" for i in range(4)],
        "longitude": [f"{-120.6 + 0.0041 * i:.14f}" for i in range(5)],  # of 17 digits: too many for a double
    }
    for name, words in axes.items():
        (folder / f"{name}.txt").write_text(" ".join(words) + AFTER)
    run = runs.open(folder)
    for name, words in axes.items():
        assert getattr(run, name).tolist() == list(map(float, words))
