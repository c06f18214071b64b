"""The options of the command line that choose networks."""

from __future__ import annotations

import argparse
from typing import Any

from .names import option_of

__all__ = ["CHOICES", "DTYPES", "INPAINTING_SETTINGS", "SVD_SETTINGS", "TOONCRAFTER_SETTINGS", "add_networks"]

# As in rendering/neural/options.py and in the settings of the models, whose rooms cost more than a help text may.
CHOICES = {
    "renderer": ("composite", "svd", "inpainting"),
    "interpolate_with": ("motion", "flow", "blend", "tooncrafter"),
    "extractor": ("gaussians", "informative"),
    "segmenter": ("grabcut", "sam"),
}
DTYPES = ("auto", "fp32", "fp16", "bf16")
SVD_SETTINGS = (
    "steps=25, motion_bucket=160, frames_per_second=6, picture_noise=0.0, overlap=4, area=184320, decoded_together=10,"
    " seed=0, follow=sketches, weak=0.32, strong=0.42, guidance=1.0"
)
INPAINTING_SETTINGS = (
    "prompt=, negative_prompt=, steps=25, strength=1.0, guidance=7.5, seed=0, shared_noise=True, area=None"
)
TOONCRAFTER_SETTINGS = (
    "steps=50, solver=ddim, eta=1.0, guidance=7.5, guidance_rescale=0.7, frame_rate=10, control_scale=0.1, area=163840,"
    " pairs_together=1, decoded_together=3, seed=0"
)

_MEMORY = (
    "Weights are files that you have: nothing is downloaded, and nothing in them is run. All of them are opened before"
    " the work. With fp16, SVD at 576 x 320 and ToonCrafter at 512 x 320 fit a GPU of 6 GB, and SVD takes 5.7 GiB of"
    " main memory; a smaller area or decoded_together needs less, fp32 twice as much. On a CPU a clip takes hours, and"
    " ToonCrafter 17 GB. Ctrl+C ends it after the step at work."
)


def add_networks(parser: argparse.ArgumentParser, *, points: bool, in_betweens: bool) -> None:
    """The options of networks.

    Args:
        parser: of a command.
        points: it cuts parts out at points.
        in_betweens: it fills frames in.
    """
    group = parser.add_argument_group("networks in place of what needs none", _MEMORY)

    def choice(name: str, text: str) -> None:
        group.add_argument(option_of(name), choices=CHOICES[name], help=f"{text} (default: {CHOICES[name][0]})")

    def file(name: str, text: str) -> None:
        group.add_argument(option_of(name), metavar="FILE", help=text)

    choice(
        "renderer",
        "who draws frames. svd: Stable Video Diffusion, after sketches, the paper's way, or after composite's frames,"
        " on opaque pictures; inpainting: composite, with what the parts have uncovered painted by Stable Diffusion, on"
        " opaque flat pictures",
    )
    file(
        "svd",
        "svd.safetensors (image to video, 14 frames), or the folder of its diffusers version, from"
        " huggingface.co/stabilityai/stable-video-diffusion-img2vid",
    )
    file(
        "lvcd",
        "lvcd.ckpt from huggingface.co/luckyhzt/lvcd_pretrained_models, or lvcd-fp16.safetensors from"
        " huggingface.co/Kijai/LVCD-pruned; needed only where svd follows sketches",
    )
    _add_settings(
        group,
        "--svd-options",
        SVD_SETTINGS,
        "; follow is sketches, animation (composite's frames; needs no LVCD, and its defaults are motion_bucket=17,"
        " picture_noise=0.02, guidance=3.0) or both; moving parts are held to the animation from the part weak to the"
        " part strong of the steps",
    )
    group.add_argument(
        "--still-parts",
        action=argparse.BooleanOptionalAction,
        help="with svd: take what no part ever covers from the illustration, to which the model would change a little"
        " (default: yes)",
    )
    group.add_argument(
        "--soft-edge",
        metavar="PX",
        type=float,
        help="width of the transition to still parts with svd (default: 24), around holes with inpainting (default:"
        " 16)",
    )
    _add_inpainting(group)
    if in_betweens:
        _add_in_betweens(group, choice, file)
        group.add_argument(
            "--close-loop",
            action=argparse.BooleanOptionalAction,
            help="with --loop: svd draws the last frames between the end and the beginning, for which it may need one"
            " segment more, and frames are also filled in between the last keyframe and the first (default: yes)",
        )
    group.add_argument(
        "--colour-match",
        metavar="SHARE",
        type=float,
        help="with svd or tooncrafter: how much of the model's colour drift is taken out, 0 to 1, by the colours of"
        " composite outside holes, or of the keyframes (default: 1)",
    )
    choice("extractor", "who draws the lines of sketches. informative: a network that draws them")
    file(
        "lines",
        "sk_model.pth, sk_model2.pth (informative drawings) or netG.pth (Anime2Sketch), from"
        " huggingface.co/lllyasviel/Annotators",
    )
    group.add_argument(
        "--lines-size",
        metavar="PX",
        type=int,
        help="longer side of the picture that the line network looks at; smaller gives fewer and bolder lines (default:"
        " the picture's)",
    )
    if points:
        choice("segmenter", "who cuts out the parts of --points. sam: a Segment Anything network")
        file("sam", "folder with config.json and .safetensors (SAM, SAM-HQ, SAM 2, EdgeTAM, SAM 3), or SAM's own .pth")
    group.add_argument(
        "--device", metavar="NAME", help="where networks compute: auto, cpu, cuda, cuda:1, mps (default: auto, a GPU)"
    )
    group.add_argument(
        "--dtype",
        choices=DTYPES,
        help="of weights and computing (default: auto, which is fp16 with cuda and fp32 elsewhere;"
        " for Segment Anything always fp32)",
    )


def _add_inpainting(group: argparse._ArgumentGroup) -> None:
    group.add_argument(
        "--inpainting",
        metavar="FOLDER",
        help="Stable Diffusion 1 or 2 in diffusers' format, best one for inpainting, such as"
        " huggingface.co/stable-diffusion-v1-5/stable-diffusion-inpainting; needs the package transformers",
    )
    _add_settings(
        group,
        "--inpainting-options",
        INPAINTING_SETTINGS,
        "; a prompt may have commas; less strength keeps holes closer to what composite shows there; without an area,"
        " that of the picture",
    )
    group.add_argument(
        "--grow",
        metavar="PX",
        type=float,
        help="with inpainting: how far holes reach beyond what parts have uncovered (default: 4); and the mask of"
        " --save-uncovered",
    )


def _add_in_betweens(group: argparse._ArgumentGroup, choice: Any, file: Any) -> None:
    choice("interpolate_with", "who fills frames in. tooncrafter: a video model, the paper's way")
    file(
        "tooncrafter",
        "model.ckpt from huggingface.co/Doubiiu/ToonCrafter, or its pruned fp16 safetensors from"
        " huggingface.co/Kijai/DynamiCrafter_pruned",
    )
    file("sketch_encoder", "ToonCrafter's sketch_encoder.ckpt, with which sketches lead the in-betweens")
    file("image_encoder", "CLIP-ViT-H-14's picture encoder, which the pruned file lacks")
    file("text_encoder", "Stable Diffusion 2.1's text encoder, which the pruned file lacks; needed once")
    _add_settings(group, "--tooncrafter-options", TOONCRAFTER_SETTINGS)


def _add_settings(group: argparse._ArgumentGroup, option: str, usual: str, more: str = "") -> None:
    group.add_argument(
        option,
        metavar="NAME=VALUE,...",
        help=f"settings, such as steps=12,seed=7; an area also as 576x320 [px]{more} (default: {usual})",
    )
