"""A study with people: which of two clips they prefer, as a page for raters and as results of their answers."""

from __future__ import annotations

from .answers import AnswerFile, StudyKey, read_files
from .clip_folders import MethodClips, method_clips
from .making import StudyOptions, make_study
from .questions import QUESTIONS, Question, questions_of
from .results import Preference, StudyResults, results_of

__all__ = [
    "QUESTIONS",
    "AnswerFile",
    "MethodClips",
    "Preference",
    "Question",
    "StudyKey",
    "StudyOptions",
    "StudyResults",
    "make_study",
    "method_clips",
    "questions_of",
    "read_files",
    "results_of",
]
