"""The whole way on a small picture: what moves, what stays, what is refused."""

from __future__ import annotations

import threading
import time
from fractions import Fraction
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError, PhysAnimatorError
from physanimator.physics.interruption import checkpoint
from physanimator.physics.material import PRESETS
from physanimator.physics.scene import Scene
from physanimator.rendering.animation import Animation, timed
from physanimator.rendering.composite import LayeredRenderer
from physanimator.rendering.options import AutomaticWind, LayerChoice, Saving, Timing, Watch
from physanimator.rendering.parts import Parts
from physanimator.rendering.pipeline import animate
from PIL import Image

WIDTH, HEIGHT = 160, 120
FRAMES = 13


def picture() -> np.ndarray:
    """A gradient with a dark strip that hangs in its middle."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    image = np.stack([80 + x * 0.8, 200 - y * 0.9, 160 + 0 * x], axis=-1)
    image[strip()] = (70, 40, 30)
    return image.astype(np.uint8)


def strip() -> np.ndarray:
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    return (np.abs(x - 70) < 10) & (y > 15) & (y < 95)


def document(**changes: Any) -> dict[str, Any]:
    """A scene file without strokes, in which the strip's upper end swings by 10 px."""
    wave = {"type": "wave", "amplitude": 10, "period": 1.0, "direction": [1, 0]}
    rig = {"position": [70, 20], "region": {"type": "circle", "radius": 25}, "motion": wave}
    return {"version": 1, "width": WIDTH, "height": HEIGHT, "frame_rate": 12, "rig_points": [rig], **changes}


@pytest.fixture(scope="module")
def windy() -> Animation:
    return animate(
        picture(), [strip()], timing=Timing(frames=FRAMES, frame_rate=12.5), wind=AutomaticWind(strength=2.0)
    )


def test_first_frame_is_the_picture(windy: Animation) -> None:
    first = next(windy.frames())
    assert np.abs(first.astype(int) - picture()).max() <= 1


def test_part_moves_and_what_it_never_covers_stays_exactly_as_drawn(windy: Animation) -> None:
    frames = list(windy.frames())
    assert len(frames) == len(windy) == FRAMES
    moved = np.linalg.norm(windy.motion.positions[-1] - windy.motion.positions[0], axis=1).max()
    assert moved > 2
    assert (frames[-1] != frames[0]).any(axis=2)[strip()].mean() > 0.02
    reach = windy.motion.positions[..., 0]
    left, right = int(reach.min()) - 4, int(reach.max()) + 5
    for frame in frames:
        assert (frame[:, :left] == picture()[:, :left]).all()
        assert (frame[:, right:] == picture()[:, right:]).all()


def test_same_input_gives_the_same_motion(windy: Animation) -> None:
    again = animate(
        picture(), [strip()], timing=Timing(frames=FRAMES, frame_rate=12.5), wind=AutomaticWind(strength=2.0)
    )
    assert (again.motion.positions == windy.motion.positions).all()


def test_calm_air_moves_nothing() -> None:
    calm = animate(picture(), [strip()], timing=Timing(frames=5), wind=AutomaticWind(strength=0))
    assert np.abs(calm.motion.positions - calm.motion.positions[0]).max() < 0.01


def test_scene_document_leads_the_part_and_sets_the_frame_rate() -> None:
    led = animate(picture(), [strip()], scene=document(), timing=Timing(frames=4))
    assert led.motion.frame_rate == 12
    rest = led.scene.bodies[0].mesh.vertices
    top = np.linalg.norm(rest - (70, 20), axis=1) < 20
    shift = (led.motion.positions[3] - led.motion.positions[0])[top]
    assert shift[:, 0] == pytest.approx(10 * np.sin(2 * np.pi * 3 / 12), abs=0.05)
    assert shift[:, 1] == pytest.approx(0, abs=0.05)


def test_scene_document_with_its_own_mesh_needs_no_other() -> None:
    from physanimator.physics.document import scene_to_dict

    led = animate(picture(), [strip()], scene=document(), timing=Timing(frames=2))
    again = animate(picture(), [strip()], scene=scene_to_dict(led.scene), timing=Timing(frames=2))
    assert len(again.scene.bodies) == 1
    assert again.scene.bodies[0].mesh.content_hash == led.scene.bodies[0].mesh.content_hash


@pytest.mark.parametrize(
    "scene", [float("nan"), "calm", [1], 5, {"version": 2, "bodies": [5]}, {"version": 2, "bodies": 5}]
)
def test_what_is_no_scene_is_refused_before_the_work(scene: object) -> None:
    with pytest.raises(InvalidInputError, match=r"must be|is missing"):
        animate(picture(), [strip()], scene=scene, timing=Timing(frames=2))  # type: ignore[arg-type]


def test_caller_may_change_a_given_scene() -> None:
    changed = animate(
        picture(), [strip()], scene=document(), preset="jelly", sway=3.0, timing=Timing(frames=2, frame_rate=30)
    )
    assert changed.motion.frame_rate == 30
    assert changed.scene.bodies[0].material.poisson_ratio == PRESETS["jelly"].poisson_ratio
    assert changed.scene.bodies[0].material.sway_frequency == 3.0


def test_given_plate_shows_where_the_part_was() -> None:
    plate = np.full((HEIGHT, WIDTH, 3), (255, 0, 255), np.uint8)
    other = animate(
        picture(),
        [strip()],
        plate=plate,
        timing=Timing(frames=FRAMES, frame_rate=12.5),
        wind=AutomaticWind(strength=2.0),
    )
    uncovered = strip() & (other.renderer.alpha(FRAMES - 1) == 0)
    assert uncovered.sum() > 20
    assert (list(other.frames())[-1][uncovered] == (255, 0, 255)).all()


def test_points_select_the_part() -> None:
    chosen = animate(picture(), points=["70,50,1\n120,50,0"], timing=Timing(frames=1))
    assert (chosen.masks[0] > 0.5)[strip()].mean() > 0.9
    assert (chosen.masks[0] > 0.5)[~strip()].mean() < 0.05


def test_cuts_are_shown_before_anything_is_made_of_them() -> None:
    seen: list[Any] = []

    def stop(cut: Any) -> None:
        seen.extend(cut)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(picture(), [strip()], points=["70,50,1\n120,50,0"], watch=Watch(on_cut=stop, on_scene=seen.append))
    (cut,) = seen
    assert (cut > 0.5)[strip()].mean() > 0.9


def test_the_scene_is_shown_before_it_is_simulated() -> None:
    seen: list[str] = []
    animate(
        picture(),
        [strip()],
        timing=Timing(frames=2),
        watch=Watch(on_scene=lambda scene: seen.append("scene"), progress=lambda *step: seen.append(step[0])),
    )
    assert [each for each in seen if each != "prepare"] == ["mesh", "mesh", "scene", "simulate", "simulate"]


def test_presets_one_for_each_part() -> None:
    other = np.roll(strip(), 45, axis=1)
    both = animate(picture(), [strip(), other], preset=["ribbon", "leaf"], timing=Timing(frames=1))
    assert [body.material.damping for body in both.scene.bodies] == [PRESETS["ribbon"].damping, PRESETS["leaf"].damping]


def test_stages_are_timed_and_reported() -> None:
    seen: list[tuple[str, int, int]] = []
    animation = animate(
        picture(), [strip()], timing=Timing(frames=3), watch=Watch(progress=lambda *step: seen.append(step))
    )
    list(animation.frames(progress=lambda *step: seen.append(step)))
    frames = [(stage, done, 3) for stage in ("simulate", "render") for done in (1, 2, 3)]
    assert [each for each in seen if each[0] != "prepare"] == [("mesh", 0, 1), ("mesh", 1, 1), *frames]
    assert list(animation.seconds) == ["segment", "mesh", "scene", "simulate", "prepare", "render"]
    assert all(value >= 0 for value in animation.seconds.values())


def test_the_illustration_is_taken_apart_while_its_motion_is_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    begun = threading.Event()
    at_rest = Parts.drawn_at_rest

    def drawn(self: Parts, scene: Scene) -> object:
        begun.set()
        return at_rest(self, scene)

    def wait(stage: str, done: int, total: int) -> None:
        assert stage != "simulate" or begun.wait(10)

    monkeypatch.setattr(Parts, "drawn_at_rest", drawn)
    animation = animate(picture(), [strip()], scene=document(), timing=Timing(frames=4), watch=Watch(progress=wait))
    frames = list(animation.frames())
    told = LayeredRenderer(picture(), [strip()], animation.motion)  # knows the motion when it is made
    np.testing.assert_array_equal(frames, [told.frame(t) for t in range(4)])
    assert np.abs(frames[3].astype(int) - frames[0]).max() > 50


def test_what_cannot_be_taken_apart_ends_the_simulation() -> None:
    done = []
    everything, watch = np.ones_like(strip()), Watch(progress=lambda *step: done.append(step))
    with pytest.raises(InvalidInputError, match="masks must leave some of the picture"):
        animate(picture(), [everything], timing=Timing(frames=2000), spacing=20, watch=watch)
    assert ("simulate", 2000, 2000) not in done


def test_interruption_leaves_everything_usable(windy: Animation) -> None:
    def stop(stage: str, done: int, total: int) -> None:
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        animate(picture(), [strip()], timing=Timing(frames=FRAMES), watch=Watch(progress=stop))
    with pytest.raises(KeyboardInterrupt):
        list(windy.frames(progress=stop))
    assert len(list(windy.frames())) == FRAMES


def test_in_betweens_keep_the_keyframes(windy: Animation) -> None:
    full, sparse = list(windy.frames()), list(windy.frames(every=4))
    assert len(sparse) == FRAMES
    assert all((sparse[t] == full[t]).all() for t in (0, 4, 8, 12))
    difference = np.mean([np.abs(a.astype(int) - b).mean() for a, b in zip(full, sparse, strict=True)])
    still = np.mean([np.abs(a.astype(int) - full[0]).mean() for a in full])
    assert difference < 0.5 * still


def test_transparent_frames_hold_the_part_alone(windy: Animation) -> None:
    first = next(windy.frames(transparent=True))
    assert first.shape == (HEIGHT, WIDTH, 4)
    assert (first[..., 3] > 127)[strip()].mean() > 0.97
    assert (first[..., 3] > 127)[~strip()].mean() < 0.03


def test_side_products_have_one_picture_a_frame(windy: Animation) -> None:
    sketches = list(windy.sketches())
    assert len(sketches) == FRAMES
    assert sketches[0].shape == (HEIGHT, WIDTH)
    assert sketches[0].min() < 0.5 < sketches[0].max()
    for pictures in (list(windy.flows()), list(windy.previews())):
        assert len(pictures) == FRAMES
        assert pictures[0].shape == (HEIGHT, WIDTH, 3)
        assert (pictures[-1] != pictures[0]).any()


def test_saved_video_has_the_right_length_rate_and_alpha(windy: Animation, tmp_path: Path) -> None:
    windy.save(tmp_path / "out.mp4")
    windy.save(tmp_path / "out.webm", transparent=True)
    for name in ("out.mp4", "out.webm"):
        with av.open(str(tmp_path / name)) as container:
            assert container.streams.video[0].average_rate == Fraction(25, 2)
            assert sum(1 for _ in container.decode(video=0)) == FRAMES
    assert windy.seconds["write"] > 0


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"masks": []}, "at least one mask"),
        ({"masks": [np.ones((8, 8), bool)]}, r"masks\[0\] must have the picture's size or at least its proportions"),
        ({"image": np.zeros((HEIGHT, WIDTH), np.uint8)}, "image must be an RGB or RGBA picture"),
        ({"plate": np.zeros((4, 4, 3), np.uint8)}, "plate must have the picture's size"),
        ({"plate": np.zeros((HEIGHT, WIDTH, 3), np.complex64)}, "plate|image"),
        ({"plate": "plate.png"}, "plate"),
        ({"image": np.zeros((HEIGHT, WIDTH, 3), np.complex64)}, "image"),
        ({"image": np.zeros((0, 0, 3), np.uint8)}, "image"),
        ({"frames": 0}, "frames must be at least 1"),
        ({"frames": 2.5}, "frames must be a whole number"),
        ({"frames": "3"}, "frames must be a whole number"),
        ({"frames": True}, "frames must be a whole number"),
        ({"skip": 1.5}, "skip must be a whole number"),
        ({"skip": -1}, "skip must be at least 0"),
        ({"skip": 2}, "skip must be at least 0 and below"),
        ({"frame_rate": float("nan")}, "frame_rate"),
        ({"frame_rate": "24"}, "frame_rate"),
        ({"preset": "steel"}, "preset must be one of hair"),
        ({"preset": ["hair", "cloth"]}, "preset must be named once"),
        ({"spacing": -3.0}, "spacing"),
        ({"sway": 0.0}, "sway_frequency"),
        ({"frame_rate": 0.0}, "frame_rate"),
        ({"scene": {"version": 1}}, "width"),
        ({"scene": document(strokes=[{"radius": -1}])}, r"strokes\[0\]"),
        ({"scene": document(bodies=[{}, {}])}, "bod"),
        ({"masks": [np.zeros((HEIGHT, WIDTH), bool)]}, "mask"),
        ({"points": ["5000,2,1"]}, "inside the picture"),
        ({"points": "10,2,1"}, "points must be a list with the points of one part in each place. Got: str"),
        ({"points": 7}, "points must be a list"),
        ({"preset": 5}, "preset must be the name of a material, or a list of names. Got: int"),
        ({"layers": LayerChoice(move=("hair",))}, "layers must be left out where the picture is flat"),
        ({"wind": 3}, r"wind must be given as AutomaticWind\(strength=2\). Got: int"),
        ({"touching": "hair"}, r"touching must be given as Touching\(...\). Got: str"),
        ({"physics": {}}, "physics must be given as PhysicsOptions"),
        ({"networks": "sam"}, "networks must be given as NetworkOptions"),
        ({"watch": print}, "watch must be given as Watch"),
        ({"layers": ["hair"]}, "layers must be given as LayerChoice"),
        ({"save": "girl.mp4"}, r"save must be given as Saving\(\"a.mp4\"\). Got: str"),
        ({"save": Saving("girl.xyz")}, "output must end in"),
        ({"save": Saving("girl.mp4", background="no colour")}, "background must be picture, transparent"),
        ({"save": Saving("girl.mp4", background=5)}, "background must be a text. Got: int"),  # type: ignore[arg-type]
        ({"save": Saving("girl.gif", background="transparent", width=-3)}, "width must be at least 1 px"),
        ({"save": Saving("girl.mp4", background="transparent")}, "transparen"),
    ],
)
def test_bad_input_is_refused_in_one_sentence_before_the_simulation(
    changes: dict[str, Any], words: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr("physanimator.rendering.pipeline.simulate", lambda *_, **__: pytest.fail("simulated"))
    monkeypatch.chdir(tmp_path)
    timing = {name: changes[name] for name in ("frames", "skip", "frame_rate") if name in changes}
    inputs: dict[str, Any] = {name: value for name, value in changes.items() if name not in timing}
    with pytest.raises(InvalidInputError, match=words) as caught:
        animate(**{"image": picture(), "masks": [strip()], "timing": Timing(**{"frames": 2, **timing}), **inputs})
    assert isinstance(caught.value, PhysAnimatorError)
    assert "\n" not in str(caught.value)


def test_bad_input_is_refused_before_the_simulation(monkeypatch: pytest.MonkeyPatch) -> None:
    """The plate is needed last and checked first."""
    monkeypatch.setattr("physanimator.rendering.pipeline.simulate", lambda *_, **__: pytest.fail("simulated"))
    for plate in (np.zeros((4, 4, 3), np.uint8), np.zeros((HEIGHT, WIDTH, 3), np.complex64), "plate.png"):
        with pytest.raises(InvalidInputError):
            animate(picture(), [strip()], plate=plate, timing=Timing(frames=2))  # type: ignore[arg-type]


@pytest.mark.parametrize("every", [0, -1, 1.5, "2", True, None])
def test_in_betweens_are_counted(windy: Animation, every: object) -> None:
    with pytest.raises(InvalidInputError, match="every must be"):
        windy.frames(every=every)  # type: ignore[arg-type]


@pytest.mark.parametrize("width", [0, -5, 8.5, "80"])
def test_widths_are_counted(windy: Animation, tmp_path: Path, width: object) -> None:
    with pytest.raises(InvalidInputError, match="width must be"):
        windy.save(tmp_path / "a.mp4", width=width)  # type: ignore[arg-type]
    assert list(tmp_path.iterdir()) == []


def test_time_is_counted_when_a_stage_fails() -> None:
    seconds: dict[str, float] = {}
    with pytest.raises(KeyError), timed(seconds, "write"):
        raise KeyError
    assert seconds["write"] >= 0


def sprite() -> np.ndarray:
    """The strip before a body narrower than it is long, on transparency."""
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    image = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    image[(np.abs(x - 60) < 30) & (y > 50)] = (200, 160, 90, 255)
    image[strip()] = (70, 40, 30, 255)
    return image


def test_a_picture_with_transparency_moves_on_it(tmp_path: Path) -> None:
    animation = animate(sprite(), [strip()], timing=Timing(frames=FRAMES), wind=AutomaticWind(strength=3.0))
    frames = list(animation.frames())
    assert (frames[0] == sprite()).all()
    assert (frames[-1] != frames[0]).any(axis=2).sum() > 50
    assert all(frame[2:10].max() == 0 for frame in frames)
    assert [each.shape[2] for each in (next(animation.previews()), next(animation.frames(background="white")))] == [
        3,
        3,
    ]
    assert next(animation.sketches()).min() < 0.5
    for name, channels in (("clip/", 4), ("white/", 3)):
        animation.save(f"{tmp_path}/{name}", background=None if channels == 4 else "white", width=81)
        assert np.array(Image.open(tmp_path / name / "frame_0003.png")).shape == (61, 81, channels)
    animation.save(tmp_path / "clip.mp4")
    animation.save(tmp_path / "sparse.gif", every=3)
    with pytest.raises(InvalidInputError, match="one by one"):
        animation.save(tmp_path / "sparse.webm", every=3, background="parts")


def test_in_betweens_cannot_be_transparent(windy: Animation) -> None:
    with pytest.raises(InvalidInputError, match="one by one"):
        windy.frames(transparent=True, every=2)


def test_whoever_gives_up_while_the_illustration_is_taken_apart_is_heard(monkeypatch: pytest.MonkeyPatch) -> None:
    def endless(self: Parts, scene: Scene) -> None:
        while True:
            checkpoint()
            time.sleep(0.005)

    def stop(stage: str, done: int, total: int) -> None:
        if stage == "prepare":
            raise KeyboardInterrupt

    monkeypatch.setattr(Parts, "drawn_at_rest", endless)
    with pytest.raises(KeyboardInterrupt):
        animate(picture(), [strip()], timing=Timing(frames=2), watch=Watch(progress=stop))
    assert not [each for each in threading.enumerate() if each.name.startswith("physanimator-beside")]
