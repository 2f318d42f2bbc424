"""Captions of a film: words, local time and UTC, speed, and burned area, all from the run; as SRT and WebVTT.

A caption stays for at least `_STEP` seconds, so that people can read it. Its numbers belong to the model time
that it names.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime, timedelta
from typing import cast

from firetwin_core.run import Run

from ..run import info, times
from ..run.measure import Units
from ..shot.frames import TIME_LAPSE
from .storyboard import Storyboard
from .timeline import Span

SEPARATOR = " | "
_STEP, _FAST_STEP = 2.0, 0.5  # s; least time of a caption, and of one of a time-lapse
_RATE_OVER = 4  # captions of a time-lapse, over which it shows the rate of growth
_ROUND = (1, 60, 300, 600, 900, 1800, 3600, 10800)  # s; steps of clocks


@dataclass(frozen=True)
class Caption:
    """Caption of the frames from `first` to before `end` of a shot: its words, and facts of a model time.

    Attributes
    ----------
    moment
        Model time of the facts, UTC; None on cards.
    area
        Area burned by then, m2.
    growth
        Its rate, m2/h, over the captions before; 0 except in a time-lapse.
    mark
        Further words of the text, which a picture has elsewhere.
    """

    span: Span
    first: int
    end: int
    words: str
    moment: datetime | None = None
    facts: str = ""
    area: float = 0.0
    growth: float = 0.0
    mark: str = ""

    @property
    def lines(self) -> str:
        """Facts for the picture, in two lines; the lower one ends before the mark."""
        clock, *others = self.facts.split(SEPARATOR)
        rate = [others.pop()] if self.growth > 0.0 else []
        return "\n".join(map(SEPARATOR.join, ([clock, *rate], others))) if others else self.facts

    @property
    def text(self) -> str:
        """Words, facts and mark."""
        return f"{self.words}\n{self.facts}{self.mark and SEPARATOR}{self.mark}".strip()


def make(story: Storyboard, spans: Sequence[Span], run: Run) -> list[Caption]:
    """Make the captions of a film, ascending."""
    captions = [each for span in spans for each in _unfilled(story, span)]
    moments = [times.seconds(run, each.moment) for each in captions if each.moment]
    burned = iter(info.burned(run, moments) if moments else [])
    captions = [replace(each, area=next(burned)) if each.moment else each for each in captions]
    return [
        _filled(story, run, each, _growth(captions, number)) if each.moment else each
        for number, each in enumerate(captions)
    ]


def _growth(captions: Sequence[Caption], number: int) -> float:
    """Return the rate of growth (m2/h) up to a caption of a time-lapse; 0 for the first one, and others."""
    now = captions[number]
    shown = [each for each in captions[max(number - _RATE_OVER, 0) : number] if each.span is now.span]
    if not (shown and now.span.shot.speed > TIME_LAPSE[0] and now.moment and shown[0].moment):
        return 0.0
    return (now.area - shown[0].area) / ((now.moment - shown[0].moment).total_seconds() / 3600.0)


def _unfilled(story: Storyboard, span: Span) -> Iterator[Caption]:
    """Yield the captions of a shot without facts; captions of one model time are joined."""
    words, end = span.shot.caption.strip(), span.free
    if span.moment(span.first) is None:
        yield Caption(span, span.first, end, words)
        return
    fast = span.shot.speed > TIME_LAPSE[0]
    step = max(round((_FAST_STEP if fast else _STEP) * story.fps), 1)
    steps = max((end - span.first) // step, 1)
    firsts = [span.first + step * k for k in range(steps)]
    moments = [_readable(span, first + fast * (step // 2), step / story.fps) for first in firsts]
    begin = 0
    for k in range(1, steps + 1):
        if k == steps or moments[k] != moments[begin]:
            yield Caption(span, firsts[begin], end if k == steps else firsts[k], words, moments[begin])
            begin = k


def _readable(span: Span, frame: int, seconds: float) -> datetime:
    """Return the model time of a frame, in steps that fit captions of `seconds` in the film."""
    moment, start = span.moment(frame), span.shot.start
    assert moment
    assert start
    most = 0.5 * seconds * span.shot.speed
    step = timedelta(seconds=max((step for step in _ROUND if step <= most), default=_ROUND[0]))
    return max(moment - (moment - datetime(moment.year, 1, 1, tzinfo=moment.tzinfo)) % step, start)


def _filled(story: Storyboard, run: Run, caption: Caption, growth: float) -> Caption:
    """Add the facts to a caption: clocks, speed, area, and its growth (m2/h) if there is any."""
    assert caption.moment
    words, units = story.words, cast(Units, story.units)
    facts = [
        words.date(clocks(caption.moment, story.zone or "UTC")),
        words.pace(caption.span.shot.speed),
        words.area(caption.area, units),
    ]
    facts += [words.rate(growth, units)] * (growth > 0.0)
    mark = words.synthetic if run.synthetic else ""
    return replace(caption, facts=SEPARATOR.join(facts), growth=growth, mark=mark)


def clocks(moment: datetime, zone: str) -> str:
    """Format local time and UTC: ``17 Sep 2014 19:00:02 PDT (18 Sep 02:00:02 UTC)``."""
    local, utc = (times.text(moment, each, moment.second > 0) for each in (zone, "UTC"))
    day, month, year, *clock = utc.split(" ")
    if local.rpartition(" ")[0] == utc.rpartition(" ")[0]:
        return utc
    if local.startswith(f"{day} {month} {year} "):
        return f"{local} ({' '.join(clock)})"
    return f"{local} ({' '.join([day, month, *clock])})"


def srt(captions: Sequence[Caption], fps: int) -> str:
    """Format captions as SubRip."""
    return "\n".join(
        f"{number}\n{_span(each, fps, ',')}\n{_plain(each)}\n" for number, each in enumerate(captions, 1)
    )


def vtt(captions: Sequence[Caption], fps: int) -> str:
    """Format captions as WebVTT."""
    cues = (f"{_span(each, fps, '.')}\n{_escaped(_plain(each))}\n" for each in captions)
    return "\n".join(["WEBVTT\n", *cues])


def _plain(caption: Caption) -> str:
    """Return the text without empty lines, which end a cue."""
    return "\n".join(line for line in caption.text.splitlines() if line.strip()).replace("-->", "->")


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def _span(caption: Caption, fps: int, mark: str) -> str:
    """Format the times of a caption in the film: ``00:00:05,000 --> 00:00:07,000``."""
    return " --> ".join(_clock((frame - 1) / fps, mark) for frame in (caption.first, caption.end))


def _clock(seconds: float, mark: str) -> str:
    whole, thousandths = divmod(round(seconds * 1000.0), 1000)
    return f"{whole // 3600:02d}:{whole // 60 % 60:02d}:{whole % 60:02d}{mark}{thousandths:03d}"
