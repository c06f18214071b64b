"""A small stand-in of the host, so that every node and workflow without model files runs in pytest.

``host/`` has its modules as far as this pack imports them; the files here check and run prompts as its executor does,
with a few of its own nodes. The real host is the authority: ``tests/host/test_stand_in.py`` compares the two.
"""

from __future__ import annotations

from .installing import installed
from .stand_in import StandIn

__all__ = ["StandIn", "installed"]
