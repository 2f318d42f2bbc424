"""Worker process: calls functions in a child process, isolated from Blender's output and crashes.

The parent writes each call to the child's stdin as a pickle and keeps that pipe open. The child answers on
its stdout with pickles: progress and messages, then a result or an error. Blender's own output goes to a log
file. The child ends when the parent's end of the pipe closes, even if the parent was killed.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, Protocol, TypeVar

from .. import memory
from ..gpu import caches
from ..progress import MessageCallback, Progress, duration, no_message, silent

if TYPE_CHECKING:
    from ..errors import Error

Result = TypeVar("Result", covariant=True)
Answer = tuple[str, Any]
"""A kind, "progress", "tell", "heartbeat", "result" or "error", and its value."""

_START = b"firetwin: answers follow\n"  # after the banner of Blender's own executable
_NONE: Answer = ("", None)
_LEAVING = 3.0  # s, in which an idle child may exit


class Work(Protocol[Result]):
    """A function at the top of a module, or a `functools.partial` of one with its other arguments.

    Arguments and result are dataclasses and other values that pickle can represent.
    """

    def __call__(self, *, progress: Progress, tell: MessageCallback) -> Result:
        """Do the work; worker side."""


class StoppedError(Exception):
    """The work was cancelled by `Stop.now`."""


class EndedError(Exception):
    """A process without Blender, or with a limit, ended before it answered; the message gives the reason."""


class Stop:
    """Cancellation token: ends each `run` with it from another thread."""

    def __init__(self) -> None:
        self.asked = False
        self._children: list[subprocess.Popen[bytes]] = []
        self._lock = threading.Lock()

    def now(self) -> None:
        """Cancel: end the children; a `run` that has not begun ends as soon as it begins."""
        with self._lock:
            self.asked = True
            for child in (each for each in self._children if each.poll() is None):
                child.terminate()
                sure = threading.Timer(3.0, child.kill)
                sure.daemon = True
                sure.start()

    def watch(self, child: subprocess.Popen[bytes]) -> None:
        """Register a child to end."""
        with self._lock:
            self._children = [*(each for each in self._children if each.poll() is None), child]
        if self.asked:
            self.now()


def run(
    work: Work[Result],
    progress: Progress = silent,
    eevee: bool = False,
    stop: Stop | None = None,
    tell: MessageCallback = no_message,
    blender: bool = True,
    patience: float = 0.0,
    size: int = 0,
) -> Result:
    """Call ``work(progress=..., tell=...)`` in a new child process (see `Worker`)."""
    with Worker(eevee, blender, patience, size) as worker:
        return worker.run(work, progress, stop, tell)


class Worker:
    """A child process that does one work after another, as a context; started by the first work.

    After an error, or if it ended meanwhile, the next work gets a new process.

    Parameters
    ----------
    eevee
        The work renders with EEVEE, which needs OpenGL; without a display it uses an off-screen one.
    blender
        The work needs Blender; work that does not need it also runs without a Blender.
    patience
        Timeout in s: the child is ended after this time without progress or heartbeat (see
        `run.models.heartbeat`); 0: no timeout.
    size
        Limit on the memory that the work takes, bytes; 0: no limit.
    """

    def __init__(
        self, eevee: bool = False, blender: bool = True, patience: float = 0.0, size: int = 0
    ) -> None:
        self._eevee, self._blender, self._patience, self._size = eevee, blender, patience, size
        self._child: subprocess.Popen[bytes] | None = None
        self._log = Path()

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        if self._child is not None:
            self._close()

    def run(
        self,
        work: Work[Result],
        progress: Progress = silent,
        stop: Stop | None = None,
        tell: MessageCallback = no_message,
    ) -> Result:
        """Call ``work(progress=..., tell=...)`` in the child process, and return its result.

        Parameters
        ----------
        stop
            Cancellation token for use by another thread.

        Raises
        ------
        InputError, Error
            An error that the function raised, of the same kind, or an Error that describes how the process
            ended.
        StoppedError
            `stop` was used.
        EndedError
            The process of work without Blender, or with a limit of memory, ended otherwise.
        """
        child = self._start()
        kind, value = _NONE
        try:
            end_on_sigterm()
            if stop is not None:
                stop.watch(child)
            with _Watchdog(child, self._patience) as watch:
                kind, value = _converse(child, work, progress, tell, watch)
        finally:
            if kind != "result":
                self._child = None
                _end(child, 0.0 if kind == "" else _LEAVING)
        if kind == "result":
            return value
        raise self._error(child, kind, value, stop, watch)

    def _start(self) -> subprocess.Popen[bytes]:
        """Start the child, unless one waits for work."""
        from ..errors import writing

        if self._child is not None:
            if self._child.poll() is None:
                return self._child
            self._close()
        with writing("the temporary folder"):
            log = tempfile.NamedTemporaryFile(prefix="firetwin-", suffix=".log", delete=False)  # noqa: SIM115
        name, limits = f"{__package__ or 'firetwin'}.worker", f"{self._blender}, {self._size}"
        with log:
            self._child = subprocess.Popen(
                _command(f"import importlib; importlib.import_module({name!r}).serve({limits})"),
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=log,
                env=_environment(self._eevee),
            )
        self._log = Path(log.name)
        return self._child

    def _close(self) -> None:
        """End the child, which has no work, and remove its log."""
        assert self._child is not None
        _end(self._child, _LEAVING)
        self._child = None
        _remove(self._log)

    def _error(
        self, child: subprocess.Popen[bytes], kind: str, value: Any, stop: Stop | None, watch: _Watchdog
    ) -> Exception:
        """Return the error of a work that has no result; the log stays if the error names it."""
        from ..errors import Error, InputError

        is_quiet = not self._blender or self._size > 0
        stopped = stop is not None and stop.asked
        if stopped or is_quiet or isinstance(value, InputError):
            _remove(self._log)
        log_at = "" if is_quiet else f" (the log of Blender is {self._log})"
        if stopped:
            return StoppedError()
        if kind == "error":
            return (
                value if isinstance(value, InputError) else type(value)(" ".join(str(value).split()) + log_at)
            )
        if is_quiet and watch.over:
            return EndedError(f"made no progress for {duration(self._patience)} and was ended")
        if is_quiet:
            return EndedError(_stopped(child.returncode))
        return Error(f"{_ending(child.returncode, self._eevee)}{log_at}")


def end_on_sigterm() -> None:
    """Turn SIGTERM and Ctrl-Break into an exception as Ctrl-C does, so that unfinished files are removed."""
    if threading.current_thread() is threading.main_thread():
        for number in filter(None, (signal.SIGTERM, getattr(signal, "SIGBREAK", None))):
            signal.signal(number, lambda received, _: sys.exit(128 + received))


class _Watchdog:
    """Watchdog: ends a child without output for `seconds` (0: never).

    Attributes
    ----------
    over
        True if it ended the child.
    """

    def __init__(self, child: subprocess.Popen[bytes], seconds: float) -> None:
        self.over = False
        self._child, self._seconds = child, seconds
        self._heard, self._done = threading.Event(), False

    def __enter__(self) -> _Watchdog:
        if self._seconds > 0:
            threading.Thread(target=self._wait, daemon=True).start()
        return self

    def __exit__(self, *_: object) -> None:
        self._done = True
        self._heard.set()

    def heard(self) -> None:
        """Restart the timeout: the child sent output."""
        self._heard.set()

    def _wait(self) -> None:
        while self._heard.wait(self._seconds):
            if self._done:
                return
            self._heard.clear()
        self.over = True
        self._child.kill()


def _remove(path: Path) -> None:
    """Remove a log; it stays if its disk has become read-only."""
    with contextlib.suppress(OSError):
        path.unlink(missing_ok=True)


def _converse(
    child: subprocess.Popen[bytes],
    work: Work[Any],
    progress: Progress,
    tell: MessageCallback,
    watch: _Watchdog,
) -> Answer:
    """Send the work, pass on progress and messages, and return the last answer; `_NONE` without one."""
    assert child.stdin is not None
    assert child.stdout is not None
    call = pickle.dumps(pickle.dumps(work))  # the child reads bytes, and loads modules of the work later
    try:
        child.stdin.write(call)
        child.stdin.flush()
    except OSError:  # broken pipe: BrokenPipeError, on Windows an invalid argument
        return _NONE
    for line in child.stdout:
        if line.endswith(_START):
            watch.heard()
            break
    while True:
        try:
            kind, value = pickle.load(child.stdout)
        except (EOFError, pickle.UnpicklingError):  # it ended, perhaps within an answer
            child.wait()
            return _NONE
        watch.heard()
        if kind == "progress":
            progress(*value)
        elif kind == "tell":
            tell(value)
        elif kind != "heartbeat":
            return kind, value


def _end(child: subprocess.Popen[bytes], leaving: float) -> None:
    """End the child: close its pipe, after `leaving` (s) terminate it, then kill it."""
    assert child.stdin is not None
    assert child.stdout is not None
    with contextlib.suppress(OSError):
        child.stdin.close()
    with contextlib.suppress(subprocess.TimeoutExpired):
        child.wait(timeout=leaving)
    child.stdout.close()
    if child.poll() is None:
        child.terminate()
        try:
            child.wait(timeout=3)
        except subprocess.TimeoutExpired:
            child.kill()
            child.wait()


def _command(code: str) -> list[str]:
    """Compose the child's command: Python with Blender as a module, or Blender's executable in Blender."""
    blender = sys.modules["bpy"].app.binary_path if "bpy" in sys.modules else ""
    return (
        [blender, "--background", "--disable-autoexec", "--python-expr", code]
        if blender
        else [sys.executable, "-c", code]
    )


def _environment(eevee: bool) -> dict[str, str]:
    environment = os.environ | memory.few_arenas() | caches.environment(os.environ)
    display = environment.get("DISPLAY") or environment.get("WAYLAND_DISPLAY")
    if eevee and sys.platform == "linux" and not display:
        environment["EGL_PLATFORM"] = "surfaceless"
        if not any(Path("/dev/dri").glob("renderD*")) and not Path("/dev/nvidia0").exists():
            environment["LIBGL_ALWAYS_SOFTWARE"] = "1"
    return environment


def _stopped(code: int) -> str:
    how = f"signal {-code} ({_signal(-code)})" if code < 0 else f"exit status {code}"
    return f"stopped {'on' if code < 0 else 'with'} {how}"


def _ending(code: int, eevee: bool) -> str:
    how = _stopped(code)
    if eevee:
        need = "EEVEE needs OpenGL (on Debian: libegl1 libgl1-mesa-dri)"
        return f'Blender {how}; {need}, or set engine = "cycles" in [render]'
    if code < 0 and _signal(-code) == "SIGKILL":
        return f"Blender {how}; most likely memory ran out: larger voxels or a lower resolution need less"
    return f"Blender {how}"


def _signal(number: int) -> str:
    """Return the name of a signal; the set of signals differs between systems."""
    try:
        return signal.Signals(number).name
    except ValueError:
        return "of no name"


def serve(blender: bool = True, size: int = 0) -> None:
    """Do the parent's works until it closes the pipe; worker side of `Worker`."""
    # Ctrl-C reaches both; the parent decides. On Windows its wait for an answer ends only with this process.
    signal.signal(signal.SIGINT, signal.SIG_DFL if sys.platform == "win32" else signal.SIG_IGN)
    channel, source = os.fdopen(os.dup(1), "wb"), os.fdopen(os.dup(0), "rb")
    os.dup2(2, 1)
    # Windows' libraries ask for stdin when they are loaded, and wait while its pipe is read.
    with open(os.devnull, "rb") as nothing:
        os.dup2(nothing.fileno(), 0)
    _set_binary(channel)
    _set_binary(source)
    sending = threading.Lock()
    calls: queue.SimpleQueue[bytes] = queue.SimpleQueue()
    threading.Thread(target=_read_calls, args=(source, calls), daemon=True).start()

    def answer(kind: str, value: Any = None) -> None:
        data = pickle.dumps((kind, value))
        with sending:
            channel.write(data)
            channel.flush()

    if blender:
        import bpy  # noqa: F401 (before the core: the first of two libtbb.so.12 wins; it must be Blender's)

    while True:
        call = calls.get()
        channel.write(_START)
        channel.flush()
        answer(*_do(call, size, answer))


def _do(call: bytes, size: int, answer: Callable[..., None]) -> Answer:
    """Do a work, and return its last answer."""
    from ..errors import InputError
    from ..run.models import heartbeat

    try:
        work: Work[Any] = pickle.loads(call)
        if size:
            memory.limit(size)
        with heartbeat.to(lambda: answer("heartbeat")):
            result = work(
                progress=lambda *where: answer("progress", where), tell=lambda text: answer("tell", text)
            )
        return "result", result
    except Exception as error:
        if not isinstance(error, InputError):
            traceback.print_exc()
        return "error", _as_firetwin_error(error)
    finally:
        sys.stderr.flush()


def _set_binary(stream: IO[Any]) -> None:
    """Keep Windows from converting the ends of lines, as it does in Blender's Python."""
    if sys.platform == "win32":
        import msvcrt

        msvcrt.setmode(stream.fileno(), os.O_BINARY)


def _as_firetwin_error(error: Exception) -> Error:
    """Convert an exception to an Error of Firetwin."""
    from ..errors import Error, TryAgainError, full_disk_error, input_error, is_worth_another_try

    if isinstance(error, Error):
        return error
    again = is_worth_another_try(error)
    if isinstance(error, OSError) and isinstance(error.filename, str) and error.strerror:
        return full_disk_error(error.filename) if again else input_error(error.filename, error.strerror)
    text = str(error) if isinstance(error, OSError) else f"{type(error).__name__}: {error}"
    return TryAgainError(text) if again else Error(text)


def _read_calls(source: IO[bytes], calls: queue.SimpleQueue[bytes]) -> None:
    """Read calls of the parent; end this process when the parent closes the pipe or ends.

    Blender as a module may crash while the interpreter shuts down, so nothing is shut down.
    """
    with contextlib.suppress(EOFError, pickle.UnpicklingError):
        while True:
            calls.put(pickle.load(source))
    _remove_temporary_folder()
    os._exit(0)


def _remove_temporary_folder() -> None:
    """Remove the folder of Blender's temporary files, which Blender removes when it shuts down."""
    with contextlib.suppress(KeyError, AttributeError):  # without Blender, or while it is being loaded
        folder = Path(sys.modules["bpy"].app.tempdir)
        if folder.name.startswith("blender_"):  # else the folder that all programs share
            shutil.rmtree(folder, ignore_errors=True)
