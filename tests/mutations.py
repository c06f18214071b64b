"""Scene documents and preview requests as nobody means them: good ones, changed at random places, always the same."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Callable
from typing import Any

import numpy as np
from physanimator.physics.material import preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body

__all__ = ["KEY", "mutated_document", "mutated_request", "patches"]

KEY = "0123456789abcdef" * 4
_SIDE = 64
_RUNS = [1000, 40, 24, 40, 24, 40, 24, 40, 24, 40, _SIDE * _SIDE - 1296]
_MASK = {"type": "mask", "width": _SIDE, "height": _SIDE, "runs": _RUNS}
_POLYGON = {"type": "polygon", "points": [[10, 10], [90, 12], [80, 90], [12, 80]]}
_MESH = {"vertices": [[20, 20], [60, 20], [60, 60], [20, 60], [40, 75]], "triangles": [[0, 1, 2], [0, 2, 3], [3, 2, 4]]}

_SCENE: dict[str, Any] = {
    "version": 2,
    "width": 100,
    "height": 80,
    "frame_rate": 24,
    "loop": 1.0,
    "gravity": [0, 0.5],
    "sag": False,
    "wind": {"strength": 1, "angle": 20, "gust": 0.5, "gust_period": 2, "turbulence": 0.4, "turbulence_size": 60},
    "bodies": [
        {"name": "hair", "layer": 1, "material": {"preset": "hair", "name": "hair", "damping": 2}},
        {"name": "leaf", "material": {"youngs_modulus": 300, "density": 1.5, "poisson_ratio": 0.3}},
    ],
    "strokes": [
        {"kind": "wind", "path": [[0, 30], [50, 35], [100, 50]], "radius": 60, "speed": 200, "strength": 4},
        {"kind": "repel", "path": [[50, 40]], "radius": 30, "speed": 0, "start": 0.1, "end": 0.6, "repeat": 0.8},
        {"path": [[0, 0], [90, 70]], "strength_keys": [[0, 1], [1, 0.2]], "speed_keys": [[0, 1], [0.5, 2]]},
    ],
    "rig_points": [
        {"position": [20, 30], "region": {"type": "circle", "radius": 15}, "falloff": 12},
        {"position": [60, 40], "region": _POLYGON, "motion": {"type": "wave", "amplitude": 8, "direction": [1, 0.2]}},
        {"position": [50, 50], "region": _MASK, "motion": {"type": "swing", "amplitude": 12}, "body": 0, "falloff": 9},
        {
            "position": [40, 40],
            "motion": {
                "type": "combined",
                "motions": [
                    {"type": "path", "times": [0, 0.4, 0.9], "points": [[40, 40], [60, 30], [40, 40]]},
                    {"type": "squash", "times": [0, 0.5, 1], "factors": [1, 1.3, 1]},
                    {"type": "pulse", "stretch": 1.1},
                    {"type": "rotation", "times": [0, 1], "angles": [0, 360]},
                ],
            },
        },
    ],
    "contact": {"friction": 0.3, "thickness": 1.5, "self_contact": True},
    "colliders": [
        {"region": _POLYGON},
        {"region": _MASK},
        {"region": {"type": "polygon", "points": [[0, 70], [100, 70], [50, 300]]}},
    ],
    "paint": [{"region": _MASK, "stiffness": 4, "density": 2}, {"region": _POLYGON, "damping": 3, "body": 0}],
    "query_points": [{"x": 10, "y": 20, "positive": True, "part": 1}],
}

_NUMBERS: list[Any] = [
    0,
    -0.0,
    1,
    -1,
    2,
    3.0,
    0.5,
    100,
    1e3,
    16384.0,
    65536.0,
    65536,
    1e6,
    -1e6,
    1e6 + 1,
    1e12,
    1e-3,
    1e-30,
    1e-150,
    1e-300,
    5e-324,
    1e308,
    -1e308,
    2**31,
    2**53 + 1,
    2**63,
    2**64,
    10**30,
    10**629,
    -(10**629),
    float("nan"),
    float("inf"),
    float("-inf"),
]
_TEXTS = [
    "",
    "a",
    "hair",
    "polygon",
    "mask",
    "circle",
    "12",
    "NaN",
    "x" * 3000,
    "\n",
    "a\nb\x1b[31m",
    "\ud800",
    "é" * 200,
    "1" * 629,
    "../../etc",
]
_KEYS = [
    "width",
    "height",
    "runs",
    "points",
    "region",
    "motion",
    "type",
    "radius",
    "path",
    "body",
    "preset",
    "name",
    "density",
    "youngs_modulus",
    "sway_frequency",
    "poisson_ratio",
    "stretch_limit",
    "stiffness_scale",
    "density_scale",
    "damping_scale",
    "wind_response",
    "root_stiffness",
    "layer",
    "mesh",
    "vertices",
    "triangles",
    "interval",
    "speed",
    "end",
    "repeat",
    "falloff",
    "friction",
    "x\ny",
    "",
    "__proto__",
    "k" * 5000,
    "7" * 629,
    "\u202e",
    "times",
    "easing",
    "keep_area",
    "phase",
    "period",
    "loop",
    "sag",
    "seed",
    "mu",
    "lambda",
    "time_step",
    "strokes_as",
]

_FAR = {"type": "polygon", "points": [[0, 0], [1e6, 1], [1e6, 60]]}


def mutated_document(seed: int) -> str:
    """The text of a scene document."""
    chance = random.Random(seed)
    document = _base(chance)
    for _ in range(chance.choice((1, 1, 2, 3, 6))):
        _mutate_somehow(document, chance)
    return _text(document, chance)


def mutated_request(seed: int) -> bytes:
    """The body of a preview request."""
    chance = random.Random(seed)
    document = _base(chance)
    for body in document.get("bodies", []) if isinstance(document.get("bodies"), list) else []:
        body.pop("mesh", None)
    request: dict[str, Any] = {"editor": "one", "key": KEY, "scene": document, "frames": chance.choice((1, 5, 24, 200))}
    for _ in range(chance.choice((1, 1, 2, 3, 6))):
        _mutate_somehow(request if chance.random() < 0.1 else document, chance)
    text = _text(request, chance).encode("utf-8", "surrogatepass")
    if chance.random() < 0.03:
        cut = chance.randrange(len(text))
        text = text[:cut] + bytes([chance.randrange(256)]) + text[cut + chance.randrange(3) :]
    return text


def patches(count: int = 2, cells: int = 6) -> list[Body]:
    """Small square bodies beside each other over a picture of 100 x 80."""
    bodies = []
    for number in range(count):
        x, y = np.meshgrid(np.linspace(20, 45, cells + 1) + 26 * number, np.linspace(20, 60, cells + 1))
        corner = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
        upper = np.column_stack([corner, corner + 1, corner + cells + 1])
        lower = np.column_stack([corner + 1, corner + cells + 2, corner + cells + 1])
        mesh = TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), np.concatenate([upper, lower]), 100, 80)
        bodies.append(Body(mesh, preset("leaf"), name=f"patch {number}"))
    return bodies


def _base(chance: random.Random) -> dict[str, Any]:
    """A good scene, often without some of its features."""
    document = copy.deepcopy(_SCENE)
    for name in (
        "loop",
        "wind",
        "sag",
        "strokes",
        "rig_points",
        "contact",
        "colliders",
        "paint",
        "query_points",
        "bodies",
    ):
        if chance.random() < 0.35:
            document.pop(name, None)
    if chance.random() < 0.3 and "bodies" in document:
        document["bodies"][0]["mesh"] = copy.deepcopy(_MESH)
    return document


def _mutate_somehow(document: Any, chance: random.Random) -> None:
    """Change a random place of a document, more often than not into something of the same kind."""
    if chance.random() < 0.7:
        _vary(document, chance)
    else:
        _mutate(document, chance)


def _vary(document: Any, chance: random.Random) -> None:
    """Change a number, a list or a region into another that may well be allowed."""
    places = _places(document)
    regions = [(holder, key) for holder, key in places if key == "region"]
    if regions and chance.random() < 0.35:
        holder, key = chance.choice(regions)
        holder[key] = chance.choice((_large(chance), copy.deepcopy(_FAR)))
        return
    lists = [(holder, key) for holder, key in places if isinstance(holder[key], list) and holder[key]]
    if lists and chance.random() < 0.3:
        holder, key = chance.choice(lists)
        entries = holder[key]
        holder[key] = chance.choice(
            (entries * chance.choice((2, 9, 40)), entries[::-1], entries[: len(entries) // 2 + 1])
        )
        return
    numbers = [(h, k) for h, k in places if type(h[k]) in (int, float) and abs(h[k]) < 1e300 and k != "version"]
    if numbers:
        holder, key = chance.choice(numbers)
        value = holder[key]
        steps = (1e-9, 1e-3, 0.1, 0.5, 2, 10, 1e3, 1e5)
        others = (0, 1, 0.001, 0.01, 0.4999999, 1000, 1e6, 1e-300, 1e-30)
        holder[key] = chance.choice((value * chance.choice(steps), chance.choice(others), float(value), -value))


def _mutate(document: Any, chance: random.Random) -> None:
    """Change a random place of a document."""
    places = _places(document)
    if not places:
        return
    holder, key = chance.choice(places)
    value = holder[key]
    ways: list[Callable[[], Any]] = [
        lambda: chance.choice(_NUMBERS),
        lambda: chance.choice(_NUMBERS),
        lambda: chance.choice(_TEXTS),
        lambda: chance.choice([None, True, False, [], {}, [[]], [None], {"type": "mask"}, [0] * 7]),
        lambda: copy.deepcopy(chance.choice(places)[0]),
        lambda: [value] * chance.choice((2, 50, 3000) if isinstance(value, int | float | str) else (2, 9)),
        lambda: _nested(value, chance.choice((2, 20, 100))),
        lambda: copy.deepcopy(_FAR),
        lambda: _large(chance),
        lambda: [chance.choice(_NUMBERS) for _ in range(chance.randrange(5))],
    ]
    if isinstance(value, int | float) and not isinstance(value, bool):
        ways += [
            lambda: str(value),
            lambda: value if abs(value) > 1e290 else value * 10.0 ** chance.randrange(-12, 12),
            lambda: -value,
        ] * 2
    if isinstance(value, list):
        ways += [lambda: value * 40, lambda: value[:-1], lambda: [*value, *value[:1]], lambda: value[::-1]]
    if isinstance(holder, dict) and chance.random() < 0.25:
        renamed = chance.choice([*_KEYS, str(key).upper(), str(key) + "\n", str(key)[:-1]])
        holder[renamed] = holder.pop(key) if chance.random() < 0.6 else copy.deepcopy(value)
        return
    holder[key] = chance.choice(ways)()


def _nested(value: Any, depth: int) -> Any:
    for _ in range(depth):
        value = [value]
    return value


def _large(chance: random.Random) -> Any:
    """A region that is as large, or as ragged, as it may be."""
    side = chance.choice((4000, 5700, 16384, 60000))
    whole = chance.choice((int, float))
    count = chance.choice((400, 3000, 9000))
    wave = [[100 * k / count, chance.choice((0, 80))] for k in range(count)]
    stripes = [side * 3] * (side // 3)
    return chance.choice(
        [
            {"type": "mask", "width": whole(side), "height": whole(side), "runs": [side * side]},
            {"type": "mask", "width": whole(side), "height": whole(side), "runs": [0, side * side]},
            {
                "type": "mask",
                "width": whole(side),
                "height": whole(side),
                "runs": [*stripes, side * side - sum(stripes)],
            },
            {"type": "mask", "width": 600, "height": 600, "runs": [1] * 360_000},
            {"type": "mask", "width": 65536, "height": 500, "runs": [65536] * 500},
            {"type": "polygon", "points": wave},
            {"type": "polygon", "points": [[-1e6, 0], [1e6, 1], [1e6, 1e6], [-1e6, 1e6]]},
        ]
    )


def _places(document: Any) -> list[tuple[Any, Any]]:
    """Every key and every entry that stands anywhere in a document; few of long lists."""
    found: list[tuple[Any, Any]] = []
    pending = [document]
    while pending and len(found) < 5000:
        holder = pending.pop()
        keys = list(holder) if isinstance(holder, dict) else list(range(min(len(holder), 8)))
        found += [(holder, key) for key in keys]
        pending += [holder[key] for key in keys if isinstance(holder[key], dict | list)]
    return found


def _text(document: Any, chance: random.Random) -> str:
    text = json.dumps(document)
    if chance.random() < 0.04:  # a key that stands twice
        keys = [at for at in range(len(text)) if text.startswith('": ', at)]
        if keys:
            at = chance.choice(keys)
            start = text.rfind('"', 0, at)
            text = text[:start] + text[start : at + 3] + "0, " + text[start:]
    return text
