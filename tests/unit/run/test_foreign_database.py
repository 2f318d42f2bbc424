"""SQLite files of others are read within limits: no more data than the file stores, and in bounded time."""

import sqlite3
import tracemalloc
from contextlib import closing

import pytest
from firetwin import foreign_database, limits
from firetwin.errors import InputError
from firetwin.run.observations import geopackage
from firetwin.stations import reading
from small_stations import write

BOMB = "hex(zeroblob(20000000))"


@pytest.fixture
def make(tmp_path):
    """Function that writes a file by SQL commands."""

    def made(script):
        path = tmp_path / "a.gpkg"
        with closing(sqlite3.connect(path)) as base:
            base.executescript(script)
        return path

    return made


def read(path, table, *columns):
    with foreign_database.opened(path) as base:
        return list(base.rows(table, columns))


def peak(call):
    """Bytes that Python holds at most; of a refusal, whose text is returned, too."""
    tracemalloc.start()
    try:
        with pytest.raises(InputError) as caught:
            call()
        return tracemalloc.get_traced_memory()[1], str(caught.value)
    finally:
        tracemalloc.stop()


def test_rows_are_read_with_stored_columns_alone(make):
    path = make(f"CREATE TABLE t (a, b AS ({BOMB}), c); INSERT INTO t VALUES (1, 'x'), (2, x'00ff')")
    assert read(path, "t") == [(1, "x"), (2, b"\0\xff")]


def test_a_damaged_list_of_tables_does_not_ask_for_memory(tmp_path):
    """SQLite may take the length of a damaged row for memory that it lacks."""
    path = write(tmp_path / "s.gpkg", [(1, "A", 39.0, -120.5, "fire station", "user")])
    whole = path.read_bytes()
    end = whole.index(b"e_station_geom_parentrtree")
    path.write_bytes(whole[: end - 62] + b"\xff" * 62 + whole[end:])
    with pytest.raises(InputError, match="is damaged"):
        reading.read(path)


def test_a_generated_column_of_a_station_file_does_not_fill_the_memory(tmp_path):
    path = write(tmp_path / "s.gpkg", [(1, "A", 39.0, -120.5, "fire station", "user")])
    with closing(sqlite3.connect(path)) as base:
        base.executescript(
            "PRAGMA writable_schema = ON; UPDATE sqlite_master SET "
            f"sql = replace(sql, 'standard TEXT NOT NULL', 'standard TEXT AS ({BOMB})') WHERE name = 'type'"
        )
    most, text = peak(lambda: reading.read(path))
    assert most < 10e6
    assert "no stored column standard (generated columns are not read)" in text


@pytest.mark.parametrize(
    "kind", ["VIEW v AS SELECT hex(zeroblob(20000000)) AS a", "VIRTUAL TABLE v USING fts4(a)"]
)
def test_views_and_virtual_tables_are_not_read(make, kind):
    most, text = peak(lambda: read(make(f"CREATE {kind}"), "v"))
    assert most < 10e6
    assert "export it as a table" in text


def test_a_long_default_in_many_rows_is_refused(make):
    """Rows that end before a column take its default from the schema, one text for all rows."""
    rows = ", ".join(["(1)"] * 3000)
    text = f"CREATE TABLE t (a); INSERT INTO t VALUES {rows}; ALTER TABLE t ADD b DEFAULT '{'x' * 30000}'"
    most, text = peak(lambda: read(make(text), "t"))
    assert most < 10e6
    assert "more data than a file of" in text


def test_a_value_beyond_the_limit_of_length_is_refused(make, monkeypatch):
    monkeypatch.setattr(limits, "SQLITE_LENGTH", 1000)
    path = make("CREATE TABLE t (a); INSERT INTO t VALUES (zeroblob(2000))")
    with pytest.raises(InputError, match="more data than"):
        read(path, "t")


def test_an_expression_that_is_too_deep_is_refused(make):
    deep = "+".join(["a"] * (limits.SQLITE_DEPTH + 20))
    path = make(f"CREATE TABLE t (a, CHECK ({deep} > 0))")
    with pytest.raises(InputError, match="not a GeoPackage"):
        geopackage.read(path)


def test_reading_ends_after_a_time(make, monkeypatch):
    monkeypatch.setattr(limits, "SQLITE_SECONDS", -1)
    monkeypatch.setattr(foreign_database, "_STEPS", 100)
    path = make("CREATE TABLE t (a); INSERT INTO t VALUES " + ", ".join(["(1)"] * 1000))
    with pytest.raises(InputError, match="s to read"):
        read(path, "t")


def test_files_cannot_be_attached_or_changed(make):
    with foreign_database.opened(make("CREATE TABLE t (a)")) as base:
        for command in ("ATTACH ':memory:' AS b", "DELETE FROM t"):
            with pytest.raises(sqlite3.Error):
                base._base.execute(command)
