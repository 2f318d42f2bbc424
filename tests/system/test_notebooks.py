"""The example notebooks run, give the results that their text states, and have no outputs in the repository.

Their cells run as one program, which needs no packages of Jupyter (106 MB). With the extra `notebooks` they
also run in a kernel.
"""

import example_notebooks as notebooks
import pytest

CHECKS = {
    "convert_and_score": """
        assert abs(date["polygons"]["sorensen"] - expected) < 0.005
    """,
    "ensemble": """
        assert shares.counted.tolist() == [20, 20, 20]
        assert 0 < never < 20
        assert quantiles[0] < quantiles[1] < quantiles[2]
        assert depths.argmax() == choice.choose(found).typical
    """,
    "frame_arrays": """
        assert inside.sum() > 5000
        assert np.median(difference) < 5.0
        assert masks["class"].shape == planar.shape == (90, 160)
    """,
}
NEEDS = {"convert_and_score": ("rasterio", "pyproj", "shapely"), "frame_arrays": ("bpy", "OpenEXR")}


def test_every_notebook_is_checked():
    assert {path.stem for path in notebooks.FOLDER.glob("*.ipynb")} == set(CHECKS)


@pytest.mark.parametrize("name", CHECKS)
def test_cells_run_in_order(name, tmp_path):
    for package in NEEDS.get(name, ()):
        pytest.importorskip(package)
    check = "\n".join(line.strip() for line in CHECKS[name].splitlines())
    assert notebooks.run(name, tmp_path, check)


@pytest.mark.parametrize("name", CHECKS)
def test_outputs_are_not_committed(name):
    made = notebooks.read(name)
    assert (made["nbformat"], made["metadata"]["kernelspec"]["name"]) == (4, "python3")
    for cell in made["cells"]:
        if cell["cell_type"] == "code":
            assert (cell["outputs"], cell["execution_count"]) == ([], None)
    for text in notebooks.code(name):
        assert not any(line.lstrip().startswith(("%", "!")) for line in text.splitlines())


@pytest.mark.parametrize("name", CHECKS)
def test_a_kernel_runs_them(name, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    nbclient = pytest.importorskip("nbclient")
    nbformat = pytest.importorskip("nbformat")
    for package in ("ipykernel", *NEEDS.get(name, ())):
        pytest.importorskip(package)
    made = nbformat.read(notebooks.FOLDER / f"{name}.ipynb", as_version=4)
    nbformat.validate(made)
    nbclient.NotebookClient(made, timeout=300, resources={"metadata": {"path": tmp_path}}).execute()
    pictures = [output for cell in made.cells for output in cell.get("outputs", ()) if "data" in output]
    assert any("image/png" in output["data"] for output in pictures)
