"""Processes of `firetwin` that can be disturbed."""

from __future__ import annotations

import contextlib
import os
import signal
import subprocess
import sys
from pathlib import Path

PATIENCE = 300.0  # s in which an undisturbed process must end


class Process:
    """A `firetwin` in its own process group.

    Its messages go to a file: nobody reads a pipe meanwhile, and a full pipe would stop the process.

    Parameters
    ----------
    arguments
        Arguments of `firetwin`; `{place}` is the folder of the job.
    environment
        More environment variables.
    """

    def __init__(self, arguments: str, place: Path, **environment: object) -> None:
        here = {"XDG_CACHE_HOME": place / "answers", "TMPDIR": place / "tmp"} | environment
        self.arguments, self.killed = arguments, False
        self._messages = os.memfd_create("messages")
        self._process = subprocess.Popen(
            [sys.executable, "-m", "firetwin", *arguments.format(place=place).split()],
            stdout=subprocess.DEVNULL,
            stderr=self._messages,
            env=os.environ | {name: str(value) for name, value in here.items()},
            start_new_session=True,
        )

    @property
    def status(self) -> int | None:
        """Exit status; None while it runs."""
        return self._process.poll()

    def wait(self) -> bool:
        """Wait until it ends; kills it and returns False if it does not end."""
        try:
            self._process.wait(PATIENCE)
        except subprocess.TimeoutExpired:
            self.kill()
            return False
        return True

    def send(self, number: int) -> None:
        """Send a signal to the process and its children."""
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self._process.pid, number)

    def kill(self, alone: bool = False) -> None:
        """Kill the process, and its children unless `alone`."""
        self.killed = True
        if alone:
            self._process.kill()
        else:
            self.send(signal.SIGKILL)
        self._process.wait()

    def messages(self) -> str:
        """Return the messages until now."""
        size = os.fstat(self._messages).st_size
        return os.pread(self._messages, size, 0).decode(errors="replace")

    def fault(self) -> str:
        """Describe what must not happen to a disturbed process; empty if nothing did."""
        said, status = self.messages(), self.status
        if "Traceback" in said or "unexpected" in said:
            return f"{self.arguments}: {said[-4000:]}"
        if status is not None and status < 0 and not self.killed:
            return f"{self.arguments}: ended by signal {-status}: {said[-2000:]}"
        return ""


def run(arguments: str, place: Path) -> None:
    """Run `firetwin` undisturbed.

    Raises
    ------
    RuntimeError
        It fails.
    """
    process = Process(arguments, place)
    try:
        ended = process.wait()
    finally:
        process.kill()
    if not ended or process.status or process.fault():
        how = f"ended with {process.status}" if ended else f"did not end in {PATIENCE:.0f} s"
        raise RuntimeError(f"undisturbed {arguments} {how}: {process.messages()[-4000:]}")
