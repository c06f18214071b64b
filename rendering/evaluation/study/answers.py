"""Answers that raters saved, and the key of their study, read without trust."""

from __future__ import annotations

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ....physics.errors import InvalidInputError, printable
from ...files import check_regular
from .making import KEY_FORMAT
from .trials import Trial

__all__ = ["ANSWERS_FORMAT", "AnswerFile", "StudyKey", "read_files"]

ANSWERS_FORMAT = "physanimator study answers"
_LARGEST = 20_000_000
_MOST_ANSWERS = 100_000
_LONGEST = 200


@dataclass(frozen=True)
class StudyKey:
    """What the page does not say.

    Attributes:
        study: its id.
        questions: texts by keys.
        trials: by ids.
    """

    study: str
    questions: dict[str, str]
    trials: dict[str, Trial]


@dataclass(frozen=True)
class AnswerFile:
    """What one rater saved.

    Attributes:
        rater: an opaque name, made by the page.
        saved: when, as ISO 8601 in UTC.
        choices: "left" or "right" by trial and question.
    """

    rater: str
    saved: str
    choices: dict[tuple[str, str], str]


def read_files(paths: Sequence[Path], key: Path | None = None) -> tuple[StudyKey, tuple[AnswerFile, ...]]:
    """Read answers and the key of their study.

    Args:
        paths: files of answers; the key may be among them.
        key: the key; None to take it from among ``paths`` or find ``*.key.json`` beside them or a folder above.

    Raises:
        InvalidInputError: a file is neither, is damaged, belongs to another study or answers what was not asked; or
            there is no key or no answer.
    """
    documents = [(path, _document(path)) for path in paths]
    keys = [(path, each) for path, each in documents if each.get("format") == KEY_FORMAT]
    given = [(path, each) for path, each in documents if each.get("format") != KEY_FORMAT]
    if not given:
        raise InvalidInputError("ANSWERS must be at least one file that a rater saved. Got: none")
    first_path, first = given[0]
    for path, each in given:
        _require(
            each.get("format") == ANSWERS_FORMAT, path, "hold answers that a study's page saved", each.get("format")
        )
        _require(each.get("version") == 1, path, "be of version 1", each.get("version"))
        same = each.get("study") == first.get("study")
        _require(same, path, f"belong to the same study as {first_path.name}", each.get("study"))
    if key is not None:
        keys = [(key, _document(key))]
    elif not keys:
        keys = _keys_beside([path for path, _ in given])
    found = _key_of(keys, first.get("study"), asked=key is not None)
    return found, tuple(_answers(path, each, found) for path, each in given)


def _document(path: Path) -> dict[str, Any]:
    check_regular(path, "ANSWERS")
    try:
        with path.open("rb") as opened:
            content = opened.read(_LARGEST + 1)
        if len(content) > _LARGEST:
            raise InvalidInputError(f"{printable(str(path))} must have at most {_LARGEST // 1_000_000} MB. Got: more")
        document = json.loads(content.decode("utf-8-sig"))
    except FileNotFoundError:
        raise InvalidInputError(f"ANSWERS must be files. Got: {printable(str(path))}, which is not there") from None
    except (OSError, UnicodeDecodeError, ValueError, RecursionError):
        raise InvalidInputError(
            f"{printable(str(path))} must be a file of JSON. Got: one that cannot be read"
        ) from None
    _require(isinstance(document, dict), path, "hold answers that a study's page saved", document)
    return document  # type: ignore[no-any-return]


def _require(holds: bool, path: Path, expected: str, got: object) -> None:
    if not holds:
        raise InvalidInputError(f"{printable(str(path))} must {expected}. Got: {printable(repr(got)[:60])}")


def _keys_beside(paths: Iterable[Path]) -> list[tuple[Path, dict[str, Any]]]:
    folders = {folder for path in paths for folder in (path.resolve().parent, path.resolve().parent.parent)}
    found = [path for folder in sorted(folders | {Path.cwd()}) for path in sorted(folder.glob("*.key.json"))]
    keys = []
    for path in dict.fromkeys(each.resolve() for each in found[:100]):
        try:
            keys.append((path, _document(path)))
        except InvalidInputError:
            continue  # of something else
    return keys


def _key_of(keys: Sequence[tuple[Path, dict[str, Any]]], study: object, *, asked: bool) -> StudyKey:
    for path, each in keys:
        if asked or (each.get("format") == KEY_FORMAT and each.get("study") == study):
            _require(each.get("format") == KEY_FORMAT, path, "be the key that study make wrote", each.get("format"))
            _require(each.get("study") == study, path, f"be the key of study {study}", each.get("study"))
            try:
                questions = {str(q["key"]): str(q["text"]) for q in each["questions"]}
                trials = {str(t["id"]): Trial(**{k: str(v) for k, v in t.items()}) for t in each["trials"]}  # type: ignore[arg-type]
            except (KeyError, TypeError, AttributeError):
                raise InvalidInputError(f"{printable(str(path))} must be a whole key of a study. Got: a part") from None
            return StudyKey(str(study), questions, trials)
    raise InvalidInputError(
        "--key must name the key that study make wrote beside its page."
        f" Got: none for study {printable(str(study)[:60])}"
    )


def _answers(path: Path, document: dict[str, Any], key: StudyKey) -> AnswerFile:
    rater, saved, rows = document.get("rater"), document.get("saved"), document.get("answers")
    named = isinstance(rater, str) and 0 < len(rater) <= _LONGEST and isinstance(saved, str) and len(saved) <= _LONGEST
    _require(named, path, "name its rater and when it was saved", (rater, saved))
    _require(isinstance(rows, list), path, "hold a list of answers", rows)
    assert isinstance(rows, list)
    _require(len(rows) <= _MOST_ANSWERS, path, f"hold at most {_MOST_ANSWERS} answers", len(rows))
    choices: dict[tuple[str, str], str] = {}
    for row in rows:
        _require(isinstance(row, dict), path, "hold answers with trial, question and choice", row)
        trial, question, choice = (row.get(name) for name in ("trial", "question", "choice"))
        _require(isinstance(trial, str) and trial in key.trials, path, "answer trials of its study", trial)
        _require(
            isinstance(question, str) and question in key.questions, path, "answer questions of its study", question
        )
        _require(choice in ("left", "right"), path, "choose left or right", choice)
        _require((trial, question) not in choices, path, "answer each question of a trial once", (trial, question))
        choices[trial, question] = str(choice)
    return AnswerFile(str(rater), str(saved), choices)
