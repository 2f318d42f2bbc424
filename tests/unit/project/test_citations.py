"""Citations: each source of a run once, and no invented one."""

from firetwin.run import citations, readers
from small_run import RUN_TOML

MODEL = '\n[source]\nmodel = "ELMFIRE"\nversion = "2025.12"\n'


def texts(rows: list[dict[str, str]], kind: str) -> list[str]:
    return [row["text"] for row in rows if row["kind"] == kind]


def test_a_synthetic_run_names_no_fire_model(make_run):
    rows = citations.of_run(readers.open(make_run()))
    assert texts(rows, "fire model") == ["none: Small is synthetic"]
    facts = texts(rows, "facts")
    assert any("CAL FIRE" in text for text in facts)  # event = "king_fire"
    assert len(facts) == len(set(facts))


def test_a_converted_run_names_its_model(make_run):
    toml = RUN_TOML.replace("synthetic = true\n", "").replace('event = "king_fire"\n', "") + MODEL
    folder = make_run(toml=toml)
    (folder / "observations").mkdir()
    (folder / "observations" / "perimeter.geojson").write_text("{}")
    rows = citations.of_run(readers.open(folder))
    assert texts(rows, "fire model") == ["ELMFIRE, version 2025.12; run: Small"]
    assert texts(rows, "observations") == ["perimeter.geojson; cite the source of this file"]
    assert not texts(rows, "facts")


def test_a_run_without_a_model_says_so(make_run):
    toml = RUN_TOML.replace("synthetic = true\n", "")
    rows = citations.of_run(readers.open(make_run(toml=toml)))
    assert texts(rows, "fire model") == ["not named in run.toml; name the model and its version"]
