"""That training trains: from files to lower losses on clips that it never saw, and by means of the sketches."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import torch
from accelerate.state import AcceleratorState
from physanimator.rendering.training import TrainingSettings, kept_clips, lvcd
from physanimator.rendering.training.checkpoints import read_checkpoint_folder
from physanimator.rendering.training.encoding import encode_for_svd
from physanimator.rendering.training.lvcd_networks import LVCDNetworks, lvcd_networks
from physanimator.rendering.training.lvcd_samples import LVCDSamples
from physanimator.rendering.training.settings import as_toml
from training_data import small_svd, write_data

STEPS = 200
MEASURED = 40


def test_training_halves_the_loss_on_unseen_clips_and_needs_the_right_sketches(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    svd = small_svd(tmp_path / "svd.safetensors", monkeypatch)
    settings = TrainingSettings(
        svd=str(svd),
        frames=3,
        steps=STEPS,
        accumulate=1,
        batch=4,
        learning_rate=5e-3,
        precision="no",
        gradient_checkpointing=False,
        workers=0,
        checkpoint_every=10_000,
        sample_every=0,
        ema=0.0,
        held_out=0.0,
    )
    unseen = write_data(tmp_path / "unseen", clips=16, side=32)
    encode_for_svd(unseen, svd)
    samples = LVCDSamples(unseen, kept_clips(unseen)[12:], replace(settings, seed=1))
    untrained = lvcd_networks(svd)
    before = loss_of(untrained, samples)
    losses = {}
    for name in ("right", "shuffled"):
        data = write_data(tmp_path / name, clips=12, side=32, shuffled=name == "shuffled")
        encode_for_svd(data, svd)
        run = replace(settings, data=str(data), output=str(tmp_path / f"run_{name}"))
        (tmp_path / f"{name}.toml").write_text(as_toml(run))
        AcceleratorState._reset_state(reset_partial_state=True)
        assert lvcd.main(["--config", str(tmp_path / f"{name}.toml")]) == 0
        trained = lvcd_networks(svd)
        kept = read_checkpoint_folder(tmp_path / f"run_{name}" / "checkpoints" / f"step_{STEPS:08d}").trained
        trained.load_state_dict(dict(kept), strict=False)
        losses[name] = loss_of(trained, samples)
    assert losses["right"] < before / 2
    assert losses["right"] < losses["shuffled"]


@torch.no_grad()
def loss_of(networks: LVCDNetworks, samples: LVCDSamples) -> float:
    """Mean loss on the same samples, with the same noise, whatever the networks."""
    drawn = [samples[number][1] for number in range(MEASURED)]
    return float(networks(**{key: torch.stack([each[key] for each in drawn]) for key in drawn[0]}).mean())
