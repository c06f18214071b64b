"""Motion vectors in files, as compositing programs name, count and sign them."""

from __future__ import annotations

import errno
import os
import sys
from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import preset
from physanimator.physics.mesh import mesh_from_mask
from physanimator.physics.motion import FrameFlow, Motion
from physanimator.physics.scene import Body
from physanimator.rendering.export import VectorChannels, check_vectors_folder, exr_channels, save_motion_vectors

MASK = np.pad(np.ones((40, 30), bool), ((10, 10), (10, 40)))


def motion() -> Motion:
    """Two pixels right and one down, then five right and three up."""
    mesh = mesh_from_mask(MASK, spacing=8)
    steps = np.array([(0, 0), (2, 1), (7, -2)])
    return Motion((Body(mesh, preset("jelly")),), (mesh.vertices + steps[:, None]).astype(np.float32), 24.0)


@pytest.mark.parametrize(
    ("channels", "expected"),
    [
        ("nuke", {"forward.u": 5, "forward.v": 3, "backward.u": -2, "backward.v": 1}),
        ("blender", {f"ViewLayer.Vector.{name}": value for name, value in zip("XYZW", (-2, 1, -5, -3), strict=True)}),
    ],
)
def test_vectors_count_upwards_in_the_program_s_channels(channels: VectorChannels, expected: dict[str, float]) -> None:
    found = exr_channels(FrameFlow(motion()).vectors(1), channels)
    assert {name: round(float(values[30, 25]), 3) for name, values in found.items()} == expected
    for values in found.values():
        assert values.dtype == np.float32
        assert values.shape == MASK.shape
        assert not values[30, 70]
        assert not np.signbit(values[30, 70])


def test_files_hold_every_frame_exactly_and_are_the_same_each_time(tmp_path: Path) -> None:
    openexr = pytest.importorskip("OpenEXR")
    done: list[tuple[int, int]] = []
    save_motion_vectors(motion(), tmp_path / "out", progress=lambda *each: done.append(each))
    names = sorted(path.name for path in (tmp_path / "out").glob("*.exr"))
    assert names == ["vectors_0000.exr", "vectors_0001.exr", "vectors_0002.exr"]
    assert done == [(1, 3), (2, 3), (3, 3)]
    for number, vectors in enumerate(FrameFlow(motion())):
        with openexr.File(str(tmp_path / "out" / names[number]), separate_channels=True) as file:
            read = {name: channel.pixels for name, channel in file.channels().items()}
        want = exr_channels(vectors, "nuke")
        assert set(read) == set(want)
        assert all((read[name] == want[name]).all() for name in want)
    first = (tmp_path / "out" / names[1]).read_bytes()
    save_motion_vectors(motion(), tmp_path / "out")
    assert (tmp_path / "out" / names[1]).read_bytes() == first


def test_files_of_others_are_never_replaced(tmp_path: Path) -> None:
    pytest.importorskip("OpenEXR")
    (tmp_path / "vectors_0001.exr").write_bytes(b"of somebody else")
    for save in (check_vectors_folder, lambda path: save_motion_vectors(motion(), path)):
        with pytest.raises(InvalidInputError, match=r"vectors_0001\.exr, which PhysAnimator did not write"):
            save(tmp_path)
    assert (tmp_path / "vectors_0001.exr").read_bytes() == b"of somebody else"
    assert len(list(tmp_path.iterdir())) == 1


def test_without_the_package_it_is_said_before_the_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "OpenEXR", None)
    with pytest.raises(InvalidInputError, match="pip install OpenEXR"):
        check_vectors_folder(tmp_path / "out")
    with pytest.raises(InvalidInputError, match="channels must be one of nuke, blender"):
        save_motion_vectors(motion(), tmp_path / "out", channels="fusion")  # type: ignore[arg-type]
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(os.name == "nt", reason="there are no such limits")
def test_a_file_that_the_disk_does_not_take_is_told_as_all_are(tmp_path: Path) -> None:
    """The library that writes them raises an error of its own kind."""
    import resource

    pytest.importorskip("OpenEXR")
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, before[1]))
    try:
        with pytest.raises(OSError, match="out") as told:
            save_motion_vectors(motion(), tmp_path / "out")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert told.value.errno == errno.EFBIG
    assert list(tmp_path.iterdir()) == []
