"""The sample run's evening, for tests of cameras."""

from datetime import UTC, datetime

import pytest
from firetwin.data import sample
from firetwin.run import readers
from firetwin.shot.sections import Forest, TerrainSettings, Time
from firetwin.shot.settings import Settings
from firetwin.shot.shot import Shot

__all__ = ["run"]


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The sample run, two of its times."""
    out = tmp_path_factory.mktemp("sample") / "run"
    sample.write(out, frames=2)
    return readers.open(out)


def shot_of(run, camera):
    """Its evening, whose terrain and fire all shots share, by one camera."""
    settings = Settings(
        time=Time(
            start=datetime(2014, 9, 17, 16, 0, tzinfo=UTC), end=datetime(2014, 9, 18, 1, 0, tzinfo=UTC)
        ),
        terrain=TerrainSettings(near_radius=0.0, apron=30_000.0),
        forest=Forest(trees=False),
        cameras=(camera,),
    )
    return Shot(settings, run)
