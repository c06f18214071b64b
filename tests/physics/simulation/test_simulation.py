"""simulate(): motion that depends on the scene alone, bounded whatever the scene, and cancellable."""

from __future__ import annotations

import threading
from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest
from physanimator.physics.assembly import MAX_WORK, plan
from physanimator.physics.errors import Cancelled, InvalidInputError, SimulationError
from physanimator.physics.forces import EnergyStroke
from physanimator.physics.material import Material, preset
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.motion import Motion
from physanimator.physics.rig import Circle, KeyedPath, Polygon, RigPoint, Wave
from physanimator.physics.scene import Body, Scene
from physanimator.physics.simulation import simulate

SIZE = 1024


def strip(across: int = 4, *, scale: float = 1.0, left: float = 400.0) -> TriangleMesh:
    """A strip of 60 x 300 px that hangs from y = 100 in a picture of 1024 x 1024 px, times a scale."""
    rows = across * 5
    x, y = np.meshgrid(np.linspace(left, left + 60, across + 1), np.linspace(100, 400, rows + 1))
    triangles = []
    for row in range(rows):
        for column in range(across):
            a = row * (across + 1) + column
            b, c, d = a + 1, a + across + 1, a + across + 2
            triangles += [(a, b, d), (a, d, c)] if (row + column) % 2 else [(a, b, c), (b, d, c)]
    size = round(SIZE * scale)
    return TriangleMesh(np.column_stack([x.ravel(), y.ravel()]) * scale, np.array(triangles), size, size)


def pin(*, scale: float = 1.0, left: float = 400.0) -> RigPoint:
    """Holds the strip's upper end."""
    corners = np.array([[left - 5, 95], [left + 65, 95], [left + 65, 105], [left - 5, 105]]) * scale
    return RigPoint((left * scale, 100 * scale), Polygon(tuple(map(tuple, corners))))


def wind(strength: float = 4.0, *, scale: float = 1.0) -> EnergyStroke:
    return EnergyStroke(
        kind="wind",
        path=((100.0 * scale, 260.0 * scale), (900.0 * scale, 300.0 * scale)),
        radius=250.0 * scale,
        speed=700.0 * scale,
        strength=strength,
        interval=0.4,
    )


def scene(
    *,
    mesh: TriangleMesh | None = None,
    material: Material | None = None,
    strokes: tuple[EnergyStroke, ...] = (),
    rig_points: tuple[RigPoint, ...] | None = None,
    **others: object,
) -> Scene:
    body = Body(mesh or strip(), material or Material(sway_frequency=1.5))
    return Scene((body,), strokes, (pin(),) if rig_points is None else rig_points, **others)  # type: ignore[arg-type]


def travel(motion: Motion) -> float:
    """The farthest that any vertex ever is from where it was drawn [px]."""
    return float(np.linalg.norm(motion.positions - motion.positions[0], axis=2).max())


def test_the_first_frame_is_the_drawing() -> None:
    motion = simulate(scene(strokes=(wind(),)), frames=5)
    np.testing.assert_array_equal(motion.positions[0], strip().vertices.astype(np.float32))
    assert len(motion) == 5
    assert motion.frame_rate == 24
    assert (motion.positions[4] != motion.positions[0]).any()


def test_a_single_frame_is_the_drawing() -> None:
    assert travel(simulate(scene(strokes=(wind(),)), frames=1)) == 0


@pytest.mark.parametrize("frames", [0, -3])
def test_no_frames_are_refused(frames: int) -> None:
    with pytest.raises(InvalidInputError, match="frames must be at least 1"):
        simulate(scene(), frames=frames)


def test_without_forces_nothing_moves() -> None:
    assert travel(simulate(scene(), frames=25)) == 0
    assert travel(simulate(scene(rig_points=()), frames=25)) == 0


def test_wind_blows_along_its_path_and_the_strip_swings_back() -> None:
    gust = EnergyStroke(path=((100.0, 250.0), (900.0, 250.0)), radius=250.0, speed=800.0, strength=6.0, end=0.1)
    motion = simulate(scene(strokes=(gust,)), frames=97)
    tip = motion.positions[:, -3, 0] - motion.positions[0, -3, 0]
    assert tip.max() > 15
    assert tip.min() < -5
    held = motion.positions[:, :5]
    np.testing.assert_array_equal(held, np.broadcast_to(held[0], held.shape))


def test_a_strip_sways_at_the_frequency_that_was_asked_for() -> None:
    nudge = EnergyStroke(path=((0.0, 250.0), (1000.0, 250.0)), radius=600.0, speed=5000.0, strength=1.0, end=0.05)
    still = Material(sway_frequency=1.5, damping=0.0)
    motion = simulate(scene(material=still, strokes=(nudge,), frame_rate=60.0), frames=601)
    tip = motion.positions[60:, -3, 0] - motion.positions[0, -3, 0]
    spectrum = np.abs(np.fft.rfft(tip * np.hanning(len(tip)), 16384))
    assert np.fft.rfftfreq(16384, 1 / 60)[spectrum.argmax()] == pytest.approx(1.5, rel=0.02)


@pytest.mark.parametrize("rate", [12.0, 60.0, 48.0])
def test_the_frame_rate_does_not_change_the_motion(rate: float) -> None:
    """Exactly: these frame rates divide the ticks."""
    wave = RigPoint((430.0, 100.0), Circle(40.0), Wave(15.0, 0.9))
    at_24 = simulate(scene(strokes=(wind(),), rig_points=(wave,), frame_rate=24.0), frames=49)
    other = simulate(scene(strokes=(wind(),), rig_points=(wave,), frame_rate=rate), frames=round(rate * 2) + 1)
    common = int(np.gcd(24, round(rate)))
    np.testing.assert_array_equal(at_24.positions[:: 24 // common], other.positions[:: round(rate) // common])
    assert travel(at_24) > 30


@pytest.mark.parametrize("rate", [25.0, 23.976, 7.3])
def test_a_frame_rate_that_does_not_divide_the_ticks_reads_between_them(rate: float) -> None:
    """Against frames at 240 a second, read by straight lines between neighbours."""
    drawn = dict(strokes=(wind(),), rig_points=(RigPoint((430.0, 100.0), Circle(40.0), Wave(15.0, 0.9)),))
    fine = simulate(scene(**drawn, frame_rate=240.0), frames=481)
    odd = simulate(scene(**drawn, frame_rate=rate), frames=int(2 * rate) + 1)
    for frame, positions in enumerate(odd.positions):
        whole, part = divmod(frame / rate * 240, 1.0)
        expected = (1 - part) * fine.positions[int(whole)] + part * fine.positions[min(int(whole) + 1, 480)]
        assert np.abs(positions - expected).max() < 0.1  # the nearest tick would be up to 2 px away
    assert travel(odd) > 30


@pytest.mark.parametrize("scale", [0.5, 2.0, 1.37])
def test_the_resolution_does_not_change_the_motion(scale: float) -> None:
    """At 512, 2048 and some odd size, against 1024."""
    wave = Wave(15.0, 0.9)
    base = simulate(
        scene(strokes=(wind(),), rig_points=(pin(), RigPoint((430.0, 400.0), Circle(20.0), wave))), frames=49
    )
    scaled = simulate(
        scene(
            mesh=strip(scale=scale),
            strokes=(wind(scale=scale),),
            rig_points=(
                pin(scale=scale),
                RigPoint((430.0 * scale, 400.0 * scale), Circle(20.0 * scale), Wave(15.0 * scale, 0.9)),
            ),
        ),
        frames=49,
    )
    assert travel(base) > 10
    tolerance = 1e-4 if scale in (0.5, 2.0) else 0.1  # other sizes round to whole pixels of the picture
    assert np.abs(scaled.positions / scale - base.positions).max() < tolerance


def test_refining_the_mesh_converges() -> None:
    """Same Young's modulus, same wind per mass: the tip's path settles as the triangles shrink."""
    material = Material(youngs_modulus=300.0)
    tips = []
    for across in (2, 4, 8, 16):
        motion = simulate(scene(mesh=strip(across), material=material, strokes=(wind(),)), frames=25)
        tips.append(motion.positions[:, -1 - across // 2] - motion.positions[0, -1 - across // 2])
    changes = [float(np.abs(fine - coarse).max()) for coarse, fine in pairwise(tips)]
    assert changes[0] > 1.5 * changes[1] > 1.5 * 1.5 * changes[2]
    assert changes[2] < 0.05 * np.abs(tips[3]).max()


def test_the_tip_goes_as_far_with_four_elements_across_as_with_eight() -> None:
    """Same sway, as artists set it: the stiffness that it takes makes up for what coarse triangles resist bending."""
    wave = RigPoint((430.0, 100.0), pin().region, Wave(15.0, 0.9))
    for acting in (dict(strokes=(wind(),)), dict(rig_points=(wave,))):
        coarse, fine = (
            motion.positions[:, -1 - across // 2] - motion.positions[0, -1 - across // 2]
            for across in (4, 8)
            for motion in (simulate(scene(mesh=strip(across), **acting), frames=49),)
        )
        reach = np.linalg.norm(fine, axis=1).max()
        assert reach > 20
        assert np.linalg.norm(fine - coarse, axis=1).max() < 0.05 * reach


def test_a_free_body_keeps_its_momentum_over_ten_thousand_steps() -> None:
    """A short, uneven blow sets it going, turning and trembling; after it, its centre of mass goes straight on."""
    blow = EnergyStroke(path=((300.0, 150.0), (900.0, 160.0)), radius=200.0, speed=3000.0, strength=6.0, end=0.05)
    thrown = scene(strokes=(blow,), rig_points=(), material=Material(youngs_modulus=300.0, damping=0.0))
    planned = plan(thrown, frames=1)
    frames = 20 + int(10_000 / planned.substeps_per_frame)
    positions = simulate(thrown, frames=frames).positions.astype(np.float64)
    mesh = strip()
    shares = np.bincount(mesh.triangles.ravel(), np.repeat(mesh.areas / 3, 3)) / mesh.areas.sum()
    centre = np.einsum("v,fvi->fi", shares, positions)[12:]
    steps = np.diff(centre, axis=0)
    assert np.linalg.norm(steps[0]) > 3
    turned = positions[-1] - positions[-1].mean(axis=0) - (positions[0] - positions[0].mean(axis=0))
    assert np.abs(turned).max() > 30
    straight = centre[0] + np.arange(len(centre))[:, None] * steps.mean(axis=0)
    assert np.abs(centre - straight).max() < 1e-3  # [px], on a way of 1,000 px


def test_two_runs_are_the_same() -> None:
    first, second = (simulate(scene(strokes=(wind(),)), frames=25).positions for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_bodies_do_not_disturb_each_other() -> None:
    soft, stiff = Material(sway_frequency=1.0), Material(sway_frequency=3.0, damping=0.5)
    left, right = Body(strip(), soft), Body(strip(left=520.0), stiff)
    rig_points = (pin(), pin(left=520.0))
    both = simulate(Scene((left, right), (wind(),), rig_points), frames=25)
    for index, body in enumerate((left, right)):
        alone = simulate(Scene((body,), (wind(),), rig_points), frames=25)
        np.testing.assert_array_equal(both.of_body(index), alone.positions)
    ends = np.linalg.norm(both.positions[12] - both.positions[0], axis=1)
    assert ends[: len(ends) // 2].max() > 3 * ends[len(ends) // 2 :].max()


def test_a_stiff_part_does_not_slow_the_others() -> None:
    soft, stiff = Body(strip(8), Material(sway_frequency=0.5)), Body(strip(2, left=520.0), Material(sway_frequency=8.0))
    rig_points = (pin(), pin(left=520.0))
    works = [plan(Scene(bodies, (), rig_points), frames=25).work for bodies in ((soft,), (stiff,), (soft, stiff))]
    assert works[2] == pytest.approx(works[0] + works[1])


def test_the_order_of_vertices_and_triangles_does_not_matter() -> None:
    """Two parts in one mesh, with everything in random order."""
    left, right = strip(), strip(left=520.0)
    vertices = np.concatenate([left.vertices, right.vertices])
    triangles = np.concatenate([left.triangles, right.triangles + len(left.vertices)])
    rng = np.random.default_rng(0)
    order = rng.permutation(len(vertices))
    shuffled = TriangleMesh(vertices[order], rng.permutation(np.argsort(order)[triangles]), SIZE, SIZE)
    drawn = dict(strokes=(wind(),), rig_points=(pin(), pin(left=520.0)))
    plain = simulate(scene(mesh=TriangleMesh(vertices, triangles, SIZE, SIZE), **drawn), frames=25)
    mixed = simulate(scene(mesh=shuffled, **drawn), frames=25)
    assert travel(plain) > 30
    assert np.abs(mixed.positions - plain.positions[:, order]).max() < 0.01


def test_a_rig_point_acts_on_its_own_body_only() -> None:
    mesh = strip()
    wave = RigPoint((430.0, 100.0), Circle(2000.0), Wave(30.0, 1.0), body=1)
    motion = simulate(Scene((Body(mesh), Body(mesh)), (), (wave,)), frames=13)
    assert np.abs(motion.of_body(0) - motion.of_body(0)[0]).max() == 0
    assert np.abs(motion.of_body(1) - motion.of_body(1)[0]).max() == pytest.approx(30.0, rel=0.01)


def test_led_vertices_go_exactly_where_they_are_led() -> None:
    path = KeyedPath((0.2, 0.7, 1.0), ((430.0, 400.0), (480.0, 380.0), (450.0, 330.0)))
    led = RigPoint((430.0, 400.0), Circle(35.0), path)
    motion = simulate(scene(rig_points=(pin(), led)), frames=37)
    near = np.hypot(*(strip().vertices - [430.0, 400.0]).T) <= 35.0
    moved = motion.positions[:, near] - motion.positions[0, near]
    assert near.sum() >= 5
    assert np.abs(moved[:5]).max() == 0  # before the first key
    np.testing.assert_allclose(moved[-1], np.tile([20.0, -70.0], (near.sum(), 1)), atol=1e-3)
    assert np.ptp(moved, axis=1).max() < 1e-3  # as one


def test_everything_pinned_stays() -> None:
    everywhere = RigPoint((500.0, 500.0), Circle(2000.0))
    motion = simulate(scene(strokes=(wind(),), rig_points=(everywhere,), gravity=(0.0, 9.0)), frames=9)
    assert travel(motion) == 0


def test_gravity_drops_a_loose_body_as_galileo_said() -> None:
    motion = simulate(scene(material=Material(damping=0.0), rig_points=(), gravity=(0.0, 0.5)), frames=25)
    fall = (motion.positions[24] - motion.positions[0])[:, 1]
    np.testing.assert_allclose(fall, 0.25 * SIZE, rtol=5e-3)


@pytest.mark.parametrize("kind", ["wind", "repel", "attract"])
@pytest.mark.parametrize("strength", [1e3, 1e6, -1e6])
def test_any_strength_gives_a_bounded_motion(kind: str, strength: float) -> None:
    path = ((300.0, 250.0), (700.0, 260.0)) if kind == "wind" else ((470.0, 260.0),)
    stroke = EnergyStroke(kind=kind, path=path, radius=300.0, strength=strength)  # type: ignore[arg-type]
    motion = simulate(scene(strokes=(stroke,)), frames=25)
    assert np.isfinite(motion.positions).all()
    assert 10 < travel(motion) < 20 * SIZE


@pytest.mark.parametrize(
    "material",
    [
        Material(youngs_modulus=1e-9),
        Material(youngs_modulus=1e-3, damping=0.0),
        Material(youngs_modulus=1e6),
        Material(poisson_ratio=0.499),
        Material(poisson_ratio=0.0),
        Material(sway_frequency=0.001),
        Material(sway_frequency=1000.0),
        Material(density=1e6),
        Material(damping=1e6),
        Material(damping=0.0, sway_frequency=1.0),
        preset("jelly"),
    ],
)
def test_any_material_gives_a_bounded_motion(material: Material) -> None:
    motion = simulate(scene(material=material, strokes=(wind(20.0),), gravity=(0.0, 0.5), sag=True), frames=13)
    assert np.isfinite(motion.positions).all()
    assert travel(motion) < 20 * SIZE


def test_what_takes_too_long_is_refused_before_it_starts_with_a_remedy() -> None:
    stiff = scene(material=Material(youngs_modulus=1e12), strokes=(wind(),))
    calls: list[int] = []
    with pytest.raises(SimulationError) as caught:
        simulate(stiff, frames=240, progress=lambda done, total: calls.append(done))
    assert calls == []
    message = str(caught.value)
    for fragment in (
        "substeps a frame",
        "of computing",
        "larger spacing (now about 15 px)",
        "lower youngs_modulus (now 1e+12)",
    ):
        assert fragment in message
    assert "fewer frames" in message


def test_the_work_that_is_accepted_can_be_chosen() -> None:
    planned = plan(scene(strokes=(wind(),)), frames=25)
    assert planned.work < MAX_WORK
    with pytest.raises(SimulationError, match="lower sway_frequency"):
        simulate(scene(strokes=(wind(),)), frames=25, max_work=planned.work / 2)
    simulate(scene(strokes=(wind(),)), frames=25, max_work=planned.work)


def test_a_plan_tells_the_work() -> None:
    planned = plan(scene(strokes=(wind(),)), frames=49)
    assert planned.triangles == 4 * 20 * 2
    assert planned.substeps_per_frame == 10 * planned.substeps
    assert planned.step == pytest.approx(1 / 240 / planned.substeps)
    assert planned.work >= planned.triangles * planned.substeps * 480
    assert planned.particles >= 2
    (part,) = planned.sway
    assert part.achieved == pytest.approx(1.5)
    twice = plan(scene(strokes=(wind(),)), frames=97)
    assert twice.work == pytest.approx(2 * planned.work, rel=0.2)


def test_progress_counts_the_frames() -> None:
    calls: list[tuple[int, int]] = []
    simulate(scene(), frames=4, progress=lambda done, total: calls.append((done, total)))
    assert calls == [(1, 4), (2, 4), (3, 4), (4, 4)]


def stop_at(frame: int, error: BaseException) -> Callable[[int, int], None]:
    def progress(done: int, _total: int) -> None:
        if done == frame:
            raise error

    return progress


@pytest.mark.parametrize("error", [Cancelled("enough"), KeyboardInterrupt()])
def test_stopping_between_frames_leaves_everything_usable(error: BaseException) -> None:
    expected = simulate(scene(strokes=(wind(),)), frames=13)
    with pytest.raises(type(error)):
        simulate(scene(strokes=(wind(),)), frames=13, progress=stop_at(6, error))
    again = simulate(scene(strokes=(wind(),)), frames=13)
    np.testing.assert_array_equal(again.positions, expected.positions)


def test_many_threads_may_simulate_at_once() -> None:
    scenes = [scene(strokes=(wind(strength),)) for strength in (1.0, 3.0, 5.0)]
    expected = [simulate(each, frames=13).positions for each in scenes]
    found: dict[int, np.ndarray] = {}

    def work(number: int) -> None:
        found[number] = simulate(scenes[number], frames=13).positions

    threads = [threading.Thread(target=work, args=(number,)) for number in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for number in range(3):
        np.testing.assert_array_equal(found[number], expected[number])
