"""Write the bill of materials of a wheel (CycloneDX 1.6, as PEP 770 describes).

The libraries are linked statically, so that scanners do not find them: this file names each with its version,
the SHA-256 of its source, and the module that contains it.
"""

from __future__ import annotations

import json
import uuid
from pathlib import Path
from typing import NamedTuple


class Library(NamedTuple):
    """A library that the module contains; `sha256` is the hash of its source file, None if it has none."""

    name: str
    version: str
    sha256: str | None = None


def read_sources(path: Path, names: set[str]) -> list[Library]:
    """Return the libraries of sources.txt that are in `names`."""
    lines = (line.split() for line in path.read_text(encoding="utf-8").splitlines())
    entries = [fields for fields in lines if fields and not fields[0].startswith("#")]
    return [Library(name, version, sha256) for name, version, _, sha256 in entries if name in names]


def _component(library: Library, modules: list[str]) -> dict:
    """Return the component of one library."""
    checksum = f"?checksum=sha256:{library.sha256}" if library.sha256 else ""
    component = {
        "type": "library",
        "bom-ref": library.name,
        "name": library.name,
        "version": library.version,
        "purl": f"pkg:generic/{library.name.replace('+', '%2B')}@{library.version}{checksum}",
        "evidence": {"occurrences": [{"location": module} for module in modules]},
    }
    if library.sha256:
        component["hashes"] = [{"alg": "SHA-256", "content": library.sha256}]
    return component


def document(name: str, version: str, libraries: list[Library], modules: list[str]) -> str:
    """Return the bill of materials of the wheel `name`, whose `modules` contain the libraries."""
    components = [_component(library, modules) for library in libraries]
    serial = uuid.uuid5(
        uuid.NAMESPACE_URL, json.dumps([name, version, components])
    )  # the same for the same content
    bom = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "serialNumber": f"urn:uuid:{serial}",
        "version": 1,
        "metadata": {
            "component": {
                "type": "library",
                "bom-ref": f"pkg:pypi/{name}@{version}",
                "name": name,
                "version": version,
                "purl": f"pkg:pypi/{name}@{version}",
            }
        },
        "components": components,
        "dependencies": [
            {"ref": f"pkg:pypi/{name}@{version}", "dependsOn": [library.name for library in libraries]},
            *({"ref": library.name} for library in libraries),
        ],
    }
    return json.dumps(bom, indent=2) + "\n"
