"""The training loop of both networks, over one device or many (Hugging Face's accelerate)."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import torch
from accelerate import Accelerator
from diffusers.training_utils import EMAModel
from torch import Tensor, nn
from torch.utils.data import DataLoader, Dataset

from ...physics.errors import InvalidInputError, PhysAnimatorError
from ..files import uninterrupted
from .checkpoints import Checkpoint, find_checkpoint, read_checkpoint_folder, write_checkpoint
from .drawing_lots import numbers_of_process
from .optimizer import learning_rate, made_optimizer, set_learning_rate
from .recomputing import recompute_stages
from .settings import TrainingSettings

__all__ = ["Task", "TrainingError", "train"]

Batch = dict[str, Tensor]


class TrainingError(PhysAnimatorError):
    """A training cannot go on."""


@dataclass(frozen=True, eq=False)
class Task:
    """What is trained, on what.

    Attributes:
        kind: ``lvcd`` or ``tooncrafter``.
        networks: their output is the loss of each clip of a batch; what is trained requires gradients, and has the
            names of the public checkpoint.
        samples: by number; endless.
        held_out: the same for clips that are not trained on; None where there are none.
        draw: writes a sample clip beside its truth into a folder, under a name; None where none is drawn.
    """

    kind: str
    networks: nn.Module
    samples: Dataset[Any]
    held_out: Dataset[Any] | None = None
    draw: Callable[[nn.Module, Path, str], Path] | None = None


def train(
    task: Task,
    settings: TrainingSettings,
    *,
    resume: str | None = None,
    say: Callable[[str], None] = lambda _: None,
) -> Path:
    """Train to the last step; Ctrl+C and a full disk leave what was learned in checkpoints.

    Args:
        task: what is trained.
        settings: of the run.
        resume: ``latest`` or a checkpoint's folder, to go on from.
        say: is told of progress, a line at a time, by the main process.

    Returns:
        The last checkpoint.

    Raises:
        InvalidInputError: settings or data are unusable, or a run is there already and ``resume`` is not given.
        TrainingError: the loss is not a number any more; the message names the step and the clips.
    """
    output = Path(settings.output)
    run = _Run(task, settings, output)
    step = run.resumed(resume)
    if step >= settings.steps:
        return run.saved(step)
    batches = run.batches(step)
    try:
        if settings.sample_every and step == 0:
            run.measure(step, say)  # what the training will be compared with
        while step < settings.steps:
            loss, norm = run.one_step(step, batches)
            with uninterrupted():
                run.updated()
                step += 1
            run.log(
                step, {"loss": loss, "gradient_norm": norm, "learning_rate": learning_rate(step - 1, settings)}, say
            )
            if settings.sample_every and step % settings.sample_every == 0:
                run.measure(step, say)
            if step % settings.checkpoint_every == 0 and step < settings.steps:
                run.saved(step)
        return run.saved(step)
    except KeyboardInterrupt:
        with uninterrupted():
            say(f"step {step}: stopped; kept in {run.saved(step)}")
        raise
    finally:
        run.end()


class _Run:
    """The parts of a run that change with every step."""

    def __init__(self, task: Task, settings: TrainingSettings, output: Path) -> None:
        self.task, self.settings, self.output = task, settings, output
        self.accelerator = Accelerator(
            mixed_precision=settings.precision,
            gradient_accumulation_steps=settings.accumulate,
            log_with="tensorboard" if _has_tensorboard() else None,
            project_dir=str(output),
        )
        self.device = self.accelerator.device
        if settings.gradient_checkpointing:
            recompute_stages(task.networks)
        self.trained = {name: each for name, each in task.networks.named_parameters() if each.requires_grad}
        self.networks = task.networks.to(self.device)
        parameters = list(self.trained.values())
        self.optimizer = made_optimizer(parameters, settings, self.device)
        self.average = EMAModel(parameters, decay=settings.ema, foreach=True) if settings.ema else None
        self.wrapped, self.optimizer = self.accelerator.prepare(self.networks, self.optimizer)

    def resumed(self, asked: str | None) -> int:
        """Take up a checkpoint, or begin; the step that comes next."""
        there = find_checkpoint(self.output, "latest")
        if asked is None:
            if there is not None:
                raise InvalidInputError(
                    f"output must be a folder without a run, or --resume latest given. Got: {self.output}, which has"
                    f" {there.name}"
                )
            self._begin()
            return 0
        place = find_checkpoint(self.output, asked)
        self._begin()
        if place is None:
            return 0
        found = read_checkpoint_folder(place)
        if found.state.get("kind") != self.task.kind or set(found.trained) != set(self.trained):
            raise InvalidInputError(
                f"resume must be a checkpoint of {self.task.kind} with these networks. Got: {place}"
            )
        with torch.no_grad():
            for name, parameter in self.trained.items():
                parameter.copy_(found.trained[name])
        self.optimizer.load_state_dict(found.optimizer["optimizer"])
        if self.accelerator.scaler is not None and found.optimizer.get("scaler"):
            self.accelerator.scaler.load_state_dict(found.optimizer["scaler"])
        if self.average is not None:
            self._resume_average(found)
        return int(found.state["step"])

    def _begin(self) -> None:
        if self.accelerator.is_main_process:
            self.output.mkdir(parents=True, exist_ok=True)
        told = {name: value for name, value in asdict(self.settings).items() if isinstance(value, int | float | str)}
        self.accelerator.init_trackers("logs", config=told)

    def _resume_average(self, found: Checkpoint) -> None:
        assert self.average is not None
        if found.average:
            kept = [found.average[name].to(self.device) for name in self.trained]
            self.average.shadow_params = kept
            self.average.optimization_step = int(found.state["average_steps"])
        else:
            self.average.shadow_params = [each.detach().clone() for each in self.trained.values()]

    def batches(self, step: int) -> Iterator[tuple[list[str], Batch]]:
        """The batches of this process, from a step on."""
        settings, accelerator = self.settings, self.accelerator
        first, last = (each * settings.accumulate for each in (step, settings.steps))
        numbers = numbers_of_process(
            first, last, batch=settings.batch, process=accelerator.process_index, processes=accelerator.num_processes
        )
        loader = DataLoader(
            self.task.samples,
            batch_sampler=list(numbers) if settings.workers == 0 else _Numbers(numbers),
            num_workers=settings.workers,
            collate_fn=_together,
            pin_memory=self.device.type == "cuda",
            persistent_workers=False,
        )
        return iter(loader)

    def one_step(self, step: int, batches: Iterator[tuple[list[str], Batch]]) -> tuple[float, float]:
        """Gradients of one step; the mean loss and the gradients' norm."""
        set_learning_rate(self.optimizer, learning_rate(step, self.settings))
        found, norm = [], 0.0
        for _ in range(self.settings.accumulate):
            names, batch = next(batches)
            with self.accelerator.accumulate(self.wrapped):
                loss = self.wrapped(
                    **{name: each.to(self.device, non_blocking=True) for name, each in batch.items()}
                ).mean()
                self._check(loss, step, names)
                self.accelerator.backward(loss)
                found.append(loss.detach().float())
        if self.settings.clip:
            norm = float(self.accelerator.clip_grad_norm_(self.trained.values(), self.settings.clip))
        else:
            norm = float(
                nn.utils.get_total_norm([each.grad for each in self.trained.values() if each.grad is not None])
            )
        return float(self.accelerator.reduce(torch.stack(found).mean(), "mean")), norm

    def _check(self, loss: Tensor, step: int, names: Sequence[str]) -> None:
        if not torch.isfinite(loss):
            value = float(loss.detach())
            raise TrainingError(
                f"the loss must stay a number; at step {step} it became {value} on {', '.join(names)}; a lower"
                " learning_rate, or bf16 in place of fp16, may help"
            )

    def updated(self) -> None:
        """Let the optimizer take its step."""
        self.optimizer.step()
        self.optimizer.zero_grad(set_to_none=True)
        if self.average is not None:
            self.average.step(self.trained.values())

    def log(self, step: int, values: Mapping[str, float], say: Callable[[str], None]) -> None:
        """To tensorboard, to a file, and to whoever watches."""
        self.accelerator.log(dict(values), step=step)
        if not self.accelerator.is_main_process:
            return
        with (self.output / "log.jsonl").open("a", encoding="utf-8") as file:
            file.write(json.dumps({"step": step, **values}) + "\n")
        if "loss" in values:
            say(f"step {step}: loss {values['loss']:.4g}, gradient {values['gradient_norm']:.3g}")
        else:
            say(f"step {step}: " + ", ".join(f"{name} {value:.4g}" for name, value in values.items()))

    def measure(self, step: int, say: Callable[[str], None]) -> None:
        """The loss on held-out clips, and a sample clip beside its truth; by the main process."""
        if self.accelerator.is_main_process:
            with self._averaged():
                if self.task.held_out is not None:
                    self.log(step, {"held_out_loss": self._held_out_loss()}, say)
                if self.task.draw is not None and self.settings.sample_steps:
                    file = self.task.draw(self.networks, self.output / "samples", f"step_{step:08d}")
                    say(f"step {step}: sample in {file}")
                    self._show(file, step)
        self.accelerator.wait_for_everyone()

    @torch.no_grad()
    def _held_out_loss(self) -> float:
        assert self.task.held_out is not None
        losses = []
        for number in range(self.settings.samples):
            _, batch = _together([self.task.held_out[number]])
            with self.accelerator.autocast():
                losses.append(self.networks(**{name: each.to(self.device) for name, each in batch.items()}).mean())
        return float(torch.stack(losses).mean())

    def _averaged(self) -> _Averaged:
        return _Averaged(self.average, list(self.trained.values()))

    def _show(self, file: Path, step: int) -> None:
        from ..pictures import read_clip

        for tracker in self.accelerator.trackers:
            if tracker.name == "tensorboard":
                frames = torch.stack([torch.from_numpy(each.copy()) for each in read_clip(file)])
                tracker.log_images(
                    {"sample": frames[:: max(len(frames) // 4, 1)].numpy()}, step=step, dataformats="NHWC"
                )

    def saved(self, step: int) -> Path:
        """Write a checkpoint; by the main process."""
        place = self.output / "checkpoints" / f"step_{step:08d}"
        if self.accelerator.is_main_process:
            average = {} if self.average is None else dict(zip(self.trained, self.average.shadow_params, strict=True))
            scaler = self.accelerator.scaler
            state = {
                "kind": self.task.kind,
                "step": step,
                "average_steps": 0 if self.average is None else self.average.optimization_step,
                "settings": asdict(self.settings),
            }
            optimizer = {
                "optimizer": self.optimizer.state_dict(),
                "scaler": None if scaler is None else scaler.state_dict(),
            }
            place = write_checkpoint(
                self.output, Checkpoint(state, self.trained, average, optimizer), keep=self.settings.keep
            )
        self.accelerator.wait_for_everyone()
        return place

    def end(self) -> None:
        """Close the log."""
        self.accelerator.end_training()


class _Averaged:
    """The moving average in place of the weights, meanwhile."""

    def __init__(self, average: EMAModel | None, parameters: list[nn.Parameter]) -> None:
        self.average, self.parameters = average, parameters

    def __enter__(self) -> None:
        if self.average is not None:
            self.average.store(self.parameters)
            self.average.copy_to(self.parameters)

    def __exit__(self, *_: object) -> None:
        if self.average is not None:
            self.average.restore(self.parameters)


class _Numbers:
    """Lists of numbers that a loader of several processes may go through once."""

    def __init__(self, numbers: Iterator[list[int]]) -> None:
        self.numbers = numbers

    def __iter__(self) -> Iterator[list[int]]:
        return self.numbers


def _together(samples: Sequence[tuple[str, Batch]]) -> tuple[list[str], Batch]:
    """A batch of samples, and the names of their clips."""
    names = [name for name, _ in samples]
    return names, {key: torch.stack([each[key] for _, each in samples]) for key in samples[0][1]}


def _has_tensorboard() -> bool:
    from accelerate.utils import is_tensorboard_available

    return bool(is_tensorboard_available())
