"""Damage users' files and read them: content or one polite line, or it is a finding.

    .venv/bin/python tests/system/fuzz/files.py [--runs 100000] [--seconds 0] [--seed 0] [KIND ...]

KIND is stations, geopackage, geojson, kml, gpx, track_kml, csv, labels, scene, storyboard or run. A kind ends
after so many seconds of processor time (0: never). A finding is another exception, a warning of NumPy, an
impolite line, or 5 s of processor time; its file is left in build/fuzz/findings; exit status 1.
"""

import argparse
import contextlib
import io
import resource
import sqlite3
import sys
import tempfile
import time
import warnings
from collections import Counter
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[2] / "helpers"))

import polite
import small_run
import small_stations
from damage import WAYS, damaged
from file_seeds import PLACES, SCENE, SEEDS, TOKENS, VALUES
from firetwin import cli
from firetwin.run import buildings, info, labels, observations, readers, zone
from firetwin.shot.cameras import track
from firetwin.shot.settings import scene_file
from firetwin.stations import importers, measures, merging, page, reading
from firetwin.stations.query import Query
from firetwin.story import captions, story_file, timeline
from station_files import write_usgs

SECONDS = 5.0
MEMORY = 4 << 30
FINDINGS = Path("build/fuzz/findings")


def read_stations(path):
    """Read, list, search and merge a station file."""
    found = reading.read(path)
    page.format_facts(page.facts(found))
    measures.measure(
        found, Query(near=PLACES[0], minutes=60.0, at=small_stations.DAYS[0], tonnes_per_hour=1.0)
    )
    merging.merge([(path, importers.read(path))], merging.SourceOptions())


def read_features(path):
    """Read features as footprints, perimeters, and stations."""
    found = observations.features(path)
    if isinstance(found, list):
        buildings.collect((each.polygons, buildings.height_of(each.properties)) for each in found)
    for call in (lambda: observations.read([f"{path}@2014-09-18T04:00Z"]), lambda: importers.read(path)):
        polite_error(call)


def read_track(path):
    """Read a track and its extent."""
    track._read.cache_clear()
    track.read(path).corners()


def read_csv(path):
    """Read a CSV as stations, resources and labels."""
    for call in (lambda: importers.read(path), lambda: labels.read(path)):
        polite_error(call)
    observations.features(path)


def read_scene(path):
    """Read a scene file, and write it."""
    scene_file.text(scene_file.read(path))


def read_storyboard(path):
    """Read a storyboard, and write its captions."""
    story = story_file.read(path)
    shown = captions.make(story, timeline.lay_out(story), readers.open(story.run))
    captions.srt(shown, story.fps)
    story_file.text(story)


def read_run(path):
    """Open a run whose run.toml is damaged, and describe it."""
    run = readers.open(path.parent)
    info.page(info.gather(run, zone.time_zone(run)))


KINDS = {
    "stations": (".gpkg", read_stations),
    "geopackage": (".gpkg", read_features),
    "geojson": (".geojson", read_features),
    "kml": (".kml", read_features),
    "gpx": (".gpx", read_track),
    "track_kml": (".kml", read_track),
    "csv": (".csv", read_csv),
    "labels": (".geojson", labels.read),
    "scene": (".toml", read_scene),
    "storyboard": (".toml", read_storyboard),
    "run": (".toml", read_run),
}


class RudeError(Exception):
    """An error that is not polite."""


def polite_error(call):
    """Call, and return True if it succeeds; an error must be one polite line."""
    try:
        call()
    except Exception as error:
        said = io.StringIO()
        with contextlib.redirect_stderr(said):
            cli._report(error)
        wrong = polite.rude(said.getvalue())
        if isinstance(error.__cause__, MemoryError | Warning | AssertionError):
            wrong = wrong or repr(error.__cause__)
        if wrong:
            raise RudeError(f"{wrong}: {said.getvalue()[:300]!r} by {error!r}"[:600]) from error
        return False
    return True


def seeds(kind, folder):
    """Bytes of sound files of a kind."""
    if kind == "stations":
        return [
            small_stations.briefed(folder / "s.gpkg", [("A", *PLACES[0]), ("B", *PLACES[1])]).read_bytes()
        ]
    if kind == "geopackage":
        return [write_usgs(folder / "u.gpkg").read_bytes()]
    if kind == "run":
        return [small_run.RUN_TOML.encode(), *(each.encode() for each in SEEDS["run"])]
    return [each.encode() for each in ([SCENE, *SEEDS["scene"]] if kind == "scene" else SEEDS[kind])]


def changed_text(data, rng):
    """Replace tokens of a text by odd ones."""
    parts = data.split(b'"') if rng.random() < 0.3 else data.split(b" ") if rng.random() < 0.5 else None
    if parts is None or len(parts) < 2:
        numbers = [k for k, byte in enumerate(data) if chr(byte).isdigit()]
        if not numbers:
            return data
        at = int(rng.choice(numbers))
        end = at
        while end < len(data) and chr(data[end]) in "0123456789.+-eE":
            end += 1
        return data[:at] + TOKENS[rng.integers(len(TOKENS))].encode() + data[end:]
    glue = b'"' if data.split(b'"') == parts else b" "
    for _ in range(int(rng.integers(1, 3))):
        parts[int(rng.integers(len(parts)))] = TOKENS[rng.integers(len(TOKENS))].encode()
    return glue.join(parts)


def changed_database(data, rng, folder):
    """Change values and tables of a database by SQL."""
    path = folder / "changing.gpkg"
    path.write_bytes(data)
    with contextlib.closing(sqlite3.connect(path)) as base:
        base.execute("PRAGMA ignore_check_constraints = ON")
        base.create_function("ST_IsEmpty", 1, lambda _: 1)
        for (name,) in base.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
            base.execute(f'DROP TRIGGER "{name}"')
        listed = base.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
        tables = [name for (name,) in listed if not name.startswith(("rtree", "sqlite"))]
        for _ in range(int(rng.integers(1, 4))):
            table = tables[rng.integers(len(tables))]
            columns = [row[1] for row in base.execute(f'PRAGMA table_info("{table}")')]
            if not columns:
                continue
            column = columns[rng.integers(len(columns))]
            blob = damaged(bytes.fromhex("4750000100000000") + data[:90], WAYS[rng.integers(len(WAYS))], rng)
            value = [*VALUES, blob][rng.integers(len(VALUES) + 1)]
            commands = [
                (f'UPDATE "{table}" SET "{column}" = ?', [value]),
                (f'UPDATE OR REPLACE "{table}" SET "{column}" = ? WHERE rowid = 1', [value]),
                (f'DELETE FROM "{table}" WHERE rowid % 2', []),
                (f'ALTER TABLE "{table}" DROP COLUMN "{column}"', []),
                (f'ALTER TABLE "{table}" RENAME COLUMN "{column}" TO "{column} 2"', []),
                (f'ALTER TABLE "{table}" ADD COLUMN x AS (hex(zeroblob(1000000)))', []),
            ]
            with contextlib.suppress(sqlite3.Error, OverflowError):
                base.execute(*commands[0 if rng.random() < 0.6 else rng.integers(len(commands))])
        base.commit()
    return path.read_bytes()


def changed(kind, data, rng, folder):
    """A damaged file."""
    if not data:
        return data
    if rng.random() < 0.4:
        return damaged(data, WAYS[rng.integers(len(WAYS))], rng)
    if KINDS[kind][0] != ".gpkg":
        return changed_text(data, rng)
    try:
        return changed_database(data, rng, folder)
    except (sqlite3.Error, ValueError):  # damaged before
        return data


def work(kind, runs_, seconds, seed, folder):
    """Number of findings of a kind; each fault of one kind is left once."""
    end, read = KINDS[kind]
    rng, ends, originals, messages = np.random.default_rng(seed), Counter(), seeds(kind, folder), set()
    if kind in ("run", "storyboard"):
        (folder / "run.toml").write_text(small_run.RUN_TOML)
        for name, values in small_run.small_fields().items():
            small_run.write_field(folder, name, values, "npy")
    path = folder / ("run.toml" if kind == "run" else f"fuzzed{end}")
    for whole in originals:
        path.write_bytes(whole)
        assert polite_error(lambda: read(path)), f"{kind}: a seed is not read"
    began = time.process_time()
    for run in range(runs_):
        if seconds and time.process_time() - began > seconds:
            break
        data = originals[run % len(originals)]
        for _ in range(int(rng.integers(1, 3))):
            data = changed(kind, data, rng, folder)
        path.write_bytes(data)
        start, wrong = time.process_time(), ""
        try:
            ends["read" if polite_error(lambda: read(path)) else "refused"] += 1
        except RudeError as error:
            wrong = str(error)
        if (took := time.process_time() - start) > SECONDS:
            wrong = f"took {took:.1f} s"
        if wrong:
            ends["finding"] += 1
            if (what := "".join(c for c in wrong if not c.isdigit())[:160]) not in messages:
                messages.add(what)
                FINDINGS.mkdir(parents=True, exist_ok=True)
                (FINDINGS / f"{kind}-{seed}-{run}{end}").write_bytes(data)
                print(f"fuzz: {kind}, run {run}: {wrong}", flush=True)
    print(f"fuzz: {kind}: {dict(ends)} in {time.process_time() - began:.0f} s", flush=True)
    return ends["finding"]


def main():
    """Damage files of each kind, and tell."""
    parser = argparse.ArgumentParser(description=__doc__)
    for name, value in (("runs", 100_000), ("seconds", 0), ("seed", 0)):
        parser.add_argument(f"--{name}", type=int, default=value)
    parser.add_argument("kinds", metavar="KIND", nargs="*", choices=[*KINDS, []], help=", ".join(KINDS))
    asked = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    warnings.simplefilter("error", RuntimeWarning)
    found = []
    for kind in asked.kinds or KINDS:
        with tempfile.TemporaryDirectory() as folder:
            found.append(work(kind, asked.runs, asked.seconds, asked.seed, Path(folder)))
    return 1 if any(found) else 0


if __name__ == "__main__":
    sys.exit(main())
