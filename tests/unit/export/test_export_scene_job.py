"""Exports of the built scene: terms of tiles are checked before anything is built."""

from dataclasses import replace

import pytest
from firetwin.errors import InputError
from firetwin.export import scene_job
from firetwin.export.request import ExportRequest
from firetwin.jobs import worker
from firetwin.shot.settings import Settings
from firetwin.shot.source import ShotSource


@pytest.mark.parametrize(("source", "name"), [("ion:2275207", "Google"), ("ion:96188", "Cesium ion")])
def test_tiles_whose_terms_forbid_exports_are_refused_by_name(monkeypatch, tmp_path, source, name):
    settings = Settings(path=tmp_path / "scene.toml")
    settings = replace(settings, tiles=replace(settings.tiles, sources=(source,), vegetation="tileset"))
    monkeypatch.setattr(ShotSource, "settings", lambda self: settings)
    monkeypatch.setattr(worker, "run", lambda *_, **__: pytest.fail("a process was started"))
    request = ExportRequest(ShotSource(), "usd", tmp_path)
    with pytest.raises(InputError, match=f"{name}.* does not allow that tiles are written to other formats"):
        scene_job.run(request)
