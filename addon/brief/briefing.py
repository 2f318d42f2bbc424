"""Content of the briefing page, gathered from a run, its scene file, stations, film and observations."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from firetwin_core.run import Run
from numpy.typing import NDArray

from ..errors import UsageError
from ..run import areas, content, fronts, info, labels, observations, readers, score, times, zone
from ..run.fronts import Front
from ..run.labels import Label
from ..run.measure import Units
from ..run.observations import Perimeter
from ..shot.settings import Settings
from ..shot.source import ShotSource
from ..shot.terrain.elevation import Elevation
from ..stations import reading
from ..stations.records import Resource, Station
from ..stations.station_file import StationFile
from . import context, film, inputs, layers, reached
from .command import LIMIT
from .context import Context
from .film import Film
from .layers import Layer
from .reached import Reached
from .sheet_options import SheetOptions


@dataclass(frozen=True)
class Request:
    """Inputs of the page.

    Attributes
    ----------
    scene
        Scene file, or run folder.
    stations, film
        GeoPackage of stations, and folder of a film; None to omit them.
    against
        Files of observations; if empty, the files in the folder of the run.
    limit
        Maximum size of the page, bytes.
    context
        Names and files of map features (see `context`).
    sheet
        Choices for the printed sheets.
    """

    scene: Path
    stations: Path | None = None
    film: Path | None = None
    against: Sequence[str | Path] = ()
    limit: int = LIMIT
    context: Sequence[tuple[str, Path]] = ()
    sheet: SheetOptions = field(default_factory=SheetOptions)


@dataclass(frozen=True)
class Point:
    """A place on the map and in the lists: a named place, or a station with its resources.

    Attributes
    ----------
    id
        Identifier within this page.
    latitude, longitude
        Degrees.
    """

    id: str
    name: str
    latitude: float
    longitude: float
    reached: Reached
    station: Station | None = None

    @property
    def kind(self) -> str:
        """Kind of place: "station" or "place"."""
        return "station" if self.station else "place"


@dataclass(frozen=True)
class Briefing:
    """Content of the page.

    Attributes
    ----------
    elevation
        (fy, fx) on the fuel grid, m; can come from a user's elevation model.
    facts
        See `info.gather`.
    tolerance
        Maximum deviation of the simplified fronts, m.
    points
        Stations, then named places.
    observed
        Perimeters within the run's time.
    scores
        See `score.score`; None without observations, or for the reason in `no_scores`.
    others
        Names of the comparison runs of the scene file, which the page omits.
    inputs
        Files with unknown licences: role and file name.
    context
        Map features of the user, in the order of drawing.
    sheet
        Choices for the printed sheets.
    sections, sentences
        Further sections, before the others, and sentences on methods.
    """

    run: Run
    zone: str
    elevation: NDArray[np.floating]
    facts: dict[str, Any]
    layers: list[Layer]
    fronts: list[Front]
    tolerance: float
    points: list[Point]
    station_file: StationFile | None
    film: Film | None
    observed: list[Perimeter]
    scores: dict[str, Any] | None
    no_scores: str
    others: list[str]
    inputs: list[tuple[str, str]]
    context: list[Context]
    sheet: SheetOptions
    sections: tuple[str, ...] = ()
    sentences: tuple[str, ...] = ()

    @cached_property
    def moments(self) -> list[str]:
        """Local times of the fronts."""
        return [times.text(front.utc, self.zone) for front in self.fronts]

    @cached_property
    def warnings(self) -> list[tuple[str, str]]:
        """Words in large letters on each map and sheet, and their meaning."""
        warnings = []
        if self.run.synthetic:
            warnings.append(("SYNTHETIC", "Not the output of a fire model, and not a forecast"))
        if self.exercise:
            words = "Stations, resources or lines are invented: not operational advice"
            warnings.append(("EXERCISE", words))
        return warnings

    @cached_property
    def exercise(self) -> bool:
        """True if rows of the stations or map features belong to an exercise."""
        invented = self.station_file is not None and self.station_file.exercise
        return invented or any(each.exercise for each in self.context)

    @property
    def units(self) -> Units:
        """Units that come first."""
        return self.sheet.units

    @property
    def marks(self) -> tuple[str, ...]:
        """Words in large letters on each map and sheet."""
        return tuple(word for word, _ in self.warnings)

    @cached_property
    def short_sources(self) -> list[str]:
        """Name the sources in short, for the map sheet."""
        source = self.facts["source"] if isinstance(self.facts["source"], dict) else {}
        model = f", made from {source['model']}" if source.get("model") else ""
        stations = self.station_file.sources if self.station_file else ()
        named = [f"Stations: {each.name}" for each in stations]
        named += [f"{each.title}: {each.file}" for each in self.context]
        if self.observed:
            named.append(f"Perimeter: {self.observed[-1].source}")
        return [f"Fire, terrain, fuel: run {self.run.name}{model}", *dict.fromkeys(named)]

    def resources(self, station: Station) -> list[Resource]:
        """Return the resources of a station."""
        return self.station_file.resources_of[station.id] if self.station_file else []

    def origins(self, station: Station) -> set[str]:
        """Collect the origins of a station and of its resources."""
        return {station.origin, *(each.origin for each in self.resources(station))}


def gather(request: Request) -> Briefing:
    """Gather the content. Clips may fill half of the size limit of the page.

    Raises
    ------
    InputError
        A file cannot be used; the message names the file and a remedy.
    """
    run, settings, elevation = _open(request.scene)
    station_file = reading.read(request.stations) if request.stations else None
    shown = film.read(request.film, _hashes(run), request.limit // 2) if request.film else None
    clock = settings.time.zone if settings else zone.time_zone(run)
    named = request.against or observations.beside(Path(run.path))
    seen = observations.read(named)
    scores, reason = _scores(run, seen, clock, bool(request.against))
    files = sorted({observations.dates.without(each)[0].name for each in named})
    lines, tolerance = fronts.find(run, clock)
    around = context.read(request.context)
    return Briefing(
        run=run,
        zone=clock,
        elevation=elevation.fuel,
        facts=info.gather(run, clock),
        layers=layers.draw(run, elevation.fuel, clock, request.sheet.units),
        fronts=lines,
        tolerance=tolerance,
        points=_points(run, settings, station_file, clock, _arrival_error(scores), request.sheet.units),
        station_file=station_file,
        film=shown,
        observed=[p for p in seen.perimeters if run.times[0] <= times.seconds(run, p.time) <= run.times[-1]],
        scores=scores,
        no_scores=reason,
        others=[other.name for other in settings.runs] if settings else [],
        inputs=[
            *inputs.find(settings),
            *(("Observations", name) for name in files),
            *((f"Context ({each.name})", each.file) for each in around),
        ],
        context=around,
        sheet=request.sheet,
    )


def _hashes(run: Run) -> dict[str, str]:
    """Compute hashes of the small fields that distinguish runs."""
    few = {"elevation", "fuel_arrival_time", "fuel_latitude", "fuel_longitude", "latitude", "longitude"}
    hashes = content.inputs(run, Path("cache"), set(run.fields) - few)
    return {
        name: value for name, value in hashes.items() if name != "run.toml"
    }  # the name of a run can change


def _points(
    run: Run,
    settings: Settings | None,
    station_file: StationFile | None,
    clock: str,
    error: float | None,
    units: Units,
) -> list[Point]:
    """List stations, then named places within the grid, with the arrival of the fire at each."""
    towns = labels.find(run, settings.labels.file if settings else None)
    by_name = sorted(station_file.stations, key=lambda each: (each.title, each.id)) if station_file else ()
    spots: list[Station | Label] = [*by_name, *towns]
    arrivals = reached.find(
        run, [s.latitude for s in spots], [s.longitude for s in spots], clock, error, units
    )
    middle = 0.5 * float(run.longitude[0] + run.longitude[-1])
    return [
        Point(
            f"p{k}", spot.title if isinstance(spot, Station) else spot.name,
            spot.latitude, float(areas.turned(spot.longitude, middle)), how,
            spot if isinstance(spot, Station) else None,
        )
        for k, (spot, how) in enumerate(zip(spots, arrivals, strict=True))
        if isinstance(spot, Station) or how.state != "outside"
    ]  # fmt: skip


def _arrival_error(scores: dict[str, Any] | None) -> float | None:
    """Return the mean absolute error of arrival times against observations, s; None: unknown."""
    errors = (scores or {}).get("arrival")
    return errors["mae"] if errors else None


def _open(scene: Path) -> tuple[Run, Settings | None, Elevation]:
    """Open run, settings and elevation of a scene file; a run folder has no settings (None)."""
    if scene.suffix == ".toml" and scene.is_file():
        shot = ShotSource(scene=str(scene)).shot()
        return shot.run, shot.settings, shot.relief
    run = readers.open(scene)
    return run, None, Elevation(run)


def _scores(
    run: Run, seen: observations.Observations, clock: str, asked: bool
) -> tuple[dict[str, Any] | None, str]:
    """Score the run; returns scores, or None and the reason if there are observations.

    Raises
    ------
    UsageError
        Scores were requested (`asked`), and a package is missing.
    """
    if not seen.perimeters and not seen.detections:
        return None, ""
    try:
        return score.score(run, seen, zone=clock), ""
    except UsageError as error:
        if asked:
            raise
        return None, str(error)
