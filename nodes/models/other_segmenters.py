"""What else in the host cuts parts out, for a sentence where clicks and colours alone do not."""

from __future__ import annotations

import re
import sys

__all__ = ["segmenter_advice"]

# SAM3_Detect, Sam2Segmentation, "SAM Predictor", "Segment Anything", but not Sampler or Sample.
_NAME = re.compile(r"(?<![A-Za-z])(SAM|Sam|sam)(?![a-z])|[Ss]egment[ _-]?[Aa]nything")
_CUTS = re.compile(r"detect|segment|predict", re.IGNORECASE)
_MOST = 3


def segmenter_advice() -> str:
    """One sentence that names Segment Anything here, and nodes of the host and of other packs that cut with it."""
    from .sam_files import has_sam_model

    own = "choose segment anything as backend"
    if not has_sam_model():
        own += " (a model belongs into models/sams, see this node's help)"
    others = _names_of_others()
    more = f", or connect the mask of {' or '.join(others)}" if others else ""
    return f"Where points and colours are not enough, {own}{more}."


def _names_of_others() -> list[str]:
    """Names that the host shows for nodes of others that cut with Segment Anything."""
    nodes = sys.modules.get("nodes")  # the host's; importing it would start the host's machinery where none runs
    known = getattr(nodes, "NODE_CLASS_MAPPINGS", {})
    shown = getattr(nodes, "NODE_DISPLAY_NAME_MAPPINGS", {})
    found = [
        name for name in known if _NAME.search(name) and _CUTS.search(name) and not name.startswith("PhysAnimator")
    ]
    return [shown.get(name) or name for name in sorted(found)[:_MOST]]
