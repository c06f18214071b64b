"""Commands about training data and trained weights; nothing else of the command line knows of them."""

from __future__ import annotations

import argparse
from pathlib import Path

__all__ = ["add_training"]


def add_training(parser: argparse.ArgumentParser) -> None:
    """All that ``physanimator training`` takes."""
    parser.description = "Work with checkpoints of a training (python -m physanimator.rendering.training.lvcd)."
    commands = parser.add_subparsers(required=True, metavar="WHAT", parser_class=type(parser))
    export = commands.add_parser("export", help="write what was trained as one file that the nodes load")
    export.description = (
        "Write the trained weights of a checkpoint under the public checkpoint's names: for --lvcd and Render's LVCD"
        " file, or for --sketch-encoder and Interpolate's. The file tells which data, how many steps and which blur."
    )
    export.add_argument(
        "file", metavar="CHECKPOINT", help="folder of a checkpoint, such as OUTPUT/checkpoints/step_00010000"
    )
    export.add_argument("--output", "-o", metavar="OUT.safetensors", required=True, help="file to write")
    export.add_argument("--dtype", choices=("fp32", "fp16", "bf16"), default="fp16", help="precision (default: fp16)")
    export.add_argument(
        "--average",
        action=argparse.BooleanOptionalAction,
        help="write the moving average of the weights, or the last weights (default: the average where one is kept)",
    )
    export.set_defaults(run=_export)


def _export(options: argparse.Namespace) -> None:
    from ..training.export import export_checkpoint
    from .messages import say

    kind = export_checkpoint(Path(options.file), Path(options.output), dtype=options.dtype, average=options.average)
    option = "--lvcd" if kind == "lvcd" else "--sketch-encoder"
    say(f"{options.output}: give it to {option}")
