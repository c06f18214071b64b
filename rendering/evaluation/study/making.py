"""A study as files: the page for raters, and the key that says which clip is of which method."""

from __future__ import annotations

import base64
import hashlib
import json
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from ....physics.errors import InvalidInputError, printable, require
from ....physics.interruption import checkpoint
from ....physics.progress import Progress
from ...files import (
    RecordedFiles,
    check_file_place,
    check_recorded_folder,
    check_text_output,
    write_recorded_folder,
    write_text,
)
from ...pictures import read_clip
from .clip_folders import BROKEN, MethodClips
from .page_text import page_text
from .questions import Question
from .trials import Trial
from .videos import frame_rate_of, write_video
from .words import LANGUAGES, WORDS

__all__ = ["KEY_FORMAT", "StudyOptions", "key_place", "make_study"]

KEY_FORMAT = "physanimator study key"


@dataclass(frozen=True)
class StudyOptions:
    """How a study is written.

    Attributes:
        questions: about each pair.
        language: of the page, one of ``LANGUAGES``.
        title: above the page; that of the language when empty.
        rate: frames a second of clips that do not say, such as folders of pictures.
        longest: side that larger clips are brought to [px].
        limit: of the page with its clips [MB].
        beside: whether clips lie in a folder beside the page instead of in it.
    """

    questions: tuple[Question, ...]
    language: str = "en"
    title: str = ""
    rate: float = 24.0
    longest: int = 720
    limit: float = 100.0
    beside: bool = False

    def __post_init__(self) -> None:
        require("language", self.language, self.language in LANGUAGES, f"one of {', '.join(LANGUAGES)}")
        require("fps", self.rate, 1 <= self.rate <= 240, "1 to 240")
        require("width", self.longest, 64 <= self.longest <= 4096, "64 to 4096 px")
        require("limit", self.limit, 0.1 <= self.limit <= 2000, "0.1 to 2000 MB")


def key_place(page: Path) -> Path:
    """Where the key of a page lies."""
    return page.with_name(f"{page.stem}.key.json")


def _folder(page: Path) -> Path:
    return page.with_name(f"{page.stem}_clips")


def check_study(page: Path, options: StudyOptions, methods: Sequence[MethodClips], trials: Sequence[Trial]) -> None:
    """Refuse what :func:`make_study` could not do, before it encodes anything.

    Raises:
        InvalidInputError: nothing can be written there, the key of another study is there, or a clip has no frame that
            can be read.
    """
    check_text_output(page, ".html")
    check_file_place(key_place(page))
    _check_key(page, _key(None, trials, options))
    if options.beside:
        check_recorded_folder(f"{_folder(page)}/", _CLIPS)
    named = {each.method: each.clips for each in methods}
    for picture, method in sorted({(t.picture, m) for t in trials for m in (t.left, t.right) if m != BROKEN}):
        next(iter(read_clip(named[method][picture])))


def make_study(
    page: Path,
    methods: Sequence[MethodClips],
    trials: Sequence[Trial],
    options: StudyOptions,
    *,
    progress: Progress | None = None,
) -> str:
    """Write the page and its key; the study's id is returned.

    The page says nothing about methods and pictures: clips are numbered in the order in which they are seen.

    Args:
        page: file to write, ``.html``; the key comes beside it as ``NAME.key.json``.
        methods: with their clips.
        trials: what is shown.
        options: how.
        progress: called with the clips that are encoded and their number.

    Raises:
        InvalidInputError: see :func:`check_study`; or the page becomes larger than its limit.
    """
    check_study(page, options, methods, trials)
    named = {each.method: each.clips for each in methods}
    with tempfile.TemporaryDirectory() as folder:
        numbers, files = _encoded(trials, named, options, Path(folder), progress)
        study = _identity(trials, options, files)
        key = _key(study, trials, options)
        _check_key(page, key)
        sources = [
            f"{_folder(page).name}/{path.name}" if options.beside else base64.b64encode(path.read_bytes()).decode()
            for path in files
        ]
        document = _document(study, trials, numbers, options, sources)
        with _key_written(key_place(page), key):
            if options.beside:
                write_recorded_folder(f"{_folder(page)}/", _CLIPS, lambda place: _copied(files, place))
            write_text(page, page_text(document, options.language, options.title or WORDS[options.language]["title"]))
    return study


@contextmanager
def _key_written(place: Path, key: dict[str, Any]) -> Iterator[None]:
    """The key, written before its page; a new one goes again where the page cannot be written."""
    is_new = not place.exists()
    write_text(place, json.dumps(key, indent=1, ensure_ascii=False) + "\n")
    try:
        yield
    except BaseException:
        if is_new:
            place.unlink(missing_ok=True)
        raise


def _check_key(page: Path, key: dict[str, Any]) -> None:
    """Refuse to replace the key of another study: without it, answers to that one would say nothing."""
    place = key_place(page)
    try:
        there = json.loads(place.read_text(encoding="utf-8"))
    except FileNotFoundError:
        return
    except (OSError, ValueError, RecursionError):
        there = None
    known = isinstance(there, dict) and there.get("format") == KEY_FORMAT
    if not known or there != {**key, "study": key["study"] or there.get("study")}:
        raise InvalidInputError(
            f"{place.name} must be no other study's key: answers to that one need it; choose another name or delete it."
            f" Got: {'the key of study ' + printable(str(there.get('study'))[:60]) if known else 'something else'}"
        )


def _present(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.glob("clip_*.mp4"))


_CLIPS = RecordedFiles("study_clips", ".physanimator_study.json", "no clips but those of an earlier page", _present)


def _copied(files: Sequence[Path], place: Path) -> list[str]:
    for path in files:
        shutil.copyfile(path, place / path.name)
    return [path.name for path in files]


def _encoded(
    trials: Sequence[Trial], named: dict[str, dict[str, Path]], options: StudyOptions, folder: Path,
    progress: Progress | None,
) -> tuple[dict[tuple[str, str], int], list[Path]]:  # fmt: skip
    """Numbers of the clips by picture and method, and their files."""
    needed: dict[tuple[str, str], tuple[Path, int | None]] = {}
    for k, trial in enumerate(trials):
        for method in (trial.left, trial.right):
            true = trial.left if trial.right == BROKEN else trial.right
            source = named[true if method == BROKEN else method][trial.picture]
            key = (trial.picture, f"{BROKEN} {true}" if method == BROKEN else method)
            needed.setdefault(key, (source, k if method == BROKEN else None))
    files, total = [], 0
    for number, (source, seed) in enumerate(needed.values()):
        checkpoint()
        path = folder / f"clip_{number:04}.mp4"
        write_video(source, path, rate=frame_rate_of(source, options.rate), longest=options.longest, broken_by=seed)
        total += path.stat().st_size * (1 if options.beside else 4) // (1 if options.beside else 3)
        if not options.beside and total > options.limit * 1e6:
            raise InvalidInputError(
                f"the page must have at most {options.limit:g} MB with its clips; fewer pairs, smaller clips or clips"
                f" beside the page help. Got: more after {number + 1} of {len(needed)} clips"
            )
        files.append(path)
        if progress is not None:
            progress(number + 1, len(needed))
    return {key: number for number, key in enumerate(needed)}, files


def _identity(trials: Sequence[Trial], options: StudyOptions, files: Sequence[Path]) -> str:
    """Of all that raters see, so that answers to another study are told apart."""
    seen = hashlib.sha256(json.dumps([[asdict(t) for t in trials], asdict(options)], sort_keys=True).encode())
    for path in files:
        seen.update(path.read_bytes())
    return seen.hexdigest()[:16]


def _document(
    study: str, trials: Sequence[Trial], numbers: dict[tuple[str, str], int], options: StudyOptions, sources: list[str]
) -> dict[str, Any]:
    """What the page's script reads. Catch trials look as the others do."""

    def number(trial: Trial, method: str) -> int:
        true = trial.left if trial.right == BROKEN else trial.right
        return numbers[trial.picture, f"{BROKEN} {true}" if method == BROKEN else method]

    shown = [{"id": t.id, "left": number(t, t.left), "right": number(t, t.right)} for t in trials]
    practice = next((k for k, t in enumerate(trials) if t.kind == "practice"), None)
    first = shown.pop(practice) if practice is not None else None
    if first is not None and practice is not None:
        first["true"] = "right" if trials[practice].left == BROKEN else "left"
    return {
        "study": study,
        "language": options.language,
        "beside": options.beside,
        "words": WORDS[options.language],
        "questions": [asdict(each) for each in options.questions],
        "practice": first,
        "trials": shown,
        "clips": sources,
    }


def _key(study: str | None, trials: Sequence[Trial], options: StudyOptions) -> dict[str, Any]:
    return {
        "format": KEY_FORMAT,
        "version": 1,
        "study": study,
        "questions": [asdict(each) for each in options.questions],
        "trials": [asdict(each) for each in trials],
    }
