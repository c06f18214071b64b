"""Line drawing networks: files are checked, any size is drawn, and strips give what the whole picture gives."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
import pytest
import torch
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.networks.checkpoints import CheckpointError
from physanimator.rendering.sketch.drawings import InformativeDrawingsConfiguration, SketchUNetConfiguration
from physanimator.rendering.sketch.drawings.extractor import draw_sketch
from physanimator.rendering.sketch.drawings.informative_drawings import InformativeDrawings
from physanimator.rendering.sketch.drawings.models import LineDrawer, load_drawer
from physanimator.rendering.sketch.drawings.sketch_unet import SketchUNet
from physanimator.rendering.sketch.drawings.strips import draw_in_strips
from safetensors.torch import save_file
from torch import Tensor, nn


def seeded(network: LineDrawer) -> LineDrawer:
    torch.manual_seed(3)
    for parameter in network.parameters():
        parameter.data.normal_(0, 1 / max(1, parameter[0].numel()) ** 0.5)
    return network.requires_grad_(False).eval()


def informative(width: int = 8, blocks: int = 3) -> LineDrawer:
    return seeded(InformativeDrawings(InformativeDrawingsConfiguration(base_channels=width, n_residual_blocks=blocks)))


def unet(width: int = 4, levels: int = 8) -> LineDrawer:
    return seeded(SketchUNet(SketchUNetConfiguration(base_channels=width, levels=levels)))


def picture(height: int, width: int) -> np.ndarray:
    return np.random.default_rng(5).random((height, width, 3), dtype=np.float32)


class _Darkest(nn.Module):
    """Stands for a network: paper of 0.9, and lines where the picture is dark."""

    multiple, least = 4, 8

    def __init__(self) -> None:
        super().__init__()
        self.weight = nn.Parameter(torch.zeros(1))
        self.seen: list[tuple[int, ...]] = []

    def forward(self, given: Tensor) -> Tensor:
        self.seen.append(tuple(given.shape))
        return 0.9 * given.mean(dim=1, keepdim=True)


@pytest.mark.parametrize("suffix", [".pth", ".safetensors"])
@pytest.mark.parametrize("make", [informative, unet])
def test_files_are_recognised_by_their_names(tmp_path: Path, suffix: str, make: type) -> None:
    network, path = make(), tmp_path / f"any{suffix}"
    weights = network.state_dict()
    save_file(weights, path) if suffix == ".safetensors" else torch.save({"state_dict": weights}, path)
    loaded, given = load_drawer(path), torch.rand(1, 3, 256, 256)
    assert type(loaded) is type(network)
    torch.testing.assert_close(loaded(given), network(given))


def test_names_of_a_network_trained_on_several_devices(tmp_path: Path) -> None:
    torch.save({f"module.{name}": value for name, value in unet().state_dict().items()}, tmp_path / "netG.pth")
    assert isinstance(load_drawer(tmp_path / "netG.pth"), SketchUNet)


def test_the_public_unet_has_these_names() -> None:
    names = set(unet().state_dict())
    assert len(names) == 32
    innermost = "model.model" + ".1.model" + ".3.model" * 6
    assert {"model.model.0.weight", "model.model.3.bias", "model.model.1.model.5.weight"} <= names
    assert {f"{innermost}.1.weight", f"{innermost}.3.weight", f"{innermost}.3.bias"} <= names


@pytest.mark.parametrize("make", [informative, unet])
def test_a_truncated_file_names_what_is_missing(tmp_path: Path, make: type) -> None:
    weights = make().state_dict()
    lost = sorted(weights)[-2:]
    torch.save({name: value for name, value in weights.items() if name not in lost}, tmp_path / "cut.pth")
    with pytest.raises(CheckpointError, match=f"cut.pth does not fit: 2 missing: .*{lost[1]}.*sk_model.pth.*netG.pth"):
        load_drawer(tmp_path / "cut.pth")


def test_lost_residual_blocks_are_missed(tmp_path: Path) -> None:
    weights = {name: value for name, value in informative().state_dict().items() if not name.startswith("model2.2")}
    torch.save(weights, tmp_path / "cut.pth")
    with pytest.raises(CheckpointError, match=r"4 missing: model2\.2\.conv_block\.1\.weight"):
        load_drawer(tmp_path / "cut.pth")


def test_another_network_s_file_names_missing_and_surplus(tmp_path: Path) -> None:
    torch.save({"encoder.conv.weight": torch.zeros(3)}, tmp_path / "other.pth")
    with pytest.raises(CheckpointError, match=r"24 missing: model0\.1\.weight.*1 not wanted: encoder\.conv\.weight"):
        load_drawer(tmp_path / "other.pth")


def test_a_file_that_could_run_code_is_refused(tmp_path: Path) -> None:
    torch.save(informative(), tmp_path / "whole.pth")
    with pytest.raises(CheckpointError, match="could run code"):
        load_drawer(tmp_path / "whole.pth")


def test_a_missing_file(tmp_path: Path) -> None:
    with pytest.raises(CheckpointError, match=r"none\.pth does not exist"):
        load_drawer(tmp_path / "none.pth")


@pytest.mark.parametrize("blocks", [0, 2])
@pytest.mark.parametrize(("height", "width", "rows"), [(48, 36, 8), (44, 20, 12), (100, 8, 4), (8, 8, 4), (60, 32, 60)])
def test_strips_give_what_the_whole_picture_gives(blocks: int, height: int, width: int, rows: int) -> None:
    network = informative(blocks=blocks)
    given = torch.from_numpy(picture(height, width)).permute(2, 0, 1)[None]
    torch.testing.assert_close(draw_in_strips(network, given, rows=rows), network(given), atol=2e-5, rtol=0)


def test_strips_use_the_statistics_of_the_whole_picture() -> None:
    network, given = informative(), torch.rand(1, 3, 64, 32)
    given[:, :, 32:] *= 0.1
    own = torch.cat([network(given[:, :, :32]), network(given[:, :, 32:])], dim=2)
    whole = network(given)
    assert (own - whole).abs()[:, :, [10, 54]].max() > 0.02
    torch.testing.assert_close(draw_in_strips(network, given, rows=32), whole, atol=2e-5, rtol=0)


def test_large_pictures_are_drawn_in_strips_with_the_same_result() -> None:
    network, image = informative(), picture(90, 70)
    whole, strips = draw_sketch(image, network), draw_sketch(image, network, strip_pixels=3000)
    np.testing.assert_allclose(strips, whole, atol=1e-4)


@pytest.mark.parametrize("make", [informative, unet])
@pytest.mark.parametrize(("height", "width"), [(1, 1), (3, 50), (37, 41), (64, 64)])
def test_any_size_comes_back_in_the_same_size(make: type, height: int, width: int) -> None:
    sketch = draw_sketch(picture(height, width), make())
    assert sketch.shape == (height, width)
    assert sketch.dtype == np.float32
    assert sketch.min() >= 0
    assert sketch.max() <= 1


def test_padding_is_cut_off_again() -> None:
    image = np.ones((41, 30, 3), np.float32)
    image[20:22] = 0
    image[:, 28:] = 0
    sketch = draw_sketch(image, _Darkest())
    assert (sketch[20:22] < 0.05).all()
    assert (sketch[:, 28:] < 0.05).all()
    assert (sketch[:20, :28] == 1).all()


def test_paper_is_white_and_faint_lines_and_specks_are_left_out() -> None:
    image = np.ones((40, 60, 3), np.float32)
    image[10] = 0.96
    image[20] = 0.5
    image[30:32, 30:32] = 0
    sketch = draw_sketch(image, _Darkest(), threshold=0.06, smallest_speck=24)
    assert (sketch[20] < 0.6).all()
    sketch[20] = 1
    assert (sketch == 1).all()


def test_working_size_is_what_the_network_sees() -> None:
    network, image = _Darkest(), np.ones((100, 200, 3), np.float32)
    cv2.rectangle(image, (40, 20), (160, 80), (0, 0, 0), 6)
    sketch = draw_sketch(image, network, working_size=64)
    assert network.seen == [(1, 3, 32, 64)]
    assert sketch.shape == (100, 200)
    assert sketch[50, 40] < 0.3
    assert sketch[50, 100] == 1


def test_half_precision_weights_draw_in_half_precision() -> None:
    network, image = informative(), picture(32, 32)
    expected = draw_sketch(image, network, threshold=0.01, smallest_speck=0)
    got = draw_sketch(image, network.bfloat16(), threshold=0.01, smallest_speck=0)
    assert 0 < np.abs(got - expected).mean() < 0.05


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"working_size": 3}, "working_size must be 0, or 16 to"),
        ({"threshold": 0}, "threshold must be"),
        ({"smallest_speck": -1}, "smallest_speck must be"),
        ({"image": np.zeros((10, 10), np.float32)}, "image must be an RGB picture"),
    ],
)
def test_bad_parameters(changes: dict[str, object], message: str) -> None:
    arguments = {"image": picture(16, 16), **changes}
    with pytest.raises(InvalidInputError, match=message):
        draw_sketch(arguments.pop("image"), _Darkest(), **arguments)
