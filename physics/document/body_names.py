"""Bodies of a document found by their names among parts that have names, such as the layers of an artwork."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

__all__ = ["arranged_for", "bodies_named", "order_of_layers", "rig_points_kept", "still_layers"]

_OF_BODIES = ("rig_points", "paint")  # lists whose entries may speak of a body by its number


def bodies_named(document: Mapping[str, Any]) -> list[str]:
    """The names of a checked document's bodies, without those that have none."""
    return [entry["name"] for entry in document.get("bodies", []) if entry.get("name")]


def still_layers(document: Mapping[str, Any]) -> list[str]:
    """The names of the layers that a checked document keeps still."""
    return list(document.get("still", []))


def order_of_layers(document: Mapping[str, Any]) -> list[str]:
    """The names of layers that a checked document puts in order, from back to front."""
    return list(document.get("order", []))


def rig_points_kept(document: Mapping[str, Any], names: Sequence[str]) -> list[int]:
    """Which rig points of a checked document are left where its bodies are these parts, by their numbers.

    The others speak of bodies that no part is: see :func:`arranged_for`.
    """
    points = document.get("rig_points", [])
    numbered = {**document, "rig_points": [{**point, "number": index} for index, point in enumerate(points)]}
    return [point["number"] for point in arranged_for(numbered, names)[0]["rig_points"]]


def arranged_for(document: Mapping[str, Any], names: Sequence[str]) -> tuple[Mapping[str, Any], tuple[str, ...]]:
    """A checked document whose bodies stand in the order of the parts, and the names that no part has.

    A body with a name goes to the part of that name. Bodies without a name, later ones of a name, and all of them where
    parts have none, go in order to the parts that are left. What speaks of a body by number follows it; what speaks of
    a body that no part is, is left out. Parts that the document does not know get an entry without values.

    Args:
        document: as ``check_document`` lets it pass.
        names: of the parts, empty for those that have none.

    Examples:
        >>> from physanimator.physics.document.body_names import arranged_for
        >>> document = {"version": 2, "width": 9, "height": 9, "bodies": [{"name": "hair"}, {"name": "tail"}]}
        >>> arranged_for(document, ["tail", "cape", "hair"])[0]["bodies"]
        [{'name': 'tail'}, {}, {'name': 'hair'}]
        >>> arranged_for(document, ["cape"])[1]
        ('hair', 'tail')
    """
    entries = document.get("bodies", [])
    named = {name: number for number, name in reversed(list(enumerate(names))) if name}
    if not named or not bodies_named(document):
        return document, ()
    places = [named.pop(entry["name"], None) if entry.get("name") else None for entry in entries]
    free = [number for number in range(len(names)) if number not in places]
    unnamed = iter([number for number in free if not names[number]])
    anywhere = iter(free)
    missing = []
    for index, entry in enumerate(entries):
        if places[index] is not None:
            continue
        name = entry.get("name")
        left = anywhere if not name or name in names else unnamed
        places[index] = next((number for number in left if number not in places), None)
        if places[index] is None and name:
            missing.append(name)
    # Numbers beyond the document's own bodies go on with the parts that it does not know.
    places += [number for number in free if number not in places]
    return _rearranged(document, places, len(names)), tuple(dict.fromkeys(missing))


def _rearranged(document: Mapping[str, Any], places: Sequence[int | None], count: int) -> Mapping[str, Any]:
    entries = document.get("bodies", [])
    if list(places) == list(range(count)):
        return document
    bodies: list[dict[str, Any]] = [{} for _ in range(count)]
    left_over = []
    for entry, place in zip(entries, places, strict=False):
        if place is not None:
            # Who covers whom follows from the parts' order, which is another now.
            bodies[place] = {key: value for key, value in entry.items() if key != "layer"}
        elif not entry.get("name"):
            left_over.append(entry)  # one too many, which the check of the scene speaks of
    lists = {name: _following(document[name], places, count) for name in _OF_BODIES if name in document}
    return {**document, "bodies": [*bodies, *left_over], **lists}


def _following(entries: list[dict[str, Any]], places: Sequence[int | None], count: int) -> list[dict[str, Any]]:
    """The entries that still have something to act on, with the new numbers of their bodies."""
    kept = []
    for entry in entries:
        body = entry.get("body")
        if body is None:
            kept.append(entry)
            continue
        number = int(body)
        place = places[number] if number < len(places) else max(number, count)
        if place is not None:
            kept.append({**entry, "body": place})
    return kept
