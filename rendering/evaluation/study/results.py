"""What raters prefer: shares with intervals, by question and pair of methods, without careless raters."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ....physics.errors import InvalidInputError
from .agreement import krippendorff_alpha
from .answers import AnswerFile, StudyKey
from .clip_folders import ALL, BROKEN

__all__ = ["Preference", "RaterCheck", "StudyResults", "results_of"]


@dataclass(frozen=True)
class Preference:
    """How often one method was preferred to another.

    Attributes:
        question: key of the question.
        method: the one.
        other: the other, or ``ALL``.
        preferred: answers for the one.
        answers: all answers.
        share: of answers for the one, 0..1.
        low: of the 95 % interval by Clopper and Pearson, 0..1.
        high: of the same.
        p_value: of as far a share from one half by chance, two-sided binomial test.
    """

    question: str
    method: str
    other: str
    preferred: int
    answers: int
    share: float
    low: float
    high: float
    p_value: float


@dataclass(frozen=True)
class RaterCheck:
    """One rater.

    Attributes:
        rater: the opaque name.
        files: files that were given of them.
        answers: that count, catch trials not among them.
        caught: right answers to catch trials.
        catch_answers: all answers to catch trials.
        dropped: whether the answers are left out.
    """

    rater: str
    files: int
    answers: int
    caught: int
    catch_answers: int
    dropped: bool


@dataclass(frozen=True)
class StudyResults:
    """All that a study says.

    Attributes:
        study: its id.
        questions: texts by keys.
        preferences: by question and pair of methods.
        agreement: Krippendorff's alpha by question; None where it has none.
        raters: each with the outcome of the catch trials.
    """

    study: str
    questions: dict[str, str]
    preferences: tuple[Preference, ...]
    agreement: dict[str, float | None]
    raters: tuple[RaterCheck, ...]


def results_of(
    key: StudyKey, files: Sequence[AnswerFile], *, against: str | None = None, least_caught: float = 0.8
) -> StudyResults:
    """Count the answers.

    Several files of one rater become one: of each question the answer in the file that was saved last counts.

    Args:
        key: of the study.
        files: what raters saved.
        against: the method that stands first in each pair; None for the one that all pairs share, or else the names'
            order.
        least_caught: share of right answers to catch trials below which a rater is dropped; one who answered none is
            kept where the study has none, and dropped otherwise. 0 keeps all.

    Raises:
        InvalidInputError: there is no such method, or the share is out of range.
    """
    if not 0 <= least_caught <= 1:
        raise InvalidInputError(f"least-caught must be 0 to 1. Got: {least_caught}")
    methods = sorted({m for t in key.trials.values() if t.kind == "pair" for m in (t.left, t.right)})
    if against is not None and against not in methods:
        raise InvalidInputError(f"against must be one of {', '.join(methods)}. Got: {against}")
    first = against if against is not None else _shared(key)
    merged = _merged(files)
    raters = tuple(_checked(key, rater, count, choices, least_caught) for rater, (count, choices) in merged.items())
    kept = [merged[each.rater][1] for each in raters if not each.dropped]
    votes = _votes(key, kept, first)
    return StudyResults(
        key.study,
        key.questions,
        tuple(_preferences(key, votes)),
        {question: _agreement(key, kept, question) for question in key.questions},
        raters,
    )


def _shared(key: StudyKey) -> str | None:
    pairs = [{t.left, t.right} for t in key.trials.values() if t.kind == "pair"]
    common = set.intersection(*pairs) if pairs else set()
    return min(common) if len(common) == 1 else None


def _merged(files: Iterable[AnswerFile]) -> dict[str, tuple[int, dict[tuple[str, str], str]]]:
    found: dict[str, tuple[int, dict[tuple[str, str], str]]] = {}
    for each in sorted(files, key=lambda file: (file.rater, file.saved)):
        count, choices = found.get(each.rater, (0, {}))
        found[each.rater] = (count + 1, choices | each.choices)
    return found


def _checked(key: StudyKey, rater: str, files: int, choices: dict[tuple[str, str], str], least: float) -> RaterCheck:
    kinds = {t.id: t.kind for t in key.trials.values()}
    catches = [(key.trials[trial], side) for (trial, _), side in choices.items() if kinds[trial] == "catch"]
    caught = sum((trial.left if side == "left" else trial.right) != BROKEN for trial, side in catches)
    counted = sum(kinds[trial] == "pair" for trial, _ in choices)
    share = caught / len(catches) if catches else float("catch" not in kinds.values())
    return RaterCheck(rater, files, counted, caught, len(catches), share < least)


def _votes(
    key: StudyKey, raters: Iterable[dict[tuple[str, str], str]], first: str | None
) -> dict[tuple[str, str, str], list[bool]]:
    """Whether the first method of a pair was preferred, by question and pair."""
    votes: dict[tuple[str, str, str], list[bool]] = defaultdict(list)
    for choices in raters:
        for (trial_id, question), side in choices.items():
            trial = key.trials[trial_id]
            if trial.kind != "pair":
                continue
            a, b = sorted((trial.left, trial.right), key=lambda name: (name != first, name))
            votes[question, a, b].append((trial.left if side == "left" else trial.right) == a)
    return votes


def _preferences(key: StudyKey, votes: dict[tuple[str, str, str], list[bool]]) -> Iterable[Preference]:
    pairs = sorted({(a, b) for _, a, b in votes})
    for question in key.questions:
        for a, b in pairs:
            if votes.get((question, a, b)):
                yield _preference(question, a, b, votes[question, a, b])
        firsts = {a for a, _ in pairs}
        if len(firsts) == 1 and len(pairs) > 1:
            together = [vote for a, b in pairs for vote in votes.get((question, a, b), [])]
            if together:
                yield _preference(question, firsts.pop(), ALL, together)


def _preference(question: str, method: str, other: str, votes: Sequence[bool]) -> Preference:
    from scipy.stats import binomtest

    test = binomtest(sum(votes), len(votes))
    interval = test.proportion_ci(confidence_level=0.95, method="exact")
    share = sum(votes) / len(votes)
    return Preference(
        question,
        method,
        other,
        sum(votes),
        len(votes),
        share,
        float(interval.low),
        float(interval.high),
        float(test.pvalue),
    )


def _agreement(key: StudyKey, raters: Sequence[dict[tuple[str, str], str]], question: str) -> float | None:
    """Of raters who saw the same pairs; what was preferred is the side, which chance gave to the methods."""
    pairs = [t.id for t in key.trials.values() if t.kind == "pair"]
    return krippendorff_alpha([[c[trial, question] for c in raters if (trial, question) in c] for trial in pairs])
