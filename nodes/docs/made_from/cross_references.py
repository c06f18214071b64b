"""References to classes of ours, wherever they are defined, lead to the room that hands them out."""

from __future__ import annotations

from typing import Any

__all__ = ["resolve_reexported"]

_CLASSES = {"class", "exception"}


def resolve_reexported(app: Any, env: Any, node: Any, contnode: Any) -> Any:
    """Sphinx's ``missing-reference``: a type hint names the class, or its file; the reference is written for the room.

    A name that no room hands out stays text: it is ours to use inside, and not to be imported.
    """
    target = node.get("reftarget", "")
    if node.get("refdomain") != "py":
        return None
    domain = env.get_domain("py")
    name = target.rsplit(".", 1)[-1]
    found = [
        full for full, told in domain.objects.items() if full.rsplit(".", 1)[-1] == name and told.objtype in _CLASSES
    ]
    if found and (target.startswith("physanimator.") or "." not in target):
        room = min(found, key=lambda full: (full.count("."), full))
        return domain.resolve_xref(env, node["refdoc"], app.builder, "obj", room, node, contnode)
    return contnode if target.startswith("physanimator.") else None
