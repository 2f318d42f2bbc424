"""Methods paragraph: model, grid, terrain, observations, software, and what is not observed."""

import firetwin_core
from firetwin.run import methods, readers
from firetwin.run.methods import Inputs
from small_run import RUN_TOML

MODEL = """
[source]
model = "ELMFIRE"
version = "2025.12"
assumptions = ["heat from fuel", "orthometric heights"]
"""


def test_a_synthetic_run(make_run):
    text = methods.paragraph(readers.open(make_run()), Inputs())
    assert "The run Small is synthetic: it is not the output of a fire-atmosphere model." in text
    assert "Elevation and fuels are from the run. The run is not compared with observations." in text
    assert f"Firetwin {firetwin_core.__version__} with Python" in text
    assert "rendered" not in text
    assert "exercise" not in text


def test_a_run_of_a_model_with_all_inputs(make_run):
    run = readers.open(make_run(toml=RUN_TOML.replace("synthetic = true\n", "") + MODEL))
    text = methods.paragraph(
        run,
        Inputs(
            *("dem.tif", ("a.geojson", "b.csv"), ("Further inputs.",), (("Blender", "4.5.15"),)),
            exercise=True,
        ),
    )
    for sentence in (
        "The fire model ELMFIRE, version 2025.12 computed the run Small.",
        "converted the files of the model with 2 assumptions (run.toml).",
        "Elevation is from dem.tif, fuels are from the run.",
        "The run is compared with a.geojson, b.csv.",
        "Further inputs.",
        "Blender 4.5.15 rendered the pictures. Trees, flames, embers and fine smoke are modelled",
        "Stations, resources or lines are invented for an exercise.",
    ):
        assert sentence in text
