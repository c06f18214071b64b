"""Training runs one after another in one process; accelerate otherwise keeps the precision of the first."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

accelerate = pytest.importorskip("accelerate", reason="training needs accelerate")


@pytest.fixture(autouse=True)
def _its_own_accelerator() -> Iterator[None]:
    from accelerate.state import AcceleratorState

    yield
    AcceleratorState._reset_state(reset_partial_state=True)
