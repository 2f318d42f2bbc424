"""Fuzzing of netCDF files and NumPy archives: valid files with one deviation from the model's."""

import io
import tempfile
from pathlib import Path

import netCDF4
import numpy as np

FILLS = (np.nan, np.inf, -np.inf, 0.0, -1.0, 1e30, -9999.0, 3e38)
WORDS = (
    "",
    "x",
    "\x1b[31m\n",
    "0000-00-00_00:00:00",
    "days since the flood",
    "9" * 300,
    -1,
    np.nan,
    1e300,
    2**31 - 1,
)


def netcdf(whole, rng):
    """Bytes of a netCDF file with one variable, dimension or attribute changed, and a description."""
    with tempfile.TemporaryDirectory() as folder:
        before, after = Path(folder, "before"), Path(folder, "after")
        before.write_bytes(whole)
        with netCDF4.Dataset(before) as old, netCDF4.Dataset(after, "w", format=old.data_model) as new:
            old.set_auto_maskandscale(False)
            way = _copy(old, new, rng)
        return way, after.read_bytes()


def _copy(old, new, rng):
    name = str(rng.choice(list(old.variables)))
    way = str(
        rng.choice(["gone", "filled", "spoilt", "words", "type", "turned", "attribute", "size", "attributes"])
    )
    sizes = {each: len(dimension) for each, dimension in old.dimensions.items()}
    if way == "size":
        name = str(rng.choice(list(sizes)))
        least = (
            0 if old.data_model == "NETCDF4" else 1
        )  # size 0 is an unlimited dimension, of which netCDF-3 allows one
        sizes[name] = int(rng.choice([least, 1, 2, sizes[name] + 1]))
    for each, size in sizes.items():
        new.createDimension(each, size or None)
    attributes = {ncattr: old.getncattr(ncattr) for ncattr in old.ncattrs()}
    new.setncatts(_odd(attributes, rng) if way == "attributes" else attributes)
    for each, variable in old.variables.items():
        if (way, each) != ("gone", name):
            _variable(new, variable, sizes, way if each == name else "", rng)
    return f"{name} {way}"


def _variable(new, old, sizes, way, rng):
    dimensions, kind = old.dimensions, old.dtype
    if way == "turned":
        dimensions = (
            tuple(rng.permutation(dimensions)) if len(dimensions) > 1 else (*dimensions, *list(sizes)[:1])
        )
    if way in ("type", "words"):
        kind = np.dtype("S1") if way == "words" or (kind != "S1" and rng.integers(0, 2)) else np.dtype("i4")
    attributes = {ncattr: old.getncattr(ncattr) for ncattr in old.ncattrs()}
    fill = (
        attributes.pop("_FillValue", None)
        if kind == old.dtype
        else attributes.pop("_FillValue", None) and None
    )
    variable = new.createVariable(old.name, kind, dimensions, fill_value=fill)
    variable.set_auto_maskandscale(False)
    variable.setncatts(_odd(attributes, rng) if way == "attribute" else attributes)
    shape = tuple(sizes[dimension] or 0 for dimension in dimensions)
    if 0 in shape:
        return
    values = np.resize(old[...], shape)
    if way == "spoilt" and kind.kind == "f":
        values.flat[rng.integers(0, values.size, 3)] = rng.choice(FILLS)
    with np.errstate(all="ignore"):
        if kind.kind == "S":
            variable[...] = np.full(shape, b"q") if old.dtype != kind else values
        elif old.dtype.kind == "S":
            variable[...] = np.ones(shape, kind)
        else:
            variable[...] = (
                np.full(shape, rng.choice(FILLS)).astype(kind) if way == "filled" else values.astype(kind)
            )


def _odd(attributes, rng):
    if not attributes:
        return attributes
    name = str(rng.choice(list(attributes)))
    word = WORDS[rng.integers(0, len(WORDS))]
    return {k: v for k, v in attributes.items() if k != name} | ({name: word} if rng.integers(0, 4) else {})


def archive(whole, rng):
    """Bytes of a .npz with one array changed, and a description."""
    arrays = dict(np.load(io.BytesIO(whole)))
    name = str(rng.choice(list(arrays)))
    values = arrays.pop(name)
    shapes = ((), (1,), (0, 3), (1, 1), (2, 300), (3, 3, 3))
    ways = {
        "gone": lambda: None,
        "filled": lambda: np.full(values.shape, rng.choice(FILLS)),
        "shape": lambda: np.resize(values, shapes[rng.integers(0, len(shapes))]),
        "words": lambda: np.full(values.shape, "\x1b[31m"),
        "complex": lambda: values * 1j,
        "objects": lambda: np.full(values.shape, None, object),
        "strange": lambda: np.full(values.shape, 2**63, np.uint64),
    }
    way = str(rng.choice(list(ways)))
    changed, made = ways[way](), io.BytesIO()
    np.savez(made, **arrays, **({} if changed is None else {name: changed}))
    return f"{name} {way}", made.getvalue()
