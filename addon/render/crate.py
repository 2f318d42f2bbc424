"""RO-Crate of a film: ``ro-crate-metadata.json``, which describes the files of an output folder for archives.

The format is RO-Crate 1.2 (https://w3id.org/ro/crate/1.2). Hashes, model times and credits come from
``manifest.json``, so no file is read again.
"""

from __future__ import annotations

import json
import mimetypes
from collections.abc import Iterable, Iterator, Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from urllib.parse import quote

from .. import output
from ..errors import input_error
from ..run.citations import PAPER
from ..shot import passes
from . import manifest

NAME = "ro-crate-metadata.json"
_PROFILE = "https://w3id.org/ro/crate/1.2"
_GPL = "https://spdx.org/licenses/GPL-3.0-or-later"
_NO_LICENCE = "Not chosen by the authors. The licences of the cited sources apply to their parts."
_TYPES = {".exr": "image/x-exr", ".mov": "video/quicktime", ".mp4": "video/mp4", ".edl": "text/plain"}

Entity = dict[str, Any]
Hashes = dict[str, str]


def write(
    out: Path,
    runs: Mapping[str, tuple[str, Mapping[str, str]]],
    description: str,
    rows: Sequence[Mapping[str, str]],
    licence: str = "",
    overwrite: bool = False,
) -> Path:
    """Write the crate of an output folder, and return its path.

    Parameters
    ----------
    runs
        Name and SHA-256 of the fields of each run of the scene file, by its label.
    description
        Text about the film.
    rows
        Citations: ``kind`` and ``text``.
    licence
        URL of the licence of the film; "": none is stated.
    overwrite
        Replace a file of others (see `output`).

    Raises
    ------
    InputError
        The folder has no finished files, a file is missing, or a picture was rendered from another run.
    """
    content = manifest.read(out)
    if not content["files"]:
        raise input_error(out / manifest.NAME, "lists no files; render the film first")
    _check_files(out, content["files"])
    used = _inputs(out, content["settings"], {label: fields for label, (_, fields) in runs.items()})
    files_ = [_file(name, entry) for name, entry in content["files"].items()]
    files_.append(_manifest(out))
    software = list(_software(content["settings"].values()))
    inputs = [entity for label, hashes in used.items() for entity in _run(label, runs[label][0], hashes)]
    cited = list(_cited(rows))
    action = {
        "@id": "#render",
        "@type": "CreateAction",
        "name": "Rendering of the film",
        "instrument": _links(software),
        "object": _links({"@id": _run_id(label)} for label in used),
        "result": _links(files_[:-1]),
    }
    root = _root(out, [runs[label][0] for label in used], description, licence, content["files"].values())
    root |= {"hasPart": _links(files_), "mentions": _links([action, *cited])}
    about = {
        "@id": NAME,
        "@type": "CreativeWork",
        "about": {"@id": "./"},
        "conformsTo": {"@id": _PROFILE},
    }
    graph = [about, root, *files_, action, *software, *_people(software), *inputs, *cited]
    if licence not in {entity["@id"] for entity in graph}:
        graph += _licence(licence)
    text = json.dumps({"@context": f"{_PROFILE}/context", "@graph": graph}, indent=1) + "\n"
    output.write_text(out / NAME, text, overwrite)
    return out / NAME


def _check_files(out: Path, entries: Mapping[str, Any]) -> None:
    for name, entry in entries.items():
        path = out / name
        if not path.resolve().is_relative_to(out.resolve()):
            raise input_error(out / manifest.NAME, f"lists {name}, which is outside of the folder; remove it")
        if not path.is_file() or path.stat().st_size != entry["bytes"]:
            raise input_error(path, "is missing or has changed; render it again with --resume")


def _inputs(
    out: Path, settings: Mapping[str, Any], runs: Mapping[str, Mapping[str, str]]
) -> dict[str, Hashes]:
    """Collect the inputs of the pictures: SHA-256 by name, for each run of the scene file that they show.

    Raises
    ------
    InputError
        A picture shows another run.
    """
    inputs = dict[str, Hashes]()
    for made_with in settings.values():
        run = made_with.get("run")
        further = made_with.get("further", {})  # files of the scene file
        for hashes in (run and run | further, *made_with.get("beside", {}).values()):
            if not hashes:
                continue
            label = next((label for label, fields in runs.items() if _agree(hashes, fields)), None)
            if label is None:
                reason = "lists a picture of another run; name the scene file of this film"
                raise input_error(out / manifest.NAME, reason)
            inputs[label] = inputs.get(label, {}) | hashes
    return inputs


def _agree(hashes: Hashes, fields: Mapping[str, str]) -> bool:
    """Check that all fields of a run that a picture depends on agree with `fields`."""
    common = hashes.keys() & fields.keys()
    return bool(common) and all(hashes[name] == fields[name] for name in common)


def _root(
    out: Path, names: Sequence[str], description: str, licence: str, entries: Iterable[Mapping[str, Any]]
) -> Entity:
    day = datetime.fromtimestamp((out / manifest.NAME).stat().st_mtime, UTC).date()
    credits = dict.fromkeys(text for entry in entries for text in entry.get("credits", ()))
    return {
        "@id": "./",
        "@type": "Dataset",
        "name": f"Film of {', '.join(names) or out.resolve().name}",
        "description": description,
        "datePublished": day.isoformat(),
        "license": {"@id": licence or "#licence"},
    } | ({"creditText": "; ".join(credits)} if credits else {})


def _file(name: str, entry: Mapping[str, Any]) -> Entity:
    """Describe a finished file of a camera and a pass."""
    frame = f", frame {entry['frame']}" if "frame" in entry else ""
    kind = f", {entry['film']} film" if "film" in entry else ""
    entity = {
        "@id": quote(name),
        "@type": "File",
        "name": f"{entry.get('camera', 'film')}, pass {entry.get('pass', 'unknown')}{frame}{kind}",
        "contentSize": str(entry["bytes"]),
        "sha256": entry["sha256"],
        "encodingFormat": _TYPES.get(Path(name).suffix) or mimetypes.guess_type(name)[0] or "unknown",
    }
    more = {
        "description": passes.helps().get(entry.get("pass", ""), ""),
        "temporalCoverage": entry.get("time"),
        "creditText": "; ".join(entry.get("credits", ())),
    }
    return entity | {key: value for key, value in more.items() if value}


def _manifest(out: Path) -> Entity:
    return {
        "@id": manifest.NAME,
        "@type": "File",
        "name": "Manifest",
        "description": "Settings, versions, input hashes, and a hash of every file",
        "contentSize": str((out / manifest.NAME).stat().st_size),
        "encodingFormat": "application/json",
    }


def _software(settings: Iterable[Mapping[str, Any]]) -> Iterator[Entity]:
    """Describe each version of Firetwin and Blender that rendered a file."""
    for name, version in manifest.versions(settings):
        entity = {"@id": f"#{name}-{version}", "name": name, "version": version, "license": {"@id": _GPL}}
        if name == "Blender":
            yield entity | {"@type": "SoftwareApplication", "url": "https://www.blender.org/"}
        else:  # RO-Crate requires a URL of a SoftwareApplication, which Firetwin has not
            yield entity | {"@type": "CreativeWork", "author": {"@id": "#maintainers"}}


def _people(software: Sequence[Entity]) -> list[Entity]:
    """Describe the makers and the licence of the software."""
    if not software:
        return []
    makers = {"@id": "#maintainers", "@type": "Organization", "name": "The Firetwin maintainers"}
    licence = {
        "@id": _GPL,
        "@type": "CreativeWork",
        "name": "GPL-3.0-or-later",
        "description": "GNU General Public License v3.0 or later",
    }
    return [makers, licence]


def _run(label: str, name: str, hashes: Hashes) -> Iterator[Entity]:
    """Describe a run and its files: they are inputs, not files of the folder."""
    parts = [
        {"@id": f"{_run_id(label)}/{quote(file)}", "@type": "CreativeWork", "name": file, "sha256": digest}
        for file, digest in hashes.items()
    ]
    yield {"@id": _run_id(label), "@type": "CreativeWork", "name": name, "hasPart": _links(parts)}
    yield from parts


def _run_id(label: str) -> str:
    return f"#run-{quote(label)}"


def _cited(rows: Sequence[Mapping[str, str]]) -> Iterator[Entity]:
    for number, row in enumerate((row for row in rows if row["kind"] != "software"), 1):
        kind = "ScholarlyArticle" if row["text"] == PAPER else "CreativeWork"
        yield {"@id": f"#source-{number}", "@type": kind, "name": row["text"], "description": row["kind"]}


def _licence(licence: str) -> list[Entity]:
    if licence:
        return [
            {"@id": licence, "@type": "CreativeWork", "name": licence, "description": "Licence of the film"}
        ]
    return [{"@id": "#licence", "@type": "CreativeWork", "name": "No licence", "description": _NO_LICENCE}]


def _links(entities: Iterable[Entity]) -> Entity | list[Entity]:
    """Refer to entities; a single one is not a list, as RO-Crate 1.2 recommends."""
    found = [{"@id": entity["@id"]} for entity in entities]
    return found[0] if len(found) == 1 else found
