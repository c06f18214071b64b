"""The command line run within a test."""

from __future__ import annotations

from physanimator.rendering.command import main

__all__ = ["status"]


def status(*arguments: str) -> int:
    """Exit status of one command, however it ends."""
    try:
        return main(arguments)
    except SystemExit as ended:
        return int(ended.code or 0)
