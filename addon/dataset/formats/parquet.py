"""Hugging Face parquet: rows with the bytes of the picture, boxes and facts. Needs pyarrow."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from ..truth import Truth
from . import common, hf

FORMAT = {"help": "parquet/: Hugging Face rows with pictures and boxes", "package": "pyarrow"}
ORDER = 50
FOLDER = "parquet"
_FACTS = {"index": "int64", "negative": "bool", "seconds_since_ignition": "float64"}  # others are strings
_LISTS = {"category": "int64", "distance_m": "float64", "name": "string", "visible_fraction": "float64"}
_ROWS = 100  # of a group


def write(set_folder: Path, samples: Sequence[Truth], out: Path) -> None:
    """Write the files of each split."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    (out / FOLDER).mkdir()
    schema = _schema(pa)
    for split, members in common.by_split(samples).items():
        parts = common.shards(set_folder, members, (common.PICTURE,))
        for number, part in enumerate(parts):
            path = out / FOLDER / f"{split}-{number:05d}-of-{len(parts):05d}.parquet"
            with pq.ParquetWriter(path, schema) as file:
                for first in range(0, len(part), _ROWS):
                    rows = [_row(set_folder, truth) for truth in part[first : first + _ROWS]]
                    file.write_table(pa.Table.from_pylist(rows, schema))


def _row(folder: Path, truth: Truth) -> dict[str, Any]:
    path = common.picture(truth)
    picture = {"bytes": (folder / path).read_bytes(), "path": Path(path).name}
    return {"image": picture, "objects": hf.objects(truth), "meta": json.dumps(asdict(truth))} | hf.facts(
        truth
    )


def _schema(pa: Any) -> Any:
    """Return the schema, with the features that the library `datasets` reads from its metadata."""
    kinds = {"int64": pa.int64(), "float64": pa.float64(), "bool": pa.bool_(), "string": pa.string()}
    facts = {name: _FACTS.get(name, "string") for name in ("meta", *_NAMES)}
    lists = [pa.field(name, pa.list_(kinds[kind])) for name, kind in _LISTS.items()]
    columns = [
        pa.field("image", pa.struct([("bytes", pa.binary()), ("path", pa.string())])),
        pa.field("objects", pa.struct([pa.field("bbox", pa.list_(pa.list_(pa.float64()))), *lists])),
        *(pa.field(name, kinds[kind]) for name, kind in facts.items()),
    ]
    value: dict[str, Any] = {
        name: {"dtype": kind, "_type": "Value"} for name, kind in (facts | _LISTS).items()
    }
    value["category"] = {"names": [each.name for each in common.THINGS], "_type": "ClassLabel"}
    number = {"dtype": "float64", "_type": "Value"}
    boxes = {"bbox": {"feature": {"feature": number, "_type": "List"}, "_type": "List"}}
    features = {
        "image": {"_type": "Image"},
        "objects": boxes | {name: {"feature": value[name], "_type": "List"} for name in _LISTS},
        **{name: value[name] for name in facts},
    }
    return pa.schema(columns, {"huggingface": json.dumps({"info": {"features": features}})})


_NAMES = ("index", "place", "run", "camera", "utc", "negative", "seconds_since_ignition")
