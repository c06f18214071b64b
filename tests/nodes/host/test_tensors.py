"""The host's tensors to arrays and back."""

from __future__ import annotations

import numpy as np
import pytest
import torch
from physanimator.nodes.host import (
    batch_of_masks,
    batch_of_pictures,
    mask_of,
    picture_of,
    picture_with_alpha,
    pictures_of,
)
from physanimator.physics.errors import InvalidInputError


def test_picture_keeps_its_colours_exactly() -> None:
    image = torch.rand(1, 5, 7, 3)
    assert np.array_equal(picture_of(image), image[0].numpy())


def test_hidden_colours_are_never_shown() -> None:
    image = torch.rand(2, 5, 7, 4)
    image[..., 3] = torch.tensor([0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.25])
    for shown, given in zip(pictures_of(image), image.numpy(), strict=True):
        assert (shown[:, [0, 2, 4]] == 1).all()
        assert np.array_equal(shown[:, [1, 3, 5]], given[:, [1, 3, 5], :3])
        assert np.allclose(shown[:, 6], 0.25 * given[:, 6, :3] + 0.75)
    assert np.array_equal(picture_of(image[:1]), pictures_of(image)[0])


def test_a_picture_keeps_its_alpha_where_that_is_wanted() -> None:
    image = torch.rand(1, 5, 7, 4) * 0.5 + 0.25
    image[0, 2, 3, 3] = 0
    kept = picture_with_alpha(image)
    assert kept.shape == (5, 7, 4)
    assert kept[2, 3].tolist() == [0, 0, 0, 0]
    elsewhere = np.ones((5, 7), bool)
    elsewhere[2, 3] = False
    assert np.array_equal(kept[elsewhere], image[0].numpy()[elsewhere])
    image[..., 3] = 1
    assert np.array_equal(picture_with_alpha(image), image[0, ..., :3].numpy())


def test_the_mask_of_load_image_is_a_picture_s_transparency() -> None:
    image, mask = torch.rand(1, 5, 7, 3), torch.zeros(1, 5, 7)
    mask[0, :, 4:] = 1
    kept = picture_with_alpha(image, mask)
    assert np.array_equal(kept[..., 3], 1 - mask[0].numpy())
    assert np.array_equal(kept[:, :4, :3], image[0, :, :4].numpy())
    assert (kept[:, 4:] == 0).all()
    # With an opaque file the host gives an empty mask of 64 x 64 px.
    assert np.array_equal(picture_with_alpha(image, torch.zeros(1, 64, 64)), image[0].numpy())
    with pytest.raises(InvalidInputError, match=r"^image_alpha must be of the picture's size, 7 x 5 px. Got: 8 x 8 px"):
        picture_with_alpha(image, torch.ones(1, 8, 8))


def test_picture_is_clipped_to_displayable_colours() -> None:
    image = torch.tensor([-0.5, 0.25, 1.5]).reshape(1, 1, 1, 3)
    assert picture_of(image).tolist() == [[[0.0, 0.25, 1.0]]]


def test_a_batch_is_not_one_picture() -> None:
    with pytest.raises(InvalidInputError, match=r"^sketch must be one picture.*ImageFromBatch.*batch of 3"):
        picture_of(torch.zeros(3, 4, 4, 3), name="sketch")


@pytest.mark.parametrize("shape", [(4, 4, 3), (1, 4, 4, 1), (1, 0, 4, 3)])
def test_other_shapes_are_refused(shape: tuple[int, ...]) -> None:
    with pytest.raises(InvalidInputError, match=r"^images must be a batch of RGB pictures"):
        pictures_of(torch.zeros(shape), name="images")


def test_a_picture_with_a_hole_in_its_numbers_is_refused() -> None:
    with pytest.raises(InvalidInputError, match="finite colours"):
        picture_of(torch.full((1, 2, 2, 3), torch.nan))


def test_a_mask_is_taken_from_its_batch() -> None:
    masks = torch.rand(3, 4, 5)
    assert np.array_equal(mask_of(masks, index=2), masks[2].numpy())
    assert np.array_equal(mask_of(masks[1]), masks[1].numpy())


def test_a_mask_beyond_the_batch_is_refused_by_name() -> None:
    with pytest.raises(InvalidInputError, match=r"^mask_index must be below the number of masks \(2\)\. Got: 2"):
        mask_of(torch.zeros(2, 4, 4), index=2)


def test_bytes_become_the_host_s_colours() -> None:
    frame = np.array([[[0, 51, 255]]], dtype=np.uint8)
    batch = batch_of_pictures([frame, frame], 2)
    assert batch.dtype == torch.float32
    assert batch.shape == (2, 1, 1, 3)
    assert torch.allclose(batch[1, 0, 0], torch.tensor([0.0, 0.2, 1.0]))


def test_floats_pass_unchanged_and_survive_a_round_trip() -> None:
    frames = np.random.default_rng(0).random((2, 3, 4, 3), dtype=np.float32)
    assert np.array_equal(pictures_of(batch_of_pictures(iter(frames), 2)), frames)


def test_grey_frames_become_colour() -> None:
    grey = np.array([[0.25, 0.5]], dtype=np.float32)
    assert batch_of_pictures([grey], 1)[0].tolist() == [[[0.25] * 3, [0.5] * 3]]


def test_masks_from_bools_and_bytes() -> None:
    bools, grey = np.array([[True, False]]), np.array([[255, 0]], dtype=np.uint8)
    assert batch_of_masks([bools, grey], 2).tolist() == [[[1.0, 0.0]], [[1.0, 0.0]]]


def test_missing_frames_are_noticed() -> None:
    with pytest.raises(InvalidInputError, match=r"3 frames were announced\. Got: 1"):
        batch_of_masks([np.zeros((2, 2))], 3)


def test_frames_are_asked_for_one_at_a_time() -> None:
    made: list[int] = []

    def frames():
        for number in range(3):
            made.append(number)
            yield np.full((1, 1), number, dtype=np.float32)
            assert len(made) == number + 1

    assert batch_of_masks(frames(), 3).flatten().tolist() == [0.0, 1.0, 2.0]
