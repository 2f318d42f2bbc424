"""Storyboard: shots of a film with times, cameras and captions, and shots that the run cannot give."""

# ruff: noqa: RUF009 (`key` makes a field)

from __future__ import annotations

from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from ..shot import passes
from ..shot.schema import Where, key
from ..shot.schema.bounds import file_name, twice
from ..shot.sections.time import invalid_zone
from .words import Words

CARD, MAP, SCENE = "card", "map", "scene"
PICTURES = {
    CARD: "its caption on a dark ground",
    MAP: "the burned area by time on the relief",
    SCENE: "rendered",
}
GLOBE, FLIGHT, FRONT, NEAR, GROUND = "globe", "flight", "front", "near", "ground"
ABOVE, GOES = "above", "goes"
CAMERAS = GLOBE, FLIGHT, FRONT, NEAR, GROUND, ABOVE, GOES
"""Cameras of stories; others come from auto framing and from the scene file."""


def _film_passes() -> tuple[str, ...]:
    return tuple(name for name, each in passes.known().items() if each.film)


@dataclass(frozen=True)
class StoryShot:
    """One shot of a story."""

    name: str = key("", "unique name of the shot", check=file_name)
    picture: str = key(SCENE, "kind of its pictures", choices=PICTURES)
    camera: str = key(
        "",
        f"camera: {', '.join(CAMERAS)}, overview, chase, flank, satellite, or one of the scene file",
    )
    place: str = key("", "place of the camera on the ground, by its name")
    render_pass: str = key("rgb", "pass of the pictures", choices=_film_passes)
    wipe_from: str = key(
        "", "shot of the same camera and times: its pictures are left of a line that moves across"
    )
    smoke: bool = key(True, "draw the smoke")
    observed: bool = key(False, "draw observed perimeters")
    step: float = key(0.0, "model time between its pictures; 0: by quality", unit="s", at_least=0)
    start: datetime | None = key(None, "model time at its start")
    end: datetime | None = key(None, "model time at its end")
    seconds: float = key(0.0, "length in the film", unit="s", at_least=0.5, at_most=600)
    caption: str = key("", "caption; lines of a card")
    reason: str = key("", "reason for the shot")

    @property
    def speed(self) -> float:
        """Speed, times real time; 0 without times."""
        if self.start is None or self.end is None:
            return 0.0
        return (self.end - self.start).total_seconds() / self.seconds

    def validate(self) -> tuple[Where, str] | None:
        """Check that it has the times and the camera that its pictures need."""
        if self.picture == CARD:
            return None
        if self.start is None or self.end is None:
            return (
                "start" if self.start is None else "end",
            ), "shots.start and shots.end are missing; add both"
        if self.end <= self.start:
            return ("end",), "shots.end must be later than shots.start"
        if self.picture == SCENE and not self.camera:
            return ("camera",), "shots.camera is missing; name a camera"
        return None


@dataclass(frozen=True)
class Omission:
    """A shot that the run cannot give."""

    name: str = key("", "name of the shot")
    reason: str = key("", "reason why it is omitted")


@dataclass(frozen=True)
class Storyboard:
    """Storyboard of a film."""

    path: Path = Path("story.toml")
    run: Path = key(Path("sample"), "run folder")
    scene: Path | None = key(None, "scene file, whose settings and cameras shots use")
    zone: str = key("", "time zone of the captions; empty: the run's zone", check=invalid_zone)
    units: str = key("us", "units that come first", choices=("us", "metric"))
    fps: int = key(24, "frames per second", at_least=1, at_most=60)
    dissolve: float = key(0.5, "length of a dissolve between shots; 0: cuts", unit="s", at_least=0, at_most=5)
    words: Words = key(Words(), "words that the film adds; translate them, as the captions")
    shots: tuple[StoryShot, ...] = key((), "shots, in the order of the film")
    omitted: tuple[Omission, ...] = key((), "shots that the run cannot give")

    def passes_of(self, shot: StoryShot) -> tuple[str, ...]:
        """Return the passes that a shot's camera records: its own and its wipes'."""
        wipes = (each.render_pass for each in self.shots if each.wipe_from == shot.name)
        return tuple(dict.fromkeys((shot.render_pass, *wipes)))

    def validate(self) -> tuple[Where, str] | None:
        """Check that there are shots, with unique names."""
        if not self.shots:
            return ("shots",), "there are no [[shots]]; add one, or delete the file to choose them again"
        names = [shot.name for shot in self.shots]
        shots = dict(zip(names, self.shots, strict=True))
        for number, shot in enumerate(self.shots):
            if shot.wipe_from and not (
                shot.wipe_from in shots and _shows_the_same(shot, shots[shot.wipe_from])
            ):
                reason = (
                    f'shots.wipe_from "{shot.wipe_from}" is not a shot of the same camera, times and length'
                )
                return ("shots", number, "wipe_from"), f"{reason}; remove the key"
        if (second := twice(names)) is not None:
            return ("shots", second, "name"), f'two shots are called "{names[second]}"; rename one'
        return None


def _shows_the_same(one: StoryShot, other: StoryShot) -> bool:
    """Return whether two shots have the same camera and times."""
    compared = ("picture", "camera", "place", "start", "end", "seconds", "step")
    return one is not other and all(getattr(one, name) == getattr(other, name) for name in compared)
