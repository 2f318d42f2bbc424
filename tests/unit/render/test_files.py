"""Files: whole or not there, on the disk before their names are, and clear words when the disk is full."""

import ast
import contextlib
import errno
import os
import pickle
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path

import child_work
import firetwin
import numpy as np
import pytest
from firetwin import files
from firetwin.data import sample
from firetwin.errors import (
    DISK_FULL,
    FullDiskError,
    InputError,
    TryAgainError,
    UnavailableError,
    disk_is_full,
    is_nearly_full,
    is_worth_another_try,
    writing,
)
from firetwin.jobs import worker
from firetwin.render import png, verify
from firetwin.render.store import NAME, Store
from firetwin_core import Error, sensor

ADDON = next(Path(place) for place in firetwin.__path__ if (Path(place) / "render").is_dir())


@pytest.fixture
def tiny(tmp_path):
    """A disk of 1 MB."""
    place = tmp_path / "tiny"
    place.mkdir()
    command = ["mount", "-t", "tmpfs", "-o", "size=1m", "tmpfs", str(place)]
    try:
        mounted = subprocess.run(command, capture_output=True).returncode == 0
    except FileNotFoundError:
        mounted = False
    if not mounted:
        place.rmdir()
        pytest.skip("cannot mount a small disk here")
    yield place
    subprocess.run(["umount", str(place)], check=True)
    place.rmdir()


def _opened_by_another(monkeypatch, tries):
    """Refuse to rename a file `tries` times, as Windows does while another program has it open."""
    rename, refused = Path.replace, []

    def replace(part, path):
        if len(refused) < tries:
            refused.append(path)
            error = PermissionError(errno.EACCES, "The process cannot access the file", str(part))
            error.winerror = 32
            raise error
        return rename(part, path)

    monkeypatch.setattr(Path, "replace", replace)
    monkeypatch.setattr(files, "_WAITS", (0.0, 0.0))


def test_a_file_that_a_virus_scanner_has_open_is_replaced_a_moment_later(tmp_path, monkeypatch):
    _opened_by_another(monkeypatch, 2)
    files.write_text(tmp_path / "a", "text")
    assert (tmp_path / "a").read_text() == "text"


def test_a_file_that_a_program_keeps_open_is_named_with_its_remedy(tmp_path, monkeypatch):
    _opened_by_another(monkeypatch, 9)
    with pytest.raises(InputError, match=r"a: cannot be written .*; close programs that show it, or choose"):
        files.write_text(tmp_path / "a", "text")
    assert not list(tmp_path.iterdir())


def test_texts_have_the_same_line_ends_on_all_systems():
    lines = [line for path in ADDON.rglob("*.py") for line in path.read_text(encoding="utf-8").splitlines()]
    writes = [line for line in lines if "write_text(" in line and "encoding=" in line]
    assert [line for line in writes if "newline=" not in line] == []


def _fill(folder):
    with contextlib.suppress(OSError), (folder / "filler").open("wb", buffering=0) as file:
        while file.write(bytes(4096)):
            pass


def test_a_full_disk_is_named_and_leaves_nothing(tiny):
    _fill(tiny)
    path = tiny / "map.png"
    with pytest.raises(InputError, match=r"map\.png: the disk is full; free some space"):
        files.write(path, lambda part: part.write_bytes(bytes(9999)))
    assert [each.name for each in tiny.iterdir()] == ["filler"]
    assert is_nearly_full(path)


def test_a_full_disk_under_the_core(tiny):
    _fill(tiny)
    pixels = np.random.default_rng(1).uniform(size=(99, 99, 3)).astype(np.float32)
    for path in (tiny / "a.exr", tiny / "a.png"):
        with pytest.raises(InputError, match="the disk is full"), writing(path):
            sensor.write_image(path, pixels)
    assert [each.name for each in tiny.iterdir()] == ["filler"]


@pytest.mark.posix("limits of the length of files")
def test_a_file_that_ends_too_early_is_never_published(tmp_path):
    """A limit on the length of files, at their very end and before, as a disk that is full there."""
    code = """
import resource, sys
import numpy as np
from pathlib import Path
from firetwin_core import InputError, sensor, volume
pixels = np.random.default_rng(1).uniform(size=(64, 64, 3)).astype(np.float32)
def write():
    if path.suffix == ".vdb":
        volume.write(path, {"density": np.ones((16, 16, 16), np.float32)}, 1.0)
    else:
        sensor.write_image(path, pixels)
def limit(size):
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
for name in ("a.exr", "a.png", "a.vdb"):
    path = Path(sys.argv[1]) / name
    write()
    size = path.stat().st_size
    path.unlink()
    for room in (0, 1, 100, size // 2, size - 9, size - 1):
        limit(room)
        try:
            write()
        except InputError as error:
            assert "cannot be written: File too large" in str(error), error
        else:
            sys.exit(f"{name}: written within {room} of {size} bytes")
        assert not list(path.parent.iterdir()), (name, room)
    limit(size)
    write()
    assert path.stat().st_size == size
    path.unlink()
    limit(resource.RLIM_INFINITY)
"""
    result = subprocess.run([sys.executable, "-c", code, str(tmp_path)], capture_output=True, text=True)
    assert result.returncode == 0, result.stderr


@pytest.mark.parametrize("how", ["image", "python"])
def test_threads_that_write_one_path_do_not_meet(tmp_path, how):
    """Each finds its own temporary file; the last one's stays, whole, and nothing else."""
    rng = np.random.default_rng(1)
    pictures = [rng.uniform(size=(40, 40, 3)).astype(np.float32) for _ in range(6)]
    path = tmp_path / "a.exr"

    def write(pixels):
        for _ in range(25):
            if how == "image":
                sensor.write_image(path, pixels)
            else:
                files.write(path, lambda part: sensor.write_image(part, pixels))

    with ThreadPoolExecutor(len(pictures)) as pool:
        list(pool.map(write, pictures))
    read = sensor.read_image(path)
    assert any(np.array_equal(read, pixels) for pixels in pictures)
    assert list(tmp_path.iterdir()) == [path]


def test_the_core_brings_a_file_to_the_disk_before_its_name(tmp_path):
    if not shutil.which("strace"):
        pytest.skip("needs strace")
    code = "import sys; from firetwin_core import sensor; sensor.write_image(sys.argv[1], [[1.0, 0.0]])"
    log = tmp_path / "log"
    command = ["strace", "-f", "-y", "-o", str(log), "-e", "trace=fsync,rename,renameat,renameat2"]
    subprocess.run([*command, sys.executable, "-c", code, str(tmp_path / "a.exr")], check=True)
    calls = [line.split(maxsplit=1)[1] for line in log.read_text().splitlines() if "a.exr" in line]
    assert [call.partition("(")[0][:6] for call in calls] == ["fsync", "rename"]


def test_a_full_disk_under_the_store(tiny):
    with Store(tiny, create=True) as store:
        _fill(tiny)
        with pytest.raises(InputError, match=f"{NAME}: the disk is full"):
            store.add({}, {f"{i}.png": {"sha256": "0" * 64} for i in range(10_000)})
        (tiny / "filler").unlink()
        store.add({}, {"1.png": {}})
        assert store.names() == ["1.png"]


@pytest.mark.parametrize("form", sample.FORMATS)
def test_a_full_disk_under_the_sample(tiny, form):
    with pytest.raises(InputError, match="run: the disk is full"):
        sample.write(tiny / "run", frames=3, format=form)
    assert list(tiny.iterdir()) == []


def test_errors_of_writing_say_what_to_do(tmp_path):
    reason = r"a: cannot be written \(Permission denied\); choose another folder"
    with pytest.raises(InputError, match=reason), writing("a"):
        raise PermissionError(errno.EACCES, "Permission denied")
    with pytest.raises(InputError) as caught, writing("a"):
        raise OSError(errno.ENOSPC, "No space left on device")
    assert caught.value.reason == DISK_FULL
    assert disk_is_full(Error("a.vdb: cannot be written: No space left on device"))
    assert not disk_is_full(OSError(errno.EIO, "No space left on device"))
    with pytest.raises(Error, match="else"), writing("a"):
        raise Error("something else")


@pytest.mark.posix("names of open files, and syncs of folders")
def test_all_of_a_file_is_on_the_disk_before_its_name(tmp_path, monkeypatch):
    done = []
    sync, replace = os.fsync, Path.replace

    def fsync(handle):
        import fcntl  # of Linux; Windows refuses handles that cannot write

        path = Path(os.readlink(f"/proc/self/fd/{handle}"))
        if path.is_file():
            assert fcntl.fcntl(handle, fcntl.F_GETFL) & os.O_ACCMODE != os.O_RDONLY
        done.append(("sync", path.name))
        sync(handle)

    monkeypatch.setattr(os, "fsync", fsync)
    monkeypatch.setattr(Path, "replace", lambda a, b: done.append(("name", b.name)) or replace(a, b))
    (tmp_path / "part").write_bytes(b"x")
    files.publish(tmp_path / "part", tmp_path / "sub" / "whole")
    assert done == [("sync", "part"), ("name", "whole"), ("sync", "sub")]


def test_folders_that_cannot_be_opened_are_no_error(tmp_path, monkeypatch):
    def refuse(path, *_):
        raise PermissionError(errno.EACCES, "as on Windows", str(path))

    monkeypatch.setattr(os, "open", refuse)
    (tmp_path / "part").write_bytes(b"x")
    files.publish(tmp_path / "part", tmp_path / "whole")
    assert (tmp_path / "whole").read_bytes() == b"x"


def test_nothing_is_asked_that_some_systems_lack():
    """No signal asks for a process (os.kill(pid, 0) is Ctrl-C on Windows), no fcntl, no SIGKILL."""
    some = re.compile("SIGKILL|kill|fork|fcntl|pwd|resource|termios")
    texts = {path: path.read_text(encoding="utf-8") for path in ADDON.rglob("*.py")}
    for path, text in texts.items():
        for node in ast.walk(ast.parse(text)) if some.search(text) else ():
            named = ast.unparse(node) if isinstance(node, ast.Attribute) else ""
            spared = {"os.kill"} if path.parts[-2:] == ("farm", "lost.py") else set()  # not on Windows
            assert named not in {"os.kill", "signal.SIGKILL", "os.killpg", "os.fork"} - spared, path
            if isinstance(node, ast.Import | ast.ImportFrom):
                names = {alias.name for alias in node.names} | {getattr(node, "module", "")}
                without = {"memory.py": {"resource"}, "unfinished.py": {"fcntl"}}  # Windows has its own way
                spared = without.get(str(path.relative_to(ADDON)), set())
                assert not names & {"fcntl", "pwd", "resource", "termios"} - spared, path


@pytest.mark.posix("signals that end a process")
def test_a_worker_that_was_killed_may_have_lacked_memory():
    assert "most likely memory ran out" in worker._ending(-9, eevee=False)


def test_how_a_worker_ended_is_said_on_any_system(monkeypatch):
    assert "exit status 3221225477" in worker._ending(3221225477, eevee=False)
    assert "signal 77" in worker._ending(-77, eevee=False)
    monkeypatch.delattr(signal, "SIGKILL", raising=False)
    assert "Blender stopped" in worker._ending(-6, eevee=False)


def test_a_worker_that_is_gone_is_no_error_on_windows_either(monkeypatch):
    class Gone:
        def write(self, _):
            raise OSError(errno.EINVAL, "Invalid argument")

        close = flush = lambda self, *_: self.write("")

    child = subprocess.Popen([sys.executable, "-c", ""], stdin=subprocess.PIPE, stdout=subprocess.PIPE)
    child.wait()
    child.stdin.close()
    monkeypatch.setattr(child, "stdin", Gone())
    with worker._Watchdog(child, 0.0) as watch:
        assert worker._converse(child, child_work.abort, progress=None, tell=None, watch=watch) == ("", None)
    worker._end(child, 0.0)


@pytest.mark.posix("programs that remove a file which another has open")
def test_a_log_that_was_tidied_away_does_not_spoil_what_was_done(tmp_path, monkeypatch):
    child_work.importable(monkeypatch)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    assert worker.run(partial(child_work.remove_logs, tmp_path), blender=False) == 7


@pytest.fixture(params=["png", "exr"])
def picture(request, tmp_path):
    path = tmp_path / f"a.{request.param}"
    sensor.write_image(path, np.random.default_rng(1).uniform(size=(36, 64, 3)).astype(np.float32))
    return path


def test_a_whole_picture_passes(picture):
    verify.picture(picture, (64, 36))


@pytest.mark.parametrize("left", [0, 1, 40, 0.5, -1, -4, -12, -40])
def test_a_picture_that_is_cut_off_does_not(picture, left):
    data = picture.read_bytes()
    picture.write_bytes(data[: int(left * len(data)) if isinstance(left, float) else left])
    with pytest.raises(InputError, match=rf"a\{picture.suffix}: .*render it again"):
        verify.picture(picture, (64, 36))


def test_a_picture_of_another_size_or_none_does_not(picture):
    with pytest.raises(InputError, match="64 x 36 pixels instead of 32 x 36"):
        verify.picture(picture, (32, 36))
    picture.unlink()
    with pytest.raises(InputError, match="render it again"):
        verify.picture(picture, (64, 36))


def test_a_damaged_picture_on_a_full_disk_says_so(picture, tiny):
    path = tiny / picture.name
    shutil.copy(picture, path)
    _fill(tiny)
    path.write_bytes(path.read_bytes()[:100])
    with pytest.raises(InputError, match="the disk is full"):
        verify.picture(path, (64, 36))


def test_a_film_is_walked_through(tmp_path):
    path = tmp_path / "a.mp4"
    boxes = [(b"ftyp", b"isom"), (b"mdat", b"x" * 99), (b"moov", b"y" * 9)]
    data = b"".join(struct.pack(">I4s", len(body) + 8, kind) + body for kind, body in boxes)
    path.write_bytes(data)
    verify.film(path)
    for left in (0, 4, 12, 50, len(data) - 17, len(data) - 1):
        path.write_bytes(data[:left])
        with pytest.raises(InputError, match="cut off"):
            verify.film(path)
    path.unlink()
    with pytest.raises(InputError, match="missing"):
        verify.film(path)


def test_notes_of_how_long_it_took_are_taken_out_of_a_picture(tmp_path):
    path = tmp_path / "a.png"
    pixels = np.random.default_rng(1).integers(0, 255, (36, 64, 3)).astype(np.float32) / 255
    sensor.write_image(path, pixels, {"Note": "kept"})
    plain = path.read_bytes()
    png.remove_render_times(path)
    assert path.read_bytes() == plain
    body = b"tEXtcycles.rgb.total_time\x0000:01.25"
    note = struct.pack(">I", len(body) - 4) + body + struct.pack(">I", 0)
    path.write_bytes(plain[:33] + note + plain[33:])
    png.remove_render_times(path)
    assert path.read_bytes() == plain
    path.write_bytes(plain[:-30])
    png.remove_render_times(path)
    assert path.read_bytes() == plain[:-30]


def test_a_system_without_time_zones_says_what_to_install():
    code = """
import sys, zoneinfo
zoneinfo.reset_tzpath([])  # as on Windows
sys.modules["tzdata"] = None
from firetwin.shot.sections import time
print(time.invalid_zone("America/Los_Angeles"))
"""
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "install the Python package tzdata" in result.stdout, result.stderr


def test_errors_cross_processes_with_their_kind(monkeypatch):
    child_work.importable(monkeypatch)
    expected = {
        "full": (FullDiskError, f"a.png: {DISK_FULL}", True),
        "room": (FullDiskError, f"b.png: {DISK_FULL}", True),
        "nameless": (TryAgainError, "[Errno 28] No space left on device", True),
        "other": (InputError, "c.png: Input/output error", False),
        "device": (TryAgainError, "no GPU", True),
        "asked": (UnavailableError, "scene.toml:3:4: no GPU", True),
        "wrong": (InputError, "scene.toml:3:4: the disk is full, says a name", False),
        "plain": (Error, "stopped", False),
        "bug": (Error, "ValueError: odd", False),
    }
    for fault, (kind, text, again) in expected.items():
        answer = worker._do(pickle.dumps(partial(child_work.fail, fault)), 0, print)
        error = worker.Worker(blender=False)._error(None, *pickle.loads(pickle.dumps(answer)), None, None)
        assert (type(error), str(error)) == (kind, text)
        assert is_worth_another_try(error) == again
    with pytest.raises(UnavailableError, match=r"scene\.toml:3:4: no GPU"):
        worker.run(partial(child_work.fail, "asked"), blender=False)
