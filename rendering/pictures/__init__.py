"""Pictures, masks and clips: read without trust, converted, and written."""

from __future__ import annotations

from .bilinear_splat import splat
from .bleeding import bled, carried_on
from .clip_reading import read_clip
from .container_formats import FORMATS, OVERLAYS, holds_alpha
from .dense_flow import LEAST_FLOW_SIDE, optical_flow
from .frame_conversion import rgb_of
from .frame_folder import RECORD, frames_in, is_frame_name
from .images import check_image_output, data_address, load_image, load_mask, save_image
from .nearest import nearest_pixels
from .pixel_windows import window_around
from .pixels import as_dtype, as_float, as_grey, as_picture, as_uint8, check_picture
from .premultiplication import premultiplied, resized, straight
from .structure_tensor import StructureTensor, gradients
from .transparency import WHITE, Colour, is_transparent, over
from .video import check_output, write_animation

__all__ = [
    "FORMATS",
    "LEAST_FLOW_SIDE",
    "OVERLAYS",
    "RECORD",
    "WHITE",
    "Colour",
    "StructureTensor",
    "as_dtype",
    "as_float",
    "as_grey",
    "as_picture",
    "as_uint8",
    "bled",
    "carried_on",
    "check_image_output",
    "check_output",
    "check_picture",
    "data_address",
    "frames_in",
    "gradients",
    "holds_alpha",
    "is_frame_name",
    "is_transparent",
    "load_image",
    "load_mask",
    "nearest_pixels",
    "optical_flow",
    "over",
    "premultiplied",
    "read_clip",
    "resized",
    "rgb_of",
    "save_image",
    "splat",
    "straight",
    "window_around",
    "write_animation",
]
