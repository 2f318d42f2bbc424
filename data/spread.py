"""Fire spread over the sample's terrain and fuels with pyretechnics."""

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray
from pyretechnics.eulerian_level_set import SpreadState, spread_fire_with_phi_field
from pyretechnics.space_time_cube import SpaceTimeCube

from . import corridor, stored, weather
from .fractal import fractal, smooth
from .fuels import Fuels
from .grid import FUEL_CELL_SIZE, FUEL_CELLS, MODEL_CELLS, cell_of
from .history import Event
from .stored import FireSpread
from .weather import Channel

BAND = 30.0  # minutes for which the weather is taken as constant
BANDS = 62  # 31 hours
RUN_WIDTH = 650.0  # m, half width of the way of the run of 17 September
# End of a period (minutes after the start) -> how much faster fire spreads on the way of the run.
# With the period's factor (simulate.py) the run itself goes 2.6 times as fast as the model says without it.
LEAD = {615.0: 1.5, 915.0: 8.0, 1275.0: 16.0, 1335.0: 12.0}
# Most firebrands land within 300 m of the front, the farthest some 1.2 km ahead of the crown fire.
SPOTTING = {
    "random_seed": 917,
    "firebrands_per_unit_heat": 2e-9,
    "downwind_distance_mean": 6.0,
    "fireline_intensity_exponent": 0.4,
    "wind_speed_exponent": 0.35,
    "downwind_variance_mean_ratio": 120.0,
    "crosswind_distance_stdev": 90.0,
    "decay_distance": 1200.0,
}


class Fire:
    """Fuel and weather for pyretechnics."""

    def __init__(self, event: Event, fuel: Fuels, channel: Channel) -> None:
        self.event = event
        self.corridor = corridor.nearness((FUEL_CELLS, FUEL_CELLS), RUN_WIDTH)
        self.cubes = (
            _fuel_cubes(fuel) | _weather_cubes(channel) | {"fuel_spread_adjustment": _cube(_defence())}
        )

    def _simulate(
        self,
        state: SpreadState,
        start: float,
        minutes: float,
        factor: float,
        spots: dict,
        seed: int,
        lead: float,
    ) -> dict:
        adjust = factor * (1 + lead * self.corridor)
        self.cubes["weather_spread_adjustment"] = _cube(adjust)
        first = {"start_time": start, "cube_resolution": (BAND, FUEL_CELL_SIZE, FUEL_CELL_SIZE)}
        fresh = state.get_simulation_time() < 0
        return spread_fire_with_phi_field(
            self.cubes,
            state,
            max_duration=minutes,
            max_cells_per_timestep=0.4,
            surface_lw_ratio_model="behave",
            crown_max_lw_ratio=6.0,
            spot_ignitions=dict(spots),
            spot_config=SPOTTING | {"random_seed": SPOTTING["random_seed"] + seed},
            **(first if fresh else {}),
        )

    def grow_initial(self, acres: float) -> FireSpread:
        """Grow a fire of `acres` from the ignition point, with negative arrival times.

        The shape is simulated in the first night's light wind; times are then stretched so that the area
        follows the reports since the ignition.
        """
        state = SpreadState((BANDS, FUEL_CELLS, FUEL_CELLS))
        origin = self.event.ignitions[0]
        row, column = cell_of(origin.latitude, origin.longitude)
        block = np.full((5, 5), -1.0, dtype=np.float32)
        state.ignite_cells((int(row) - 2, int(column) - 2), block)
        cells = round(acres / stored.ACRES_PER_CELL)
        spots: dict = {}
        start = 60.0
        while True:
            done = self._simulate(state, start, 30.0, 5.0, spots, 0, 0.0)
            state, spots, start = done["spread_state"], done["spot_ignitions"], done["stop_time"]
            order = np.array(state.get_full_matrices(["time_of_arrival"])["time_of_arrival"])
            if np.isfinite(order).sum() >= cells:
                break
            if start > 29 * 60:
                raise RuntimeError(
                    f"only {np.isfinite(order).sum()} of {cells} cells burned in the initial fire"
                )
        flat = order.ravel()
        rank = np.argsort(np.where(np.isfinite(flat), flat, np.inf), kind="stable")[:cells]
        since = [(origin.time, 0.0)] + [(time, area) for time, area, _ in self.event.acreages]
        seconds = [(time - stored.START).total_seconds() for time, _ in since]
        areas = [area / stored.ACRES_PER_CELL for _, area in since]
        arrival = np.full(flat.size, np.nan)
        arrival[rank] = np.minimum(np.interp(np.arange(1, cells + 1), areas, seconds), -1.0)
        return _result(state, arrival.reshape(order.shape))

    def _begin(self, before: FireSpread) -> SpreadState:
        state = SpreadState((BANDS, FUEL_CELLS, FUEL_CELLS))
        state.ignite_cells((0, 0), np.where(np.isfinite(before.arrival), -1.0, 1.0).astype(np.float32))
        return state

    def tune(
        self, before: FireSpread, periods: Sequence[float], cells: Sequence[float], say: Callable[[str], None]
    ) -> list[tuple[float, float]]:
        """Factor per period so that `cells` cells have burned at its end, by bisection on its logarithm."""
        state, start, spots, factors = self._begin(before), 0.0, {}, []
        for number, (end, wanted) in enumerate(zip(periods, cells, strict=True)):
            low, high, best = np.log(0.02), np.log(8.0), None
            for _ in range(12):
                factor = float(np.round(np.exp((low + high) / 2), 4))
                trial = self._simulate(
                    state.copy(), start, end - start, factor, _copy(spots), number, lead_at(end)
                )
                burned = _burned(trial["spread_state"])
                say(f"until minute {end}: factor {factor} burns {burned} of {wanted:.0f} cells")
                if best is None or abs(burned - wanted) < abs(best[0] - wanted):
                    best = burned, factor, trial
                low, high = (low, np.log(factor)) if burned > wanted else (np.log(factor), high)
                if high - low < 0.04:  # spotting is random, so area is not quite monotone: look around again
                    low, high = low - 0.15, high + 0.12
                if abs(burned / wanted - 1) < 0.01:
                    break
            _, factor, done = best
            factors.append((end, factor))
            state, spots, start = done["spread_state"], done["spot_ignitions"], end
        return factors

    def run(self, before: FireSpread, factors: Sequence[tuple[float, float]]) -> FireSpread:
        """Spread the fire `before` to the end of the last period."""
        state, start, spots = self._begin(before), 0.0, {}
        for number, (end, factor) in enumerate(factors):
            done = self._simulate(state, start, end - start, factor, spots, number, lead_at(end))
            state, spots, start = done["spread_state"], done["spot_ignitions"], end
        minutes = np.array(state.get_full_matrices(["time_of_arrival"])["time_of_arrival"], dtype=float)
        after = _result(state, minutes * 60)
        inside = np.isfinite(before.arrival)
        return FireSpread(*(np.where(inside, old, new) for old, new in zip(before, after, strict=True)))


def _result(state: SpreadState, arrival: NDArray) -> FireSpread:
    """Read the state of cells with an arrival time."""
    matrices = state.get_full_matrices(["fireline_intensity", "fire_type"])
    burned = np.isfinite(arrival)
    intensity = np.where(burned, matrices["fireline_intensity"], 0).astype(np.float32)
    crown = np.where(burned, np.clip(matrices["fire_type"].astype(int) - 1, 0, 2), 0).astype(np.uint8)
    return FireSpread(arrival, intensity, crown)


def lead_at(end: float) -> float:
    """Return the acceleration along the corridor in the period that ends at minute `end`."""
    return LEAD.get(end, 0.0)


def _burned(state: SpreadState) -> int:
    return int(np.isfinite(np.asarray(state.get_full_matrices(["time_of_arrival"])["time_of_arrival"])).sum())


def _copy(spots: dict) -> dict:
    return {time: set(cells) for time, cells in spots.items()}


def _cube(values: NDArray | float) -> SpaceTimeCube:
    return SpaceTimeCube((BANDS, FUEL_CELLS, FUEL_CELLS), np.asarray(values, dtype=np.float32))


def _fuel_cubes(fuel: Fuels) -> dict[str, SpaceTimeCube]:
    """Fuel models (Scott & Burgan 2005) and canopy from the two loads."""
    model = np.select(
        [fuel.surface <= 0, fuel.canopy > 1.2, fuel.canopy > 0.35, fuel.canopy > 0.01, fuel.surface > 0.7],
        [91, 10, 165, 122, 142],  # none, timber with understory, the same drier, grass and shrub, shrub
        default=102,  # grass
    )
    height = np.where(fuel.canopy > 0.01, 9 + 9 * np.minimum(fuel.canopy, 2.2), 0)
    base = np.where(fuel.canopy > 0.01, 0.9 + 0.06 * height, 0)
    depth = np.maximum(height - base, 1)
    return {
        "slope": _cube(fuel.slope),
        "aspect": _cube(fuel.aspect),
        "fuel_model": SpaceTimeCube((BANDS, FUEL_CELLS, FUEL_CELLS), model.astype(np.float32)),
        "canopy_cover": _cube(np.clip(0.55 * fuel.canopy, 0, 0.8)),
        "canopy_height": _cube(height),
        "canopy_base_height": _cube(base),
        "canopy_bulk_density": _cube(np.minimum(fuel.canopy / depth, 0.3)),
    }


def _weather_cubes(channel: Channel) -> dict[str, SpaceTimeCube]:
    times = (np.arange(BANDS) + 0.5) * BAND * 60
    east, north = np.zeros((2, BANDS, MODEL_CELLS, MODEL_CELLS), dtype=np.float32)
    for band, time in enumerate(times):
        east[band], north[band] = weather.channelled(*weather.open_wind(time), channel)
    moisture = weather.dead_fuel_moisture(times)
    shape = (BANDS, 1, 1)
    return {
        "wind_speed_10m": _cube(np.hypot(east, north) * 3.6),
        "upwind_direction": _cube(np.degrees(np.arctan2(-east, -north)) % 360),
        "temperature": _cube((weather.temperature(times, weather.REFERENCE_HEIGHT) - 273.15).reshape(shape)),
        "fuel_moisture_dead_1hr": _cube(moisture.reshape(shape)),
        "fuel_moisture_dead_10hr": _cube((moisture + 0.01).reshape(shape)),
        "fuel_moisture_dead_100hr": _cube((moisture + 0.02).reshape(shape)),
        "fuel_moisture_live_herbaceous": _cube(0.45),
        "fuel_moisture_live_woody": _cube(0.75),
        "foliar_moisture": _cube(0.85),
    }


def _defence() -> NDArray[np.float64]:
    """Spread is held in the south, where crews kept the fire north of US 50, and in the west (fy, fx)."""
    row_south, _ = cell_of(38.765, -120.5)
    _, column_west = cell_of(38.8, -120.700)
    y, x = np.indices((FUEL_CELLS, FUEL_CELLS))
    south = np.clip((y - float(row_south)) / 20, 0.02, 1)
    west = np.clip((x - float(column_west)) / 40, 0.02, 1)
    return smooth(south * west, 4) * np.exp(0.25 * fractal(y.shape, 32, 60, 4, 1.2))
