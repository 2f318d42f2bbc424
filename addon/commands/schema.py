"""`firetwin schema`: the JSON Schema of scene files."""

from __future__ import annotations

import argparse
import json

from ..command import SCENES, Command

_DETAIL = """\
Save it, and refer to it in the first line of a scene file (`#:schema firetwin.json`). TOML editors then
complete keys, show their help and underline mistakes."""


def _run(arguments: argparse.Namespace) -> None:
    """Print the JSON Schema of scene files."""
    from ..shot.schema.json_schema import json_schema
    from ..shot.settings import Settings

    print(json.dumps(json_schema(Settings), indent=1, ensure_ascii=False))


COMMAND = Command("schema", "print the JSON Schema of scene files, for TOML editors", _DETAIL, SCENES, _run)
