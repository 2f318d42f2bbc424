"""Simulate the sample's fire with pyretechnics and store the result: `python -m firetwin.data.simulate`.

Needs the optional extra "simulate". Rothermel surface spread, Cruz crown fire, spotting and a level set on
the fuel grid, from the perimeter of 16 September 2014 21:45 PDT for 1,857 minutes. Terrain, fuels and weather
are invented (terrain.py, fuels.py, weather.py). Spread rates are multiplied by factors per period so that
burned areas follow the reported ones (data/king_fire.toml), and by a corridor that leads the run of 17
September up the Rubicon canyon; both replace processes outside of the model, chiefly the fire-induced wind
and the work of crews. `--tune` finds the factors again.
"""

import argparse
import hashlib
import sys
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from . import fuels, history, spread, stored, terrain, valleys

# Factors on spread rate that `--tune` found: (minutes after the start at which the period ends, factor).
FACTORS = ((615, 1.4834), (915, 0.3317), (1275, 0.1532), (1335, 0.3317), (1815, 1.7889), (1857, 0.4))


def main() -> int:
    """Run the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m firetwin.data.simulate", description=__doc__.split("\n")[0]
    )
    parser.add_argument("--out", type=Path, default=stored.PATH, help="file of the result")
    parser.add_argument(
        "--tune", action="store_true", help="search the factors on spread rate, then print them"
    )
    options = parser.parse_args()

    event = history.load()
    land = terrain.make(event)
    say(f"terrain: RMS misfit {terrain.rms(land.misfit):.1f} m at {len(land.misfit)} spot heights")
    fuel = fuels.make(event, land)
    canopy, surface = np.mean(fuel.canopy > 0.01), np.mean(fuel.surface > 0)
    say(f"fuels: canopy on {canopy:.2%} of cells, surface fuel on {surface:.2%}")
    channel = valleys.channel(land.elevation)
    fire = spread.Fire(event, fuel, channel)
    targets = reported_acres(event)
    before = fire.grow_initial(targets[0.0])
    say("initial perimeter grown")
    if options.tune:
        periods = [minute for minute, _ in FACTORS]
        wanted = [acres_at(minute, targets) for minute in periods]
        factors = tuple(fire.tune(before, periods, [acres / stored.ACRES_PER_CELL for acres in wanted], say))
        say(f"FACTORS = {factors}")
    else:
        factors = FACTORS
    result = fire.run(before, factors)
    stored.save(options.out, land, fuel, channel, result)
    for minute, acres in targets.items():
        burned = float((result.arrival <= minute * 60).sum() * stored.ACRES_PER_CELL)
        error = burned / acres - 1
        print(f"minute {minute:6.0f}: {burned:8.0f} acres, reported {acres:6.0f}, error {error:+.1%}")
    print(f"{options.out}: {options.out.stat().st_size / 1e6:.2f} MB, sha256 {digest(options.out)}")
    return 0


def reported_acres(event: history.Event) -> dict[float, float]:
    """Return minutes after the start -> reported acres, for the reports within the run."""
    result = {}
    for report in event.acreages:
        minute = (report.time - stored.START).total_seconds() / 60
        if 0 <= minute <= stored.MINUTES:
            result[minute] = report.acres
    return result


def acres_at(minute: float, targets: dict[float, float]) -> float:
    """Return the target acres: reported, with the shape of the day between (slow morning, steady night)."""
    aims = dict(targets) | {915.0: 20300.0, 1335.0: 31000.0, 1857.0: 71600.0}
    times = sorted(aims)
    return float(np.interp(minute, times, [aims[time] for time in times]))


def digest(path: Path) -> str:
    """SHA-256 of a file."""
    return hashlib.sha256(path.read_bytes()).hexdigest()


def say(text: str) -> None:
    """Report progress on stderr."""
    print(f"{datetime.now(UTC):%H:%M:%S} {text}", file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
