"""Croissant metadata (version 1.0, https://docs.mlcommons.org/croissant): ``croissant.json``.

It describes ``samples.csv`` with its columns, and the file sets of pictures, maps and metadata. They are in
the same folder, so `contentUrl` is relative.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .. import output
from . import table, truth
from .about import About
from .files import CONTENT, KINDS

NAME = "croissant.json"
VERSION = "1.0.0"
_TERMS = (
    "citeAs column equivalentProperty extract field fileObject fileProperty fileSet "
    "format includes isLiveDataset jsonPath key md5 parentField path recordSet "
    "references regex repeated replace samplingRate separator source subField transform"
)
_CONTEXT = {
    "@language": "en",
    "@vocab": "https://schema.org/",
    "conformsTo": "dct:conformsTo",
    "cr": "http://mlcommons.org/croissant/",
    "rai": "http://mlcommons.org/croissant/RAI/",
    "data": {"@id": "cr:data", "@type": "@json"},
    "examples": {"@id": "cr:examples", "@type": "@json"},
    "dataType": {"@id": "cr:dataType", "@type": "@vocab"},
    "dct": "http://purl.org/dc/terms/",
    "sc": "https://schema.org/",
    **{name: f"cr:{name}" for name in _TERMS.split()},
}
_MIME = {".jpg": "image/jpeg", ".png": "image/png", ".tif": "image/tiff", ".json": "application/json"}
DESCRIPTION = (
    "Synthetic pictures of wildfires with labels of fire and smoke: boxes, masks, opacity of smoke, depth "
    "and temperature. Fires come from runs of fire models; pictures are rendered."
)
LIMITS = (
    "Vegetation, optics of smoke and sensors are simulated. The set is meant for pre-training and stress "
    "tests, and does not replace real pictures."
)


def write(
    folder: Path,
    about: About,
    hashes: Mapping[str, str],
    licences: Mapping[str, str],
    overwrite: bool = False,
) -> None:
    """Write the metadata.

    Parameters
    ----------
    hashes
        SHA-256 of `samples.csv` by its path.
    licences
        Licence of each source.
    """
    content = document(folder, about, hashes[table.NAME], licences)
    text = json.dumps(content, indent=1, ensure_ascii=False) + "\n"
    output.write_text(folder / NAME, text, overwrite)


def document(folder: Path, about: About, table_hash: str, licences: Mapping[str, str]) -> dict[str, Any]:
    """Make the metadata of a data set."""
    named_licences = sorted(
        {licence for licence in (about.licence, *licences.values()) if licence and " " not in licence}
    )
    return {
        "@context": _CONTEXT,
        "@type": "Dataset",
        "conformsTo": "http://mlcommons.org/croissant/1.0",
        "name": about.title,
        "version": VERSION,
        "description": DESCRIPTION,
        "rai:dataBiases": LIMITS,
        "rai:dataCollection": "Rendered by Firetwin from draws with a seed for each value",
        "rai:personalSensitiveInformation": "none",
        **({"license": [_address(name) for name in named_licences]} if named_licences else {}),
        "distribution": [_table(table_hash), *_file_sets(folder)],
        "recordSet": [_records()],
    }


def _address(licence: str) -> str:
    """Return the address of a licence of SPDX's list, or the name of another one."""
    return licence if licence.startswith("LicenseRef-") else f"https://spdx.org/licenses/{licence}.html"


def _table(table_hash: str) -> dict[str, Any]:
    return {
        "@type": "cr:FileObject",
        "@id": table.NAME,
        "name": table.NAME,
        "description": "One row for each sample",
        "contentUrl": table.NAME,
        "encodingFormat": "text/csv",
        "sha256": table_hash,
    }


def _file_sets(folder: Path) -> list[dict[str, Any]]:
    """List the sets of files that the data set has, by folder."""
    kinds = KINDS | {truth.FOLDER: ".json"}
    return [
        {
            "@type": "cr:FileSet",
            "@id": name,
            "name": name,
            "description": f"{CONTENT[name]}, by number of the sample",
            "encodingFormat": _MIME[end],
            "includes": f"{name}/*{end}",
        }
        for name, end in kinds.items()
        if (folder / name).is_dir()
    ]


def _records() -> dict[str, Any]:
    return {
        "@type": "cr:RecordSet",
        "@id": "samples",
        "name": "samples",
        "description": "Samples with their split, groups and numbers of labels",
        "key": {"@id": "samples/index"},
        "field": [
            {
                "@type": "cr:Field",
                "@id": f"samples/{name}",
                "name": name,
                "description": content,
                "dataType": f"sc:{kind}",
                "source": {"fileObject": {"@id": table.NAME}, "extract": {"column": name}},
            }
            for name, (kind, content) in table.COLUMNS.items()
        ],
    }
