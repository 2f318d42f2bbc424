"""Commands of the command line; each imports the heavy modules that it needs."""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from collections.abc import Iterable
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .progress import Reporter, count, duration, result, say, size

if TYPE_CHECKING:
    from firetwin_core.run import Run

    from .jobs.cache import Cached
    from .jobs.render import RenderResult
    from .jobs.tiles.access import TileAccess
    from .shot.shot import Shot
    from .shot.source import ShotSource
    from .stations.command import Fire

_FRAME_SECONDS = 25.0  # processor s of a frame of 640 x 360 pixels, rgb and thermal (the example's, measured)


def sample(arguments: argparse.Namespace) -> None:
    """Write the sample run."""
    from .data import sample
    from .errors import UsageError

    if arguments.members is not None:
        from .run.ensemble import synthetic

        if arguments.member or arguments.pace != 1.0 or arguments.frames is not None:
            raise UsageError("--members: has arrival times alone; leave out --member, --pace and --frames")
        synthetic.write(arguments.out, arguments.members, Reporter("members"))
        result(arguments.out)
        return
    say(f"writing the synthetic King-like run to {arguments.out}")
    report = Reporter("model times")
    options = arguments.frames, arguments.format, report, arguments.pace, arguments.member
    sample.write(arguments.out, *options)
    result(arguments.out)


def info(arguments: argparse.Namespace) -> None:
    """Show the contents of a run, or of all runs of a scene file."""
    from .run import info, zone
    from .run.ensemble import ensemble, summary
    from .shot.source import ShotSource

    if ensemble.sniff(arguments.run):
        facts = summary.gather(ensemble.open(arguments.run))
        page = summary.page(facts)
    elif arguments.run.suffix == ".toml" and arguments.run.is_file():
        shot = ShotSource(scene=str(arguments.run)).shot()
        runs = _runs(shot)
        say(shot.describe_film())
        facts = {name: info.gather(run, zone.time_zone(run)) for name, run in runs.items()}
        page = "\n\n".join(f"{name}: {runs[name].path}\n{info.page(each)}" for name, each in facts.items())
    else:
        run = _open_run(arguments.run)
        facts = info.gather(run, zone.time_zone(run))
        page = info.page(facts)
    if arguments.json:
        json.dump(facts, sys.stdout, indent=1)
        print()
    else:
        result(page)


def new(arguments: argparse.Namespace) -> None:
    """Write a scene file that fits a run."""
    from . import files
    from .errors import UsageError

    if arguments.out.suffix != ".toml":
        raise UsageError(f"-o: {arguments.out} does not end in .toml; name a .toml file")
    if arguments.out.exists() and not arguments.overwrite:
        raise UsageError(f"-o: {arguments.out} exists already; choose another name, or add --overwrite")
    asked = arguments.start, arguments.end
    text = _fit_scene(arguments.run, arguments.out, arguments.out.parent / "cache", asked)
    files.write_text(arguments.out, text)
    result(arguments.out)


def maps(arguments: argparse.Namespace) -> None:
    """Draw the maps of a run."""
    run = _open_run(arguments.run)
    say("drawing the maps of the fuel load and of the maximum heat flux")
    from .run import maps, observations, zone

    observed = observations.read(arguments.against or observations.beside(arguments.run))
    for path in maps.draw(run, arguments.out, zone.time_zone(run), observed):
        result(path)


def haze(arguments: argparse.Namespace) -> None:
    """Read the smoke of a weather forecast over a run, for the haze of a scene."""
    run = _open_run(arguments.run)
    from .run import times, zone
    from .shot.light import smoke_forecast

    clock = zone.time_zone(run)
    smokes = smoke_forecast.read(run, arguments.forecast)
    middle = times.utc(run, float(run.times[0] + run.times[-1]) / 2.0)
    nearest = min(smokes, key=lambda each: abs((each.valid - middle).total_seconds()))
    chosen = smoke_forecast.at(smokes, arguments.time) if arguments.time else nearest
    result(smoke_forecast.page(smokes, chosen, clock))
    if arguments.out:
        from .run import maps

        text = f"forecast of {times.text(chosen.issued, clock)} for {times.text(chosen.valid, clock)}"
        path = arguments.out / f"smoke_{chosen.valid:%Y%m%dT%H%MZ}.png"
        maps.save(maps.smoke_map(run, chosen.column, text), path)
        result(path)


def score(arguments: argparse.Namespace) -> None:
    """Compare a run with observations of its fire."""
    from . import files
    from .errors import Error, UsageError, input_error
    from .run import observations, zone
    from .run import score as scores
    from .run.ensemble import ensemble
    from .run.score import page, used

    if ensemble.sniff(arguments.run):
        _score_members(arguments)
        return
    if arguments.run.suffix == ".toml" and arguments.run.is_file():
        run, *others = _open_runs(arguments.run).values()
        named = arguments.against or [other.path for other in others]
    else:
        run = _open_run(arguments.run)
        named = arguments.against or observations.beside(arguments.run)
    runs = [_open_run(Path(each)) for each in named if not observations.is_one(each)]
    if len(runs) > 1:
        raise UsageError("--against: accepts one other run; remove the others")
    if arguments.report and arguments.report.suffix.lower() != ".html":
        raise UsageError(f"--report: {arguments.report} does not end in .html; name an .html file")
    observed = observations.read(each for each in named if observations.is_one(each))
    if observed.heat and not (observed.perimeters or observed.detections or runs):
        raise input_error(named[0], "has detections but no perimeter; name a file with a perimeter")
    found = scores.score(run, observed, runs[0] if runs else None, zone=zone.time_zone(run))
    result(json.dumps(found, indent=1) if arguments.json else page.page(found))
    if arguments.report:
        from .run.score import report

        text = report.html(run, found, observed, *runs)
        files.write_text(arguments.report, text)
        say(f"wrote {arguments.report}")
    if not runs and (none := used.nothing(found["uses"])):
        raise Error(none)


def _score_members(arguments: argparse.Namespace) -> None:
    """Compare an ensemble with observed perimeters."""
    from .errors import UsageError
    from .run import observations, zone
    from .run.ensemble import ensemble
    from .run.score import members

    found = ensemble.open(arguments.run)
    named = arguments.against or observations.beside(arguments.run)
    if arguments.report:
        raise UsageError("--report: is of runs alone; use --json for the scores of an ensemble")
    if not named or not all(observations.is_one(each) for each in named):
        raise UsageError("--against: name files of observed perimeters")
    place = float(found.longitude.mean())
    results = members.score(found, observations.read(named), found.manifest.zone or zone.of_longitude(place))
    result(json.dumps(results, indent=1) if arguments.json else members.page(results))


def cite(arguments: argparse.Namespace) -> None:
    """List the sources that a work with a run, an ensemble or a film has to cite."""
    from .errors import UsageError
    from .run import citations
    from .run.ensemble import ensemble
    from .shot.source import ShotSource

    if arguments.licence and not arguments.crate:
        raise UsageError("--license: is of --crate; name the folder of the film")
    if ensemble.sniff(arguments.run):
        rows = citations.of_ensemble(ensemble.open(arguments.run))
    elif arguments.run.suffix == ".toml" and arguments.run.is_file():
        shot = ShotSource(scene=str(arguments.run)).shot()
        rows = _sources(shot)
        if arguments.crate:
            result(_write_crate(shot, rows, arguments.crate, arguments.licence))
            return
    else:
        rows = citations.of_run(_open_run(arguments.run))
    if arguments.crate:
        raise UsageError(f"--crate: {arguments.run} is not a scene file; name the scene file of the film")
    if arguments.json:
        json.dump(rows, sys.stdout, indent=1)
        print()
    else:
        result(citations.page(rows))


def _sources(shot: Shot) -> list[dict[str, str]]:
    """List the sources of a film, each once: of its runs, its forecast, and its pictures."""
    from .run import citations
    from .shot import forecast, picture_credits

    rows = [row for run in _runs(shot).values() for row in citations.of_run(run)]
    if shot.settings.forecast.ensemble:
        rows += citations.of_ensemble(forecast.of(shot.settings))
    credits = picture_credits.of_shot(shot)
    rows += [{"kind": "pictures", "text": text} for text in (*credits.data, *credits.logo)]
    return list({row["text"]: row for row in rows}.values())


def _write_crate(shot: Shot, rows: list[dict[str, str]], out: Path, licence: str) -> Path:
    """Describe the files of a film for archives."""
    from .render import crate, manifest
    from .run import content, methods
    from .shot import forecast

    terrain, ensemble = shot.settings.terrain, shot.settings.forecast.ensemble
    report = Reporter("input hashes")
    runs = {
        label: (run.name, content.inputs(run, shot.settings.cache, (), report))
        for label, run in _runs(shot).items()
    }
    inputs = methods.Inputs(
        elevation=terrain.elevation.name if terrain.elevation else "",
        forecast=forecast.of(shot.settings).manifest if ensemble else None,
        rendered=manifest.versions(manifest.read(out)["settings"].values()),
    )
    return crate.write(out, runs, methods.paragraph(shot.run, inputs), rows, licence)


def brief(arguments: argparse.Namespace) -> None:
    """Write the briefing page of a run."""
    from .brief import command

    command.run(arguments)


def deliver(arguments: argparse.Namespace) -> None:
    """Deliver the finished files of a film."""
    from .delivery import command

    command.run(arguments)


def edit(arguments: argparse.Namespace) -> None:
    """Write the edit of a scene's films."""
    from .edit import command

    command.run(arguments, _find_source(arguments).shot())


def export(arguments: argparse.Namespace) -> None:
    """Write a scene for other programs."""
    from .export import command

    command.run(arguments, _find_source(arguments))


def import_(arguments: argparse.Namespace) -> None:
    """Add the cameras of a file to a scene file."""
    from .camera_import import command
    from .shot.source import ShotSource

    command.run(arguments, ShotSource(scene=str(arguments.out)))


def imager(arguments: argparse.Namespace) -> None:
    """Write the simulated measurements of a satellite's imager."""
    from .errors import UsageError, input_error
    from .run import times
    from .shot.satellites import geotiff, imager

    run = _open_run(arguments.run)
    instrument = imager.INSTRUMENTS[arguments.instrument]
    moments = imager.times(run, arguments.every)
    report = Reporter("pictures")
    try:
        for done, (time, picture) in enumerate(imager.film(instrument, run, arguments.longitude, moments)):
            report(done, len(moments))
            moment = times.utc(run, time)
            path = arguments.out / f"{instrument.name}_{moment:%Y%m%dT%H%M}Z.tif"
            geotiff.write(path, picture, instrument, run.name, moment)
            result(path)
    except imager.HorizonError as error:
        raise UsageError(f"--longitude: {error}") from None
    except imager.NothingSeenError as error:
        finer = "; try --instrument viirs, which has smaller pixels" if instrument is imager.ABI else ""
        raise input_error(arguments.run, f"{error}{finer}") from None
    report(len(moments), len(moments))


def convert(arguments: argparse.Namespace) -> None:
    """Convert a fire model's own files to a run."""
    from .errors import UsageError
    from .jobs import convert

    if arguments.members and arguments.wind:
        raise UsageError("--wind: members have arrival times alone; give it with --member")
    if arguments.members:
        options = arguments.start, arguments.at, arguments.projection, arguments.horizon * 3600.0
        result(
            convert.run_members(
                arguments.paths, arguments.out, *options, tell=say, name=arguments.name, zone=arguments.zone
            )
        )
        return
    reporter = Reporter("times")
    try:
        result(
            convert.run(
                arguments.paths, arguments.out, arguments.start, arguments.at, arguments.projection,
                arguments.interval, reporter, say, name=arguments.name, zone=arguments.zone,
                member=arguments.member, wind=arguments.wind,
            )
        )  # fmt: skip
    finally:
        reporter.close()


def watch(arguments: argparse.Namespace) -> int:
    """Convert the output of a model that is still running."""
    from .jobs import watch

    source, *extra = arguments.run
    request = watch.WatchRequest(
        source=source,
        extra=tuple(extra),
        out=arguments.out,
        every=float(arguments.every),
        end=arguments.end,
        idle=float(arguments.idle),
        start=arguments.start,
        at=arguments.at,
        projection=arguments.projection,
        name=arguments.name,
        zone=arguments.zone,
    )
    state = watch.run(request, say)
    result(arguments.out)
    return 1 if state == "failed" else 0


def build(arguments: argparse.Namespace) -> None:
    """Build the scene and save it."""
    from .errors import UsageError
    from .jobs import build

    if arguments.out.suffix != ".blend":
        raise UsageError(f"-o: {arguments.out} does not end in .blend; name a .blend file")
    access, source = _tile_access(arguments), _find_source(arguments)
    build.run(
        source,
        arguments.out,
        Reporter(),
        say,
        access=access,
        volumes=arguments.volumes,
        live=arguments.live,
    )
    result(arguments.out)


def bake(arguments: argparse.Namespace) -> None:
    """Prepare smoke for `render`, or write smoke volumes."""
    from .errors import UsageError
    from .jobs import bake

    source, frames = _find_source(arguments), None
    if arguments.frames is not None:
        if not arguments.volumes:
            raise UsageError("--frames: selects volumes; add --volumes")
        frames = _frames(arguments.frames, source)
    folders = bake.run(source, Reporter("smoke"), say, volumes=arguments.volumes, frames=frames)
    if not folders:
        say("nothing to bake: this scene has no smoke ([smoke] enabled = false)")
    for folder in folders:
        result(folder)


def _frames(text: str, source: ShotSource) -> list[int]:
    """Read a list of frames of a shot."""
    from .errors import UsageError
    from .shot.schema.frame_list import FrameList

    try:
        return FrameList(text).frames(source.settings().time.frames)
    except ValueError as error:
        raise UsageError(f"--frames: {error}") from None


def render(arguments: argparse.Namespace) -> None:
    """Render the requested pictures that are not finished, then the films."""
    from .jobs import render

    asked = render.RenderRequest(
        arguments.out,
        arguments.frames,
        arguments.camera,
        arguments.passes,
        arguments.resume,
        access=_tile_access(arguments),
    )
    if arguments.follow:
        from .jobs import follow

        made = follow.run(_find_source(arguments), asked, Reporter(), say)
    else:
        made = render.run(_find_source(arguments), asked, Reporter(), say)
    if arguments.json:
        print(json.dumps(_render_json(arguments.out, made), indent=1))
    else:
        _list_output(arguments.out)


def dataset(arguments: argparse.Namespace) -> int:
    """Make labelled training data, or write it in other formats."""
    from .dataset import command

    return command.run(arguments)


def farm(arguments: argparse.Namespace) -> int | None:
    """Plan, run or follow a farm job."""
    from .farm import command

    return command.run(arguments, _find_source)


def stations(arguments: argparse.Namespace) -> None:
    """Make or list a station file."""
    from .stations import command

    command.run_stations(arguments, _open_fire)


def resources(arguments: argparse.Namespace) -> int:
    """List resources that match a query."""
    from .stations import command

    return command.find_resources(arguments, _open_fire)


def tiles(arguments: argparse.Namespace) -> None:
    """Read a tileset, or make one."""
    if arguments.verb == "make":
        _make_tiles(arguments)
        return
    from .jobs.tiles.access import apply_preferences
    from .tiles import command

    command.run(arguments, apply_preferences(_tile_access(arguments)).network())


def _tile_access(arguments: argparse.Namespace) -> TileAccess:
    """Collect the options on access to tiles."""
    from .jobs.tiles.access import TileAccess

    return TileAccess(
        strict=arguments.strict,
        online=not arguments.offline,
        hosts=tuple(arguments.host),
        private=arguments.private,
        root=arguments.tile_root,
    )


def _make_tiles(arguments: argparse.Namespace) -> None:
    from .jobs.tiles import imagery, make

    request = make.TilesRequest(
        arguments.out, arguments.levels, arguments.buildings, arguments.geoid, arguments.credit
    )
    choice, reporter = _find_source(arguments), Reporter("tiles")
    imagery.prepare(choice, (), reporter, say)
    made = make.run(choice.shot(), request, reporter, say)
    errors = ", ".join(f"{error:.3g}" for error in made.errors)
    buildings = f" with {count(made.buildings, 'building')}" if made.buildings else ""
    say(f"{count(made.tiles, 'tile')}{buildings}, {size(made.bytes)}; errors of the levels: {errors} m")
    result(arguments.out / "tileset.json")


def allocate(arguments: argparse.Namespace) -> None:
    """Suggest an allocation of resources. Exercise: not operational advice."""
    from .allocation import command

    command.run(arguments, _open_run)


def track(arguments: argparse.Namespace) -> None:
    """Write a camera's path as a GPX track."""
    from . import files
    from .errors import UsageError
    from .shot import comparison
    from .shot.cameras import track_xml

    if arguments.out.suffix.lower() != ".gpx":
        raise UsageError(f"--out: {arguments.out} does not end in .gpx; name a .gpx file")
    shot = _find_source(arguments).shot()
    names = [camera.name for camera in shot.settings.cameras]
    if not names:
        raise UsageError(f"{arguments.scene} has no [[cameras]]; add one to write its path")
    alone = comparison.for_view(shot, arguments.camera or names[0])
    (view,) = alone.paths
    moments = [alone.utc(frame) for frame in range(1, alone.frames.count + 1)]
    text = track_xml.gpx_text(view.camera.name, *alone.local_frame.reverse(view.position), moments)
    files.write_text(arguments.out, text)
    result(arguments.out)


def cache(arguments: argparse.Namespace) -> None:
    """List cached smoke volumes and tiles, or remove the least recently used."""
    from .jobs import cache

    folders = cache.folders(arguments.places or [Path("cache")])
    kept = cache.by_last_use(folders)
    where = " and ".join(map(str, folders))
    folder, number, total, used = cache.answers()
    if not arguments.prune:
        _list_cached(kept)
        if number:
            ago = duration(time.time() - used)
            result(f"{folder}  {size(total)}  {count(number, 'response')}, used {ago} ago")
        say(f"{size(sum(each.bytes for each in kept))} of {_name_content(kept)} in {where}")
        return
    gone = cache.prune(kept, arguments.limit, arguments.dry_run)
    _list_cached(gone)
    freed = sum(each.bytes for each in gone)
    left = sum(each.bytes for each in kept) - freed
    word = "would free" if arguments.dry_run else "freed"
    say(f"{word} {size(freed)}; {size(left)} of {_name_content(kept)} remain in {where}")
    if number:
        left = cache.prune_answers(arguments.answers, arguments.dry_run)
        say(f"{word} {size(total - left)}; {size(left)} of tile server responses remain in {folder}")


def _name_content(kept: Iterable[Cached]) -> str:
    """Name the content of a cache."""
    from .jobs.tiles.cache import CachedTiles

    has_tiles = any(isinstance(each, CachedTiles) for each in kept)
    return "smoke volumes and tiles" if has_tiles else "smoke volumes"


def _list_cached(kept: Iterable[Cached]) -> None:
    for each in kept:
        ago = "in use" if each.in_use else f"used {duration(time.time() - each.used)} ago"
        result(f"{each.folder}  {size(each.bytes)}  {ago}")


def gpu(arguments: argparse.Namespace) -> None:
    """List GPUs, or prepare their kernels."""
    from .jobs import gpu

    if arguments.kernels:
        lines = gpu.make_kernels(arguments.kernels, say)
    else:
        lines = gpu.warm(say) if arguments.warm else gpu.describe(say)
    result("\n".join(lines))


def assets(arguments: argparse.Namespace) -> None:
    """Write the asset library."""
    import tempfile

    from .jobs import assets
    from .shot.source import ShotSource

    with tempfile.TemporaryDirectory() as folder:
        scene = arguments.scene
        if scene is None:
            from .data import sample

            say("writing a small sample run, which the assets are made for")
            sample.write(Path(folder) / "sample", 13)
            scene = Path(folder) / "scene.toml"
            scene.write_text(assets.SCENE, encoding="utf-8")
        number = assets.run(ShotSource(scene=str(scene)), arguments.out, Reporter(), say)
    say(f"{count(number, 'asset')} in {arguments.out}")
    result(arguments.out / assets.BLEND)


def schema(arguments: argparse.Namespace) -> None:
    """Print the JSON Schema of scene files."""
    from .shot.schema.json_schema import json_schema
    from .shot.settings import Settings

    print(json.dumps(json_schema(Settings), indent=1, ensure_ascii=False))


def bench(arguments: argparse.Namespace) -> int:
    """Measure, and print the tables; the exit status is 1 if a target is missed."""
    from .bench import measure

    say("measuring run time and error of all tools in turn")
    from .bench import table

    report = measure(arguments.runs, Reporter())
    if arguments.json:
        result(json.dumps(report.as_json(), indent=1))
    else:
        result(table.markdown(report) if arguments.markdown else table.page(report))
    missed = sum(not target.met for target in report.targets)
    say(f"{len(report.targets) - missed} of {len(report.targets)} targets met")
    return 1 if missed else 0


def _render_json(out: Path, made: RenderResult) -> dict[str, Any]:
    """Collect the result of a render for JSON; memory in bytes, None if unknown."""
    memory = {"expected": made.expected or None, "peak": made.peak or None}
    return {"folder": str(out), "pictures": made.pictures, "files": _finished_files(out), "memory": memory}


def _finished_files(out: Path) -> list[str]:
    """List the finished files, relative to the folder."""
    from .render.store import Store

    with Store(out) as store:
        return store.names()


def _list_output(out: Path) -> None:
    """List the output: a line per folder of pictures and per film."""
    from .render import manifest
    from .render.picture import FILM_SUFFIXES

    files = _finished_files(out)
    folders: dict[str, int] = {}
    for name in files:
        if not name.endswith(FILM_SUFFIXES):
            kind = f"{Path(name).parent}/*{Path(name).suffix}"
            folders[kind] = folders.get(kind, 0) + 1
    for kind, number in folders.items():
        result(f"{out / kind}  {count(number, 'picture')}")
    for name in files:
        if name.endswith(FILM_SUFFIXES):
            result(out / name)
    result(out / manifest.NAME)


def _open_runs(scene: Path) -> dict[str, Run]:
    """Open all runs of a scene file, by name and in order."""
    from .shot.source import ShotSource

    return _runs(ShotSource(scene=str(scene)).shot())


def _runs(shot: Shot) -> dict[str, Run]:
    """Return all runs of a shot, by name and in order."""
    return {shot.label: shot.run, **shot.others}


def _open_run(folder: Path) -> Run:
    from .run import readers

    return readers.open(folder)


def _open_fire(path: Path) -> Fire:
    """Open the run of a folder, or the first run of a scene file, with the head of its fire."""
    from .shot.runs.run_head import Head
    from .stations.command import Fire

    run = (
        next(iter(_open_runs(path).values()))
        if path.suffix == ".toml" and path.is_file()
        else _open_run(path)
    )
    return Fire(run, Head(run))


def _find_source(arguments: argparse.Namespace) -> ShotSource:
    """Find the shot source: a scene file, or for a run folder a fitted scene file in the cache."""
    import hashlib

    from . import files
    from .run.readers import folder
    from .shot.source import ShotSource

    scene, cache = arguments.scene, Path("cache")
    if folder.sniff(scene):
        text = _fit_scene(scene, cache / "scene.toml", cache)
        scene = cache / f"{scene.absolute().name}-{hashlib.sha256(text.encode()).hexdigest()[:12]}.toml"
        files.write_text(scene, text)
        say(f"these settings are in {scene}; to edit them, run: firetwin new {arguments.scene} -o SCENE.toml")
    return ShotSource(
        scene=str(scene),
        beside=getattr(arguments, "run", None) or "",
        preset=getattr(arguments, "preset", None) or "",
    )


def _fit_scene(
    run: Path, path: Path, cache: Path, asked: tuple[datetime | None, datetime | None] = (None, None)
) -> str:
    """Write the text of a scene file `path` that fits a run in the requested times; prints its choices."""
    from . import auto_framing
    from .errors import UsageError
    from .progress import READING, notify_if_slow
    from .run import times
    from .shot.sections import Time

    opened, window = _open_run(run), Time(*asked)
    first, last = (times.utc(opened, float(opened.times[i])) for i in (0, -1))
    for name, moment in zip(("start", "end"), asked, strict=True):
        if moment is not None and not first <= moment <= last:
            raise UsageError(
                f"--{name}: is outside the run, which covers {times.iso(first)} to {times.iso(last)}"
            )
    if wrong := window.validate():
        raise UsageError(f"--end: {wrong[1]}")
    with notify_if_slow(READING):
        fitted = auto_framing.fit_folder(run, path, cache, window)
    for line in fitted.lines:
        say(line)
    frames, cores = fitted.settings.time.frames, os.cpu_count() or 1
    film = f"about {duration(frames * _FRAME_SECONDS / cores)} on {count(cores, 'core')}"
    say(f"a camera films {count(frames, 'frame')}: {film}, once its smoke is solved")
    return fitted.text
