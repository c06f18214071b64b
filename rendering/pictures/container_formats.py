"""The kinds of files that animations are written into, and how FFmpeg's libraries write each."""

from __future__ import annotations

from dataclasses import dataclass, field

from ..files import StrPath, is_folder_name, suffix_of

__all__ = ["FORMATS", "OVERLAYS", "ContainerFormat", "holds_alpha"]


@dataclass(frozen=True)
class ContainerFormat:
    """How FFmpeg's libraries write one kind of file.

    Attributes:
        container: FFmpeg's name of the file format.
        codec: FFmpeg's name of the encoder.
        pixels: pixel format of opaque frames.
        alpha_pixels: pixel format of frames with alpha; None where the format has no alpha.
        mixes_neighbours: colours of neighbours are mixed, whatever their alpha.
        options: of the encoder.
        alpha_options: of the encoder, in addition, for frames with alpha.
        exact_options: of the encoder, in addition, where colours shall stay as they are.
        container_options: of the file format.
        longest_side: largest width and height that it holds [px].
    """

    container: str
    codec: str
    pixels: str
    alpha_pixels: str | None = None
    mixes_neighbours: bool = False
    options: dict[str, str] = field(default_factory=dict)
    alpha_options: dict[str, str] = field(default_factory=dict)
    exact_options: dict[str, str] = field(default_factory=dict)
    container_options: dict[str, str] = field(default_factory=dict)
    longest_side: int = 65_535


FORMATS = {
    ".mp4": ContainerFormat(
        "mp4",
        "libx264",
        "yuv420p",
        # As good as "medium" at 17 (PSNR of the bundled example's frames 33.9 dB, of its luma 47.8 against 47.4) in
        # less than half of the time, with files larger by a third.
        options={"crf": "15", "preset": "veryfast", "tune": "animation"},
        # The index stands in front, so that a browser starts to play before it has everything.
        container_options={"movflags": "+faststart"},
        longest_side=16_384,
    ),
    ".webm": ContainerFormat(
        "webm",
        "libvpx-vp9",
        "yuv420p",
        "yuva420p",
        mixes_neighbours=True,
        options={"crf": "22", "b": "0", "cpu-used": "3", "row-mt": "1", "threads": "4"},
        # Alternate reference frames and alpha exclude each other in libvpx.
        alpha_options={"auto-alt-ref": "0"},
        container_options={"fflags": "+bitexact"},  # no number drawn by chance, so the same frames are the same bytes
    ),
    ".gif": ContainerFormat("gif", "gif", "pal8", "pal8", container_options={"loop": "0"}),
    ".webp": ContainerFormat(
        "webp",
        "libwebp_anim",
        "bgra",
        "bgra",
        mixes_neighbours=True,
        options={"quality": "90"},
        exact_options={"lossless": "1"},
        container_options={"loop": "0"},
        longest_side=16_383,
    ),
    ".apng": ContainerFormat("apng", "apng", "rgb24", "rgba", container_options={"plays": "0"}),
    # ProRes 4444, for editing and compositing programs, which take its alpha as straight.
    ".mov": ContainerFormat(
        "mov",
        "prores_ks",
        "yuv444p10le",
        "yuva444p10le",
        mixes_neighbours=True,
        # Some programs refuse what does not name Apple as its maker.
        options={"profile": "4444", "vendor": "apl0"},
        alpha_options={"alpha_bits": "16"},
        container_options={"movflags": "+faststart+write_colr"},
    ),
}

OVERLAYS = (".webm", ".mov")
"""Videos to lay over others: unless something is said, those of an opaque picture show its moving parts alone."""


def holds_alpha(path: StrPath) -> bool:
    """Whether what :func:`~physanimator.rendering.pictures.write_animation` writes there can be transparent.

    Args:
        path: a file ending in one of ``FORMATS``, or a folder ending in ``/``.
    """
    chosen = None if is_folder_name(path) else FORMATS.get(suffix_of(path))
    return is_folder_name(path) or (chosen is not None and chosen.alpha_pixels is not None)
