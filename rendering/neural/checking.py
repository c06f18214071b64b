"""What can be known of the chosen networks before any work: their device, and whether each file is the one meant."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ...physics.errors import InvalidInputError
from .options import FILES, NetworkOptions

__all__ = ["check_networks", "naming_files"]


def check_networks(options: NetworkOptions) -> None:
    """Refuse devices that are not there, and files that are missing, damaged or of another model.

    Every file but that of Segment Anything, which is the first to be used, is opened as it will be, and let go again.

    Raises:
        CheckpointError: the message names the file and what is wanted.
        InvalidInputError: there is no such device, or a model has fewer steps than are wanted.
    """
    from .devices import device_of, dtype_of
    from .drawing import load_svd, load_tooncrafter
    from .line_drawing import line_extractor
    from .soft_inpainting import load_inpainting

    dtype_of(options.dtype, device_of(options.device))
    with naming_files(options):
        if options.renderer == "svd":
            load_svd(options, as_saved=True)
        if options.renderer == "inpainting":
            load_inpainting(options, as_saved=True)
        if options.interpolate_with == "tooncrafter":
            load_tooncrafter(options, as_saved=True)
        if options.lines is not None:
            line_extractor(options)


@contextmanager
def naming_files(options: NetworkOptions) -> Iterator[None]:
    """Let an error about a file say which of the options it is."""
    try:
        yield
    except InvalidInputError as error:
        given = {name: str(Path(getattr(options, name))) for name in FILES if getattr(options, name) is not None}
        name = next((name for name, path in given.items() if str(error).startswith(path)), None)
        if name is None:
            raise
        raise type(error)(f"{name}: {error}") from error
