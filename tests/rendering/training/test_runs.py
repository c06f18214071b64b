"""Runs through the real command: they learn, stop, go on to the bit, and lose nothing."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import random_networks
import torch
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.inbetweens import interpolate
from physanimator.rendering.svd.models import load_models
from physanimator.rendering.tooncrafter import ToonCrafterOptions
from physanimator.rendering.tooncrafter.interpolator import ToonCrafterInterpolator
from physanimator.rendering.tooncrafter.models import ToonCrafterModels
from physanimator.rendering.tooncrafter.models import load_models as load_tooncrafter
from physanimator.rendering.training import TrainingSettings, checkpoints, lvcd, tooncrafter
from physanimator.rendering.training.checkpoints import find_checkpoint, read_checkpoint_folder
from physanimator.rendering.training.encoding import encode_for_svd, encode_for_tooncrafter
from physanimator.rendering.training.export import export_checkpoint
from physanimator.rendering.training.settings import PRESETS, as_toml, read_settings
from safetensors import safe_open
from safetensors.torch import load_file
from training_data import write_data

Files = dict[str, Path]


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Files:
    folder = tmp_path_factory.mktemp("training")
    made = random_networks.write(folder / "networks", "folder") | {"data": write_data(folder / "data", clips=3)}
    encode_for_svd(made["data"], made["svd"])
    encode_for_tooncrafter(made["data"], made["tooncrafter"])
    return made


@pytest.fixture
def settings(files: Files, tmp_path: Path) -> TrainingSettings:
    return TrainingSettings(
        data=str(files["data"]),
        output=str(tmp_path / "run"),
        svd=str(files["svd"]),
        tooncrafter=str(files["tooncrafter"]),
        frames=3,
        steps=4,
        accumulate=1,
        precision="no",
        gradient_checkpointing=False,
        workers=0,
        checkpoint_every=2,
        sample_every=0,
        ema=0.9,
        learning_rate=1e-3,
        licence="CC0",
    )


def config(settings: TrainingSettings, path: Path) -> str:
    path.write_text(as_toml(settings), encoding="utf-8")
    return str(path)


def run(settings: TrainingSettings, tmp_path: Path, *more: str) -> int:
    from accelerate.state import AcceleratorState

    AcceleratorState._reset_state(reset_partial_state=True)
    return lvcd.main(["--config", config(settings, tmp_path / f"{Path(settings.output).name}.toml"), *more])


def test_a_run_that_was_interrupted_ends_in_the_same_weights(settings: TrainingSettings, tmp_path: Path) -> None:
    assert run(settings, tmp_path) == 0
    halves = replace(settings, output=str(tmp_path / "halves"))
    assert run(replace(halves, steps=2), tmp_path) == 0
    assert run(halves, tmp_path, "--resume", "latest") == 0
    whole, again = (
        read_checkpoint_folder(tmp_path / name / "checkpoints" / "step_00000004") for name in ("run", "halves")
    )
    first = read_checkpoint_folder(tmp_path / "run" / "checkpoints" / "step_00000002")
    for name, tensor in whole.trained.items():
        assert torch.equal(tensor, again.trained[name]), name
        assert torch.equal(whole.average[name], again.average[name]), name
    assert any(not torch.equal(tensor, first.trained[name]) for name, tensor in whole.trained.items())
    assert any(not torch.equal(tensor, whole.average[name]) for name, tensor in whole.trained.items())
    one, other = (each.optimizer["optimizer"]["state"] for each in (whole, again))
    assert all(torch.equal(one[key]["exp_avg_sq"], other[key]["exp_avg_sq"]) for key in one)


def test_a_run_is_not_begun_over_another(
    settings: TrainingSettings, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(replace(settings, steps=1), tmp_path) == 0
    kept = read_checkpoint_folder(tmp_path / "run" / "checkpoints" / "step_00000001")
    assert run(settings, tmp_path) == 2
    assert "output must be a folder without a run, or --resume latest given" in capsys.readouterr().err
    assert kept.state == read_checkpoint_folder(tmp_path / "run" / "checkpoints" / "step_00000001").state


def test_the_newest_checkpoints_are_kept(settings: TrainingSettings, tmp_path: Path) -> None:
    assert run(replace(settings, checkpoint_every=1, keep=2), tmp_path) == 0
    assert sorted(each.name for each in (tmp_path / "run" / "checkpoints").iterdir()) == [
        "step_00000003",
        "step_00000004",
    ]


def test_ctrl_c_keeps_what_was_learned(settings: TrainingSettings, tmp_path: Path) -> None:
    endless = replace(settings, steps=100_000, checkpoint_every=100_000)
    program = (
        "import sys; sys.argv = ['physanimator']; from physanimator.rendering.training import lvcd;"
        f" sys.exit(lvcd.main(['--config', {config(endless, tmp_path / 'run.toml')!r}]))"
    )
    folder = Path(lvcd.__file__).parents[3]
    environment = os.environ | {"PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1"}
    with subprocess.Popen(
        [sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment
    ) as training:
        assert training.stdout is not None
        for line in training.stdout:
            if line.startswith("step 2:"):
                break
        training.send_signal(signal.SIGINT)
        rest, errors = training.communicate(timeout=120)
    assert training.returncode == 130, errors
    assert "stopped; kept in" in rest
    found = find_checkpoint(tmp_path / "run", "latest")
    assert found is not None
    assert read_checkpoint_folder(found).state["step"] >= 2


def test_a_full_disk_loses_no_earlier_checkpoint(
    settings: TrainingSettings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(replace(settings, steps=1), tmp_path) == 0
    before = read_checkpoint_folder(tmp_path / "run" / "checkpoints" / "step_00000001")

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(checkpoints.torch, "save", full)
    assert run(replace(settings, keep=1), tmp_path, "--resume", "latest") == 1
    assert "No space left on device" in capsys.readouterr().err
    monkeypatch.undo()
    assert [each.name for each in (tmp_path / "run" / "checkpoints").iterdir()] == ["step_00000001"]
    after = read_checkpoint_folder(tmp_path / "run" / "checkpoints" / "step_00000001")
    assert all(torch.equal(each, after.trained[name]) for name, each in before.trained.items())


def test_a_loss_that_is_no_number_ends_with_the_clips_names(
    settings: TrainingSettings, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(replace(settings, learning_rate=10.0, clip=0.0, steps=200, checkpoint_every=1000), tmp_path) == 1
    said = capsys.readouterr().err
    assert "the loss must stay a number; at step" in said
    assert "disc_0" in said


def test_exported_weights_draw_as_the_public_ones_do(settings: TrainingSettings, tmp_path: Path, files: Files) -> None:
    assert run(replace(settings, steps=1), tmp_path) == 0
    place = tmp_path / "run" / "checkpoints" / "step_00000001"
    assert export_checkpoint(place, tmp_path / "mine.safetensors", dtype="fp32", average=False) == "lvcd"
    models = load_models(files["svd"], tmp_path / "mine.safetensors")
    trained = load_file(place / "trained.safetensors")
    own = {f"control_model.{name}": each for name, each in models.control.state_dict().items()}
    own |= {f"model.diffusion_model.{name}": each for name, each in models.unet.state_dict().items()}
    assert all(torch.equal(own[name], each) for name, each in trained.items())
    with safe_open(tmp_path / "mine.safetensors", framework="pt") as opened:
        told = opened.metadata()
    assert told["physanimator.steps"] == "1"
    assert told["physanimator.data"] == files["data"].name
    assert json.loads(told["physanimator.blur"]) == [0.0, 3.0]
    assert told["physanimator.licence"] == "CC0"
    # What was exported is a start, too.
    onward = replace(settings, output=str(tmp_path / "onward"), start=str(tmp_path / "mine.safetensors"), steps=1)
    assert run(onward, tmp_path) == 0


def test_the_interpolations_controlnet_is_trained_sampled_and_exported(
    settings: TrainingSettings, tmp_path: Path, files: Files, monkeypatch: pytest.MonkeyPatch
) -> None:
    short = replace(
        settings, start=str(files["sketch_encoder"]), frames=0, steps=1, sample_every=1, sample_steps=1, samples=1
    )
    assert tooncrafter.main(["--config", config(short, tmp_path / "run.toml")]) == 0
    assert (tmp_path / "run" / "samples" / "step_00000001.mp4").is_file()
    lines = [json.loads(each) for each in (tmp_path / "run" / "log.jsonl").read_text().splitlines()]
    assert [each["step"] for each in lines if "held_out_loss" in each] == [0, 1]
    place = tmp_path / "run" / "checkpoints" / "step_00000001"
    exported = tmp_path / "sketch.safetensors"
    exported.with_name("sketch.sizes.json").write_bytes(
        files["sketch_encoder"].with_name("sketch_encoder.sizes.json").read_bytes()
    )
    assert export_checkpoint(place, exported, dtype="fp32") == "tooncrafter"
    models = load_tooncrafter(files["tooncrafter"], sketch=exported)
    assert models.sketch is not None
    average = load_file(place / "average.safetensors")
    own = models.sketch.state_dict()
    assert all(torch.equal(own[name.removeprefix("control_model.")], each) for name, each in average.items())
    frames = [
        in_betweens(load_tooncrafter(files["tooncrafter"], sketch=each)) for each in (files["sketch_encoder"], exported)
    ]
    assert all(np.isfinite(each).all() for each in frames)
    assert np.abs(frames[0] - frames[1]).max() > 0


def in_betweens(models: ToonCrafterModels) -> np.ndarray:
    """Two in-betweens that the Interpolate node's backend draws with these networks."""
    chance = np.random.default_rng(0)
    keyframes = list(chance.random((2, 64, 64, 3), dtype=np.float32))
    lines = list((chance.random((4, 64, 64)) < 0.8).astype(np.float32))
    options = ToonCrafterOptions(steps=1, area=64 * 64, guidance=1.0, control_scale=1.0)
    drawn = interpolate(keyframes, [0, 3], backend=ToonCrafterInterpolator(models, options=options), sketches=lines)
    return np.stack(list(drawn)[1:3])


def test_sample_clips_show_truth_and_drawing_side_by_side(settings: TrainingSettings, tmp_path: Path) -> None:
    from physanimator.rendering.pictures import read_clip

    assert run(replace(settings, steps=1, sample_every=1, sample_steps=2, samples=1), tmp_path) == 0
    frames = list(read_clip(tmp_path / "run" / "samples" / "step_00000001.mp4"))
    assert len(frames) == 15
    assert frames[0].shape == (64, 128, 3)


def test_two_processes_take_the_step_of_one_with_twice_the_batch(settings: TrainingSettings, tmp_path: Path) -> None:
    assert run(replace(settings, batch=2, steps=1, learning_rate=1e-5), tmp_path) == 0
    two = config(replace(settings, learning_rate=1e-5, output=str(tmp_path / "two"), steps=1), tmp_path / "two.toml")
    program = tmp_path / "program.py"
    program.write_text(
        f"import sys\nfrom physanimator.rendering.training import lvcd\nsys.exit(lvcd.main(['--config', {two!r}]))\n"
    )
    folder = Path(lvcd.__file__).parents[3]
    environment = os.environ | {"PYTHONPATH": str(folder), "OMP_NUM_THREADS": "1", "ACCELERATE_USE_CPU": "true"}
    done = subprocess.run(
        [sys.executable, "-m", "torch.distributed.run", "--standalone", "--nproc-per-node=2", str(program)],
        capture_output=True,
        text=True,
        env=environment,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr[-3000:]
    one, both = (
        load_file(tmp_path / name / "checkpoints" / "step_00000001" / "trained.safetensors") for name in ("run", "two")
    )
    for name, tensor in one.items():
        assert float((tensor - both[name]).abs().max()) < 1e-6, name


@pytest.mark.parametrize("preset", sorted(PRESETS))
@pytest.mark.parametrize("kind", ["lvcd", "tooncrafter"])
def test_a_written_file_is_read_back_as_its_preset(tmp_path: Path, preset: str, kind: str) -> None:
    main: Callable[[list[str]], int] = {"lvcd": lvcd.main, "tooncrafter": tooncrafter.main}[kind]
    file = tmp_path / "config.toml"
    assert main(["--write-config", str(file), "--preset", preset]) == 0
    text = file.read_text()
    for name, value in (("data", "data"), ("output", "out"), ("svd", "svd"), ("tooncrafter", "tc"), ("start", "s")):
        text = text.replace(f'\n{name} = ""', f'\n{name} = "{value}"')
    file.write_text(text)
    assert main(["--write-config", str(file), "--preset", preset]) == 2  # what was filled in stays
    found = read_settings(file, kind, preset)
    placed = {"data": "data", "output": "out", "svd": "svd", "tooncrafter": "tc", "start": "s"}
    assert found == replace(PRESETS[preset][kind], **{name: str(tmp_path / each) for name, each in placed.items()})


def test_the_papers_values_are_a_preset() -> None:
    for kind, steps in (("lvcd", 10_000), ("tooncrafter", 50_000)):
        paper, card = PRESETS["paper"][kind], PRESETS["24gb"][kind]
        assert (paper.steps, paper.learning_rate, 8 * paper.batch * paper.accumulate) == (steps, 1e-5, 32)
        assert card.batch * card.accumulate == 32
        assert card.eight_bit
        assert card.gradient_checkpointing


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("steps = 0", "steps must be"),
        ("steps = true", "steps must be"),
        ("frames = 1", "frames must be 0, or at least 2"),
        ("learning_rate = nan", "learning_rate must be a number from 0 to 10. Got: nan"),
        ("clip = -inf", "clip must be a number of at least 0"),
        ("licence = 5", "licence must be text"),
        ("eight_bit = 1", "eight_bit must be true or false"),
        ("learning_rate = -1", "learning_rate must be"),
        ("least_blur = 3\nmost_blur = 1", "most_blur must be"),
        ("precision = 'half'", "precision must be one of no, fp16, bf16"),
        ("colour = 3", "must have no other settings than --write-config lists. Got: colour"),
        ("steps = ", "must be TOML"),
        (f"steps = {'9' * 5000}", "must be TOML"),
        ("steps = 3", "must name data"),
        ("data = 'd'\noutput = 'o'", "must name svd"),
    ],
)
def test_unusable_settings_are_named(tmp_path: Path, text: str, sentence: str) -> None:
    (tmp_path / "config.toml").write_text(text)
    with pytest.raises(InvalidInputError, match=sentence):
        read_settings(tmp_path / "config.toml", "lvcd")


def test_a_byte_order_mark_before_the_settings_is_no_fault(tmp_path: Path) -> None:
    (tmp_path / "config.toml").write_text("data = 'd'\noutput = 'o'\nsvd = 's'\n", encoding="utf-8-sig")
    assert read_settings(tmp_path / "config.toml", "lvcd").data == str(tmp_path / "d")


def test_moments_of_eight_bits_need_cuda(
    settings: TrainingSettings, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if torch.cuda.is_available():
        pytest.skip("there is a CUDA device")
    assert run(replace(settings, eight_bit=True), tmp_path) == 2
    assert "eight_bit must be false where there is no CUDA device" in capsys.readouterr().err


@pytest.mark.parametrize("main", [lvcd.main, tooncrafter.main])
def test_without_accelerate_it_says_what_to_install(
    main: Callable[[list[str]], int], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "accelerate", None)
    assert main(["--config", "config.toml"]) == 2
    assert "pip install 'physanimator[train]'" in capsys.readouterr().err
