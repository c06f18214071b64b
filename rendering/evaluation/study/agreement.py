"""How far raters agree, beyond chance."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Sequence

__all__ = ["krippendorff_alpha"]


def krippendorff_alpha(units: Iterable[Sequence[Hashable]]) -> float | None:
    """Krippendorff's alpha for nominal values, with any number of raters a unit.

    1: all agree; 0: as by chance; below: less than by chance. Units with fewer than two values say nothing.

    Args:
        units: the values that raters gave each thing that was judged.

    Returns:
        None where no unit has two values, or all values are alike, so that chance has no measure.

    Source: K. Krippendorff, Content Analysis (4th edition, 2018), section 12.3.3, "nominal data".

    Examples:
        >>> from physanimator.rendering.evaluation.study.agreement import krippendorff_alpha
        >>> krippendorff_alpha([["a", "a"], ["b", "b"], ["a", "a"]])
        1.0
    """
    totals: Counter[Hashable] = Counter()
    disagreement = 0.0
    for values in units:
        if len(values) < 2:
            continue
        counts = Counter(values)
        totals.update(counts)
        disagreement += sum(n * (len(values) - n) for n in counts.values()) / (len(values) - 1)
    everything = sum(totals.values())
    expected = sum(n * (everything - n) for n in totals.values()) / (everything - 1) if everything > 1 else 0.0
    return 1 - disagreement / expected if expected else None
