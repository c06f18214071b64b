"""Edges strung together to few long lines, so that files hold most vertices once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["trails"]


def trails(edges: NDArray[np.integer]) -> list[NDArray[np.int64]]:
    """Lines that together run along each edge exactly once.

    Lines begin at vertices with an odd number of edges as long as there are any, so a set of closed outlines gives
    closed lines.

    Args:
        edges: pairs of vertex numbers, shape [e, 2].

    Returns:
        Vertex numbers along each line.
    """
    incident: dict[int, list[int]] = {}
    for number, (a, b) in enumerate(edges.tolist()):
        incident.setdefault(a, []).append(number)
        incident.setdefault(b, []).append(number)
    ends = edges.tolist()
    used = [False] * len(ends)

    def run(vertex: int) -> list[int]:
        line = [vertex]
        while True:
            waiting = incident[line[-1]]
            while waiting and used[waiting[-1]]:
                waiting.pop()
            if not waiting:
                return line
            number = waiting.pop()
            used[number] = True
            a, b = ends[number]
            line.append(b if a == line[-1] else a)

    odd = [vertex for vertex, numbers in incident.items() if len(numbers) % 2]
    found = [run(vertex) for vertex in [*odd, *incident]]
    return [np.array(line, dtype=np.int64) for line in found if len(line) > 1]
