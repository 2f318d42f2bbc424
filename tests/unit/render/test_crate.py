"""RO-Crate of a film: other software reads it, and its hashes, inputs and sources are those of the film."""

import hashlib
import json

import pytest
from firetwin import cli
from firetwin.render import crate, store
from firetwin.render.store import Store
from firetwin.run import content, readers
from small_run import small_fields, write_field

LICENCE = "https://creativecommons.org/licenses/by/4.0/"
NAMES = ("drone/rgb/drone_rgb_000001.png", "drone/depth/drone_depth_000001.exr", "drone/drone_rgb.mp4")


@pytest.fixture
def scene(make_run, tmp_path):
    """Scene file of the small run."""
    path = tmp_path / "film.toml"
    path.write_text(f'run = "{make_run().as_posix()}"\ncache = "cache"\n')
    return path


def finish(out, hashes, names=NAMES, **more):
    """Write made-up files of a film, and its store."""
    entries = {}
    for name in names:
        path = out / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(name.encode())
        about = {"camera": "drone", "pass": name.split("/")[1].removesuffix(".mp4").removeprefix("drone_")}
        entries[name] = store.describe(path) | about
    entries[names[0]] |= {"frame": 1, "time": "2014-09-17T21:00:00+00:00", "credits": ["Map makers, CC BY"]}
    with Store(out, create=True) as made:
        versions = {"firetwin": "0.2.0", "blender": "4.5.15"}
        made.add({"versions": versions, "run": hashes, **more}, entries)
        made.export()
    return out


@pytest.fixture
def film(scene, tmp_path):
    """Folder of a film of the small run, with the hash of an elevation model beside those of the run."""
    hashes = content.inputs(readers.open(tmp_path / "run"), tmp_path / "cache")
    return finish(tmp_path / "film", hashes | {"elevation model": "0" * 64})


def entities(out):
    graph = json.loads((out / crate.NAME).read_text())["@graph"]
    assert len({each["@id"] for each in graph}) == len(graph)
    return {each["@id"]: each for each in graph}


def ids(value):
    return [each["@id"] for each in (value if isinstance(value, list) else [value])]


def test_all_files_are_described_with_their_hashes(scene, film, capsys):
    assert cli.main(["cite", str(scene), "--crate", str(film), "--license", LICENCE]) == 0
    assert capsys.readouterr().out.strip() == str(film / "ro-crate-metadata.json")
    crate_entities = entities(film)
    root = crate_entities["./"]
    assert sorted(ids(root["hasPart"])) == sorted([*NAMES, "manifest.json"])
    for name in NAMES:
        data = (film / name).read_bytes()
        assert crate_entities[name]["sha256"] == hashlib.sha256(data).hexdigest()
        assert crate_entities[name]["contentSize"] == str(len(data))
    assert [crate_entities[name]["encodingFormat"] for name in NAMES] == [
        "image/png",
        "image/x-exr",
        "video/mp4",
    ]
    assert crate_entities[NAMES[0]]["temporalCoverage"].startswith("2014-09-17T21:00")
    assert root["creditText"] == crate_entities[NAMES[0]]["creditText"] == "Map makers, CC BY"
    assert "is synthetic" in root["description"]
    assert "Blender 4.5.15 rendered" in root["description"]
    assert crate_entities[root["license"]["@id"]]["@id"] == LICENCE
    assert "doi" not in json.dumps(crate_entities).lower()


def test_the_rendering_names_programs_inputs_and_sources(scene, film, tmp_path):
    assert cli.main(["cite", str(scene), "--crate", str(film)]) == 0
    crate_entities = entities(film)
    action = crate_entities["#render"]
    assert [crate_entities[each]["version"] for each in ids(action["instrument"])] == ["0.2.0", "4.5.15"]
    assert sorted(ids(action["result"])) == sorted(NAMES)
    run = crate_entities[action["object"]["@id"]]
    fields = {crate_entities[each]["name"]: crate_entities[each]["sha256"] for each in ids(run["hasPart"])}
    assert fields == content.inputs(readers.open(tmp_path / "run"), tmp_path / "cache") | {
        "elevation model": "0" * 64
    }
    cited = [crate_entities[each] for each in ids(crate_entities["./"]["mentions"])[1:]]
    assert {"algorithms", "fire model", "facts"} == {each["description"] for each in cited}
    assert crate_entities[crate_entities["./"]["license"]["@id"]]["description"].startswith("Not chosen")


def test_members_belong_to_the_run_of_the_film(make_run, tmp_path):
    make_run().rename(tmp_path / "other")
    write_field(tmp_path / "other", "elevation", small_fields()["elevation"] + 1.0, "npy")
    path = tmp_path / "film.toml"
    path.write_text(f'run = "{make_run().as_posix()}"\n[[runs]]\npath = "other"\nname = "other"\n')
    inputs = [content.inputs(readers.open(tmp_path / name), tmp_path / "cache") for name in ("run", "other")]
    out = finish(tmp_path / "film", inputs[0], beside={"other": inputs[1]}, further={"member 1": "2" * 64})
    assert cli.main(["cite", str(path), "--crate", str(out)]) == 0
    found = entities(out)
    runs = [found[run] for run in ids(found["#render"]["object"])]
    names = [[found[part]["name"] for part in ids(run["hasPart"])] for run in runs]
    assert ["member 1" in each for each in names] == [True, False]


def test_the_licence_of_the_programs_can_be_that_of_the_film(scene, film):
    licence = "https://spdx.org/licenses/GPL-3.0-or-later"
    assert cli.main(["cite", str(scene), "--crate", str(film), "--license", licence]) == 0
    assert entities(film)["./"]["license"]["@id"] == licence


def test_another_library_reads_it(scene, film):
    reader = pytest.importorskip("rocrate.rocrate")  # extra `test`
    assert cli.main(["cite", str(scene), "--crate", str(film)]) == 0
    read = reader.ROCrate(film)
    assert sorted(each.id for each in read.data_entities) == sorted([*NAMES, "manifest.json"])
    assert {each.type for each in read.data_entities} == {"File"}
    assert [each["version"] for each in read.get("#render")["instrument"]] == ["0.2.0", "4.5.15"]


def test_a_film_of_another_run_is_refused(scene, tmp_path, capsys):
    out = finish(tmp_path / "other", {"elevation.npy": "1" * 64})
    assert cli.main(["cite", str(scene), "--crate", str(out)]) == 1
    assert "lists a picture of another run; name the scene file of this film" in capsys.readouterr().err
    assert not (out / crate.NAME).exists()


@pytest.mark.parametrize("damage", ["missing", "longer"])
def test_a_changed_file_is_refused(scene, film, capsys, damage):
    path = film / NAMES[1]
    path.unlink() if damage == "missing" else path.write_bytes(b"x" * 99)
    assert cli.main(["cite", str(scene), "--crate", str(film)]) == 1
    assert f"{path.name}: is missing or has changed" in capsys.readouterr().err


def test_a_manifest_cannot_name_files_of_other_folders(scene, film, capsys):
    content = json.loads((film / "manifest.json").read_text())
    content["files"]["../film.toml"] = content["files"].pop(NAMES[0])
    (film / "manifest.json").write_text(json.dumps(content))
    assert cli.main(["cite", str(scene), "--crate", str(film)]) == 1
    assert "which is outside of the folder" in capsys.readouterr().err


def test_what_a_crate_needs_is_said(scene, tmp_path, capsys):
    assert cli.main(["cite", str(scene), "--crate", str(tmp_path)]) == 1
    assert "lists no files; render the film first" in capsys.readouterr().err
    assert cli.main(["cite", str(tmp_path / "run"), "--crate", str(tmp_path)]) == 2
    assert "is not a scene file; name the scene file of the film" in capsys.readouterr().err
    assert cli.main(["cite", str(scene), "--license", LICENCE]) == 2
