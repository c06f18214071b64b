"""That training trains, by the real commands: from films to weights that render, better on clips that it never saw."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import numpy as np
import pytest
import torch
from accelerate.state import AcceleratorState
from command_status import status
from physanimator.rendering.pictures import read_clip, save_image
from physanimator.rendering.svd import SVDOptions
from physanimator.rendering.svd.models import load_models
from physanimator.rendering.svd.renderer import SVDRenderer
from physanimator.rendering.training import TrainingSettings, kept_clips, lvcd
from physanimator.rendering.training.clip_writing import write_clip
from physanimator.rendering.training.data_folder import sketch_file
from physanimator.rendering.training.encoded_clips import frames_of, line_frames
from physanimator.rendering.training.lvcd_networks import LVCDNetworks, lvcd_networks
from physanimator.rendering.training.lvcd_samples import LVCDSamples
from physanimator.rendering.training.settings import as_toml
from small_videos import write_video
from training_data import small_svd, striped_oval, striped_shot

STEPS = 200
MEASURED = 48
STRONG_NOISE = 10.0
"""A level at which latents tell nothing: where things are is in the sketches alone."""

SEED = int(os.environ.get("LEARNING_SEED", "0"))
"""Of both runs; another one shows how much is luck."""


def test_training_halves_the_loss_on_unseen_clips_and_needs_the_right_sketches(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    svd = small_svd(tmp_path / "svd.safetensors", monkeypatch)
    films = [write_film(tmp_path / f"film_{number}.mp4", 10 * number) for number in range(3)]
    right, shuffled, other, simulated = (tmp_path / name for name in ("right", "shuffled", "other", "simulated"))
    build = ("dataset", "build", "--size", "64x64", "--workers", "1", "--quiet", "--output")
    assert status(*build, str(right), str(films[0]), str(films[1])) == 0
    assert status(*build, str(other), str(films[2])) == 0
    assert status("dataset", "simulate", *lantern(tmp_path), "--output", str(simulated), "--clips", "2", "-q") == 0
    for data in (right, other, simulated):
        assert status("dataset", "encode", str(data), "--svd", str(svd), "--device", "cpu", "--quiet") == 0
    shutil.copytree(right, shuffled)
    exchange_sketches(shuffled)
    networks = {"untrained": lvcd_networks(svd)}
    for data in (right, shuffled):
        networks[data.name] = lvcd_networks(svd, trained_file(data, svd))
    for data in (simulated, other):
        batch = samples_of(data)
        drawn_levels = {name: loss_of(each, batch) for name, each in networks.items()}
        strong = {name: loss_of(each, batch, STRONG_NOISE) for name, each in networks.items()}
        print(f"LEARNED seed {SEED}, {data.name}: {drawn_levels}, at strong noise {strong}")
        assert drawn_levels["right"] < 0.5 * drawn_levels["untrained"]
        assert strong["right"] < 0.35 * strong["untrained"]
        assert strong["right"] < 0.8 * strong["shuffled"]
    drawn = [drawn_frames(svd, tmp_path, simulated, name) for name in ("start", "right")]
    assert all(np.isfinite(each).all() for each in drawn)
    assert np.abs(drawn[1] - drawn[0]).mean() > 0.01


def write_film(path: Path, seed: int) -> Path:
    return write_video(path, *(striped_shot(seed + shot, 26) for shot in range(5)))


def lantern(folder: Path) -> tuple[str, ...]:
    """A picture of an oval and its mask, as options of the simulator."""
    picture, inside = striped_oval(128, np.array([34.0, 42.0]), 0.3, stripe=2)
    save_image(folder / "lantern.png", picture)
    save_image(folder / "oval.png", (255 * inside).astype(np.uint8))
    small = ("--size", "64x64", "--frames", "24", "--seed", "3")
    return (str(folder / "lantern.png"), "--mask", str(folder / "oval.png"), *small)


def exchange_sketches(data: Path) -> None:
    """Give each clip the sketches of the next, from the beginning again where it has fewer."""
    clips = kept_clips(data)
    drawn = [list(read_clip(sketch_file(data, each.name))) for each in clips]
    for number, clip in enumerate(clips):
        other = drawn[(number + 1) % len(drawn)]
        write_clip((other[frame % len(other)] for frame in range(clip.frames)), sketch_file(data, clip.name), clip.fps)


def settings_of(data: Path, svd: Path) -> TrainingSettings:
    return TrainingSettings(
        data=str(data),
        output=str(data.with_name(f"run_{data.name}")),
        svd=str(svd),
        frames=2,
        steps=STEPS,
        accumulate=1,
        batch=2,
        learning_rate=1e-2,
        precision="no",
        gradient_checkpointing=False,
        most_blur=1.0,
        workers=0,
        checkpoint_every=10_000,
        sample_every=0,
        ema=0.97,
        held_out=0.0,
        seed=SEED,
    )


def trained_file(data: Path, svd: Path) -> Path:
    """Train on a data folder, and export what was learned."""
    settings = settings_of(data, svd)
    config, exported = data.with_suffix(".toml"), data.with_suffix(".safetensors")
    config.write_text(as_toml(settings), encoding="utf-8")
    AcceleratorState._reset_state(reset_partial_state=True)
    assert lvcd.main(["--config", str(config)]) == 0
    checkpoint = Path(settings.output) / "checkpoints" / f"step_{STEPS:08d}"
    assert status("training", "export", str(checkpoint), "--output", str(exported), "--dtype", "fp32") == 0
    return exported


def samples_of(data: Path) -> dict[str, torch.Tensor]:
    """The same samples, with the same noise, whatever the networks."""
    settings = TrainingSettings(frames=2, most_blur=1.0, seed=100)
    samples = LVCDSamples(data, kept_clips(data), settings)
    drawn = [samples[number][1] for number in range(MEASURED)]
    return {key: torch.stack([each[key] for each in drawn]) for key in drawn[0]}


@torch.no_grad()
def loss_of(networks: LVCDNetworks, batch: dict[str, torch.Tensor], sigma: float | None = None) -> float:
    """Mean loss, at the noise levels that were drawn or at one of all samples."""
    levels = {} if sigma is None else {"sigma": torch.full((MEASURED,), sigma)}
    return float(networks(**batch | levels).mean())


def drawn_frames(svd: Path, folder: Path, data: Path, name: str) -> np.ndarray:
    """Frames that the Render node's renderer draws with a file of weights."""
    if name == "start":
        settings = settings_of(folder / "start", svd)
        save_start(svd, folder / "start.safetensors", settings.seed)
    models = load_models(svd, folder / f"{name}.safetensors")
    clip = kept_clips(data)[0].name
    picture = frames_of(data / "clips" / f"{clip}.mp4", [0])[0].astype(np.float32) / 255
    lines = [1 - each for each in line_frames(data, clip, range(2))]
    renderer = SVDRenderer(models, options=SVDOptions(steps=2, area=64 * 64))
    return np.stack(list(renderer.frames(picture, lines)))


def save_start(svd: Path, file: Path, seed: int) -> None:
    """The networks as a training begins, as a file."""
    from safetensors.torch import save_file

    networks = lvcd_networks(svd, seed=seed)
    save_file({name: each.detach() for name, each in networks.named_parameters() if each.requires_grad}, file)
