"""Monado's remote headset, whose head and controllers this process moves.

The packet is `struct r_remote_data` of Monado 25 (src/xrt/drivers/remote/r_interface.h): 376 bytes, little
endian, with the head's centre and a record for each controller. After a connection Monado sends its own.
"""

from __future__ import annotations

import math
import socket
import struct
from collections.abc import Iterator

from hands import check

_SIZE, _HEADER = 376, b"mndrmt3\0"
_HEAD = 8 + 2 * 48 + 16  # position of the head's centre, after two views and its rotation
LEFT, RIGHT = 136, 256
TRIGGER, SQUEEZE, FORCE, STICK, _ACTIVE = 72, 76, 80, 84, 105


class Headset:
    """Connection to Monado's remote driver."""

    def __init__(self) -> None:
        self._link = socket.create_connection(("127.0.0.1", 4242), 10)
        data = b""
        while len(data) < 2 * _SIZE:
            data += self._link.recv(2 * _SIZE - len(data))
        self._data = bytearray(data[_SIZE:])
        check(bytes(self._data[:8]) == _HEADER, "Monado speaks the known protocol")
        for hand in (LEFT, RIGHT):
            self._data[hand + _ACTIVE] = 1
        self._send()

    def _send(self) -> None:
        self._link.sendall(self._data)

    def head(self, east: float, up: float, south: float) -> None:
        """Move the head (m) in the room."""
        struct.pack_into("<3f", self._data, _HEAD, east, up, south)
        self._send()

    def point(self, hand: int, down: float, *position: float) -> None:
        """Let a controller at a position (m) in the room point forwards and down by an angle (rad)."""
        turn = math.sin(-0.5 * down), 0.0, 0.0, math.cos(0.5 * down)
        struct.pack_into("<7f", self._data, hand, *turn, *position)
        self._send()

    def press(self, hand: int, at: int, *values: float) -> None:
        """Set a control of a controller."""
        struct.pack_into(f"<{len(values)}f", self._data, hand + at, *values)
        self._send()

    def click(self, hand: int, at: int) -> Iterator[object]:
        """Press a control for a moment."""
        self.press(hand, at, 1.0)
        yield 1.5
        self.press(hand, at, 0.0)
        yield 1.5
