"""Frames of layered artwork against the truth, which layers tell in full.

    python tests/benchmarks/artwork_truth.py [FILE ...] --json

Each moving layer is enlarged four times so that its mean over each pixel is the layer again, bent there by the affine
map of each triangle of its mesh, laid with the others in their order, and brought back to size by the mean over each
pixel. What of a layer lies beyond its mesh follows the nearest triangle. Where a mesh lies over itself, what is beneath
shows through what is not opaque. Strands, which slits part, are laid over one another, each with what lies beyond the
mesh at it; along a slit each ends at its own side. Nothing of the renderer is used. Ours is compared with it, and
beside it the way of a flat picture: the same file flattened, with a mask of what is seen of each moving layer, and the
same motion.

Prints ``{artwork: {region: {"layers": dB, "worst frame": dB, "flat": dB, "pixels": _}}}``; PSNR over all frames, and in
the worst frame that has 50 such pixels or more. Regions: ``bared`` shows what was hidden in the drawing, ``covered``
hides what was seen, ``edges`` of moving layers, ``folds`` where a mesh lies over itself, ``moved`` the rest of what
moving layers touch, ``all`` of these. Without FILE: the drawn artworks of drawn_artworks.py and the bundled example.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from drawn_artworks import ARTWORKS
from physanimator.physics.motion import Motion
from physanimator.rendering.artwork import ArtLayer, Artwork, lay_over, load_artwork, moving_layers
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.options import AutomaticWind, Timing
from physanimator.rendering.parts import arranged, picture_of
from physanimator.rendering.pictures import over
from physanimator.rendering.pipeline import animate

__all__ = ["TrueArtwork", "score"]

FINE = 4
_BACK_PROJECTIONS = 8
# Beyond so many pixels from its mesh a layer is moved along, and no longer bent along.
_BENT = 12
# So far around a strand is looked for what is beside it [px].
_ROUND = 64
# What lies beyond a mesh belongs to where it is nearest to in the drawing, and so far beside that [px].
_SAME = 1
_FEWEST = 50
EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example" / "illustration.psd"

Image = np.ndarray


@dataclass(frozen=True, eq=False)
class TrueFrame:
    """One true frame.

    Attributes:
        picture: premultiplied RGBA in 0 to 1, shape [h, w, 4].
        shares: how much of each pixel shows each layer, shape [layers, h, w].
        new: how much shows parts of moving layers that were hidden in the drawing, shape [h, w].
        edges: where moving layers end, bool, shape [h, w].
        folds: where a mesh lies over itself, bool, shape [h, w].
        touched: where moving layers are, bool, shape [h, w].
    """

    picture: Image
    shares: Image
    new: Image
    edges: Image
    folds: Image
    touched: Image


class TrueArtwork:
    """The true frames of artwork whose layers move."""

    def __init__(self, artwork: Artwork, indices: Sequence[int], motion: Motion) -> None:
        self.artwork, self.motion = artwork, motion
        self.bodies = {index: body for body, index in enumerate(indices)}
        self.drawn = [k for k, layer in enumerate(artwork.layers) if (layer.visible and layer.opacity) or k in indices]
        self.fine = {k: _enlarged(on_canvas(artwork, artwork.layers[k])) for k in self.drawn}
        self.ids = {
            k: _triangles_of(
                motion.bodies[b].mesh.vertices * FINE, motion.bodies[b].mesh.triangles, self.fine[k].shape
            )[0]
            for k, b in self.bodies.items()
        }
        self.places = {k: _nearest(ids >= 0)[1] for k, ids in self.ids.items()}
        self.depths = {k: _nearest(ids < 0)[0] for k, ids in self.ids.items()}
        seen = np.ones(next(iter(self.fine.values())).shape[:2], np.float32)
        self.hidden: dict[int, Image] = {}
        for k in reversed(self.drawn):
            if k in self.bodies:
                self.hidden[k] = 1 - seen
            if artwork.layers[k].blend == "normal":
                seen = seen * (1 - self.fine[k][..., 3])
        self.rest = self._frame(None)

    def frame(self, t: int) -> TrueFrame:
        """The true frame ``t``."""
        return self._frame(t)

    def regions(self, true: TrueFrame) -> dict[str, Image]:
        """Where what is counted apart is, bool, shape [h, w] each."""
        at_rest, now = self.rest.shares, true.shares
        gained = now - at_rest
        movers = [self.drawn.index(k) for k in self.bodies]
        still = [k for k in range(len(self.drawn)) if k not in movers]
        bared = (true.new > 0.5) | (np.maximum(gained[still], 0).sum(axis=0) > 0.5)
        covered = (np.maximum(gained[movers], 0).sum(axis=0) > 0.5) & ~bared
        touched = true.touched | self.rest.touched
        rest = touched & ~(bared | covered | true.edges | true.folds)
        return {
            "bared": bared,
            "covered": covered,
            "edges": true.edges,
            "folds": true.folds,
            "moved": rest,
            "all": touched,
        }

    def _frame(self, t: int | None) -> TrueFrame:
        height, width = next(iter(self.fine.values())).shape[:2]
        planes = np.zeros((height, width, 4), np.float32)
        shares: list[Image] = []
        new = np.zeros((height, width), np.float32)
        edges, folds, touched = (np.zeros((height // FINE, width // FINE), bool) for _ in range(3))
        for k in self.drawn:
            texture, hidden = self.fine[k], self.hidden.get(k)
            if k in self.bodies:
                if t is not None:
                    texture, hidden, folded = self._bent(k, t)
                    folds |= _shrunk(folded) > 0
                alpha = _shrunk(texture[..., 3])
                edges |= cv2.dilate(((alpha > 0.02) & (alpha < 0.98)).astype(np.uint8), np.ones((3, 3))) > 0
                touched |= alpha > 0
            lay_over(planes, texture, self.artwork.layers[k].blend)
            if self.artwork.layers[k].blend == "normal":
                alpha = texture[..., 3]
                shares = [share * (1 - alpha) for share in shares]
                new *= 1 - alpha
                shares.append(alpha.copy())
                new += 0 if hidden is None else alpha * (hidden > 0.5)
            else:
                shares.append(np.zeros((height, width), np.float32))
        return TrueFrame(
            _shrunk(planes), np.array([_shrunk(each) for each in shares]), _shrunk(new), edges, folds, touched
        )

    def _bent(self, k: int, t: int) -> tuple[Image, Image, Image]:
        """A moving layer in a frame, how much of it was hidden, and where it lies over itself, at high resolution."""
        texture, mesh = self.fine[k], self.motion.bodies[self.bodies[k]].mesh
        moved = self.motion.of_body(self.bodies[k])[t].astype(np.float64) * FINE
        drawn, hidden = np.zeros_like(texture), np.zeros(texture.shape[:2], np.float32)
        sheets = np.zeros(texture.shape[:2], np.uint8)
        strands = _strands(mesh.vertices, mesh.triangles)
        for triangles in strands:
            window = slice(0, texture.shape[0]), slice(0, texture.shape[1])
            if len(strands) > 1:
                low, high = moved[triangles].min(axis=(0, 1)), moved[triangles].max(axis=(0, 1))
                window = tuple(
                    slice(max(0, int(low[c]) - _ROUND * FINE), max(0, int(high[c]) + _ROUND * FINE)) for c in (1, 0)
                )
            part, below, count = self._strand(k, triangles, moved, window)
            alpha = part[..., 3:]
            drawn[window] = drawn[window] * (1 - alpha) + part
            hidden[window] = np.where(alpha[..., 0] > 0.5, below, hidden[window])
            sheets[window] += count
        return drawn, hidden, (sheets > 1).astype(np.float32)

    def _strand(
        self, k: int, triangles: Image, moved: Image, window: tuple[slice, slice]
    ) -> tuple[Image, Image, Image]:
        """Triangles of a layer and what of it is beside them, in a window: colours, how much was hidden, how often."""
        mesh, shape = self.motion.bodies[self.bodies[k]].mesh, self.fine[k][window].shape
        corner = np.array([window[1].start, window[0].start], np.float64)
        top, first, count = _triangles_of(moved - corner, triangles, shape)
        inside = top >= 0
        far, base = _nearest(inside)
        base = base + corner
        here = np.stack(np.meshgrid(np.arange(shape[1]) + 0.5, np.arange(shape[0]) + 0.5), axis=-1) + corner
        # As far as it is bent along, it follows the nearest triangle's map; beyond that, its shift there.
        out = (here - base) * np.minimum(1, _BENT * FINE / np.maximum(far, 1e-6))[..., None]
        at = np.where(inside[..., None], here, base + out)
        nearest = tuple((base - corner - 0.5).astype(int)[..., ::-1].transpose(2, 0, 1))
        ids = np.where(inside, top, top[nearest])
        matrix = _affine(moved[triangles], mesh.vertices[triangles] * FINE)
        source = _mapped(matrix, ids, at) + (here - at)
        drawn, hidden = _read(self.fine[k], source), _read(self.hidden[k], source)
        # What lies in the mesh in the drawing, or nearest to another strand of it there, is not this one's. Along a
        # slit each strand ends at its own side; the outline is told no closer than a pixel's diagonal.
        depth = _read(self.depths[k], source, cv2.INTER_NEAREST)
        found = _read(self.places[k].astype(np.float32), source, cv2.INTER_NEAREST, cv2.BORDER_REPLICATE)
        other = np.linalg.norm(found - _mapped(matrix, ids, base), axis=2) > _SAME * FINE + 0.5 * far
        drawn[~inside & ((depth > 1.5) | other)] = 0
        # Where a sheet lies over another one, that shows through what is not opaque.
        lower = _mapped(matrix, first, here)
        double = (count > 1) & (np.linalg.norm(lower - source, axis=2) > 2 * FINE)
        drawn += np.where(double[..., None], (1 - drawn[..., 3:]) * _read(self.fine[k], lower), 0)
        return drawn, hidden, count


def _mapped(matrix: Image, ids: Image, at: Image) -> Image:
    """Places [high-resolution px] by the map of a triangle each, shape [h, w, 2]."""
    return np.einsum("hwij,hwj->hwi", matrix[ids][..., :2], at) + matrix[ids][..., 2]


def _read(picture: Image, places: Image, how: int = cv2.INTER_LINEAR, border: int = cv2.BORDER_CONSTANT) -> Image:
    """A picture at places [its px], whose first pixel is at (0.5, 0.5); nothing is beyond it."""
    x, y = (places[..., c].astype(np.float32) - 0.5 for c in (0, 1))
    return cv2.remap(picture, x, y, how, borderMode=border, borderValue=0)


def _strands(vertices: Image, triangles: Image) -> list[Image]:
    """The triangles of each strand, shape [t, 3]: between those on either side of a slit another strand begins."""
    _, place = np.unique(vertices, axis=0, return_inverse=True)
    sides: dict[tuple[int, int], list[tuple[int, tuple[int, int]]]] = {}
    for number, triangle in enumerate(triangles.tolist()):
        for side in zip(triangle, triangle[1:] + triangle[:1], strict=True):
            there = tuple(sorted(place.ravel()[list(side)].tolist()))
            sides.setdefault(there, []).append((number, tuple(sorted(side))))
    slits = [each for each in sides.values() if len(each) == 2 and each[0][1] != each[1][1]]
    starts: list[int] = []
    for last, first in sorted(((one[0], other[0]) for one, other in slits), key=lambda each: each[1]):
        if not any(last < start <= first for start in starts):
            starts.append(first)
    return np.split(triangles, starts)


def on_canvas(artwork: Artwork, layer: ArtLayer) -> Image:
    """Premultiplied RGBA of a layer over the canvas with its opacity, shape [h, w, 4]."""
    planes = np.zeros((artwork.height, artwork.width, 4), np.float32)
    left, top, right, bottom = layer.box
    x0, x1, y0, y1 = max(0, left), min(artwork.width, right), max(0, top), min(artwork.height, bottom)
    if x1 > x0 and y1 > y0:
        part = layer.pixels[y0 - top : y1 - top, x0 - left : x1 - left] / np.float64(np.iinfo(layer.pixels.dtype).max)
        part[..., 3] *= layer.opacity
        part[..., :3] *= part[..., 3:]
        planes[y0:y1, x0:x1] = part
    return planes


def _enlarged(layer: Image) -> Image:
    """A layer at high resolution whose mean over each pixel is the layer again, with no more light than alpha."""
    size = layer.shape[1] * FINE, layer.shape[0] * FINE
    large, missing = np.zeros((size[1], size[0], 4), np.float32), layer
    for _ in range(_BACK_PROJECTIONS):
        large += cv2.resize(missing, size, interpolation=cv2.INTER_CUBIC)
        np.clip(large, 0, 1, out=large)
        np.minimum(large[..., :3], large[..., 3:], out=large[..., :3])
        missing = layer - _shrunk(large)
    return large


def _shrunk(large: Image) -> Image:
    return cv2.resize(large, (large.shape[1] // FINE, large.shape[0] // FINE), interpolation=cv2.INTER_AREA)


def _triangles_of(points: Image, triangles: Image, shape: tuple[int, ...]) -> tuple[Image, Image, Image]:
    """The last and the first triangle at each pixel centre, -1 where there is none, and how many there are."""
    last, first = (np.full(shape[:2], -1, np.int32) for _ in range(2))
    count = np.zeros(shape[:2], np.uint8)
    for number, (a, b, c) in enumerate(points[triangles]):
        low = np.maximum(np.floor(np.min([a, b, c], axis=0)).astype(int), 0)
        high = np.minimum(np.ceil(np.max([a, b, c], axis=0)).astype(int) + 1, (shape[1], shape[0]))
        area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if (high <= low).any() or area == 0:
            continue
        x, y = np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1])[:, None] + 0.5
        v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area
        w = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area
        within = (v >= -1e-9) & (w >= -1e-9) & (v + w <= 1 + 1e-9)
        part = slice(low[1], high[1]), slice(low[0], high[0])
        last[part][within] = number
        first[part][within & (first[part] < 0)] = number
        # An edge that two triangles share is no fold.
        count[part] += (v > 1e-6) & (w > 1e-6) & (v + w < 1 - 1e-6)
    return last, first, count


def _nearest(inside: Image) -> tuple[Image, Image]:
    """Distance to a mesh and the place of its nearest pixel, at high resolution, shape [h, w] and [h, w, 2]."""
    far, nearest = cv2.distanceTransformWithLabels(
        (~inside).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_5, labelType=cv2.DIST_LABEL_PIXEL
    )
    row, column = np.nonzero(inside)
    place = np.zeros((int(nearest.max()) + 1, 2), np.float64)
    place[nearest[inside]] = np.stack([column + 0.5, row + 0.5], axis=1)
    return far, place[nearest]


def _affine(moved: Image, rest: Image) -> Image:
    """The maps from moved to rest corners, shape [t, 2, 3]."""
    ones = np.ones((*moved.shape[:2], 1))
    flat = np.linalg.det(np.concatenate([moved, ones], axis=2)) == 0
    moved = np.where(flat[:, None, None], rest, moved)
    return np.linalg.solve(np.concatenate([moved, ones], axis=2), rest).transpose(0, 2, 1)


def score(
    artwork: Artwork, *, wind: float = 2.0, frames: int = 49, every: int = 8, sheet: Path | None = None
) -> dict[str, Any]:
    """PSNR of ours and of the flat way in every region."""
    animation = animate(artwork, wind=AutomaticWind(strength=wind), timing=Timing(frames=frames))
    artwork = arranged(artwork)
    indices = [plan.index for plan in moving_layers(artwork) if plan.moves]
    motion, ours = animation.motion, animation.renderer
    truth = TrueArtwork(artwork, indices, motion)
    seen = [truth.rest.shares[truth.drawn.index(k)] for k in indices]
    flat = LayeredRenderer(picture_of(artwork), [np.clip(each, 0, 1) for each in seen], motion)
    sums: dict[str, list[list[float]]] = {}
    for t in range(every, frames, every):
        true = truth.frame(t)
        wanted = np.rint(np.clip(true.picture[..., :3] + 1 - true.picture[..., 3:], 0, 1) * 255)
        drawn = {name: over(each.frame(t)).astype(float) for name, each in (("layers", ours), ("flat", flat))}
        for name, region in truth.regions(true).items():
            row = [float(region.sum())]
            row += [float(((picture - wanted)[region] ** 2).mean(axis=1).sum()) for picture in drawn.values()]
            sums.setdefault(name, []).append(row)
        if sheet:
            sheet.mkdir(parents=True, exist_ok=True)
            off = np.clip(128 + 4 * (drawn["layers"] - wanted), 0, 255)
            tiles: Image = np.hstack([wanted, drawn["layers"], drawn["flat"], off])[..., ::-1].astype(np.uint8)
            cv2.imwrite(str(sheet / f"{t:03}.png"), tiles)
    return {name: _row(np.array(rows)) for name, rows in sums.items()}


def _row(rows: Image) -> dict[str, float | None]:
    many = rows[rows[:, 0] >= _FEWEST]
    total = rows.sum(axis=0)
    return {
        "layers": _psnr(total[1], total[0]),
        "worst frame": min((_psnr(each[1], each[0]) or 99.0 for each in many), default=None),
        "flat": _psnr(total[2], total[0]),
        "pixels": int(total[0]),
    }


def _psnr(squares: float, count: float) -> float | None:
    if not count:
        return None
    return round(float(min(99.0, 10 * np.log10(255**2 / max(squares / count, 1e-9)))), 2)


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", type=Path, nargs="*", help="layered files (default: drawn ones and the example)")
    parser.add_argument("--wind", type=float, default=2.0, help="strength of the automatic wind (default 2)")
    parser.add_argument("--frames", type=int, default=49, help="length of the clip (default 49)")
    parser.add_argument("--every", type=int, default=8, help="frames from one that is measured to the next (default 8)")
    parser.add_argument("--sheet", type=Path, help="folder for truth, layers, flat and 4 times the error side by side")
    parser.add_argument("--only", help="one of the drawn artworks")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    options = parser.parse_args()
    found = {path.stem: (lambda path=path: load_artwork(path)) for path in options.files}
    if not found:
        found = {name: draw for name, draw in ARTWORKS.items() if options.only in (None, name)}
        if EXAMPLE.is_file() and options.only in (None, "example"):
            found["example"] = lambda: load_artwork(EXAMPLE)
    table = {}
    for name, load in found.items():
        sheet = options.sheet / name if options.sheet else None
        table[name] = score(load(), wind=options.wind, frames=options.frames, every=options.every, sheet=sheet)
        if not options.json:
            print(name)
            for region, row in table[name].items():
                print(f"  {region:>8}  " + "  ".join(f"{key} {value}" for key, value in row.items()), flush=True)
    if options.json:
        print(json.dumps(table, indent=2))


if __name__ == "__main__":
    main()
