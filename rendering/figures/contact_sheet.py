"""Contact sheets: pictures in rows and columns with captions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require

__all__ = ["contact_sheet"]

_PAPER = (255, 255, 255)
_INK = (38, 34, 48)
_FAINT = (112, 108, 124)


def contact_sheet(
    rows: Sequence[Sequence[NDArray[np.uint8]]],
    *,
    title: str,
    note: str,
    columns: Sequence[str],
    row_names: Sequence[str],
) -> NDArray[np.uint8]:
    """Pictures in a table.

    Args:
        rows: of pictures of one size, RGB, shape [h, w, 3].
        title: above the table.
        note: one line below the title; may be empty.
        columns: caption above each column.
        row_names: caption to the left of each row; lines are split at line ends.

    Returns:
        The sheet, RGB.

    Raises:
        InvalidInputError: captions and pictures do not match.
    """
    require("columns", len(columns), all(len(row) == len(columns) for row in rows), "one caption a picture in each row")
    require("row_names", len(row_names), len(row_names) == len(rows), f"one for each of {len(rows)} rows")
    from PIL import Image, ImageDraw

    height, width = rows[0][0].shape[:2]
    unit = max(12, round((width + height) / 40))
    gap, margin = round(0.7 * unit), 2 * unit
    scratch = ImageDraw.Draw(Image.new("RGB", (1, 1)))
    side = max((scratch.multiline_textbbox((0, 0), name, font=_font(unit))[2] for name in row_names), default=0)
    left, top = round(margin + side + (unit if side else 0)), margin + round(5.2 * unit)
    size = (
        left + len(columns) * (width + gap) - gap + margin,
        top + round(2 * unit) + len(rows) * (height + gap) - gap + margin,
    )
    sheet = Image.new("RGB", size, _PAPER)
    draw = ImageDraw.Draw(sheet)
    draw.text((margin, margin), title, fill=_INK, font=_font(round(1.7 * unit)))
    draw.text((margin, margin + round(2.6 * unit)), note, fill=_FAINT, font=_font(unit))
    table = top + 2 * unit
    for number, caption in enumerate(columns):
        middle = left + number * (width + gap) + width / 2
        draw.text((middle, table - 0.6 * unit), caption, fill=_INK, font=_font(round(1.15 * unit)), anchor="ms")
    for number, (row, name) in enumerate(zip(rows, row_names, strict=True)):
        y = table + number * (height + gap)
        draw.multiline_text(
            (left - unit, y + height / 2), name, fill=_INK, font=_font(unit), anchor="rm", align="right"
        )
        for column, picture in enumerate(row):
            x = left + column * (width + gap)
            sheet.paste(Image.fromarray(picture), (x, y))
            draw.rectangle((x - 1, y - 1, x + width, y + height), outline=_FAINT)
    return np.asarray(sheet)


def _font(size: int) -> Any:
    from PIL import ImageFont

    return ImageFont.load_default(size=size)
