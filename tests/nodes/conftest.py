"""The stand-in of the host, for tests that run nodes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from standin import StandIn, installed


@pytest.fixture(scope="module")
def standin(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    with installed():
        yield StandIn(tmp_path_factory.mktemp("stand_in"))
