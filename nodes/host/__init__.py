"""Between the host and the nodes: wires, tensors, choices, progress, previews, messages, and where files are saved."""

from __future__ import annotations

from .batches import announce_batch
from .choices import checked
from .computing import PRECISIONS, dtype_of
from .defaults import default_of
from .documents import checked_document
from .input_files import contents_of, layered_files, place_of
from .literals import PATH_FORMS, boxes_of, chosen, keys_of, numbers_of, refusal, times_of, whole_numbers_of
from .messages import all_told, hint_of_pixel_art, send_to_page, shown_with, tell_user
from .progress import host_check, host_progress, watched_sampling
from .running import is_wanted, not_made, sent_inputs, server, watch_prompts
from .saving import EXR, FILE_TYPES, FRAMES, SPINE, Place, check_prefix, free_place
from .sketches import drawn_lines, lines_of_frames, sketch_lines_input, told_of_light_lines
from .tensors import (
    FrameBatch,
    batch_of_masks,
    batch_of_pictures,
    mask_batch,
    mask_of,
    picture_batch,
    picture_of,
    picture_with_alpha,
    pictures_for,
    pictures_of,
)
from .wording import named_part, parts_named, with_known_places

__all__ = [
    "EXR",
    "FILE_TYPES",
    "FRAMES",
    "PATH_FORMS",
    "PRECISIONS",
    "SPINE",
    "FrameBatch",
    "Place",
    "all_told",
    "announce_batch",
    "batch_of_masks",
    "batch_of_pictures",
    "boxes_of",
    "check_prefix",
    "checked",
    "checked_document",
    "chosen",
    "contents_of",
    "default_of",
    "drawn_lines",
    "dtype_of",
    "free_place",
    "hint_of_pixel_art",
    "host_check",
    "host_progress",
    "is_wanted",
    "keys_of",
    "layered_files",
    "lines_of_frames",
    "mask_batch",
    "mask_of",
    "named_part",
    "not_made",
    "numbers_of",
    "parts_named",
    "picture_batch",
    "picture_of",
    "picture_with_alpha",
    "pictures_for",
    "pictures_of",
    "place_of",
    "refusal",
    "send_to_page",
    "sent_inputs",
    "server",
    "shown_with",
    "sketch_lines_input",
    "tell_user",
    "times_of",
    "told_of_light_lines",
    "watch_prompts",
    "watched_sampling",
    "whole_numbers_of",
    "with_known_places",
]
