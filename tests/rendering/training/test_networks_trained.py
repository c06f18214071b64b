"""What is trained and what is not, and that a training begins where the networks are."""

from __future__ import annotations

from pathlib import Path

import pytest
import random_networks
import random_tooncrafter
import torch
from physanimator.rendering.networks.checkpoints import CheckpointError, build_without_storage
from physanimator.rendering.svd import FrameLayout, NetworkConfiguration
from physanimator.rendering.svd.controlnet import SketchControlNet
from physanimator.rendering.svd.unet import SpatioTemporalUNet
from physanimator.rendering.tooncrafter import SketchEncoderConfiguration, UNetConfiguration
from physanimator.rendering.tooncrafter.resampler import ImageResampler, ResamplerConfiguration
from physanimator.rendering.tooncrafter.sketch_encoder import SketchEncoder
from physanimator.rendering.tooncrafter.unet import InterpolationUNet
from physanimator.rendering.training.lvcd_networks import LVCDNetworks, lvcd_networks
from physanimator.rendering.training.recomputing import recompute_stages
from physanimator.rendering.training.tooncrafter_networks import ToonCrafterNetworks, tooncrafter_networks
from safetensors.torch import save_file
from torch import Tensor, nn
from training_data import small_svd

FRAMES, SIDE = 3, 8


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    return random_networks.write(tmp_path_factory.mktemp("networks"), "folder")


def lvcd_batch(clips: int = 1, seed: int = 0) -> dict[str, Tensor]:
    generator = torch.Generator().manual_seed(seed)
    latents = torch.randn((clips, FRAMES, 4, SIDE, SIDE), generator=generator)
    return {
        "latents": latents,
        "reference": latents[:, 0],
        "embedding": torch.randn((clips, 24), generator=generator),
        "hints": torch.rand((clips, FRAMES, 8 * SIDE, 8 * SIDE), generator=generator),
        "sigma": torch.rand((clips,), generator=generator) + 0.5,
        "noise": torch.randn((clips, FRAMES, 4, SIDE, SIDE), generator=generator),
    }


def tooncrafter_batch(clips: int = 1, seed: int = 0) -> dict[str, Tensor]:
    generator = torch.Generator().manual_seed(seed)
    return {
        "latents": torch.randn((clips, 4, 16, SIDE, SIDE), generator=generator),
        "tokens": torch.randn((clips, 5, 32), generator=generator),
        "prompt": torch.randn((clips, 77, 16), generator=generator),
        "rate": torch.full((clips,), 12),
        "hints": torch.rand((clips, 16, 8 * SIDE, 8 * SIDE), generator=generator),
        "timestep": torch.randint(1000, (clips,), generator=generator),
        "noise": torch.randn((clips, 4, 16, SIDE, SIDE), generator=generator),
    }


def count(network: nn.Module, part: str = "") -> int:
    return sum(each.numel() for name, each in network.named_parameters() if each.requires_grad and part in name)


def test_of_the_public_video_model_the_controlnet_and_both_self_attentions_are_trained() -> None:
    network = NetworkConfiguration()
    made = build_without_storage(lambda: LVCDNetworks(SketchControlNet(network), SpatioTemporalUNet(network)))
    assert count(made, "control_model.") / 1e6 == pytest.approx(682, abs=1)
    attention = {name for name, each in made.unet.named_parameters() if each.requires_grad}
    assert count(made.unet) / 1e6 == pytest.approx(99, abs=1)
    assert all(".attn1." in name for name in attention)
    assert any(".time_stack." in name for name in attention)
    assert any(".transformer_blocks." in name for name in attention)
    assert attention == {name for name, _ in made.unet.named_parameters() if ".attn1." in name}


def test_of_the_public_interpolation_the_sketch_encoder_is_trained() -> None:
    made = build_without_storage(
        lambda: ToonCrafterNetworks(
            SketchEncoder(SketchEncoderConfiguration()),
            InterpolationUNet(UNetConfiguration()),
            ImageResampler(ResamplerConfiguration()),
        )
    )
    assert count(made) / 1e6 == pytest.approx(364, abs=1)
    assert count(made) == count(made, "control_model.")


def test_gradients_reach_what_is_trained_and_nothing_else_changes(files: dict[str, Path]) -> None:
    for made, batch in (
        (lvcd_networks(files["svd"], files["lvcd"]), lvcd_batch()),
        (tooncrafter_networks(files["tooncrafter"], files["sketch_encoder"]), tooncrafter_batch()),
    ):
        before = {name: each.detach().clone() for name, each in made.named_parameters()}
        optimizer = torch.optim.AdamW([each for each in made.parameters() if each.requires_grad], lr=1e-3)
        made(**batch).mean().backward()
        optimizer.step()
        for name, parameter in made.named_parameters():
            reached = parameter.grad is not None
            assert reached == parameter.requires_grad, name
            changed = not torch.equal(parameter, before[name])
            assert changed <= parameter.requires_grad, name
            assert parameter.requires_grad == (
                name.startswith("control_model.") or (".attn1." in name and isinstance(made, LVCDNetworks))
            )
        moved = [name for name, each in made.named_parameters() if not torch.equal(each, before[name])]
        assert len(moved) > 0.9 * len([each for each in made.parameters() if each.requires_grad])


def test_a_new_controlnet_of_the_video_model_adds_nothing_at_first(files: dict[str, Path]) -> None:
    made, batch = lvcd_networks(files["svd"]), lvcd_batch()
    conditions = (batch["sigma"].log() / 4, batch["embedding"][:, None], torch.tensor([[6.0, 160.0, 0.0]]))
    layout = FrameLayout.single_reference(FRAMES)
    both = torch.randn((1, FRAMES, 8, SIDE, SIDE), generator=torch.Generator().manual_seed(1))
    lines = batch["hints"][:, :, None].expand(-1, -1, 3, -1, -1)
    with torch.no_grad():
        guided = made.output(both, lines, conditions[0], batch["embedding"], layout)
        plain = made.unet(both, *conditions, layout)
    assert torch.equal(guided, plain)
    encoder = {name for name, _ in made.unet.named_parameters() if name.startswith(("input_blocks.", "middle_block."))}
    own = dict(made.control_model.named_parameters())
    assert all(torch.equal(own[name], dict(made.unet.named_parameters())[name]) for name in encoder)


def test_a_new_sketch_encoder_copies_stable_diffusions_encoder(tmp_path: Path, files: dict[str, Path]) -> None:
    encoder = random_tooncrafter.weights()["sketch"]
    own = ("input_hint_block.", "zero_convs.", "middle_block_out.")
    public = {f"model.diffusion_model.{name}": each for name, each in encoder.items() if not name.startswith(own)}
    save_file({**public, "model.diffusion_model.out.0.weight": torch.ones(3)}, tmp_path / "sd21.safetensors")
    # Without a sketch encoder's own document, the sizes beside ToonCrafter's file count.
    made = tooncrafter_networks(files["tooncrafter"], encoder=tmp_path / "sd21.safetensors")
    copied = dict(made.control_model.named_parameters())
    assert all(torch.equal(copied[name.removeprefix("model.diffusion_model.")], each) for name, each in public.items())
    batch = tooncrafter_batch()
    with torch.no_grad():
        residuals = made.control_model(
            batch["noise"].transpose(1, 2).flatten(0, 1),
            batch["hints"].flatten(0, 1)[:, None],
            batch["timestep"],
            torch.randn((1, 109, 16)),
        )
    assert all(float(each.abs().max()) == 0 for each in residuals)


def test_an_encoder_of_another_shape_is_refused(tmp_path: Path, files: dict[str, Path]) -> None:
    save_file({"model.diffusion_model.time_embed.0.weight": torch.zeros(3, 3)}, tmp_path / "other.safetensors")
    with pytest.raises(CheckpointError, match=r"other\.safetensors does not fit: .* missing"):
        tooncrafter_networks(files["tooncrafter"], encoder=tmp_path / "other.safetensors")


def test_32_accumulated_batches_of_one_give_the_gradient_of_one_of_32(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    made = lvcd_networks(small_svd(tmp_path / "svd.safetensors", monkeypatch))
    for name, parameter in made.control_model.named_parameters():
        if name.startswith(("zero_convs.", "middle_block_out.")):  # else nothing behind them would have a gradient
            nn.init.normal_(parameter, std=0.1, generator=torch.Generator().manual_seed(0))
    batch = lvcd_batch(clips=32)
    made(**batch).mean().backward()
    together = {name: each.grad.clone() for name, each in made.named_parameters() if each.grad is not None}
    made.zero_grad()
    for clip in range(32):
        (made(**{name: each[clip : clip + 1] for name, each in batch.items()}).mean() / 32).backward()
    for name, parameter in made.named_parameters():
        if parameter.grad is not None:
            scale = float(together[name].abs().max()) + 1e-6
            assert float((parameter.grad - together[name]).abs().max()) < 2e-4 * scale + 1e-7, name


def test_computing_stages_twice_changes_no_gradient(files: dict[str, Path]) -> None:
    for load, batch in (
        (lambda: lvcd_networks(files["svd"], files["lvcd"]), lvcd_batch()),
        (lambda: tooncrafter_networks(files["tooncrafter"], files["sketch_encoder"]), tooncrafter_batch()),
    ):
        kept, twice = load(), load()
        assert recompute_stages(twice) > 10
        losses = [made(**batch).mean() for made in (kept, twice)]
        for each in losses:
            each.backward()
        assert torch.equal(*losses)
        for (name, one), other in zip(kept.named_parameters(), twice.parameters(), strict=True):
            assert one.grad is None or torch.allclose(one.grad, other.grad, rtol=1e-5, atol=1e-8), name


def test_frozen_parts_may_have_half_the_precision(files: dict[str, Path]) -> None:
    made = lvcd_networks(files["svd"], files["lvcd"], frozen=torch.bfloat16)
    for parameter in made.parameters():
        assert parameter.dtype == (torch.float32 if parameter.requires_grad else torch.bfloat16)
    with torch.autocast("cpu", torch.bfloat16):
        loss = made(**lvcd_batch()).mean()
    loss.backward()
    assert torch.isfinite(loss)
    exact = float(lvcd_networks(files["svd"], files["lvcd"])(**lvcd_batch()).mean().detach())
    assert float(loss.detach()) == pytest.approx(exact, rel=0.05)


def test_sketches_steer_a_trained_controlnet(files: dict[str, Path]) -> None:
    made, batch = lvcd_networks(files["svd"], files["lvcd"]), lvcd_batch()
    with torch.no_grad():
        one, other = (float(made(**{**batch, "hints": hints})) for hints in (batch["hints"], 1 - batch["hints"]))
    assert one != other
