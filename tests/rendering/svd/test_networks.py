"""The video UNet against diffusers' own where the two are the same network, and what masks and references promise."""

from __future__ import annotations

from math import log

import pytest
import random_svd
import torch
from diffusers import UNetSpatioTemporalConditionModel
from physanimator.rendering.networks.image_encoder import encoder_picture
from physanimator.rendering.svd import FrameLayout
from physanimator.rendering.svd.attention import MaskedTemporalAttention, ReferenceAttention
from physanimator.rendering.svd.controlnet import SketchControlNet
from physanimator.rendering.svd.frame_layout import KeyFrames
from physanimator.rendering.svd.temporal_convolution import MaskedTemporalConvolution
from physanimator.rendering.svd.unet import SpatioTemporalUNet

FRAMES = 5
Given = tuple[torch.Tensor, torch.Tensor, torch.Tensor, torch.Tensor]


def given(frames: int = FRAMES) -> Given:
    generator = torch.Generator().manual_seed(1)
    x = torch.randn(1, frames, 8, 8, 16, generator=generator)
    context = torch.randn(1, 2, random_svd.TINY.network.context_dim, generator=generator)
    return x, torch.tensor([0.4]), context, torch.tensor([[6.0, 127.0, 0.02]])


def unet() -> SpatioTemporalUNet:
    network = SpatioTemporalUNet(random_svd.TINY.network)
    network.load_state_dict(random_svd.random_weights(network, 1))
    return network.eval()


@torch.no_grad()
def test_without_references_it_is_plain_stable_video_diffusion() -> None:
    ours, config = unet(), random_svd.TINY.network
    theirs = UNetSpatioTemporalConditionModel(
        block_out_channels=config.level_channels,
        addition_time_embed_dim=config.ids_embed_dim,
        projection_class_embeddings_input_dim=config.adm_in_channels,
        cross_attention_dim=config.context_dim,
        num_attention_heads=tuple(each // config.num_head_channels for each in config.level_channels),
    ).eval()
    theirs.load_state_dict(dict(random_svd.diffusers_unet(ours.state_dict())))
    x, level, context, ids = given()
    plain = FrameLayout(0, (KeyFrames(tuple(range(FRAMES))),))
    expected = theirs(x, level, context, ids).sample
    torch.testing.assert_close(ours(x, level, context, ids, plain), expected, rtol=1e-3, atol=1e-3)


@torch.no_grad()
@pytest.mark.parametrize("changed", [slice(0, 1), slice(2, 3), slice(3, 9)])
def test_nothing_leaks_through_time_from_or_to_references(changed: slice) -> None:
    """Three references, six frames of the clip: a change of one reference, or of the clip, stays there."""
    convolution, attention = MaskedTemporalConvolution(4, 4, (3, 1, 1)), MaskedTemporalAttention(8, 4)
    x, tokens = torch.randn(1, 4, 9, 2, 2), torch.randn(5, 9, 8)
    other, other_tokens = x.clone(), tokens.clone()
    other[:, :, changed] += 1
    other_tokens[:, changed] += 1
    moved = (convolution(other, 3) - convolution(x, 3)).abs().amax(dim=(0, 1, 3, 4))
    attended = (attention(other_tokens, 3) - attention(tokens, 3)).abs().amax(dim=(0, 2))
    for difference in (moved, attended):
        inside = torch.zeros(9, dtype=torch.bool)
        inside[changed] = True
        assert difference[inside].min() > 1e-2
        assert difference[~inside].max() < 1e-6


@torch.no_grad()
def test_keys_come_from_the_frames_that_the_layout_names() -> None:
    """In a later segment, frame 12 uses the tokens of frames 9 and 0, and not its own."""
    attention, layout = ReferenceAttention(8, 4, amplified=True), FrameLayout.later_segment()
    x = torch.randn(layout.count, 6, 8)
    before, queries = attention(x, layout), attention.to_q(x)
    for frame, matters in ((9, True), (0, True), (11, False)):
        changed = x.clone()
        changed[frame] += 1
        assert torch.equal(attention.to_q(changed)[12], queries[12])
        assert bool((attention(changed, layout)[12] - before[12]).abs().max() > 1e-3) == matters


@torch.no_grad()
def test_amplification_counts_a_token_so_many_times() -> None:
    """A bias of ln 3 is the same as having the second half of the keys three times."""
    attention = ReferenceAttention(8, 4, amplified=True)
    x = torch.randn(3, 5, 8)
    runs = (KeyFrames((0, 1)), KeyFrames((2,), (1,), log(3)))
    keys, values = (torch.cat([project(x[2])] + [project(x[1])] * 3) for project in (attention.to_k, attention.to_v))
    logits = (attention.to_q(x[2]).unflatten(1, (2, 4)).transpose(0, 1)) @ keys.unflatten(1, (2, 4)).permute(1, 2, 0)
    mixed = (logits / 2).softmax(dim=-1) @ values.unflatten(1, (2, 4)).transpose(0, 1)
    expected = attention.to_out(mixed.transpose(0, 1).flatten(1))
    torch.testing.assert_close(attention(x, FrameLayout(0, runs))[2], expected)
    attention.amplified = False
    assert (attention(x, FrameLayout(0, runs))[2] - expected).abs().max() > 1e-4


@torch.no_grad()
def test_an_untrained_control_net_changes_nothing() -> None:
    network, control, layout = unet(), SketchControlNet(random_svd.TINY.network), FrameLayout.single_reference(3)
    x, *conditions = given(3)
    residuals = control(x, torch.rand(1, 3, 3, 64, 128), *conditions, layout)
    plain = network(x, *conditions, layout)
    torch.testing.assert_close(network(x, *conditions, layout, residuals), plain, rtol=0, atol=0)


def test_encoder_picture_smooths_before_it_shrinks() -> None:
    stripes = torch.ones(1, 3, 256, 512)
    stripes[..., ::2] = -1
    small = encoder_picture(stripes, 28)
    flat = encoder_picture(torch.zeros(1, 3, 256, 512), 28)
    assert small.shape == (1, 3, 28, 28)
    assert (small - flat)[..., 2:-2].abs().max() < 0.02
    torch.testing.assert_close(
        flat[0, :, 0, 0], (0.5 - torch.tensor([0.48145, 0.45783, 0.40821])) / 0.27, atol=0.02, rtol=0.1
    )
