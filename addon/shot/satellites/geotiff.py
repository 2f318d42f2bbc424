"""GeoTIFF export of satellite pictures, through rasterio (GDAL)."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ... import extras, output
from ...errors import Error
from .imager import ImagerPicture, Instrument, PowerBand


def write(
    path: Path,
    picture: ImagerPicture,
    instrument: Instrument,
    run: str,
    moment: datetime,
    overwrite: bool = False,
) -> None:
    """Write four bands of 32-bit floats: brightness temperatures (K), fire radiative power (W) and the mask.

    Raises
    ------
    Error
        rasterio is not installed.
    """
    rasterio = _rasterio()
    layers: dict[str, NDArray] = {
        f"brightness temperature at {instrument.short:g} um, K": picture.short,
        f"brightness temperature at {instrument.long:g} um, K": picture.long,
        "fire radiative power, W": picture.power,
        f"fire mask: 0 none, 10 fire, 11 saturated at {instrument.short:g} um": picture.mask,
    }
    x, y = picture.grid.corner(picture.row, picture.column)
    across, down = picture.grid.step
    profile = {
        "driver": "GTiff",
        "height": picture.short.shape[0],
        "width": picture.short.shape[1],
        "count": len(layers),
        "dtype": "float32",
        "crs": rasterio.crs.CRS.from_user_input(picture.grid.crs),
        "transform": rasterio.Affine(across, 0.0, x, 0.0, down, y),
        "compress": "deflate",
    }

    def fill(part: Path) -> None:
        with rasterio.open(part, "w", **profile) as made:
            for number, (name, layer) in enumerate(layers.items(), 1):
                made.write(layer.astype(np.float32), number)
                made.set_band_description(number, name)
            made.update_tags(
                title=instrument.title,
                note=instrument.hypothetical,
                run=run,
                time=moment.isoformat(timespec="seconds"),
                heat_of_the_run_W=f"{picture.heat:.6g}",
                power_from=_source(instrument.power, picture),
            )

    output.write(path, fill, overwrite)


def _source(band: PowerBand, picture: ImagerPicture) -> str:
    """Describe the band of fire radiative power, and whether saturation limits it."""
    text = f"{band.name} at {band.wave:g} um, saturated from {band.saturation:g} K"
    return f"{text}: in {picture.limited} of its pixels, where power is less than there is"


def _rasterio() -> ModuleType:
    try:
        import rasterio
    except ModuleNotFoundError:
        reason = f"GeoTIFF needs rasterio; install it with: {extras.install('raster')}"
        raise Error(reason) from None
    return rasterio
