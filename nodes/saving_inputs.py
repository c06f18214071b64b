"""Where nodes save to, as inputs."""

from __future__ import annotations

from collections.abc import Sequence

from comfy_api.latest import io

__all__ = ["place_inputs"]


def place_inputs(prefix: str, file_types: Sequence[str], about: str) -> list[io.Input]:
    """The inputs ``filename_prefix`` and ``file_type``.

    Args:
        prefix: the usual name, with a folder.
        file_types: to choose from, the usual one first.
        about: what they are.
    """
    return [
        io.String.Input(
            "filename_prefix",
            default=prefix,
            tooltip="Name in the output folder, with folders if you like; a number is added, nothing is overwritten."
            " %width%, %height%, %year%, %month%, %day% and so on are filled in.",
        ),
        io.Combo.Input("file_type", options=list(file_types), default=file_types[0], tooltip=about),
    ]
