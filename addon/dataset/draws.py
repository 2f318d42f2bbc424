"""Draws: everything that one sample is rendered from, computed for that sample alone.

Each value is a hash of the seed of the data set, the number of the sample, the number of the try and the name
of the value. So a new value changes no other one, and samples can be drawn in any order.
"""

from __future__ import annotations

import functools
from collections import defaultdict
from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from ..errors import input_error
from ..run import times
from ..shot.cameras import rotation
from . import placement, sites, splits
from .distributions import VALUES, Distribution
from .draw import Draw, DrawnCamera
from .hashing import share
from .placement import Pose, Rejected
from .plan import POSITIVE, Plan
from .run_scene import RunScene
from .strata import Strata, Stratum

TRIES = 400
"""Tries after which a sample cannot be drawn."""
BEFORE, AFTER = -1, -2
"""Moments of samples before the first fire and after the last one."""
_LOW_SUN, _BURNED_OUT = "low_sun", "burned_out"
_CLEAR = 20  # tries of a mobile camera without fire in which its target is not beyond the visibility
_VISIBILITY = defaultdict(lambda: "visibility", fog="visibility_fog", dust="visibility_dust")
_CLOUDS = defaultdict(lambda: "cloud_cover", cloud="cloud_cover_cloud")
_SENSOR = "exposure", "read_noise", "full_well", "blur", "jpeg_quality", "netd", "saturation"

Array = NDArray[np.float64]


class _Values(dict[str, float]):
    """Values of one try, drawn at first use."""

    def __init__(self, plan: Plan, index: int, attempt: int) -> None:
        super().__init__()
        self._plan, self._key = plan, (plan.seed, index, attempt)

    def __call__(self, name: str) -> float:
        if name not in self:
            self[name] = self._plan.draws[name].quantile(self.share(name))
        return self[name]

    def share(self, name: str) -> float:
        """Return the number from 0 to 1 of a name, which need not be a value of the plan."""
        return share(*self._key, name)

    def pick(self, name: str, count: int) -> int:
        """Return a number from 0 to `count` - 1."""
        return int(self.share(name) * count)


class Drawer:
    """Draws of a plan; runs are opened at first use."""

    def __init__(self, plan: Plan) -> None:
        self.plan, self.strata = plan, Strata(plan)
        self.splits = splits.Splits(plan)
        self._scenes: dict[str, RunScene] = {}
        self._towers: dict[str, list[sites.Tower]] = {}

    def scene(self, name: str) -> RunScene:
        """Open a run."""
        if name not in self._scenes:
            self._scenes[name] = RunScene(self.plan.run(name))
        return self._scenes[name]

    def towers(self, name: str) -> list[sites.Tower]:
        """List the towers of a run."""
        if name not in self._towers:
            self._towers[name] = sites.towers(self.plan, name, self.scene(name))
        return self._towers[name]

    @functools.cache  # noqa: B019 (as long as the plan)
    def moments(self, name: str) -> list[float]:
        """Compute the model times, s, of a run's samples with fire.

        There is one in each equal part of their distribution; times outside of the run are excluded.

        Raises
        ------
        InputError
            The run begins after all times of the distribution.
        """
        scene = self.scene(name)
        (first, last), began = scene.window, scene.ignition
        chosen, count = self.plan.draws["time_since_ignition"], self.plan.moments
        if chosen.quantile(1.0) < first - began:
            raise input_error(
                self.plan.path,
                f"time_since_ignition is {chosen.quantile(1.0):.0f} s at most, but run {name} begins "
                f"{first - began:.0f} s after its ignition; change it in [draws]",
            )
        shares = [(k + share(self.plan.seed, 0, k, f"moment {name}")) / count for k in range(count)]
        least, most = (_share_below(chosen, limit - began) for limit in (first, last))
        times_since = [chosen.quantile(least + part * (most - least)) for part in shares]
        return [min(max(began + since, first), last) for since in times_since]

    def draw(self, index: int) -> Draw:
        """Draw a sample; samples are numbered from 1.

        Raises
        ------
        InputError
            All tries were rejected.
        """
        stratum, rejects = self.strata.of(index), list[str]()
        for attempt in range(TRIES):
            try:
                return self._draw(index, stratum, attempt, tuple(rejects))
            except Rejected as reason:
                rejects.append(str(reason))
        common = max(set(rejects), key=rejects.count)
        raise input_error(
            self.plan.path,
            f"sample {index} ({stratum.camera} of {stratum.run}): {TRIES} cameras were rejected, most often "
            f"for: {common}; change the distance or the pitch of this camera in [draws]",
        )

    def _draw(self, index: int, stratum: Stratum, attempt: int, rejects: tuple[str, ...]) -> Draw:
        plan, scene = self.plan, self.scene(stratum.run)
        value = _Values(plan, index, attempt)
        moment, time, front = self._moment(stratum, scene, value)
        targets = scene.front(front) if stratum.kind != _BURNED_OUT else scene.burned
        if len(targets) == 0:
            raise Rejected("no fire in the run")
        target = targets[value.pick("target", len(targets))]
        lens = placement.lens(value, plan.resolution)
        if stratum.camera == "tower":
            tower = self.towers(stratum.run)[value.pick("tower", plan.sites)]
            site, pose = tower.name, placement.aim_tower(scene, tower, target, lens, value)
        else:
            flight = moment if moment >= 0 else value.pick("flight", plan.moments)
            site = f"{stratum.camera}-{flight + 1}"
            pose = placement.place_mobile(scene, stratum.camera, front, target, lens, value)
        placement.check(scene, pose, is_mobile=stratum.camera != "tower")
        placement.check_trees(scene, pose, lens.half, target)
        distance = float(np.linalg.norm(target - pose.position))
        visibility, cloud_cover = value(_VISIBILITY[stratum.kind]), value(_CLOUDS[stratum.kind])
        clear = stratum.camera != "tower" and attempt < _CLEAR  # an aircraft in fog may see nothing
        if stratum.kind == POSITIVE or clear:
            placement.check_sight(distance, visibility)
        if stratum.kind == POSITIVE:
            placement.check_fire(scene, pose, time, lens, distance, allow_hidden=value("ridge") >= 0.5)
        camera = _camera(scene, stratum.camera, site, pose, value("field_of_view"))
        sun = _sun(stratum, camera.heading, value)
        lamps = round(value("night_lights")) if stratum.kind == "night_lights" else 0
        for name in _SENSOR:
            value(name)
        planned = plan.run(stratum.run)
        return Draw(
            seed=plan.seed,
            index=index,
            attempt=attempt,
            rejects=rejects,
            place=planned.place,
            run=planned.name,
            path=planned.run,
            kind=stratum.kind,
            night=stratum.night,
            split=self.splits.of(planned.name, site),
            moment=moment,
            time=time,
            since_ignition=time - scene.ignition,
            utc=times.utc(scene.run, time),
            camera=camera,
            target=_triple(target),
            distance=distance,
            sun_elevation=sun[0],
            sun_azimuth=sun[1],
            visibility=visibility,
            cloud_cover=cloud_cover,
            lamps=lamps,
            values={name: value[name] for name in VALUES if name in value},
        )

    def _moment(self, stratum: Stratum, scene: RunScene, value: _Values) -> tuple[int, float, float]:
        """Draw the number of the moment, its model time, and the time of the front at which cameras aim."""
        moments = self.moments(stratum.run)
        moment = value.pick("moment", len(moments))
        if stratum.kind == POSITIVE:
            return moment, moments[moment], moments[moment]
        if stratum.kind == _BURNED_OUT:
            return AFTER, scene.window[1] + value("time_after_end"), moments[moment]
        return BEFORE, scene.ignition - value("time_before_ignition"), moments[moment]


def count_rejects(draws: Iterable[Draw]) -> dict[str, int]:
    """Count the rejected tries by reason."""
    found: dict[str, int] = {}
    for each in draws:
        for reason in each.rejects:
            found[reason] = found.get(reason, 0) + 1
    return dict(sorted(found.items()))


def _share_below(distribution: Distribution, limit: float) -> float:
    """Find the share of a distribution that is at most a limit, by bisection; 0 if there is none."""
    if distribution.quantile(1.0) <= limit:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if distribution.quantile(middle) <= limit else (low, middle)
    return low


def _camera(scene: RunScene, kind: str, site: str, pose: Pose, field_of_view: float) -> DrawnCamera:
    latitude, longitude, height = (float(part[0]) for part in scene.ground.frame.reverse(pose.position[None]))
    angles = rotation.angles(scene.ground.frame, pose.position, pose.rotation)
    return DrawnCamera(
        kind, site, _triple(pose.position), latitude, longitude, height, *angles, field_of_view
    )


def _sun(stratum: Stratum, heading: float, value: _Values) -> tuple[float, float]:
    """Draw elevation and azimuth of the sun, degrees."""
    if stratum.kind == _LOW_SUN:
        return value("sun_elevation_low"), (heading + value("sun_bearing_low")) % 360.0
    elevation = value("sun_elevation_night" if stratum.night else "sun_elevation_day")
    return elevation, (heading + value("sun_bearing")) % 360.0


def _triple(point: Array) -> tuple[float, float, float]:
    x, y, z = (float(part) for part in point)
    return x, y, z
