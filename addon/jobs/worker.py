"""Worker process: calls a function in a child process, isolated from Blender's output and crashes.

The parent writes the arguments to the child's stdin as one JSON line and keeps that pipe open. The child
answers on its stdout with JSON lines: progress, then a result or an error. Blender's own output goes to a log
file. The child ends when the parent's end of the pipe closes, even if the parent was killed.
"""

from __future__ import annotations

import contextlib
import functools
import importlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import memory
from ..gpu import caches
from ..progress import MessageCallback, Progress, duration, no_message, silent

if TYPE_CHECKING:
    from ..errors import Error

_heartbeats: list[Callable[[], None]] = []


class StoppedError(Exception):
    """The work was cancelled by `Stop.now`."""


class EndedError(Exception):
    """A process without Blender ended before it answered; the message gives the reason."""


class Stop:
    """Cancellation token: ends a `run` from another thread."""

    def __init__(self) -> None:
        self.asked = False
        self._child: subprocess.Popen[str] | None = None
        self._lock = threading.Lock()

    def now(self) -> None:
        """Cancel: end the child; a `run` that has not begun ends as soon as it begins."""
        with self._lock:
            self.asked = True
            if self._child is not None and self._child.poll() is None:
                self._child.terminate()
                sure = threading.Timer(3.0, self._child.kill)
                sure.daemon = True
                sure.start()

    def watch(self, child: subprocess.Popen[str]) -> None:
        """Register the child to end."""
        with self._lock:
            self._child = child
        if self.asked:
            self.now()


def run(
    task: str,
    arguments: dict[str, Any],
    progress: Progress = silent,
    eevee: bool = False,
    stop: Stop | None = None,
    tell: MessageCallback = no_message,
    blender: bool = True,
    patience: float = 0.0,
) -> Any:
    """Call ``package.module:function`` in a child process: ``function(progress=..., tell=..., **arguments)``.

    Parameters
    ----------
    arguments
        Values that JSON can represent.
    eevee
        The task renders with EEVEE, which needs OpenGL; without a display it uses an off-screen one.
    stop
        Cancellation token for use by another thread.
    blender
        The task needs Blender; a task that does not need it also runs without a Blender.
    patience
        Timeout in s: the child is ended after this time without progress or heartbeat (`send_heartbeat`); 0:
        no timeout.

    Returns
    -------
    The function's result, as JSON represents it.

    Raises
    ------
    InputError, Error
        An error that the function raised, of the same kind, or an Error that describes how the process ended.
    StoppedError
        `stop` was used.
    EndedError
        The process of a task without Blender ended otherwise.
    """
    from ..errors import Error, from_plain, writing

    with writing("the temporary folder"):
        log = tempfile.NamedTemporaryFile(prefix="firetwin-", suffix=".log", delete=False)  # noqa: SIM115
    forget = functools.partial(_remove, Path(log.name))
    package = __package__ or "firetwin"
    code = f"import importlib; importlib.import_module({package + '.worker'!r}).serve({blender})"
    with log:
        child = subprocess.Popen(
            _command(code),
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=log,
            env=_environment(eevee),
            encoding="utf-8",
            errors="replace",  # Blender's own output
        )
    try:
        _end_on_sigterm()
        if stop is not None:
            stop.watch(child)
        with _Watchdog(child, patience) as watch:
            answer = _converse(child, {"task": task, "arguments": arguments}, progress, tell, watch)
    finally:
        _end(child)
    if "result" in answer:
        forget()
        return answer["result"]
    if stop is not None and stop.asked:
        forget()
        raise StoppedError
    found, log_at = answer.get("error"), f" (the log of Blender is {log.name})" if blender else ""
    if found and ("place" in found or not blender):
        forget()
    if found:
        raise from_plain(found, log_at)
    if not blender:
        forget()
        if watch.over:
            raise EndedError(f"made no progress for {duration(patience)} and was ended")
        raise EndedError(_stopped(child.returncode))
    raise Error(f"{_ending(child.returncode, eevee)}{log_at}")


def _end_on_sigterm() -> None:
    """Turn SIGTERM into an exception as Ctrl-C does, so that unfinished files are removed."""
    if threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGTERM, lambda *_: sys.exit(128 + signal.SIGTERM))


class _Watchdog:
    """Watchdog: ends a child without output for `seconds` (0: never).

    Attributes
    ----------
    over
        True if it ended the child.
    """

    def __init__(self, child: subprocess.Popen[str], seconds: float) -> None:
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
    child: subprocess.Popen[str],
    request: dict[str, Any],
    progress: Progress,
    tell: MessageCallback,
    watch: _Watchdog,
) -> dict[str, Any]:
    """Send the request, pass on progress and messages, and return the last answer; empty without one."""
    assert child.stdin is not None
    assert child.stdout is not None
    try:
        child.stdin.write(json.dumps(request) + "\n")
        child.stdin.flush()
    except OSError:  # broken pipe: BrokenPipeError, on Windows an invalid argument
        return {}
    for line in child.stdout:
        watch.heard()
        if not line.startswith("{"):
            continue  # Blender's own executable prints a banner first
        answer = json.loads(line)
        if "progress" in answer:
            progress(*answer["progress"])
        elif "tell" in answer:
            tell(answer["tell"])
        elif "sign" not in answer:
            child.wait()
            return answer
    child.wait()
    return {}


def _end(child: subprocess.Popen[str]) -> None:
    """End the child if it still runs: terminate, then kill."""
    assert child.stdin is not None
    assert child.stdout is not None
    child.stdout.close()
    with contextlib.suppress(OSError):
        child.stdin.close()
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


def serve(blender: bool = True) -> None:
    """Execute the parent's request; worker side of `run`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches both; the parent decides
    channel = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    request = json.loads(sys.stdin.readline())
    threading.Thread(target=_watch_parent, daemon=True).start()

    def answer(**message: Any) -> None:
        print(json.dumps(message), file=channel, flush=True)

    _heartbeats.append(lambda: answer(sign=True))
    if blender:
        import bpy  # noqa: F401 (before the core: the first of two libtbb.so.12 wins, and it must be Blender's)

    from ..errors import InputError, to_plain

    module, _, function = request["task"].partition(":")
    try:
        call = getattr(importlib.import_module(module), function)
        result = call(
            progress=lambda *where: answer(progress=where),
            tell=lambda text: answer(tell=text),
            **request["arguments"],
        )
    except InputError as error:
        answer(error=to_plain(error))
    except Exception as error:
        import traceback

        traceback.print_exc()
        answer(error=to_plain(_as_firetwin_error(error)))
    else:
        answer(result=result)
    sys.stderr.flush()
    os._exit(0)  # Blender as a module may crash while the interpreter shuts down


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


def send_heartbeat() -> None:
    """Send a heartbeat to the parent's watchdog (`patience`); no effect in other processes."""
    for say in _heartbeats:
        say()


def _watch_parent() -> None:
    sys.stdin.read()
    os._exit(1)
