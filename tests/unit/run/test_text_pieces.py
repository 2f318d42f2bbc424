"""Text grids are read piece by piece (of 256 KiB); nobody sees where one ends."""

import numpy as np
import pytest
from firetwin_core import InputError
from firetwin_core.run import read_grid

PIECE = 1 << 18


def numbers(rows, columns):
    return np.random.default_rng(rows).normal(0, 1e3, (rows, columns)).astype(np.float32)


def text(values, end="\n"):
    return end.join(" ".join(f"{value:.9g}" for value in row) for row in values)


@pytest.mark.parametrize("end", ["\n", "\r\n", " # rest\n", "\n\n# between\n"])
@pytest.mark.parametrize("after", ["", "\n", "\n\n"])
@pytest.mark.parametrize(("rows", "columns"), [(900, 90), (2, 60_000), (1, 150_000), (150_000, 1)])
def test_every_row_arrives(tmp_path, rows, columns, end, after):
    values = numbers(rows, columns)
    path = tmp_path / "grid.txt"
    path.write_bytes(b"\xef\xbb\xbf" + (text(values, end) + after).encode())
    assert path.stat().st_size > 2 * PIECE
    np.testing.assert_array_equal(read_grid(path), values)


@pytest.mark.parametrize("more", range(-3, 4))
def test_lines_that_end_where_a_piece_ends(tmp_path, more):
    """Comments make the first line end there, a byte or two before, or after; CRLF may be torn apart."""
    path = tmp_path / "grid.txt"
    path.write_bytes(b"1.5 2.5 #" + b"x" * (PIECE - 11 + more) + b"\r\n3.5 4.5\r\n" + b"#" * PIECE)
    np.testing.assert_array_equal(read_grid(path), [[1.5, 2.5], [3.5, 4.5]])


@pytest.mark.parametrize("row", [0, 450, 899])
def test_errors_name_the_place_in_the_file(tmp_path, row):
    lines = text(numbers(900, 90)).split("\n")
    words = lines[row].split(" ")
    column = len(" ".join(words[:50])) + 2
    lines[row] = " ".join([*words[:50], "4x2", *words[51:]])
    path = tmp_path / "grid.txt"
    path.write_text("\n".join(lines))
    with pytest.raises(InputError, match="'4x2' is not a number") as error:
        read_grid(path)
    assert (error.value.line, error.value.column) == (row + 1, column)


def test_a_ragged_row_far_down(tmp_path):
    path = tmp_path / "grid.txt"
    path.write_text(text(numbers(900, 90)) + "\n1 2 3\n")
    with pytest.raises(InputError, match="3 values where the first has 90") as error:
        read_grid(path)
    assert error.value.line == 901


def test_nothing_but_comments(tmp_path):
    path = tmp_path / "grid.txt"
    path.write_bytes(b"# nothing\n" * 60_000)
    with pytest.raises(InputError, match="holds no numbers"):
        read_grid(path)
