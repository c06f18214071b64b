"""What a layer is by its name: the tags of See-through, and what artists write in English, Japanese and Chinese."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Sequence
from dataclasses import dataclass

from ...physics.errors import InvalidInputError
from .artwork import Artwork
from .name_table import ALTERNATES, CLOSED, MOVING, OPEN, ORNAMENTS, PARTS_OF_STATES, PLACES, STILL, Held

__all__ = ["LayerPlan", "Rule", "moving_layers", "rule_of"]


@dataclass(frozen=True)
class Rule:
    """What a name says.

    Attributes:
        moves: whether the layer moves.
        preset: of its material, a name of ``PRESETS``; None where it stands still.
        held: a hint where it is held; None where it stands still.
        alternate: whether it is another state of a part, such as a closed eye, that is not drawn beside the usual one.
        kind: what the name says, in a word; None where it says nothing.
    """

    moves: bool
    preset: str | None = None
    held: Held | None = None
    alternate: bool = False
    kind: str | None = None


_SIDES = re.compile(r"(?:[\s_.\-]+(?:l|r|left|right|\d+)|[\s_.\-]*[\(\[]\s*\d+\s*[\)\]]|[\s_.\-]*(?:左|右|\d+))+$")


@dataclass(frozen=True)
class LayerPlan:
    """What becomes of one layer.

    Attributes:
        index: of the layer, from the back.
        name: its own one, as ``Artwork.names`` has it.
        moves: whether it moves.
        preset: of its material; None where it stands still.
        held: a hint where it is held; None where it stands still or nothing is known.
        shown: whether it is drawn: neither hidden nor an alternate.
        why: the reason, to be read by a person.
        asked: whether the user named it.
    """

    index: int
    name: str
    moves: bool
    preset: str | None
    held: Held | None
    shown: bool
    why: str
    asked: bool = False


def rule_of(name: str) -> Rule:
    """What a layer is by its name.

    Sides and numbers at the end, such as ``-l``, ``_1`` or ``右``, do not count, nor do case and full-width letters.

    Args:
        name: of the layer.

    Examples:
        >>> from physanimator.rendering.artwork import rule_of
        >>> rule_of("front hair").held, rule_of("リボン_2").preset, rule_of("face").moves
        ('top', 'ribbon', False)
        >>> rule_of("eye_close-l").alternate
        True
    """
    plain = _plain(name)
    if _is_alternate(plain):
        return Rule(moves=False, alternate=True, kind="mouth" if _holds(plain, OPEN["mouth"]) else "eye")
    if _holds(plain, ORNAMENTS):
        return Rule(moves=False, kind="ornament")
    for kind, preset, held, words in MOVING:
        if _holds(plain, words):
            kind, held = _placed(plain, kind, held) if kind == "hair" else (kind, held)
            return Rule(moves=True, preset=preset, held=held, kind=kind)
    return Rule(moves=False, kind=_kind_among(plain, STILL))


def moving_layers(artwork: Artwork, move: Sequence[str] = (), still: Sequence[str] = ()) -> tuple[LayerPlan, ...]:
    """Which layers move, with which preset, and why: by the user's word, otherwise by the table of names.

    Args:
        artwork: the artwork.
        move: names of layers that are to move, whatever the table says; ``NAME=PRESET`` also says how.
        still: names of layers that are to stand still.

    Returns:
        A plan for each layer, in the artwork's order.

    Raises:
        InvalidInputError: there is no layer of that name, or it is to move and to stand still.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.artwork import ArtLayer, Artwork, moving_layers
        >>> pixels = np.full((4, 4, 4), 255, np.uint8)
        >>> art = Artwork(4, 4, (ArtLayer("face", pixels), ArtLayer("前髪", pixels)))
        >>> [(plan.name, plan.moves, plan.preset) for plan in moving_layers(art)]
        [('face', False, None), ('前髪', True, 'hair')]
    """
    wanted = {index: preset for entry in move for index, preset in _asked(artwork, entry)}
    held_still = {index for name in still for index in _found(artwork, name)}
    both = sorted(wanted.keys() & held_still)
    if both:
        raise InvalidInputError(f"layer {artwork.names[both[0]]} must either move or stand still. Got: both")
    rules = [rule_of(layer.name) for layer in artwork.layers]
    return tuple(
        _plan(artwork, index, rules, wanted=wanted, held_still=held_still) for index in range(len(artwork.layers))
    )


def _plan(
    artwork: Artwork, index: int, rules: Sequence[Rule], *, wanted: dict[int, str | None], held_still: set[int]
) -> LayerPlan:
    layer, rule, name = artwork.layers[index], rules[index], artwork.names[index]

    def plan(moves: bool, why: str, *, shown: bool = True, preset: str | None = None) -> LayerPlan:
        held = rule.held if moves else None
        asked = index in wanted or index in held_still
        suits = (preset or rule.preset or "hair") if moves else None
        return LayerPlan(index, name, moves, suits, held, shown, why, asked)

    if not layer.pixels.size or not layer.pixels[..., 3].any():
        return plan(False, "nothing is drawn on it", shown=False)
    if index in wanted:
        return plan(True, "asked for", preset=wanted[index])
    if not layer.visible:
        return plan(False, "hidden", shown=False)
    if index in held_still:
        return plan(False, "asked for")
    if rule.alternate and _open_form(artwork, rules, index):
        return plan(False, f"left out: another state of the {rule.kind}, whose open form is drawn", shown=False)
    if rule.moves:
        if layer.blend != "normal":
            return plan(False, f"the name says {rule.kind}, but it is laid over as {layer.blend}: light or shade")
        return plan(True, f"the name says {rule.kind}")
    return plan(False, f"the name says {rule.kind}" if rule.kind else "the name says nothing that moves")


def _placed(name: str, kind: str, held: Held) -> tuple[str, Held]:
    """Hair with a word of its place elsewhere in the name, such as ``hair 02 back``."""
    for words, hair, where in PLACES:
        if _holds(name, words):
            return hair, where
    return kind, held


def _open_form(artwork: Artwork, rules: Sequence[Rule], index: int) -> bool:
    """Whether the usual state of an alternate is drawn as well."""
    words = OPEN[rules[index].kind or "eye"]
    return any(
        number != index
        and layer.visible
        and layer.pixels.size > 0
        and not rule.alternate
        and _holds(_plain(layer.name), words)
        for number, (layer, rule) in enumerate(zip(artwork.layers, rules, strict=True))
    )


def _asked(artwork: Artwork, entry: str) -> list[tuple[int, str | None]]:
    """The layers of ``NAME`` or ``NAME=PRESET``."""
    from ...physics.material import PRESETS

    name, separator, preset = entry.rpartition("=")
    if not separator or entry in artwork.names:
        return [(index, None) for index in _found(artwork, entry)]
    if preset not in PRESETS:
        raise InvalidInputError(f"the preset of layer {name} must be one of {', '.join(PRESETS)}. Got: {preset}")
    return [(index, preset) for index in _found(artwork, name)]


def _found(artwork: Artwork, name: str) -> list[int]:
    """The layers of a name: the one that has it for itself, or all that the artist called so."""
    exact = [index for index, own in enumerate(artwork.names) if own == name]
    alike = [index for index, layer in enumerate(artwork.layers) if _folded(layer.name) == _folded(name)]
    found = alike if len(alike) > 1 or not exact else exact
    if not found:
        known = ", ".join(artwork.names[:20])
        raise InvalidInputError(f"there must be a layer {name}; there are {known or 'none'}. Got: no such layer")
    return found


def _plain(name: str) -> str:
    """A name in small letters, words apart, without sides and numbers at its end."""
    spread = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", unicodedata.normalize("NFKC", name))
    folded = re.sub(r"[\s_\-./]+", " ", _SIDES.sub("", spread.casefold().strip())).strip()
    return folded or spread.casefold().strip()


def _folded(name: str) -> str:
    return unicodedata.normalize("NFKC", name).casefold().strip()


def _kind_among(name: str, table: Sequence[tuple[str, str]]) -> str | None:
    return next((kind for kind, words in table if _holds(name, words)), None)


def _is_alternate(name: str) -> bool:
    return _holds(name, ALTERNATES) or (_holds(name, CLOSED) and _holds(name, PARTS_OF_STATES))


def _holds(name: str, words: str) -> bool:
    """Whether a name holds one of the words: Latin ones as whole words, others anywhere."""
    spaced = re.sub(r"[\d ]+", " ", name)
    for word in words.split(", "):
        if word.isascii():
            if re.search(rf"(?<![a-z]){re.escape(word)}(?![a-z])", spaced):
                return True
        elif word in name:
            return True
    return False
