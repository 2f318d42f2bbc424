"""Numbers on smoke in pictures, where taste argues: its outline, and whether its lumps have one size.

    python tests/benchmarks/smoke_pictures.py WITH.png WITHOUT.png [--brighter] [--json]

WITHOUT is the same picture of the same scene with `smoke.enabled = false` and the same `light.exposure`.
Smoke is where a colour differs by more than a threshold, or with --brighter where one is that much brighter:
from above its shadow on the ground is no smoke, and before the sky only what lies above the horizon, with
--upper, can be told from it. Everything is done for two thresholds. Needs SciPy.
`gallery.py` makes such pictures and measures them.

Outline: the perimeter of blobs goes as their area to the power D / 2. D is 1 for balls, 1.35 for clouds on
all scales from 1 to 1000 km (Lovejoy 1982, "Area-perimeter relation for rain and cloud areas", Science 216).
Where there are few blobs, one large column, say, the length of all outlines goes as that of the ruler they
are measured with to the power 1 - D (Mandelbrot 1967, "How long is the coast of Britain?", Science 156).
Spectrum: power of brightness over wavenumber, of squares that smoke fills: its slope in a power law's fit,
and the largest bump over that fit with the wavelength where it is. Lumps of one size stand out; without a
preferred size nothing does.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from optical import brightness, colours
from scipy import ndimage

THRESHOLDS = (0.06, 0.12)  # of the brightness as it is shown, 0 to 1
SMALLEST = 12  # px: smaller blobs are left out
RULERS = (1, 2, 4, 8)  # px
LARGEST = 3  # rulers: the least width of what the longest can measure
SQUARE = 32  # px, side of a square of the spectrum
FILLED = 0.95  # of it that smoke has to fill
BANDS = 8
LONGEST = 16.0  # px, wavelength from which on bumps are looked for; longer ones are too few to tell
FINEST = 3.0  # px: below lie the pixels' own filter and grain

Picture = NDArray[np.float64]
Mask = NDArray[np.bool_]


def outline(smoke: Mask) -> tuple[float, int]:
    """Perimeter-area dimension of the blobs of a mask, and how many they are.

    Perimeters are edges of pixels, holes' counted; blobs that touch the picture's sides are left out, as
    their outline there is not theirs. Digital discs of 5 to 60 px have 0.97.
    """
    labels, _ = ndimage.label(smoke)
    perimeters, areas = [], []
    for number, place in enumerate(ndimage.find_objects(labels), 1):
        sides = [(part.start, part.stop, whole) for part, whole in zip(place, smoke.shape, strict=True)]
        blob = np.pad(labels[place] == number, 1)
        area = int(blob.sum())
        if area < SMALLEST or any(start == 0 or stop == whole for start, stop, whole in sides):
            continue
        perimeters.append(_edges(blob))
        areas.append(area)
    if len(areas) < 5:
        return float("nan"), len(areas)
    return 2.0 * float(np.polyfit(np.log(areas), np.log(perimeters), 1)[0]), len(areas)


def ruler(smoke: Mask) -> float:
    """Dimension of the outlines of a mask's large blobs together, by the length of the ruler.

    Blobs less than `LARGEST` rulers wide, which the longest would miss, are left out. Discs of 40 to 100 px
    have 1.02 to 1.03, Koch's islands of 60 to 200 px 1.27 to 1.30 where 1.26 is theirs.
    """
    labels, count = ndimage.label(smoke)
    sizes = ndimage.sum_labels(smoke, labels, range(count + 1))
    large = smoke & (sizes >= (LARGEST * RULERS[-1]) ** 2)[labels]
    lengths = []
    for side in RULERS:
        rows, columns = (count // side for count in smoke.shape)
        squares = large[: rows * side, : columns * side].reshape(rows, side, columns, side)
        lengths.append(side * _edges(squares.mean((1, 3)) >= 0.5))
    if min(lengths) == 0:
        return float("nan")
    return 1.0 - float(np.polyfit(np.log(RULERS), np.log(lengths), 1)[0])


def _edges(mask: Mask) -> int:
    """Edges of pixels between a mask and what is not in it."""
    return sum(int(np.abs(np.diff(mask.astype(np.int8), axis=axis)).sum()) for axis in (0, 1))


def spectrum(picture: Picture, smoke: Mask) -> tuple[float, float, float, int]:
    """Slope of the power of brightness within smoke, largest bump, its wavelength (px), and squares.

    A bump is a band's power over what the power law through all bands has there.
    """
    window = np.hanning(SQUARE)[:, None] * np.hanning(SQUARE)
    power, count = np.zeros((SQUARE, SQUARE)), 0
    step = SQUARE // 3
    for j in range(0, picture.shape[0] - SQUARE + 1, step):
        for i in range(0, picture.shape[1] - SQUARE + 1, step):
            part = np.s_[j : j + SQUARE, i : i + SQUARE]
            if smoke[part].mean() >= FILLED:
                square = _flattened(picture[part])
                power += np.abs(np.fft.fft2(square * window)) ** 2
                count += 1
    if count == 0:
        return float("nan"), float("nan"), float("nan"), 0
    frequency = np.hypot(*np.meshgrid(*[np.fft.fftfreq(SQUARE)] * 2))
    edges = np.geomspace(1.0 / LONGEST, 1.0 / FINEST, BANDS + 1)
    band = np.digitize(frequency, edges) - 1
    inside = [band == n for n in range(BANDS)]
    mean = np.array([power[each].mean() for each in inside if each.any()])
    middle = np.array([np.exp(np.log(frequency[each]).mean()) for each in inside if each.any()])
    slope, start = np.polyfit(np.log(middle), np.log(mean), 1)
    bumps = mean / np.exp(start + slope * np.log(middle))
    return float(slope), float(bumps.max()), float(1.0 / middle[bumps.argmax()]), count


def _flattened(square: Picture) -> Picture:
    """Without mean and slopes: they are longer waves than a square holds."""
    j, i = np.indices(square.shape)
    plane = np.stack([np.ones(square.size), i.ravel(), j.ravel()], 1)
    return square - (plane @ np.linalg.lstsq(plane, square.ravel(), rcond=None)[0]).reshape(square.shape)


def measured(smoky: Path, clear: Path, brighter: bool, upper: float = 1.0) -> dict[str, dict[str, float]]:
    """All numbers of a picture for each threshold; `upper` is the part of its rows that counts, from its top.

    Raises
    ------
    ValueError
        The pictures differ in size.
    """
    with_smoke, without = colours(smoky), colours(clear)
    if with_smoke.shape != without.shape:
        raise ValueError(f"{smoky} and {clear} differ in size")
    rows = round(upper * len(without))
    with_smoke, without = with_smoke[:rows], without[:rows]
    change, shown, found = with_smoke - without, brightness(with_smoke), {}
    for threshold in THRESHOLDS:
        smoke = (change if brighter else np.abs(change)).max(axis=-1) > threshold
        dimension, blobs = outline(smoke)
        slope, bump, wave, squares = spectrum(shown, smoke)
        found[f"{threshold:g}"] = {
            "share_of_picture": float(smoke.mean()),
            "dimension": dimension,
            "blobs": blobs,
            "ruler_dimension": ruler(smoke),
            "slope": slope,
            "bump": bump,
            "bump_px": wave,
            "squares": squares,
        }
    return found


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("smoky", type=Path, metavar="WITH.png")
    parser.add_argument("clear", type=Path, metavar="WITHOUT.png")
    parser.add_argument("--brighter", action="store_true", help="darker places are shadow, not smoke")
    parser.add_argument("--upper", type=float, default=1.0, help="part of the rows that counts, from the top")
    parser.add_argument("--json", action="store_true")
    given = parser.parse_args()
    try:
        found = measured(given.smoky, given.clear, given.brighter, given.upper)
    except ValueError as error:
        parser.error(str(error))
    if given.json:
        print(json.dumps(found))
        return
    for threshold, values in found.items():
        print(f"threshold {threshold}: " + ", ".join(f"{name} {value:.3g}" for name, value in values.items()))


if __name__ == "__main__":
    main()
