"""Whether anything pops in a film: what changes from frame to frame that motion does not explain.

    python tests/benchmarks/popping.py FRAMES --out popping.png [--side 16] [--from 1] [--to 120]

FRAMES is a folder of a camera's pictures. Each patch is looked for in the next one, and the mean difference
of brightness (of 0 to 1, as shown) left where it fits best is its change. Flames, grain and what comes
out from behind a tree change all the time; what pops changes once. So each change is told in medians: that
of the whole picture in the median of all frames, that of a patch in the median of its place in the
`_AROUND` frames before and after. Writes a plot of both, prints the largest and where it is.
"""

from __future__ import annotations

import argparse
import itertools
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from optical import luminance, smoothed

_REACH = 10  # px that a patch may move between two frames
_AROUND = 6  # frames
_LEAST = 0.004  # of brightness; less is not seen, and no patch's median counts as less


def changes(first: NDArray, second: NDArray, side: int) -> NDArray[np.float64]:
    """Changes (rows, columns) of patches of `side` px between two smoothed pictures, wherever they have gone.

    A patch goes where least is left of it, in steps of half a pixel; a border of `_REACH` px has none.
    """
    rows, columns = ((length - 2 * _REACH - 1) // side for length in first.shape)
    high, wide = rows * side, columns * side
    inner = first[_REACH : _REACH + high, _REACH : _REACH + wide]
    least = np.full((rows, columns), np.inf)
    for half_down, half_right in itertools.product((0, 1), repeat=2):
        between = 0.5 * (second + np.roll(second, -half_down, axis=0))
        between = 0.5 * (between + np.roll(between, -half_right, axis=1))
        for down, right in itertools.product(range(2 * _REACH), repeat=2):
            off = np.abs(between[down : down + high, right : right + wide] - inner)
            least = np.minimum(least, off.reshape(rows, side, columns, side).mean(axis=(1, 3)))
    return least


def in_medians(change: NDArray[np.float64]) -> NDArray[np.float64]:
    """Changes (t, n) of patches over the median of their neighbours in time."""
    padded = np.pad(change, [(_AROUND, _AROUND), (0, 0)], "reflect")
    windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * _AROUND + 1, axis=0)
    return change / np.maximum(np.median(windows, axis=-1), _LEAST)


def plot(frame: NDArray, change: NDArray, excess: NDArray, out: Path) -> None:
    """The whole picture's change, and the most that a patch changes in medians, over the frames."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 1, figsize=(9, 5), sharex=True)
    whole = change.mean(axis=1)
    axes[0].plot(frame, whole, lw=1.2)
    axes[0].axhline(np.median(whole), color="#bbbbbb", lw=0.8)
    axes[0].set_ylabel("change of the picture")
    axes[0].set_ylim(0.0, 1.15 * whole.max())
    axes[1].plot(frame, excess.max(axis=1), lw=1.2, label="the patch that changes most")
    axes[1].plot(frame, np.quantile(excess, 0.99, axis=1), lw=1.2, label="99 % of the patches change less")
    axes[1].set_ylabel("change of a patch, medians")
    axes[1].set_ylim(0.0, None)
    axes[1].legend(frameon=False)
    axes[1].set_xlabel("frame")
    figure.tight_layout()
    figure.savefig(out, dpi=110)


def main() -> None:
    """Compare consecutive pictures."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("frames", type=Path)
    parser.add_argument("--out", type=Path, required=True)
    parser.add_argument("--side", type=int, default=16)
    parser.add_argument("--from", type=int, default=1, dest="first")
    parser.add_argument("--to", type=int, default=None, dest="last")
    asked = parser.parse_args()
    paths = sorted(asked.frames.glob("*.png"))[asked.first - 1 : asked.last]
    pictures = [smoothed(luminance(path)) for path in paths]
    change = np.stack([changes(*pair, asked.side) for pair in itertools.pairwise(pictures)])
    columns, change = change.shape[2], change.reshape(len(change), -1)
    frame = asked.first + 1 + np.arange(len(change))
    whole, excess = change.mean(axis=1), in_medians(change)
    plot(frame, change, excess, asked.out)
    worst, patch = np.unravel_index(np.argmax(excess), excess.shape)
    down, right = (_REACH + (each + 0.5) * asked.side for each in divmod(patch, columns))
    print(
        f"the picture: median change {np.median(whole):.4f}, largest {whole.max() / np.median(whole):.2f} "
        f"medians (frame {frame[whole.argmax()]})\n"
        f"a patch: largest {excess.max():.1f} medians "
        f"(frame {frame[worst]}, {right:.0f} px right, {down:.0f} px down), "
        f"of all frames' largest the median {np.median(excess.max(axis=1)):.1f}"
    )


if __name__ == "__main__":
    main()
