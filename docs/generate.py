"""Write settings.md, passes_and_cameras.md, tables of limits.md, and the table of layers in CONTRIBUTING.md.

``.venv/bin/python docs/generate.py``; a test compares the pages with the code.
"""

from __future__ import annotations

import ast
import inspect
import re
import sys
import tomllib
from collections.abc import Iterable
from datetime import datetime
from itertools import pairwise
from pathlib import Path
from typing import Any, get_args

from firetwin import limits
from firetwin.shot import passes
from firetwin.shot.cameras import rigs
from firetwin.shot.schema import Field, Key, fields, plain
from firetwin.shot.schema.frame_list import FrameList
from firetwin.shot.settings import Camera, Settings

FOLDER = Path(__file__).parent
ROOT = FOLDER.parent
HEAD = "<!-- made by docs/generate.py; change the code, not this page -->\n"
NAMES = {
    bool: "true or false",
    int: "integer",
    float: "number",
    str: "text",
    FrameList: "frame list",
    Path: "path",
    datetime: "time",
}


def format_table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> str:
    """Format a Markdown table."""
    lines = [head, tuple("---" for _ in head), *rows]
    return (
        "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)
        + "\n"
    )


def format_default(part: Field) -> str:
    """Format the default of a key as a scene file writes it."""
    if part.table:
        return "none"
    found = part.default if isinstance(part.default, int) else plain(part.type, part.default)
    if found is None or found == "" or found == []:
        return "not set"
    if isinstance(found, bool):
        return f"`{str(found).lower()}`"
    return f"`{found}`".replace("'", '"') if not isinstance(found, str) else f'`"{found}"`'


def format_type(part: Field) -> str:
    """Format type, unit and bounds of a key."""
    if part.table:
        return "list of tables" if part.tables else "table"
    inner = get_args(part.type)
    name = f"list of {NAMES[inner[0]]}s".replace("texts", "text") if inner else NAMES[part.type]
    key = part.key
    bounds = [
        f"{word} {number:,.12g}"
        for word, number in (("from", key.at_least), ("above", key.above), ("to", key.at_most))
        if number is not None
    ]
    return ", ".join(each for each in (name, key.unit, " ".join(bounds)) if each)


def format_meaning(key: Key, listed: bool = True) -> str:
    """Format the help of a key and its choices."""
    names = key.names() if listed else {}
    choices = [f'`"{name}"`' + (f" {text}" if text else "") for name, text in names.items()]
    return key.help + (": " + "; ".join(choices) if choices else "")


def format_keys(keys: list[Field]) -> str:
    """Format a table of keys; choices that are passes have a separate page."""
    rows = []
    for part in keys:
        is_listed = part.key.choices is not passes.helps
        meaning = format_meaning(part.key, is_listed)
        rows.append((f"`{part.name}`", format_default(part), format_type(part), meaning))
    out = format_table(("key", "default", "value", "meaning"), rows)
    inner = [f"\nEach table of `{p.name}`:\n\n{format_keys(list(fields(p.table)))}" for p in keys if p.table]
    return out + "".join(inner)


def convert_columns(block: str) -> str:
    """Convert a table of reStructuredText, with columns under its rulers, to Markdown."""
    ruler, head, _, *rows, _ = block.splitlines()
    starts = [found.start() for found in re.finditer("=+", ruler)]
    cells = [tuple(line[a:b].strip() for a, b in pairwise([*starts, None])) for line in (head, *rows)]
    return format_table(cells[0], iter(cells[1:]))


def convert_docstring(text: str | None) -> str:
    """Convert a docstring to Markdown: tables, single backticks, and no references to modules."""
    blocks = re.split(r"\n\n+", inspect.cleandoc(text or ""))
    blocks = [
        convert_columns(block) if block.startswith("===") else block.replace("``", "`") for block in blocks
    ]
    return "\n\n".join(re.sub(r"\s*\((?:see `[\w.]+`|`[a-z_]+\.[\w.]+`)\)", "", block) for block in blocks)


def describe_settings() -> str:
    """Describe every section of a scene file with its keys."""
    sections = [part for part in fields(Settings) if part.table]
    own = [part for part in fields(Settings) if not part.table]
    out = [
        HEAD,
        "# Settings\n",
        SETTINGS,
        "## At the top\n",
        format_keys(own),
    ]
    for part in sections:
        name = f"[[{part.name}]]" if part.tables else f"[{part.name}]"
        inner = [each for each in fields(part.table) if not each.key.variants]
        out += [
            f"## `{name}`\n",
            f"{complete_sentence(inspect.cleandoc(part.table.__doc__ or part.key.help))}\n",
            format_keys(inner),
        ]
        if part.table is Camera:
            out.append(
                "Keys of each kind of camera are on the page [Passes and cameras](passes_and_cameras.md).\n"
            )
    return "\n".join(out)


def complete_sentence(text: str) -> str:
    """Complete a sentence with a capital and a full stop."""
    text = text.strip()
    return text[:1].upper() + text[1:] + ("" if text.endswith(".") else ".")


def describe_pass(each: passes.Pass) -> str:
    """Describe a pass."""
    files = [passes.file_of("CAMERA", each.name, 1, suffix) for suffix in each.files]
    facts = [f"Files: {', '.join(f'`{file}`' for file in files)}"]
    if each.made_from:
        facts.append(f"Made from: {', '.join(f'[`{name}`](#{name})' for name in each.made_from)}")
    if isinstance(each, passes.RenderedPass) and each.excludes:
        facts.append(f"Excludes: {', '.join(each.excludes).replace('lamps', 'point lights of flames')}")
    if isinstance(each, passes.RenderedPass) and each.samples:
        facts.append(f"Rays per pixel: {each.samples}")
    facts += ["Also written as a video (MP4)"] if each.film else []
    facts += ["Not for panoramas"] if each.single_view else []
    facts += ["Compares the runs of `[[runs]]`"] if isinstance(each, passes.ComparisonPass) else []
    text = convert_docstring(passes.modules()[each.name].__doc__)
    return f"### {each.name}\n\n{text}\n\n" + "\n".join(f"- {fact}." for fact in facts) + "\n"


def describe_rig(name: str, rig: type) -> str:
    """Describe a kind of camera."""
    texts = [convert_docstring(text) for text in (sys.modules[rig.__module__].__doc__, rig.__doc__)]
    return "\n\n".join((f"### {name}", *texts, format_keys(list(fields(rig)))))


SETTINGS = """\
A scene file is TOML. Each section below is one of its tables, and each key has a default.
`examples/king_fire.toml` shows and explains every key. `firetwin new RUN -o my_scene.toml` writes a short
one. Lengths are metres and angles degrees. Relative paths start at the scene file's folder.

With `firetwin schema > firetwin.json` and a first line `#:schema firetwin.json`, a TOML editor completes and
validates a scene file. Former names of sections and keys are read with a note; `CHANGELOG.md` lists them.
"""

PASSES = """\
A pass is a kind of picture that a camera records. `[render] passes` lists the passes of all
cameras; the `passes` of a camera override it. Each file in `addon/passes/`, or in `passes/` of a
feature, defines one pass. EXR files have 32 bits per value; the EXR of `rgb` has 16 and is
scene-linear. [EXR files](delivery.md#exr-files) lists
their attributes.

AgX is Blender's view transform: it maps scene-linear radiance to the colours of a screen, and desaturates
highlights as film does. The PNG and the films of `rgb` are AgX pictures with lens bloom. The EXR has neither,
so that compositors grade the radiance itself. `[render] exr_space = "acescg"` writes it in ACEScg.

`fused`, `split`, `difference` and `forecast` need matplotlib. `imager_short` (MWIR) and `imager_long`
(LWIR) are ABI bands 7 and 14 (3.9 and 11.2 µm) for a geostationary satellite, otherwise VIIRS bands I4 and
I5 (3.74 and 11.45 µm). They are simulated: ABI was not yet in orbit in September 2014. VIIRS was, but its
observations are not used here. `pose` with `rgb` also writes an index for nerfstudio,
`CAMERA/transforms.json`, and one of all cameras, `transforms.json`. With `nerfstudio`, which needs no other
pass in the list, the index also has `depth_file_path` and `mask_path`, if every frame of the index has
these files. `thermal_map` and `edl` follow the FIRETWIN paper. `normal` and `masks` need an additional
render with one ray per pixel. The `[thermal]` section sets the band (long-wave infrared, LWIR, 8 to 14 µm,
or mid-wave infrared, MWIR, 3.4 to 4.1 µm), the palette and the flaws of the detector.

Each built scene has compositor groups with the results of these passes, within 1e-5: *Firetwin Thermal
Blend*, *Thermal Camera*, *Eye Dome* and *Overlay*. *Firetwin Regrade* grades the
layers of `comp` ([Regrading](delivery.md#regrading-in-blender)).
"""

CAMERAS = """\
`kind` of `[[cameras]]` is one of these; each file in `addon/shot/cameras/rigs/` defines one
kind. Focal lengths and sensors are in millimetres. Keys have handles that can be moved in Blender.

A drone looks ahead, at a point or at the fire, and stays above its clearance. It flies from key to key or
along a GPX, KML or CSV track. `firetwin track SCENE.toml --camera NAME --out FILE.gpx` writes a camera's
path; a drone with `track = "FILE.gpx"` flies it again. Heights of tracks refer to the datum of the run's
elevations.

A `tour` visits places for a film: by the name of a label, by position, the "head" of the fire or its
"ignition". `stay` and `travel` are in seconds, and are scaled together so that the tour fills the film. The
camera arrives from the direction of the previous place, stops, and continues with an eased start and end,
above the terrain.

A `globe` flies from space to a place: along the geodesic, at constant speed on the screen from 2,000 km down
(van Wijk and Nuij 2003). It looks at the place all along, with a level horizon, and ends like a stop of a
`tour`; from its default start the picture has the Earth's limb. Positions are computed in double precision in
the scene's axes and include the Earth's curvature. Clip planes follow the height, frame by frame. With such a
camera the terrain continues into the WGS84 ellipsoid, in NASA's Blue Marble or in your picture
`terrain.globe`, which needs a credit. Haze follows the curvature and is blue from above; the sky darkens with
height and surrounds the limb.

`vr` needs Cycles. The left eye's equirectangular picture is above the right eye's. Stills have XMP metadata
for this (GPano), films `st3d` and `sv3d`. A `satellite` is an orthographic nadir view from above all smoke
or, with `geostationary`, a perspective view from that longitude over the equator.

Three example commands write to `examples/out/NAME`: `examples/film.sh drone_feed` writes all feeds of a
drone's mount, with their fused view, sidecars and masks. `examples/film.sh satellite` writes the complete
run from space, in true colour and both bands. `examples/film.sh vr` writes a clip for headsets. A fourth
scene file, `examples/rigs.toml`, has one camera of each remaining kind. All use the synthetic sample run.
"""


def describe_passes_and_cameras() -> str:
    """Describe every pass and every kind of camera."""
    all_passes, kinds = passes.known(), rigs.kinds()
    return "\n".join(
        [
            HEAD,
            "# Passes and cameras\n",
            "## Passes\n",
            PASSES,
            format_table(
                ("pass", "content"), ((f"[`{n}`](#{n})", text) for n, text in passes.helps().items())
            ),
            *(describe_pass(each) for each in all_passes.values()),
            "## Cameras\n",
            CAMERAS,
            *(describe_rig(name, rig) for name, rig in kinds.items()),
        ]
    )


def read_summary(module: Path) -> str:
    """Return the first line of the docstring of a package or module, without its full stop."""
    path = module / "__init__.py" if module.is_dir() else module.with_suffix(".py")
    text = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8")))
    if not text:
        raise ValueError(f"{path} has no docstring; write one line for the table in CONTRIBUTING.md")
    return text.splitlines()[0].rstrip(".").replace("``", "`")


def format_layers() -> str:
    """Format the layers of the contracts in pyproject.toml, from the highest down, with what each has."""
    rooms = " ".join(sorted(path.parent.name for path in (ROOT / "addon").glob("*/command.py")))
    text = (ROOT / "pyproject.toml").read_text(encoding="utf-8").replace("{rooms}", rooms)
    configuration, out = tomllib.loads(text), []
    for contract in configuration["tool"]["importlinter"]["contracts"]:
        for container in contract.get("containers", []):
            folder = ROOT.joinpath("addon", *container.split(".")[1:])
            rows = []
            for level, names in enumerate(contract["layers"], 1):
                for name in re.findall(r"\w+", names):
                    module = folder / name if name != "data" else ROOT / "data"
                    path = module.relative_to(ROOT).as_posix() + ("/" if module.is_dir() else ".py")
                    rows.append((str(level), f"`{path}`", read_summary(module)))
            out.append(format_table(("layer", "module", "content"), rows))
    return "\n".join(out)


def replace_tables(page: Path, name: str, tables: str) -> str:
    """Return a page with tables in place of the ones between its marks of a name."""
    before, start, rest = page.read_text(encoding="utf-8").partition(
        f"<!-- {name}: made by docs/generate.py -->\n"
    )
    _, end, after = rest.partition(f"\n<!-- end of {name} -->")
    if not end:
        raise ValueError(f"{page.name} has no marks for the tables of {name}")
    return before + start + "\n" + tables + end + after


def update_contributing() -> str:
    """Return CONTRIBUTING.md with the table of layers between its marks."""
    return replace_tables(ROOT / "CONTRIBUTING.md", "layers", format_layers())


def update_limits() -> str:
    """Return limits.md with the tables of `firetwin.limits` between their marks."""
    groups = dict.fromkeys(each.group for each in limits.LIMITS)
    tables = (
        f"### {group}\n\n"
        + format_table(
            ("quantity", "limit", "beyond it"),
            ((each.quantity, each.value, each.beyond) for each in limits.LIMITS if each.group == group),
        )
        for group in groups
    )
    return replace_tables(FOLDER / "limits.md", "limits", "\n".join(tables))


PAGES: dict[str, Any] = {
    "limits.md": update_limits,
    "settings.md": describe_settings,
    "passes_and_cameras.md": describe_passes_and_cameras,
    "../CONTRIBUTING.md": update_contributing,
}


def pages() -> dict[str, str]:
    """Return the text of each page by its name."""
    return {name: make().rstrip("\n") + "\n" for name, make in PAGES.items()}


if __name__ == "__main__":
    for name, text in pages().items():
        (FOLDER / name).write_text(text, encoding="utf-8")
