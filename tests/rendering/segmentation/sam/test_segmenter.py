"""Segment Anything with small random networks: loading, prompts, and the choice among the answers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

pytest.importorskip("transformers")

from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.networks.checkpoints import CheckpointError
from physanimator.rendering.segmentation import Prompt
from physanimator.rendering.segmentation.sam.segmenter import SamSegmenter
from random_sam import original_names, random_network, save_network
from safetensors.torch import save_file

WIDTH, HEIGHT = 90, 50
NAMES = ("sam", "sam_hq", "sam2", "sam3_tracker")
PROMPTS = [
    Prompt([(10, 20), (40, 30)], [1, 0]),
    Prompt(box=(5, 5, 40, 40)),
    Prompt([(60.5, 20)], [1], (50, 3, 80, 40)),
]


def picture() -> np.ndarray:
    return np.random.default_rng(0).integers(0, 255, (HEIGHT, WIDTH, 3), dtype=np.uint8)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    root = tmp_path_factory.mktemp("sams")
    for name in NAMES:
        save_network(random_network(name), root / name)
    return root


@pytest.mark.parametrize("name", NAMES)
def test_each_object_gets_the_best_of_the_networks_answers(name: str, folder: Path) -> None:
    segmenter = SamSegmenter.load(folder / name)
    masks, scores = segmenter.segment(picture(), PROMPTS)
    network, square = random_network(name), segmenter._square(WIDTH, HEIGHT)
    for prompt, mask, score in zip(PROMPTS, masks, scores, strict=True):
        assert mask.shape == (HEIGHT, WIDTH)
        with torch.inference_mode():
            answer = network(
                square.pixels(picture(), segmenter.family), **segmenter._asked(prompt, square), multimask_output=True
            )
        expected = answer.iou_scores[0, 0]
        assert score == pytest.approx(float(expected.max()), abs=1e-5)
        logits = square.logits(answer.pred_masks[0, 0, [int(expected.argmax())]])[0]
        # Where the network is undecided to within rounding, either answer will do.
        np.testing.assert_array_equal(mask[abs(logits) > 1e-4], (logits > 0)[abs(logits) > 1e-4])


def test_objects_do_not_depend_on_what_is_asked_beside_them(folder: Path) -> None:
    segmenter = SamSegmenter.load(folder / "sam")
    _, together = segmenter.segment(picture(), PROMPTS)
    alone = [segmenter.segment(picture(), [prompt])[1][0] for prompt in PROMPTS]
    assert together == alone


def test_prompts_reach_the_network_in_pixels_of_its_square(folder: Path) -> None:
    segmenter = SamSegmenter.load(folder / "sam")
    asked = segmenter._asked(PROMPTS[2], segmenter._square(WIDTH, HEIGHT))
    x_scale, y_scale = 64 / WIDTH, 36 / HEIGHT
    point, box = [60.5 * x_scale, 20 * y_scale], [50 * x_scale, 3 * y_scale, 80 * x_scale, 40 * y_scale]
    torch.testing.assert_close(asked["input_points"] + 0.5, torch.tensor([[[point]]]))
    torch.testing.assert_close(asked["input_boxes"] + 0.5, torch.tensor([[box]]))
    assert asked["input_labels"].tolist() == [[[1]]]


@pytest.mark.parametrize("suffix", [".pth", ".safetensors"])
@pytest.mark.parametrize("names", ["original", "transformers"])
def test_a_single_file_gives_the_same_answers_as_the_folder(
    suffix: str, names: str, folder: Path, tmp_path: Path
) -> None:
    tensors = random_network("sam").state_dict()
    if names == "original":
        tensors = original_names(tensors)
    file = tmp_path / f"sam_vit_b_01ec64{suffix}"
    if suffix == ".pth":
        torch.save(tensors, file)
    else:
        save_file({name: tensor.clone() for name, tensor in tensors.items()}, file)
    expected = SamSegmenter.load(folder / "sam").segment(picture(), PROMPTS)
    got = SamSegmenter.load(file).segment(picture(), PROMPTS)
    assert got[1] == pytest.approx(expected[1], abs=1e-6)
    np.testing.assert_array_equal(got[0], expected[0])


def test_weights_of_a_video_model_are_read_too(folder: Path, tmp_path: Path) -> None:
    """SAM 2 is published as a video model; its picture part is what is needed."""
    network = random_network("sam2")
    save_network(network, tmp_path)
    config = json.loads((tmp_path / "config.json").read_text())
    (tmp_path / "config.json").write_text(json.dumps(config | {"model_type": "sam2_video"}))
    got = SamSegmenter.load(tmp_path).segment(picture(), PROMPTS)[1]
    assert got == pytest.approx(SamSegmenter.load(folder / "sam2").segment(picture(), PROMPTS)[1], abs=1e-6)


def test_missing_weights_say_what_to_get_and_where(tmp_path: Path) -> None:
    with pytest.raises(CheckpointError) as caught:
        SamSegmenter.load(tmp_path / "sams" / "sam_vit_b_01ec64.pth")
    for word in ("sam_vit_b_01ec64.pth", "config.json", "model.safetensors", "https://", "Apache-2.0", "sams"):
        assert word in str(caught.value)


def _without_weights(folder: Path) -> None:
    (folder / "model.safetensors").unlink()


def _of_another_kind(folder: Path) -> None:
    (folder / "config.json").write_text('{"model_type": "bert"}')


def _without_config(folder: Path) -> None:
    (folder / "config.json").unlink()


def _incomplete(folder: Path) -> None:
    tensors = dict(random_network("sam").state_dict())
    tensors.pop("mask_decoder.iou_token.weight")
    save_file({name: tensor.clone() for name, tensor in tensors.items()}, folder / "model.safetensors")


def _pickled(folder: Path) -> None:
    torch.save(random_network("sam").state_dict(), folder / "pytorch_model.bin")
    _without_weights(folder)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (_without_weights, "no .safetensors"),
        (_of_another_kind, "model type 'bert'"),
        (_without_config, "no readable config.json"),
        (_incomplete, "mask_decoder.iou_token.weight"),
        (_pickled, "no .safetensors"),
    ],
)
def test_a_folder_that_does_not_fit(spoil: Any, words: str, tmp_path: Path) -> None:
    save_network(random_network("sam"), tmp_path)
    spoil(tmp_path)
    with pytest.raises(CheckpointError, match=words):
        SamSegmenter.load(tmp_path)


def test_a_file_that_holds_something_else(tmp_path: Path) -> None:
    save_file({"weight": torch.zeros(2)}, tmp_path / "sam.safetensors")
    with pytest.raises(CheckpointError, match="does not hold SAM's weights"):
        SamSegmenter.load(tmp_path / "sam.safetensors")
    tensors = original_names(random_network("sam").state_dict())
    tensors.pop("mask_decoder.transformer.norm_final_attn.weight")
    save_file({name: tensor.clone() for name, tensor in tensors.items()}, tmp_path / "sam.safetensors")
    with pytest.raises(CheckpointError, match=r"1 missing: mask_decoder.transformer.layer_norm_final_attn.weight"):
        SamSegmenter.load(tmp_path / "sam.safetensors")


@pytest.mark.parametrize(
    ("prompt", "words"),
    [
        (Prompt(), "with one on the part at least, or with a box"),
        (Prompt([(5, 5)], [0]), "with one on the part at least, or with a box"),
        (Prompt([(95, 5)], [1]), "inside the picture of 90 x 50 px"),
        (Prompt(box=(95, 0, 99, 5)), "box must be"),
    ],
)
def test_bad_prompts(prompt: Prompt, words: str, folder: Path) -> None:
    with pytest.raises(InvalidInputError, match=words):
        SamSegmenter.load(folder / "sam").segment(picture(), [prompt])
