"""A small disk of memory for one process tree, which can be full or read-only for a while."""

import os
import subprocess
import sys
import time
from pathlib import Path

SIZE = 256 << 20  # bytes
_PRIVATE = "CHAOS_PRIVATE"  # environment variable, set within the namespace
_TRIES = 20


def own_mounts() -> bool:
    """Start this program again in its own mount namespace if allowed; returns whether it is in one."""
    if _PRIVATE not in os.environ:
        for command in (["unshare", "--mount"], ["unshare", "--map-root-user", "--mount"]):
            if _succeeds(*command, "true"):
                again = [*command, sys.executable, *sys.argv]
                os.execvpe(again[0], again, os.environ | {_PRIVATE: "1"})  # does not return
    return _PRIVATE in os.environ


class Disk:
    """The disk, mounted on a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        folder.mkdir()
        subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={SIZE}", "tmpfs", folder], check=True)

    def fill(self, seconds: float) -> bool:
        """Reduce its size to the used bytes for a while; False if its use grew each time."""
        for _ in range(_TRIES):
            space = os.statvfs(self.folder)
            used = (space.f_blocks - space.f_bfree) * space.f_frsize
            if self._resize(max(used, space.f_frsize)):  # a size of 0 has no limit
                time.sleep(seconds)
                return self._resize(SIZE)
        return False

    def write_protect(self, seconds: float) -> bool:
        """Cover it with a read-only mount for a while; files that are open for writing remain so."""
        if not _succeeds("mount", "--bind", "-o", "ro", self.folder, self.folder):
            return False
        time.sleep(seconds)
        return _succeeds("umount", "--lazy", self.folder)

    def close(self) -> None:
        """Unmount it."""
        subprocess.run(["umount", "--lazy", self.folder], check=True)

    def _resize(self, size: int) -> bool:
        return _succeeds("mount", "-o", f"remount,size={size}", self.folder)


def _succeeds(*command: object) -> bool:
    return subprocess.run(list(map(str, command)), capture_output=True, check=False).returncode == 0
