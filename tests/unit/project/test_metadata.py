"""Metadata of the project: one version, one licence, one title, and one record for citing."""

import json
import re
import tomllib
from pathlib import Path

from firetwin.run import citations

ROOT = Path(__file__).resolve().parents[3]
CFF = (ROOT / "CITATION.cff").read_text()
ZENODO = json.loads((ROOT / ".zenodo.json").read_text())


def of_cff(key: str) -> str:
    """Text of a key of the first level: on its line, or folded (`>-`) below."""
    found = re.search(rf"^{key}: (?:>-\n((?:  .*\n)+)|(.*)\n)", CFF, re.MULTILINE)
    assert found, key
    return " ".join((found[1] or found[2]).split())


def test_one_version():
    version = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["version"]
    manifest = tomllib.loads((ROOT / "addon/blender_manifest.toml").read_text())
    assert manifest["version"] == version
    assert of_cff("version") == version == ZENODO["version"]


def test_the_change_log_is_short_and_has_the_date_of_the_version():
    text = (ROOT / "CHANGELOG.md").read_text()
    version, date = re.search(r"^## (\S+) - (\d{4}-\d\d-\d\d)$", text, re.MULTILINE).groups()
    assert version == of_cff("version")
    assert date == of_cff("date-released")
    assert len(text.splitlines()) < 150


def test_the_archive_and_the_citation_agree():
    assert ZENODO["title"] == of_cff("title")
    assert ZENODO["description"] == of_cff("abstract")
    assert ZENODO["license"] == of_cff("license")
    assert f"[{', '.join(ZENODO['keywords'])}]" == of_cff("keywords")
    authors = re.search(r"^authors:\n((?:  .*\n)+)", CFF, re.MULTILINE)
    assert re.findall(r"  - name: (.*)", authors[1]) == [each["name"] for each in ZENODO["creators"]]
    assert ZENODO["references"] == [citations.PAPER]
    names = re.findall(r"family-names: (.*)", CFF)
    assert [citations.PAPER.index(name) for name in names] == sorted(map(citations.PAPER.index, names))


def test_no_doi_is_invented():
    assert not re.search(r"\bdoi\b|10\.\d{4,}/", CFF + json.dumps(ZENODO), re.IGNORECASE)


def test_licence_text_is_where_people_and_reuse_expect_it():
    assert (ROOT / "LICENSE").read_bytes() == (ROOT / "LICENSES/GPL-3.0-or-later.txt").read_bytes()
