"""Work that somebody asks for again and again while he clicks: one piece at a time for each editor, the latest wins."""

from __future__ import annotations

import asyncio
from collections import OrderedDict
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from dataclasses import dataclass, field

from ...physics.errors import Cancelled

__all__ = ["Turn", "Turns"]

_MOST = 64
_AT_ONCE = 2


@dataclass(eq=False)
class _Line:
    """Those who wait for one editor."""

    lock: asyncio.Lock = field(default_factory=asyncio.Lock)
    latest: int = -1
    waiting: int = 0


@dataclass(frozen=True, eq=False)
class Turn:
    """One piece of work.

    Attributes:
        order: later requests have higher numbers.
    """

    order: int
    _line: _Line

    def check(self) -> None:
        """
        Raises:
            Cancelled: the editor has asked for something else since.
        """
        if self._line.latest > self.order:
            raise Cancelled("superseded")


class Turns:
    """The work of all editors, of which two are at work at once at most; used on the server's loop alone."""

    def __init__(self) -> None:
        self._lines: OrderedDict[str, _Line] = OrderedDict()
        self._at_work = asyncio.Semaphore(_AT_ONCE)

    @asynccontextmanager
    async def of(self, editor: str, order: int) -> AsyncIterator[Turn]:
        """Wait for the editor's earlier work to end; it is cancelled by this.

        Args:
            editor: whose it is.
            order: rises with each request.

        Raises:
            Cancelled: the editor has asked for something else meanwhile.
        """
        line = self._lines.setdefault(editor, _Line())
        self._lines.move_to_end(editor)
        line.latest = max(line.latest, order)
        turn = Turn(order, line)
        line.waiting += 1
        try:
            async with line.lock:
                turn.check()
                async with self._at_work:
                    turn.check()
                    yield turn
        finally:
            line.waiting -= 1
            self._forget()

    def _forget(self) -> None:
        for editor in [name for name, line in self._lines.items() if not line.waiting][: max(0, len(self) - _MOST)]:
            del self._lines[editor]

    def __len__(self) -> int:
        return len(self._lines)
