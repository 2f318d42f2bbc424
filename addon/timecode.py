"""Exact frame rates, and timecode by SMPTE ST 12-1.

Rates of 24, 30 and 60 frames per second for television are divided by 1.001: 23.976 stands for 24000/1001.
Timecode numbers frames. At 30000/1001 and 60000/1001 it skips numbers (drop-frame): the first two of each
minute (four at 60) that is not a multiple of ten, so that it follows the clock to 3.6 ms in an hour. There is
no drop-frame form at 24000/1001: its timecode is 3.6 s behind the clock after an hour.
"""

from __future__ import annotations

from fractions import Fraction

_SLOWED = (24, 30, 60)  # rates that are divided by 1.001
_NEAR = 0.005  # frames per second; 23.98 is 24000/1001, too
_HOURS = 24  # timecode begins again after a day


def exact_rate(fps: float) -> Fraction:
    """Convert a decimal number to its exact rate: 29.97 -> 30000/1001; other numbers stay."""
    for rate in _SLOWED:
        if abs(fps - rate / 1.001) < _NEAR:
            return Fraction(rate * 1000, 1001)
    return Fraction(fps)


def invalid_rate(fps: float) -> str | None:
    """Check a frame rate: error message, or None if valid."""
    if exact_rate(fps).denominator in (1, 1001):
        return None
    return f"must be a whole number, 23.976, 29.97 or 59.94, not {fps:.12g}"


def nominal_rate(rate: Fraction) -> int:
    """Return the number of frames that timecode counts in a second: 30 for 30000/1001."""
    return round(rate)


def format_rate(rate: Fraction) -> str:
    """Format a rate: ``24``, ``23.976``."""
    return f"{float(rate):.5g}"


def is_drop_frame(rate: Fraction) -> bool:
    """Return whether timecode at this rate skips numbers."""
    return rate.denominator == 1001 and nominal_rate(rate) % 30 == 0


def components(count: int, rate: Fraction) -> tuple[int, int, int, int]:
    """Split a number of frames since 00:00:00:00 into hours, minutes, seconds and frames of timecode."""
    nominal = nominal_rate(rate)
    number = count % _frames_of_hours(_HOURS, rate)
    if is_drop_frame(rate):
        skipped = nominal // 15
        tens, rest = divmod(number, _frames_of_hours(1, rate) // 6)
        minutes = max(rest - skipped, 0) // (60 * nominal - skipped)
        number += skipped * (9 * tens + minutes)
    seconds, frames = divmod(number, nominal)
    return seconds // 3600, seconds // 60 % 60, seconds % 60, frames


def count_of_frame(frame: int, rate: Fraction) -> int:
    """Return the number of frames since 00:00:00:00 of a film's frame; frame 1 is at 01:00:00:00."""
    return _frames_of_hours(1, rate) + frame - 1


def of_frame(frame: int, rate: Fraction) -> str:
    """Return the timecode of a film's frame: ``01:00:00:00`` for frame 1, ``01:00:00;00`` if drop-frame."""
    hours, minutes, seconds, frames = components(count_of_frame(frame, rate), rate)
    return f"{hours:02}:{minutes:02}:{seconds:02}{';' if is_drop_frame(rate) else ':'}{frames:02}"


def _frames_of_hours(hours: int, rate: Fraction) -> int:
    """Return the number of frames of whole hours of timecode."""
    nominal = nominal_rate(rate)
    return hours * (3600 * nominal - is_drop_frame(rate) * 54 * (nominal // 15))
