"""The command line's options of materials and of how they are integrated."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..physics_options import PhysicsOptions

__all__ = ["STROKES_AS", "add_physics", "physics_of"]

STROKES_AS = ("acceleration", "force", "vertex_force")
"""Choices of ``Scene.strokes_as``, without the time that it takes to load scenes."""

_VALUES = {
    "mu": ("MU", "Lame parameter mu of the paper, with --lambda, instead of preset stiffness and sway"),
    "lambda": ("LAMBDA", "Lame parameter lambda of the paper; 0 for no resistance to a change of area"),
    "youngs-modulus": ("E", "Young's modulus instead [density side^2/s^2]"),
    "poisson-ratio": ("NU", "Poisson's ratio, 0 to 0.5 (default: the preset's)"),
    "density": ("RHO", "mass for its size; 1 is ordinary"),
    "damping": ("RATE", "how fast motion dies away [1/s]; 0 never, as in the paper"),
    "stretch-limit": ("TIMES", "how many times as far as drawn a point gets from what is held; 0 for no limit"),
    "wind-response": ("FACTOR", "how strongly wind and strokes act"),
    "root-stiffness": ("TIMES", "how many times as stiff parts are where they are held as at their tips; 1 alike"),
}


def add_physics(parser: argparse.ArgumentParser) -> None:
    """Options of what parts are made of and of how their motion is computed."""
    made = parser.add_argument_group(
        "what parts are made of",
        "One number for all parts or one for each, instead of what --preset and --scene say. Young's modulus E and"
        " Poisson's ratio NU stand for mu = E / (2 (1 + NU)) and lambda = E NU / ((1 + NU) (1 - 2 NU)).",
    )
    for name, (shown, text) in _VALUES.items():
        made.add_argument(f"--{name}", metavar=shown, type=float, action="extend", nargs="+", help=text)
    computed = parser.add_argument_group("how the motion is computed")
    computed.add_argument(
        "--time-step",
        metavar="SECONDS",
        type=float,
        help="step of plain semi-implicit Euler, all forces evaluated in each; 0.001 in the paper. Refused where it is"
        " unstable, with the longest that is not. 0: steps follow from the mesh (default, unless the scene has one)",
    )
    computed.add_argument(
        "--strokes-as",
        choices=STROKES_AS,
        help="what strengths of strokes and wind are: an acceleration (default), a force on the area, which moves"
        " density 4 a quarter as far, or a force on each vertex, as the paper writes",
    )
    computed.add_argument(
        "--sag",
        action=argparse.BooleanOptionalAction,
        help="parts are drawn without their weight, so that gravity makes them sag (default: as the scene says)",
    )


def physics_of(options: argparse.Namespace) -> PhysicsOptions:
    """What was said of materials and of the computation.

    Raises:
        InvalidInputError: a value is none that may be.
    """
    from ..physics_options import PhysicsOptions

    values = {name.replace("-", "_"): getattr(options, name.replace("-", "_")) for name in _VALUES}
    values["lambda_"] = values.pop("lambda")
    return PhysicsOptions(**values, time_step=options.time_step, strokes_as=options.strokes_as, sag=options.sag)
