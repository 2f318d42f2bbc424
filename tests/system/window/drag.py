"""Drags a file onto a window as a file manager does (XDND, version 5): ``drag.py FILE TITLE X Y``.

X and Y are on the screen. Exit status 0: the window took it.
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

from Xlib import X, display
from Xlib.protocol import event

_PATIENCE = 60.0  # s


def _named(parent: object, title: str) -> object | None:
    """The window below another one that is called so and takes drops."""
    for child in parent.query_tree().children:
        if title in str(child.get_wm_name() or ""):
            return child
        if found := _named(child, title):
            return found
    return None


class Drag:
    """A file under the pointer of an invisible window of this process."""

    def __init__(self, path: Path, title: str) -> None:
        self.screen = display.Display()
        root = self.screen.screen().root
        self.own = root.create_window(0, 0, 1, 1, 0, X.CopyFromParent)
        self.target = _named(root, title)
        self.uri = f"{path.absolute().as_uri()}\r\n".encode()
        self.own.set_selection_owner(self.atom("XdndSelection"), X.CurrentTime)

    def atom(self, name: str) -> int:
        """The number of a name."""
        return self.screen.intern_atom(name)

    def send(self, name: str, *data: int) -> None:
        """A message to the target: our window, then four numbers."""
        words = (32, [self.own.id, *data, *(0,) * (4 - len(data))])
        message = event.ClientMessage(window=self.target, client_type=self.atom(name), data=words)
        self.target.send_event(message)
        self.screen.flush()

    def give(self, asked: object) -> None:
        """Answer a request for the dragged file."""
        asked.requestor.change_property(asked.property, asked.target, 8, self.uri)
        asked.requestor.send_event(
            event.SelectionNotify(
                time=asked.time,
                requestor=asked.requestor,
                selection=asked.selection,
                target=asked.target,
                property=asked.property,
            )
        )
        self.screen.flush()

    def wait(self, name: str) -> list[int]:
        """Numbers of the target's next message of this name; requests on the way are answered."""
        end, wanted = time.monotonic() + _PATIENCE, self.atom(name)
        while time.monotonic() < end:
            if not self.screen.pending_events():
                time.sleep(0.02)
                continue
            found = self.screen.next_event()
            if found.type == X.SelectionRequest:
                self.give(found)
            elif found.type == X.ClientMessage and found.client_type == wanted:
                return list(found.data[1])
        raise TimeoutError(f"no {name}")

    def drop(self, x: int, y: int) -> bool:
        """Enter, move there and let go; whether it was taken."""
        self.send("XdndEnter", 5 << 24, self.atom("text/uri-list"))
        for step in range(3):
            self.send(
                "XdndPosition", 0, (x << 16) | (y - 2 + step), X.CurrentTime, self.atom("XdndActionCopy")
            )
            accepted = self.wait("XdndStatus")[1] & 1
        if accepted:
            self.send("XdndDrop", 0, X.CurrentTime)
            self.wait("XdndFinished")
        return bool(accepted)


if __name__ == "__main__":
    file, title, x, y = sys.argv[1:]
    drag = Drag(Path(file), title)
    if drag.target is None:
        sys.exit(f"no window is called {title}")
    sys.exit(0 if drag.drop(int(x), int(y)) else "the window does not take it")
