"""The paper's tables as commands: sets of pictures, methods and their ablations, columns, reports, and studies."""

from __future__ import annotations

__all__: list[str] = []
