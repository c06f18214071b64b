"""Files on disk: places checked before the work, written whole or not at all, removed when a signal ends the work."""

from __future__ import annotations

from .atomic import is_full, naming_place, putting_in_place, replacing
from .path_names import StrPath, is_folder_name, plain_name, same_name, suffix_of
from .places import check_file_place, check_folder_place, check_replaceable, is_read_only, place_of
from .record import WrittenFile, recorded
from .recorded_folder import RecordedFiles, check_recorded_folder, write_recorded_folder
from .regular import check_regular
from .signals import ending_signals, hear_signals, ignore_signals, uninterrupted
from .text_files import check_text_output, parsed_toml, read_text_file, write_text
from .unfinished import made_beside, noting_unfinished, remove_noted, remove_unfinished, removed_at_signals

__all__ = [
    "RecordedFiles",
    "StrPath",
    "WrittenFile",
    "check_file_place",
    "check_folder_place",
    "check_recorded_folder",
    "check_regular",
    "check_replaceable",
    "check_text_output",
    "ending_signals",
    "hear_signals",
    "ignore_signals",
    "is_folder_name",
    "is_full",
    "is_read_only",
    "made_beside",
    "naming_place",
    "noting_unfinished",
    "parsed_toml",
    "place_of",
    "plain_name",
    "putting_in_place",
    "read_text_file",
    "recorded",
    "remove_noted",
    "remove_unfinished",
    "removed_at_signals",
    "replacing",
    "same_name",
    "suffix_of",
    "uninterrupted",
    "write_recorded_folder",
    "write_text",
]
