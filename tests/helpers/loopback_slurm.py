"""Slurm on this machine alone: a controller and two nodes from unpacked Debian packages, no service.

Nothing is installed. All it writes is in the folder that it is given, and in ``build/slurm``.
"""

from __future__ import annotations

import contextlib
import getpass
import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path

PACKAGES = ("slurmctld", "slurmd", "slurm-client", "slurm-wlm-basic-plugins", "libmunge2")
PBS_PACKAGES = ("slurm-wlm-torque", "libslurm-perl", "libslurmdb-perl", "libslurm38", "libswitch-perl")
ROOT = Path(__file__).parents[2] / "build" / "slurm"
NODES = ("n0", "n1")
_CONFIGURATION = """\
ClusterName=loop
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/none
CredType=cred/none
AuthInfo=cred_expire=5
SlurmUser={user}
SlurmdUser={user}
PluginDir={plugins}
PlugStackConfig=/dev/null
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
TaskProlog={folder}/prolog.sh
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
JobCompType=jobcomp/filetxt
JobCompLoc={folder}/ended.txt
SlurmdParameters=config_overrides
ReturnToService=2
SlurmdTimeout=15
MinJobAge=300
KillWait=5
MaxArraySize={array}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool-%n
SlurmctldPidFile={folder}/ctld.pid
SlurmdPidFile={folder}/%n.pid
SlurmctldLogFile={folder}/ctld.log
SlurmdLogFile={folder}/%n.log
NodeName=n[0-1] NodeHostname={host} NodeAddr=127.0.0.1 Port=[{ports[1]}-{ports[2]}] CPUs=1 RealMemory=2000
PartitionName=farm Nodes=n[0-1] Default=YES MaxTime=INFINITE State=UP
"""
_PROLOG = """\
#!/bin/sh
echo "export TMPDIR={folder}/disk-$SLURMD_NODENAME"
"""


class UnavailableError(Exception):
    """Slurm cannot be had here; says why."""


def unpacked() -> Path:
    """The folder with the packages' files; they are downloaded by apt if they are not there."""
    tree = ROOT / "root"
    if not (tree / "usr/sbin/slurmctld-wlm").exists():
        _unpack(tree, PACKAGES)
    return tree


def unpack_pbs() -> None:
    """Add qsub, qdel and others of Slurm to its commands, as in `unpacked`."""
    if not (unpacked() / "usr/bin/qsub").exists():
        _unpack(unpacked(), PBS_PACKAGES)


def _unpack(tree: Path, packages: tuple[str, ...]) -> None:
    if not shutil.which("apt-get") or not shutil.which("dpkg-deb"):
        raise UnavailableError("Slurm comes from Debian packages, and there is no apt-get here")
    debs = ROOT / packages[0]
    debs.mkdir(parents=True, exist_ok=True)
    found = subprocess.run(["apt-get", "download", *packages], cwd=debs, capture_output=True, text=True)
    if found.returncode:
        raise UnavailableError(f"apt-get download: {found.stderr.strip().splitlines()[-1]}")
    for deb in debs.glob("*.deb"):
        subprocess.run(["dpkg-deb", "-x", deb, tree], check=True)


class Slurm:
    """Two nodes of one processor each.

    Attributes
    ----------
    environment
        In which sbatch and its like work.
    """

    def __init__(self, folder: Path, array: int = 1001) -> None:
        tree = unpacked()
        (libraries,) = {path.parent for path in tree.glob("usr/lib/*/slurm-wlm/libslurmfull.so")}
        self.folder, self._sbin = folder, tree / "usr/sbin"
        (folder / "state").mkdir(parents=True)
        text = _CONFIGURATION.format(
            host=socket.gethostname().partition(".")[0],
            user=getpass.getuser(),
            plugins=libraries,
            folder=folder,
            array=array,
            ports=_ports(),
        )
        (folder / "slurm.conf").write_text(text)
        prolog = folder / "prolog.sh"
        prolog.write_text(_PROLOG.format(folder=folder))
        prolog.chmod(0o755)
        for node in NODES:
            self.disk(node).mkdir()
        self.environment = os.environ | {
            "SLURM_CONF": str(folder / "slurm.conf"),
            "LD_LIBRARY_PATH": f"{libraries}:{libraries.parent}",
            "PATH": f"{tree / 'usr/bin'}:{os.environ['PATH']}",
            "PERL5LIB": ":".join(map(str, [*tree.glob("usr/lib/*/perl5/*"), tree / "usr/share/perl5"])),
        }
        self._running: dict[str, subprocess.Popen[bytes]] = {}

    def __enter__(self) -> Slurm:
        try:
            self._start("ctld", "slurmctld-wlm", "-D", "-i")
            for node in NODES:
                self.start_node(node)
            self._wait(lambda: self.call("sinfo", "-h", "-o", "%T %D") == "idle 2", "two idle nodes")
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        for name in list(self._running):
            self._end(name)

    def start_node(self, node: str) -> None:
        """Start a node, also one that was killed."""
        self._start(node, "slurmd-wlm", "-D", "-N", node, "-d", str(self._sbin / "slurmstepd-wlm"))

    def kill_node(self, node: str) -> None:
        """Have a machine fall over: its daemon and all that it started are killed, its own disk is lost."""
        daemon = self._running.pop(node)
        daemon.kill()
        self._kill_tasks(node)
        daemon.wait()
        shutil.rmtree(self.folder / f"spool-{node}")
        shutil.rmtree(self.disk(node))
        self.disk(node).mkdir()

    def disk(self, node: str) -> Path:
        """A node's own disk for temporary files."""
        return self.folder / f"disk-{node}"

    def _kill_tasks(self, node: str) -> None:
        """Kill the tasks of a node: sessions with a script from the node's folder."""
        scripts = f"{self.folder}/spool-{node}/".encode()
        sessions = {session for _, session, command in _processes() if scripts in command}
        for pid, session, _ in _processes():
            if session in sessions:
                with contextlib.suppress(ProcessLookupError):
                    os.kill(pid, signal.SIGKILL)

    def call(self, *command: str, check: bool = True) -> str:
        """Run a command of Slurm and return its output."""
        done = subprocess.run(
            command, env=self.environment, capture_output=True, text=True, timeout=60, check=check
        )
        return done.stdout.strip()

    def states(self) -> dict[str, str]:
        """State of every job and array task, also of those that have ended, by its number."""
        lines = self.call("squeue", "-h", "-a", "-r", "-t", "all", "-o", "%i %j %T").splitlines()
        return {" ".join(line.split()[:2]): line.split()[2] for line in lines}

    def wait(self, seconds: float = 600.0) -> dict[str, str]:
        """Wait until no job is left; the states."""
        busy = {"PENDING", "RUNNING", "COMPLETING", "CONFIGURING", "REQUEUED", "SUSPENDED"}
        self._wait(lambda: not busy & set(self.states().values()), "the jobs to end", seconds)
        return self.states()

    def _start(self, name: str, program: str, *arguments: str) -> None:
        with (self.folder / f"{name}.out").open("ab") as log:
            command = [str(self._sbin / program), *arguments]
            self._running[name] = subprocess.Popen(
                command,
                env=self.environment,
                cwd=self.folder,
                stdout=log,
                stderr=log,
                stdin=subprocess.DEVNULL,
            )

    def _end(self, name: str) -> None:
        process = self._running.pop(name)
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if name in NODES:
            self._kill_tasks(name)

    def _wait(self, there: Callable[[], bool], what: str, seconds: float = 60.0) -> None:
        end = time.monotonic() + seconds
        while True:
            with contextlib.suppress(subprocess.SubprocessError):
                if there():
                    return
            if time.monotonic() > end:
                raise TimeoutError(f"Slurm: waited for {what}; {self._logs()}")
            time.sleep(0.2)

    def _logs(self) -> str:
        return " | ".join(path.read_text(errors="replace")[-800:] for path in self.folder.glob("*.log"))


def _ports() -> list[int]:
    """Three ports in a row that nobody listens on."""
    for first in range(26817 + os.getpid() % 1000 * 3, 60000, 3):
        with contextlib.ExitStack() as stack, contextlib.suppress(OSError):
            for port in range(first, first + 3):
                stack.enter_context(socket.socket()).bind(("127.0.0.1", port))
            return [first, first + 1, first + 2]
    raise UnavailableError("no free ports")


def _processes() -> Iterator[tuple[int, int, bytes]]:
    """Number, session and command line of every process."""
    for folder in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            session = int((folder / "stat").read_text().rpartition(")")[2].split()[3])
            yield int(folder.name), session, (folder / "cmdline").read_bytes()
