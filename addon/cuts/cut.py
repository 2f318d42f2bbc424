"""Cut of films: stretches of frames, and the clips of a timeline.

Frames have their numbers in the scene, from 1; frame 1 is the start of the timeline. A film has the frames
that its camera rendered, one after another; their numbers may have gaps.
"""

from __future__ import annotations

import bisect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from fractions import Fraction

from .. import timecode


@dataclass(frozen=True)
class Stretch:
    """Consecutive frames of a film.

    Attributes
    ----------
    first
        Number of the first frame.
    position
        Position of this frame in the film, from 0.
    length
        Number of frames.
    """

    first: int
    position: int
    length: int

    @property
    def last(self) -> int:
        """Number of the last frame."""
        return self.first + self.length - 1


@dataclass(frozen=True)
class CameraFilm:
    """Film of a camera.

    Attributes
    ----------
    camera
        Name of the camera.
    url
        Address of the film, relative to the edit, percent-encoded.
    frames
        Numbers of its frames, ascending.
    size
        Width and height, pixels.
    sequences
        EXR sequences of these frames, by the key of their media reference.
    slate
        Number of pictures of the film before these frames.
    """

    camera: str
    url: str
    frames: tuple[int, ...]
    size: tuple[int, int]
    sequences: Mapping[str, ImageSequence] = field(default_factory=dict)
    slate: int = 0

    @property
    def length(self) -> int:
        """Number of pictures of the film."""
        return self.slate + len(self.frames)

    @property
    def stretches(self) -> list[Stretch]:
        """Stretches of the film."""
        return stretches(self.frames)

    def start(self, rate: Fraction) -> int:
        """Return the timecode of the film's first frame, as frames since 00:00:00:00."""
        return timecode.count_of_frame(self.frames[0], rate)


@dataclass(frozen=True)
class ImageSequence:
    """EXR sequence: address of its folder, name before and after the number, and the frames that exist."""

    folder: str
    prefix: str
    suffix: str
    frames: frozenset[int]


@dataclass(frozen=True)
class Clip:
    """Frames of a stretch on the timeline: `length` frames from number `first`.

    Attributes
    ----------
    name
        Name of the clip; empty: the camera's.
    """

    film: CameraFilm
    stretch: Stretch
    first: int
    length: int
    name: str = ""

    @property
    def end(self) -> int:
        """Number of the frame after the clip."""
        return self.first + self.length

    @property
    def position(self) -> int:
        """Position of the first frame in the film, from 0."""
        return self.stretch.position + self.first - self.stretch.first

    @property
    def title(self) -> str:
        """Name of the clip, or of its camera."""
        return self.name or self.film.camera


@dataclass(frozen=True)
class Marker:
    """Marker at a frame: its text and colour."""

    frame: int
    words: str
    colour: str


@dataclass(frozen=True)
class Edit:
    """Edit: its name, frame rate, films and markers.

    Attributes
    ----------
    cut
        Clips of track V1, ascending.
    """

    name: str
    rate: Fraction
    films: tuple[CameraFilm, ...]
    cut: tuple[Clip, ...]
    markers: tuple[Marker, ...]

    @property
    def tracks(self) -> list[tuple[str, Sequence[Clip]]]:
        """Name and clips of each track: V1, then one for each camera."""
        return [("V1", self.cut), *((film.camera, clips(film)) for film in self.films)]

    @property
    def length(self) -> int:
        """Number of frames from frame 1 to the last one of any film."""
        return max(film.frames[-1] for film in self.films)


def stretches(frames: Iterable[int]) -> list[Stretch]:
    """Divide the frames of a film (ascending) into stretches of consecutive numbers."""
    parts: list[Stretch] = []
    for position, frame in enumerate(frames):
        if parts and frame == parts[-1].last + 1:
            parts[-1] = Stretch(parts[-1].first, parts[-1].position, parts[-1].length + 1)
        else:
            parts.append(Stretch(frame, position, 1))
    return parts


def clips(film: CameraFilm) -> list[Clip]:
    """Return a clip for each stretch of a film."""
    return [Clip(film, each, each.first, each.length) for each in film.stretches]


def cut(films: Sequence[CameraFilm]) -> list[Clip]:
    """Divide all frames evenly among the films, in order; each frame comes once.

    If a film misses a frame of its part, the next film that has the frame takes it; after the last film comes
    the first.
    """
    having = [frozenset(film.frames) for film in films]
    stretches_of = [film.stretches for film in films]
    every = sorted(frozenset().union(*having))
    cuts: list[Clip] = []
    for k, frame in enumerate(every):
        part = k * len(films) // len(every)
        order = [*range(part, len(films)), *range(part)]
        chosen = next(number for number in order if frame in having[number])
        if cuts and cuts[-1].film is films[chosen] and cuts[-1].end == frame:
            cuts[-1] = replace(cuts[-1], length=cuts[-1].length + 1)
        else:
            at = bisect.bisect_right(stretches_of[chosen], frame, key=lambda each: each.first) - 1
            cuts.append(Clip(films[chosen], stretches_of[chosen][at], frame, 1))
    return cuts
