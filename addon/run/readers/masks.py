"""Reader of burned masks as one GeoTIFF with a band per time, of learned forecasts and other models.

The name contains *burned*, *mask* or *fraction*. Times are the bands' descriptions (ISO 8601, or seconds with
`--start`), else one hour apart from `--start`. Values are 0 to 1; the largest value of integer masks is 1.
"""

from __future__ import annotations

import re
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...errors import input_error
from ..models import companion_rasters, from_arrival_time, masks, raster
from ..models.model import Model, Options

NAME, ORDER = "burned masks by time in one GeoTIFF", 70
MODELS = ""
RASTER = "or burned_mask.tif, with a band for each time"

_NAMED = re.compile(r"(?<![a-z])(burn(ed|t)?|masks?|fractions?)(?![a-z])")
_HOUR = 3600.0


def sniff(path: Path) -> bool:
    """Check whether a raster's name says that it has masks, as its values do not identify it."""
    return bool(_NAMED.search(path.stem.lower().replace("_", " "))) and raster.is_raster(path)


def read(paths: list[Path], options: Options) -> Model:
    """Read the masks as a model."""
    ours = [path for path in paths if sniff(path)]
    if len(ours) > 1:
        raise input_error(ours[1], f"is a second file of masks next to {ours[0].name}; write one file")
    first = raster.read(ours[0])
    bands, texts = raster.read_bands(ours[0])
    if len(bands) < 2:
        raise input_error(ours[0], "has one band; masks need a band for each time")
    options, times, note = _times(ours[0], texts, options)
    land = companion_rasters.find(paths, look=True)
    projection = options.projection or first.projection or land.projection
    grid, said = first.grid(projection, options.at)
    top = float(np.nanmax(bands)) if first.whole else 1.0
    dated_options = Options(options.start, options.at, projection, options.interval)

    def share(index: int) -> NDArray:
        return bands[index] / (top or 1.0)

    notes = [each for each in (note, said) if each]
    return masks.model(times, share, grid, land, dated_options, "burned masks", ours, notes)


def _times(path: Path, texts: list[str], options: Options) -> tuple[Options, NDArray[np.float64], str]:
    """Return the options with a start, times of the bands (s since then), and a note about them."""
    moments = [_moment(text) for text in texts]
    if all(moments):
        known = [each for each in moments if each is not None]
        times = masks.since(known)
        options, note = from_arrival_time.with_start(options, known[0]), ""
    else:
        from_arrival_time.begun(options, path)
        try:
            times, note = np.array([float(text) for text in texts]), ""
        except ValueError:
            times, note = _HOUR * np.arange(len(texts)), "bands have no times: they are taken as hourly"
    if (np.diff(times) <= 0.0).any():
        raise input_error(path, "the times of its bands do not ascend; order the bands by time")
    return options, times, note


def _moment(text: str) -> datetime | None:
    try:
        moment = datetime.fromisoformat(text.strip())
    except ValueError:
        return None
    return moment.astimezone(UTC) if moment.tzinfo else moment.replace(tzinfo=UTC)
