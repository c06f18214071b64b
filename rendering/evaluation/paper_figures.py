"""The paper's own numbers, for reference: they are of its own pictures, so they do not compare with those of others."""

from __future__ import annotations

from dataclasses import dataclass, field

__all__ = ["NOTE", "PAPER_TABLES", "PaperTable"]

NOTE = (
    "The paper's own numbers are of its 20 anime illustrations with 10 samples each, which are not published: they are"
    " another set of pictures, and do not compare directly with the rows above."
)

_COLUMNS = ("fid", "vsvq", "vstc", "vsdd", "vsfc")


@dataclass(frozen=True)
class PaperTable:
    """A table of the paper.

    Attributes:
        title: what it is.
        rows: values by method and column.
    """

    title: str
    rows: dict[str, dict[str, float]] = field(default_factory=dict)


def _rows(**rows: tuple[float, ...]) -> dict[str, dict[str, float]]:
    return {
        name.replace("__", " ").replace("_", "-"): dict(zip(_COLUMNS[-len(values) :], values, strict=True))
        for name, values in rows.items()
    }


PAPER_TABLES = (
    PaperTable(
        "PhysAnimator (CVPR 2025), quantitative comparison",
        _rows(
            Cinemo=(49.5, 2.85, 2.80, 2.42, 2.58),
            DragAnything=(148.9, 2.77, 2.45, 2.97, 2.52),
            DynamiCrafter=(94.9, 2.78, 2.68, 2.53, 2.51),
            Motion_I2V=(121.8, 2.70, 2.50, 2.66, 2.39),
            PhysAnimator=(90.4, 2.89, 2.86, 2.48, 2.64),
        ),
    ),
    PaperTable(
        "PhysAnimator (CVPR 2025), ablation of dynamics enhancement",
        _rows(
            Ours__without__DE=(2.94, 2.90, 2.48, 2.68),
            Ours__with__DE=(2.89, 2.86, 2.48, 2.64),
        ),
    ),
)
"""Tables "Quantitative Comparisons" and "Ablation of Dynamics Enhancement" of the paper."""
