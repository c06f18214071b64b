"""Many shots: a list of them, checked before any begins, done by processes on one machine or many, nothing twice."""

from __future__ import annotations

from .cluster import check_installed, connected, local_cluster, threads_each, usual_workers
from .collisions import colliding_outputs
from .document import ShotRow, read_rows
from .engine import SchedulerLost, check_workers, outcomes_here, outcomes_of, workers_for
from .farms import command_lines, openjd_template
from .fork_server import begin_fork_server
from .job import Animated, Job, Outcome
from .missing_workers import GPU_WORKERS, missing_workers_told
from .option_words import OptionNames, Word, shot_name, words_of
from .ordering import longest_first
from .problems import Problem, merged
from .report import write_report
from .run_folder import NOTES, alone_in, forgetting, others_files
from .shot import FileDigests, Shot, identity_of
from .shot_record import ENDING, ShotRecord, is_finished, read_shot_record
from .summary import summary_lines

__all__ = [
    "ENDING",
    "GPU_WORKERS",
    "NOTES",
    "Animated",
    "FileDigests",
    "Job",
    "OptionNames",
    "Outcome",
    "Problem",
    "SchedulerLost",
    "Shot",
    "ShotRecord",
    "ShotRow",
    "Word",
    "alone_in",
    "begin_fork_server",
    "check_installed",
    "check_workers",
    "colliding_outputs",
    "command_lines",
    "connected",
    "forgetting",
    "identity_of",
    "is_finished",
    "local_cluster",
    "longest_first",
    "merged",
    "missing_workers_told",
    "openjd_template",
    "others_files",
    "outcomes_here",
    "outcomes_of",
    "read_rows",
    "read_shot_record",
    "shot_name",
    "summary_lines",
    "threads_each",
    "usual_workers",
    "words_of",
    "workers_for",
    "write_report",
]
