"""HTCondor on this machine alone, in a folder with Debian 13, the one that has it; nothing is installed.

Its daemons and jobs see this machine's files below ``/host``, and a film's folder at its own path. This
machine's Python stands there as a script that runs the real one in this machine's own root.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

PROJECT = Path(__file__).parents[2]
TREE = Path(os.environ.get("FIRETWIN_DEBIAN", PROJECT / "build" / "debian")) / "trixie"
INSTALL = """\
command -v condor_master >/dev/null || {
  apt-get -q update && DEBIAN_FRONTEND=noninteractive apt-get -qy install --no-install-recommends htcondor
}"""
USER = "games"  # any but root and condor: HTCondor takes no jobs of those
COMMANDS = ("condor_submit_dag", "condor_submit", "condor_rm", "condor_q", "condor_history", "condor_status")
_CONFIGURATION = """\
LOCAL_DIR = {folder}
LOCAL_CONFIG_FILE =
LOCAL_CONFIG_DIR =
RELEASE_DIR = /usr
LIB = /usr/lib/condor
LIBEXEC = /usr/libexec/condor
SBIN = /usr/sbin
BIN = /usr/bin
LOG = {folder}/log
SPOOL = {folder}/spool
EXECUTE = {folder}/execute
LOCK = {folder}/lock
RUN = {folder}/lock
use ROLE : Personal
CONDOR_HOST = 127.0.0.1
NETWORK_INTERFACE = 127.0.0.1
COLLECTOR_HOST = 127.0.0.1:{port}
SEC_DEFAULT_AUTHENTICATION_METHODS = FS
SEC_DEFAULT_AUTHENTICATION = REQUIRED
SEC_DEFAULT_ENCRYPTION = OPTIONAL
SEC_DEFAULT_INTEGRITY = OPTIONAL
ALLOW_READ = *
ALLOW_WRITE = *
ALLOW_ADMINISTRATOR = *
ALLOW_DAEMON = *
ALLOW_NEGOTIATOR = *
NUM_CPUS = 2
MEMORY = 4000
UPDATE_INTERVAL = 5
NEGOTIATOR_INTERVAL = 2
NEGOTIATOR_MIN_INTERVAL = 1
NEGOTIATOR_CYCLE_DELAY = 1
SCHEDD_INTERVAL = 2
SCHEDD_MIN_INTERVAL = 1
DAGMAN_USER_LOG_SCAN_INTERVAL = 1
RUNBENCHMARKS = False
STARTD_NOCLAIM_SHUTDOWN = 0
"""
_ENTER = """\
#!/bin/sh
# Runs {name} as HTCondor's user in the folder, where a film's own folder is at the same path.
case $PWD in */farm/htcondor) chmod -R a+rwX ../.. ;; esac
exec nsenter --mount=/proc/{pid}/ns/mnt chroot {tree} setpriv --reuid={user} --regid={user} --clear-groups \\
  env -i -C "$PWD" {environment} {name} "$@"
"""


_STAND_IN = """\
#!/bin/sh
# Runs {python} of this machine as root, which alone reads folders of tests, and gives SIGTERM to it.
outside="/usr/sbin/outside /host /usr/bin/setpriv --reuid=0 --regid=0 --clear-groups"
$outside /usr/bin/env -C "$PWD" {python} "$@" &
child=$!
told=
trap 'told=1; $outside /bin/kill -TERM "$child"' TERM
wait "$child"
status=$?
while [ "$told" ]; do
  told=
  wait "$child"
  status=$?
done
exit "$status"
"""


class UnavailableError(Exception):
    """HTCondor cannot be had here; says why."""


def prepare() -> None:
    """Have the folder with HTCondor; it is made if it is not there (some minutes)."""
    if not (TREE / "usr/sbin/condor_master").exists():
        command = ["tests/system/in_debian.sh", "trixie", TREE, "bash", "-c", INSTALL]
        made = subprocess.run(command, cwd=PROJECT, capture_output=True, text=True)
        if made.returncode:
            raise UnavailableError(made.stderr.strip().splitlines()[-1])
    if os.geteuid() or not shutil.which("nsenter"):
        raise UnavailableError("HTCondor's folder needs root and nsenter")


class Condor:
    """A pool of one machine with two slots.

    Attributes
    ----------
    films
        Folder for films: jobs find no other folder at its own path.
    environment
        In which condor_submit_dag and its like work.
    """

    def __init__(self) -> None:
        self._place = tempfile.TemporaryDirectory(
            prefix="condor-",
            dir="/var/tmp",
            ignore_cleanup_errors=True,  # DAGMan refuses /tmp
        )
        self.folder = Path(self._place.name)
        self.films = self.folder / "films"
        for name in ("films", "bin", "log", "spool", "execute", "lock"):
            (self.folder / name).mkdir()
        text = _CONFIGURATION.format(folder=self.folder, port=20000 + os.getpid() % 20000)
        (self.folder / "condor_config").write_text(text)
        self.environment = os.environ | {"PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}"}

    def __enter__(self) -> Condor:
        try:
            self._start()
            self._wait(lambda: self.call("condor_status", "-af", "Name").strip(), "a machine in the pool")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._master.terminate()
        try:
            self._master.wait(20)
        except subprocess.TimeoutExpired:
            self._master.kill()
            self._master.wait()
        self._place.cleanup()

    def call(self, *command: str) -> str:
        """Run a command of HTCondor and return its output."""
        done = subprocess.run(command, env=self.environment, cwd=self.folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def wait(self, seconds: float = 600.0) -> None:
        """Wait until no job is left."""
        self._wait(lambda: not self.call("condor_q", "-af", "ClusterId").strip(), "the jobs to end", seconds)

    def _start(self) -> None:
        stand_in = TREE / sys.executable.lstrip("/")
        stand_in.parent.mkdir(parents=True, exist_ok=True)
        stand_in.write_text(_STAND_IN.format(python=sys.executable))
        stand_in.chmod(0o755)
        shutil.copy(TREE / "usr/sbin/chroot", TREE / "usr/sbin/outside")
        (TREE / "usr/sbin/outside").chmod(0o4755)
        for path in (TREE / "host", TREE / str(self.folder).lstrip("/")):
            path.mkdir(parents=True, exist_ok=True)
        script = """
        mount --rbind / "$1/host" && mount --bind /proc "$1/proc" && mount --rbind /dev "$1/dev" &&
        mount --bind "$2" "$1$2" && chown -R "$(chroot "$1" id -u "$3")" "$2" && chmod -R a+rwX "$2" &&
        exec chroot "$1" setpriv --reuid="$3" --regid="$3" --clear-groups env -i "${@:4}" condor_master -f
        """
        about = [
            "PATH=/usr/sbin:/usr/bin:/sbin:/bin",
            f"HOME={self.folder}",
            f"CONDOR_CONFIG={self.folder}/condor_config",
        ]
        unshared = ["unshare", "--mount", "--propagation", "private", "bash", "-c", script, "bash"]
        with (self.folder / "master.out").open("ab") as log:
            self._master = subprocess.Popen(
                [*unshared, TREE, self.folder, USER, *about], stdout=log, stderr=log
            )
        for name in COMMANDS:
            path = self.folder / "bin" / name
            place = {"pid": self._master.pid, "tree": TREE, "user": USER}
            path.write_text(_ENTER.format(name=name, environment=" ".join(about), **place))
            path.chmod(0o755)

    def _wait(self, there: Callable[[], object], what: str, seconds: float = 60.0) -> None:
        end = time.monotonic() + seconds
        while True:
            with contextlib.suppress(AssertionError):
                if there():
                    return
            if time.monotonic() > end or self._master.poll() is not None:
                logs = [*self.folder.glob("master.out"), *self.folder.glob("log/*Log")]
                said = " | ".join(each.read_text(errors="replace")[-800:] for each in logs)
                raise TimeoutError(f"HTCondor: waited for {what}; {said}")
            time.sleep(0.3)
