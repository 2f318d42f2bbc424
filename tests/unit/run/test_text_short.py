"""Short numbers, which the text reader reads in a special way, are as exact as others."""

import re
from fractions import Fraction

import numpy as np
import pytest
from firetwin.run import opening as runs
from firetwin_core import InputError
from firetwin_core.run import read_grid
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis_profiles import examples

AFTER = "\n# the end of a file is read in the plain way; this keeps it away from the numbers\n"


@pytest.fixture(scope="module")
def read(tmp_path_factory):
    path = tmp_path_factory.mktemp("text") / "grid.txt"

    def read(words):
        path.write_text(" ".join(words) + AFTER)
        return read_grid(path)[0]

    return read


def nearest(text):
    """The float32 nearest to a decimal text, by exact arithmetic, ties to even."""
    exact = Fraction(text)
    guess = np.float32(float(exact))
    near = [np.nextafter(guess, np.float32(-np.inf)), guess, np.nextafter(guess, np.float32(np.inf))]
    return min(near, key=lambda f: (abs(Fraction(float(f)) - exact), int(f.view(np.uint32)) & 1))


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
def test_every_short_value_is_the_nearest_float32(read, numbers):
    found = read(numbers)
    np.testing.assert_array_equal(found, [nearest(word) for word in numbers])
    assert np.signbit(found).tolist() == [word.startswith("-") for word in numbers]


def test_numbers_whose_nearest_double_lies_between_two_floats(read):
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
    expected = [nearest(word) for word in words]
    assert sum(np.float32(float(word)) != value for word, value in zip(words, expected, strict=True)) > 10
    np.testing.assert_array_equal(read(words), expected)


@pytest.mark.parametrize("word", ["1e+", "1e", "1.e+x1", "--1", "-", ".", "1e+01x", "1.2.3", "1e1.5", "0x10"])
def test_what_only_begins_like_a_number_is_an_error(read, word):
    with pytest.raises(InputError, match=f"'{re.escape(word)}' is not a number"):
        read(["1.5", word])


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
