"""How soon a drawn stroke moves the picture: live previews through the routes' own handlers, on a server of their own.

python tests/benchmarks/preview.py --json

With --browser the same is also measured in the page of the ComfyUI at COMFYUI_PATH, where a pointer draws.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import statistics
import struct
import time
from typing import Any

import numpy as np
import preview_browser
import source_tree  # noqa: F401
from aiohttp import web
from aiohttp.test_utils import TestClient, TestServer
from physanimator.nodes.preview import FRAME, HEADER, PreviewBodies, PreviewStore, split_records
from physanimator.nodes.preview.routes import PreviewRoutes
from physanimator.nodes.preview.session import warm_up
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.scene import Body

WIDTH, HEIGHT, FRAMES = 1280, 720, 73
SPACING = 15.7  # [px]: some 1,000 triangles
CASES: dict[str, dict[str, Any]] = {
    "stroke": {},
    "pin": {"moved": True},
    "gravity": {"gravity": [0, 0.5]},
    "pin_under_gravity": {"moved": True, "gravity": [0, 0.5]},
    "loop": {"loop": 2.0},
}
"""What is edited in each round: a stroke, or with it the pin, after which the bodies are prepared anew."""


def document(number: int, *, moved: bool = False, **changes: Any) -> dict[str, Any]:
    """A scene with a stroke, and if wanted a pin, that no other round has."""
    wind = {"kind": "wind", "path": [[0, 300], [WIDTH, 260]], "radius": 250, "speed": 1500, "strength": 3 + number / 8}
    pin = {"position": [600, 110], "region": {"type": "circle", "radius": 40 + moved * 6 * number}}
    return {"version": 2, "width": WIDTH, "height": HEIGHT, "strokes": [wind], "rig_points": [pin], **changes}


def stored() -> PreviewBodies:
    mask = np.zeros((HEIGHT, WIDTH), dtype=bool)
    mask[100:650, 500:700] = True
    return PreviewBodies((Body(mesh_from_mask(mask, spacing=SPACING), preset("hair")),))


async def timed(client: TestClient[Any, Any], body: dict[str, Any]) -> dict[str, float]:
    """One preview from the moment of sending: when its first moving frame was there, how fast the rest came."""
    begun = time.perf_counter()
    answer = await client.post("/physanimator/preview", json=body)
    assert answer.status == 200, await answer.text()
    data, first = b"", 0.0
    async for chunk in answer.content.iter_any():
        data += chunk
        if not first and any(map(_moves, split_records(data))):
            first = time.perf_counter() - begun
    seconds = time.perf_counter() - begun
    records = split_records(data)
    frames = [payload for kind, payload in records if kind == FRAME]
    assert records[0][0] == HEADER
    return {
        "pen_up_to_first_frame_ms": first * 1e3,
        "simulated_frames_per_second": (len(frames) - 2) / (seconds - first),
        "bytes_per_frame": statistics.mean(map(len, frames)) + 8,
    }


def _moves(of_record: tuple[int, bytes]) -> bool:
    kind, payload = of_record
    return kind == FRAME and struct.unpack_from("<I", payload)[0] == 1


async def measured(rounds: int) -> dict[str, Any]:
    """Each case in turn, as a median of rounds."""
    store, table, app = PreviewStore(), web.RouteTableDef(), web.Application()
    bodies = stored()
    key, routes = store.put(bodies), PreviewRoutes(store)
    routes.register(table)
    app.add_routes(table)
    cases: dict[str, Any] = {}
    async with TestClient(TestServer(app)) as client:
        cold = time.perf_counter()
        warm_up()
        cold = time.perf_counter() - cold
        for name, changes in CASES.items():
            times = []
            for number in range(rounds + 1):
                scene = document(number, **changes)
                times.append(await timed(client, {"editor": "a", "key": key, "scene": scene, "frames": FRAMES}))
            cases[name] = {figure: statistics.median(t[figure] for t in times[1:]) for figure in times[0]}
            cases[name]["slowest_first_frame_ms"] = max(t["pen_up_to_first_frame_ms"] for t in times[1:])
    routes.close()
    return {
        **{figure: cases["stroke"][figure] for figure in times[0]},
        "cases": cases,
        "warm_up_s": cold,
        "triangles": len(bodies.bodies[0].mesh.triangles),
        "frames": FRAMES,
        "rounds": rounds,
        "machine": {"cores": os.cpu_count(), "load": os.getloadavg()[0]},
    }


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--json", action="store_true", help="print the whole document instead of a table")
    parser.add_argument("--rounds", type=int, default=15, help="previews of each kind (default 15)")
    parser.add_argument("--browser", action="store_true", help="also in ComfyUI's page; needs playwright")
    arguments = parser.parse_args()
    result = asyncio.run(measured(arguments.rounds))
    if arguments.browser:
        result["browser"] = preview_browser.measured(arguments.rounds)
    if arguments.json:
        print(json.dumps(result, indent=2))
        return
    for name, case in result["cases"].items():
        first, rate = case["pen_up_to_first_frame_ms"], case["simulated_frames_per_second"]
        print(
            f"{name:>18}  first moving frame {first:6.1f} ms  {rate:6.0f} frames/s  {case['bytes_per_frame']:.0f} bytes"
        )
    for canvas, case in result.get("browser", {}).items():
        print(
            f"{canvas:>18}  first moving frame {case['pen_up_to_first_frame_ms']:6.1f} ms in the browser,"
            f" at most {case['slowest_first_frame_ms']:.0f} ms"
        )


if __name__ == "__main__":
    main()
