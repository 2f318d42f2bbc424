"""Write the fields of a run folder, as .npy arrays or as text."""

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import ClassVar

import numpy as np
from numpy.lib.format import write_array_header_1_0
from numpy.typing import NDArray

Put = Callable[[int, Sequence[NDArray]], None]


class NpyWriter:
    """One .npy per field; a series is one float32 array [nt, ny, nx]."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def field(self, name: str, values: NDArray) -> None:
        """Write a field that does not change with time."""
        np.save(self.folder / f"{name}.npy", values)

    @contextmanager
    def series(self, names: Sequence[str], times: int, shape: tuple[int, int]) -> Iterator[Put]:
        """Give a function put(index, fields), which stores one time of all the named fields."""
        with ExitStack() as stack:  # written, not mapped into memory: a full disk ends a process that maps
            files = [stack.enter_context((self.folder / f"{name}.npy").open("wb")) for name in names]
            for file in files:
                described = {"descr": "<f4", "fortran_order": False, "shape": (times, *shape)}
                write_array_header_1_0(file, described)
            begin, size = files[0].tell(), 4 * math.prod(shape)

            def put(index: int, fields: Sequence[NDArray]) -> None:
                for file, values in zip(files, fields, strict=True):
                    file.seek(begin + index * size)
                    file.write(np.ascontiguousarray(values, "<f4"))

            yield put


class TextWriter:
    """One text file per field, and per time in a series: rows of numbers separated by blanks.

    Text is made by looking numbers up in a table of whole steps, many times faster than formatting each.
    """

    # Steps of 1 W/m2, 0.1 K and 0.1 m/s: half a step is the error of the text.
    STEPS: ClassVar = {"heat_flux": 1.0, "temperature": 0.1, "wind_east": 0.1, "wind_north": 0.1}

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.tables = {step: _Numerals(step) for step in set(self.STEPS.values())}

    def field(self, name: str, values: NDArray) -> None:
        """Write a field that does not change with time, digits enough to give its bits back."""
        digits = 17 if values.dtype == np.float64 else 9
        rows = np.atleast_2d(values) if values.ndim == 2 else values[:, None]
        text = "\n".join(" ".join(f"{value:.{digits}g}" for value in row) for row in rows.tolist())
        (self.folder / f"{name}.txt").write_text(text + "\n", encoding="ascii", newline="\n")

    @contextmanager
    def series(self, names: Sequence[str], times: int, shape: tuple[int, int]) -> Iterator[Put]:
        """Give a function put(index, fields), which stores one time of all the named fields."""
        digits = max(6, len(str(times - 1)))
        for name in names:
            (self.folder / name).mkdir()

        def put(index: int, fields: Sequence[NDArray]) -> None:
            for name, values in zip(names, fields, strict=True):
                path = self.folder / name / f"{index:0{digits}d}.txt"
                path.write_text(self._text(values, self.STEPS[name]), encoding="ascii", newline="\n")

        yield put

    def _text(self, values: NDArray, step: float) -> str:
        look = self.tables[step].__getitem__
        whole = np.rint(values / step).astype(np.int64).tolist()
        return "\n".join(" ".join(map(look, row)) for row in whole) + "\n"


class _Numerals(dict[int, str]):
    """Whole number of steps -> its text, made when first asked for."""

    def __init__(self, step: float) -> None:
        super().__init__()
        self.step = step

    def __missing__(self, number: int) -> str:
        self[number] = text = f"{number * self.step:.10g}"
        return text
