"""Writes the thumbnails of the workflows: NAME.webp moves, NAME.jpg is for hosts that take stills alone.

    python tests/host/thumbnails.py [workflow ...]

Needs no host: each is drawn from the bundled example by the library, and shows what its workflow has of its own.
"""

from __future__ import annotations

import copy
import json
import sys
from collections.abc import Callable
from functools import cache, partial
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray
from PIL import Image

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT.parent), str(Path(__file__).parent)]

from physanimator.physics.motion import tracks  # noqa: E402
from physanimator.physics.scene import Contact  # noqa: E402
from physanimator.rendering.animation import Animation  # noqa: E402
from physanimator.rendering.artwork import Artwork, load_artwork  # noqa: E402
from physanimator.rendering.control import ModelFormat, line_frames, time_to_move, warped_frames  # noqa: E402
from physanimator.rendering.neural.uncovered_area import uncovered_area  # noqa: E402
from physanimator.rendering.options import AutomaticWind, Timing, Touching  # noqa: E402
from physanimator.rendering.overlays import draw_tracks, preview  # noqa: E402
from physanimator.rendering.pictures import load_image, load_mask  # noqa: E402
from physanimator.rendering.pipeline import animate  # noqa: E402
from physanimator.rendering.sketch import extract_sketch  # noqa: E402
from thumbnail_clips import (  # noqa: E402
    COUNT,
    INK,
    LIGHT,
    SIZE,
    Clip,
    Picture,
    arrow,
    badged,
    bars,
    beside,
    closer,
    evenly,
    grid,
    put,
    round_and_round,
    sized,
)

EXAMPLE = ROOT / "workflows" / "example"
SMALL, RATE = (352, 198), 12
PARTS = ("hair", "cape", "ribbon", "plant")


def _illustration() -> Picture:
    return load_image(EXAMPLE / "illustration.png")[..., :3]


def _mask(part: str) -> NDArray[Any]:
    return load_mask(EXAMPLE / f"mask_{part}.png", width=1280, height=720)


def _scene(**changes: Any) -> dict[str, Any]:
    return {**json.loads((EXAMPLE / "scene.json").read_text(encoding="utf-8")), **changes}


def _hair(**material: Any) -> dict[str, Any]:
    """The example's scene with nothing but its hair, under one gust."""
    scene = _scene()
    gust = {**scene["strokes"][0], "path": [[430, 250], [1000, 250]], "strength": 5.0, "interval": 0.3, "end": 0.7}
    body = {"name": "hair", "material": {**scene["bodies"][0]["material"], **material}}
    return {**scene, "bodies": [body], "rig_points": scene["rig_points"][:1], "strokes": [gust]}


@cache
def _example() -> Animation:
    """The example's own scene, as a loop."""
    masks = [_mask(part) for part in PARTS]
    return animate(_illustration(), masks, scene=_scene(loop=COUNT / RATE))


@cache
def _layers() -> Animation:
    return animate(load_artwork(EXAMPLE / "illustration.psd"), timing=Timing(loop=COUNT / RATE))


@cache
def _frames() -> Clip:
    return evenly(_example().frames())


@cache
def _sketches() -> Clip:
    return evenly(_example().sketches())


def _over(**shown: bool) -> Clip:
    """The frames with what is asked for of meshes, rig points and strokes."""
    example = _example()
    drawn = enumerate(example.frames())
    said = {"wireframe": False, "rig": False, "strokes": False, **shown}
    return evenly(preview(frame, example.motion, example.scene, t, **said) for t, frame in drawn)


def _gust(scene: dict[str, Any]) -> Clip:
    """The hair in a gust of its own, there and back."""
    moved = animate(_illustration(), [_mask("hair")], scene=scene, timing=Timing(frames=2 * COUNT))
    return evenly(picture[:560, 300:1296] for picture in moved.frames())


def _strokes() -> Clip:
    left, up = [[1000, 250], [430, 250]], [[800, 640], [800, 20]]
    clips = []
    for path in (left, up):
        for strength in (1.5, 5.0):
            scene = copy.deepcopy(_hair())
            scene["strokes"][0].update(path=path, strength=strength, radius=260)
            way = np.sign(np.subtract(path[1], path[0]))
            clips.append(badged(_gust(scene), partial(arrow, way=way, strength=strength)))
    return grid(clips)


def _stiffness() -> Clip:
    """The hair from soft to stiff, with as many of four bars."""
    clips = [_gust(_hair(sway_frequency=rate)) for rate in (0.4, 0.8, 1.6, 3.2)]
    return grid([badged(clip, partial(bars, full=number)) for number, clip in enumerate(clips, start=1)])


def _contact() -> Clip:
    """The flower bends into the hair."""
    wind, touching = AutomaticWind(strength=2.5, angle=180.0), Touching(contact=Contact())
    masks = [_mask("hair"), _mask("plant")]
    moved = animate(
        _illustration(), masks, preset=("hair", "leaf"), wind=wind, touching=touching, timing=Timing(frames=2 * COUNT)
    )
    return closer(evenly(moved.frames()), 0.42, 0.0, 0.58)


def _painted() -> Clip:
    """The hair in the colours of its stiffness."""
    picture, mask = _illustration().astype(np.float32), _mask("hair").astype(np.float32)[..., None]
    mask = mask / max(1.0, float(mask.max()))
    along = np.clip((np.arange(1280, dtype=np.float32) - 460) / 560, 0, 1)[None, :, None]
    colours = (1 - along) * np.float32([235, 64, 52]) + along * np.float32([66, 135, 245])
    tinted = picture * (1 - 0.6 * mask) + colours * 0.6 * mask
    scene = _hair(root_stiffness=60)
    moved = animate(tinted.astype(np.uint8), [_mask("hair")], scene=scene, timing=Timing(frames=2 * COUNT))
    return closer(evenly(moved.frames()), 0.25, 0.0, 0.7)


def _holes() -> tuple[Clip, Clip]:
    """What a video model gets: frames with grey holes; and the same with the holes in colour."""
    example = _example()
    form = ModelFormat(frames=COUNT + 1, width=832, height=464)
    grey, pink = [], []
    for frame, hole in list(warped_frames(example.image, example.masks, example.motion, form, grow=8))[:COUNT]:
        grey.append(sized(frame))
        pink.append(sized(np.where(hole[..., None] > 0, np.float32([1.0, 0.2, 0.6]), frame)))
    return grey, pink


def _soft_mask() -> Clip:
    """Where something is to be painted, white; and how the mask fades out around it."""
    example, form = _example(), ModelFormat(frames=COUNT + 1, width=832, height=464)
    holes = [hole for _, hole in warped_frames(example.image, example.masks, example.motion, form, grow=8)][:COUNT]
    return [sized(np.maximum(hole, cv2.GaussianBlur(hole.astype(np.float32), (0, 0), 14))) for hole in holes]


def _uncovered() -> Clip:
    """The picture without its moving parts, with all that they uncover in colour."""
    example = _example()
    area = uncovered_area(example.renderer)[..., None]
    plate = example.renderer.plate / np.float32(255)
    return [sized(plate + area * 0.6 * (np.float32([1.0, 0.2, 0.6]) - plate))] * COUNT


def _lines() -> Clip:
    example = _example()
    form = ModelFormat(frames=COUNT + 1, width=832, height=464)
    return [sized(lines) for lines in line_frames(extract_sketch(example.image), example.motion, form)][:COUNT]


def _tracks() -> Clip:
    example = _example()
    followed = tracks(example.motion, points=90, static_points=12)
    return evenly(draw_tracks(frame, followed, t) for t, frame in enumerate(example.frames()))


def _dark_tracks() -> Clip:
    """The points alone, as a model that follows them gets to see them."""
    followed = tracks(_example().motion, points=90, static_points=12)
    dark = np.full((720, 1280, 3), 18, dtype=np.uint8)
    return evenly(draw_tracks(dark, followed, t) for t in range(len(_example())))


def _closed() -> Clip:
    """The same frame at both ends of what is between."""
    end = [_frames()[0]] * COUNT
    between = [cv2.GaussianBlur(picture, (0, 0), 5) for picture in _frames()]
    return round_and_round(beside(end, between, end, same=True))


@cache
def _crude() -> list[tuple[NDArray[Any], NDArray[Any]]]:
    """The crude animation and its mask."""
    example, form = _example(), ModelFormat(frames=4 * COUNT + 1, width=640, height=352)
    steps = time_to_move(example.image, [_mask(part) for part in PARTS], example.motion, form)
    return [(step.frames[-1], step.mask) for step, _ in zip(steps, range(COUNT), strict=False)]


def _repainted() -> Clip:
    """The crude animation with its mask in colour, and what comes of it."""
    tint = np.float32((1.0, 0.25, 0.2))
    tinted = [frame + 0.5 * mask[..., None] * (tint - frame) for frame, mask in _crude()]
    return beside([sized(picture) for picture in tinted], _frames(), same=True)


def _repainted_by_masks() -> Clip:
    """The mask, the crude animation, and what comes of them."""
    masks, crude = [sized(mask) for _, mask in _crude()], [sized(frame) for frame, _ in _crude()]
    return beside(masks, crude, _frames(), same=True)


def _noisy() -> Clip:
    """The frames, the noise out of which a model draws them anew, and the frames."""
    random = np.random.default_rng(0)
    noise = [random.normal(128, 60, (SIZE[1] // 3, SIZE[0] // 3, 3)) for _ in range(COUNT)]
    grains = [sized(np.clip(each, 0, 255).astype(np.uint8)) for each in noise]
    between = [cv2.addWeighted(frame, 0.35, grain, 0.65, 0) for frame, grain in zip(_frames(), grains, strict=True)]
    return beside(_frames(), between, _frames(), same=True)


def _ends() -> Clip:
    """First frame, what is between, last frame."""
    first, last = [_frames()[0]] * COUNT, [_frames()[COUNT // 2]] * COUNT
    between = [cv2.GaussianBlur(picture, (0, 0), 5) for picture in _frames()]
    return beside(closer(first, 0.15, 0, 0.8), between, last)


def _timeline() -> Clip:
    """The motion over a timeline with three keyframes, along which a mark goes."""
    shown = closer(_frames(), 0.2, 0.0, 0.72)
    left, right, y = 60, SIZE[0] - 60, SIZE[1] - 40
    for number, picture in enumerate(shown):
        cv2.rectangle(picture, (0, y - 34), (SIZE[0], SIZE[1]), INK, -1)
        cv2.line(picture, (left, y), (right, y), LIGHT, 4, cv2.LINE_AA)
        x = left + round((right - left) * number / max(1, COUNT - 1))
        cv2.circle(picture, (x, y), 9, (235, 64, 52), -1, cv2.LINE_AA)
        for key in (left, (left + right) // 2, right):
            corners = np.array([(key, y - 17), (key + 17, y), (key, y + 17), (key - 17, y)], dtype=np.int32)
            cv2.fillPoly(picture, [corners], (255, 176, 32), cv2.LINE_AA)
    return shown


def _film() -> Clip:
    """Three frames on end, of which the middle one is new."""
    clip, shown = closer(_frames(), 0.25, 0.0, 0.62), []
    for number in range(COUNT):
        sheet = np.full((SIZE[1], SIZE[0], 3), INK, dtype=np.uint8)
        for place in range(3):
            picture = sized(clip[(number + place) % COUNT][:, 120:520], (196, 250))
            x, new = 13 + place * 209, (number + place) % 2 == 1
            cv2.rectangle(sheet, (x - 5, 50), (x + 200, 309), (255, 176, 32) if new else INK, -1)
            sheet[55:305, x : x + 196] = picture
            for hole in range(7):
                for y in (18, 324):
                    cv2.rectangle(sheet, (x + hole * 29, y), (x + hole * 29 + 14, y + 18), LIGHT, -1)
        shown.append(sheet)
    return shown


def _tiles() -> Clip:
    """The parts of the character, each alone on a chequered ground."""
    own = [layer for layer in _layers().layers(0).layers if layer.name != "background"]
    ys, xs = np.indices((SIZE[1], SIZE[0]))
    chequers = np.where(((ys // 10 + xs // 10) % 2)[..., None] > 0, np.uint8(245), np.uint8(222)).repeat(3, axis=2)
    moving, shown = [_layers().layers(round(t * len(_layers()) / COUNT)) for t in range(COUNT)], []
    for artwork in moving:
        sheet = chequers.copy()
        names = [layer.name for layer in own][:8]
        for number, name in enumerate(names):
            layer = next(each for each in artwork.layers if each.name == name)
            put(sheet, layer.pixels, (number % 4) * 160 + 8, (number // 4) * 180 + 8, 144, 164)
        shown.append(sheet)
    return shown


def _stack() -> Clip:
    """The layers behind one another, as sheets seen from the side."""
    shown = []
    for t in range(COUNT):
        artwork = _layers().layers(round(t * len(_layers()) / COUNT))
        shown.append(_sheets(artwork))
    return shown


def _sheets(artwork: Artwork) -> Picture:
    names = ["background", "back hair", "cape", "skirt", "front hair", "ribbon"]
    layers = [each for each in artwork.layers if each.name in names]
    sheet = np.full((SIZE[1], SIZE[0], 3), 44, dtype=np.uint8)
    for number, layer in enumerate(layers):
        whole = np.zeros((artwork.height, artwork.width, 4), dtype=np.uint8)
        pixels = (layer.pixels // 257).astype(np.uint8) if layer.pixels.dtype == np.uint16 else layer.pixels
        top, left = max(layer.top, 0), max(layer.left, 0)
        inside = pixels[top - layer.top :, left - layer.left :][: artwork.height - top, : artwork.width - left]
        whole[top : top + inside.shape[0], left : left + inside.shape[1]] = inside
        x = 10 + number * 74
        corners = np.float32([(x, 60), (x + 250, 16), (x + 250, 316), (x, 340)])
        source = np.float32([(0, 0), (artwork.width, 0), (artwork.width, artwork.height), (0, artwork.height)])
        bent = cv2.warpPerspective(whole, cv2.getPerspectiveTransform(source, corners), SIZE, flags=cv2.INTER_AREA)
        pane = np.zeros(SIZE[::-1], dtype=np.uint8)
        cv2.fillPoly(pane, [np.rint(corners).astype(np.int32)], 255, cv2.LINE_AA)
        tint = 0.16 * (pane[..., None] / 255)
        sheet[:] = np.rint(sheet * (1 - tint) + 255 * tint)
        alpha = bent[..., 3:].astype(np.float32) / 255
        sheet[:] = np.rint(sheet * (1 - alpha) + bent[..., :3] * alpha)
        cv2.polylines(sheet, [np.rint(corners).astype(np.int32)], True, (235, 235, 235), 1, cv2.LINE_AA)
    return sheet


def _picked() -> Clip:
    """What is clicked on, in colours; and how it moves."""
    still = _illustration().astype(np.float32)
    for part, colour in zip(PARTS, ((235, 64, 52), (66, 135, 245), (250, 190, 40), (60, 200, 110)), strict=True):
        mask = _mask(part).astype(np.float32)[..., None]
        still += (np.float32(colour) - still) * 0.55 * mask / max(1.0, float(mask.max()))
    picture = sized(still.astype(np.uint8))
    for at in ((390, 130), (330, 230), (300, 55), (545, 125)):
        cv2.circle(picture, at, 11, LIGHT, -1, cv2.LINE_AA)
        cv2.circle(picture, at, 7, INK, -1, cv2.LINE_AA)
    return beside([picture] * COUNT, _frames(), same=True)


THUMBNAILS: dict[str, Callable[[], Clip]] = {
    "quickstart": _frames,
    "animate_illustration": _picked,
    "scene_editor": lambda: _over(rig=True, strokes=True),
    "wind_and_pins": lambda: closer(_over(rig=True, wireframe=True), 0.28, 0.0, 0.5),
    "seamless_loop": lambda: round_and_round(closer(_frames(), 0.2, 0.0, 0.5)),
    "contact": _contact,
    "paint_and_measure": _painted,
    "figure_strokes": _strokes,
    "figure_stiffness": _stiffness,
    "every_step": lambda: beside(_over(wireframe=True), _sketches(), evenly(_example().flows()), _frames(), same=True),
    "soft_inpaint": lambda: closer(beside(_frames(), _holes()[1]), 0.25, 0.0, 0.7),
    "inpaint_plate": lambda: closer(beside(_uncovered(), _frames()), 0.25, 0.0, 0.7),
    "render_from_animation": _noisy,
    "layers": _stack,
    "see_through": _tiles,
    "frame_interpolation": _film,
    "wan_vace": lambda: closer(_holes()[0], 0.25, 0.0, 0.7),
    "wan_tracks": lambda: closer(_tracks(), 0.3, 0.0, 0.65),
    "differential_diffusion": lambda: beside(_holes()[0], _soft_mask(), same=True),
    "wan_lines": _lines,
    "wan_time_to_move": _repainted,
    "wan_time_to_move_core": _repainted_by_masks,
    "wan_first_last_frame": _ends,
    "wan_loop": _closed,
    "ltx_lines": lambda: beside(_lines(), _frames()),
    "ltx_tracks": lambda: beside(_dark_tracks(), _frames(), same=True),
    "anisora_inbetweens": _timeline,
    "physanimator_paper": lambda: beside(_sketches(), _frames()),
    "paper_strict": lambda: beside(_over(wireframe=True), evenly(_example().flows()), _sketches(), same=True),
}


def write(name: str) -> None:
    """Both thumbnails of a workflow; one that has none of its own shows the example in motion."""
    clip = [Image.fromarray(picture) for picture in THUMBNAILS.get(name, _frames)()]
    place = ROOT / "workflows" / name
    still = max(clip, key=lambda one: np.abs(np.asarray(one, dtype=np.int16) - np.asarray(clip[0])).mean())
    still.save(place.with_suffix(".jpg"), quality=85, optimize=True, progressive=True)
    first, *rest = [one.resize(SMALL, Image.Resampling.LANCZOS) for one in clip]
    first.save(
        place.with_suffix(".webp"),
        save_all=True,
        append_images=rest,
        duration=round(1000 / RATE),
        loop=0,
        quality=50,
        method=6,
    )
    print(place.with_suffix(".webp").relative_to(ROOT), place.with_suffix(".webp").stat().st_size // 1000, "kB")


def main() -> None:
    for name in sys.argv[1:] or sorted(path.stem for path in (ROOT / "workflows").glob("*.json")):
        write(name)


if __name__ == "__main__":
    main()
