"""The published workflows that hand a motion to the host's own video models."""

from __future__ import annotations

import copy
from typing import Any

from graphs import BLUE, GREEN, ORANGE, PURPLE, TEAL, Column, Group, Node, core, ours
from time_to_move_graphs import time_to_move, time_to_move_core

__all__ = [
    "AVOIDED",
    "COMMON_FILES",
    "PROMPT",
    "VIDEO_MODEL_WORKFLOWS",
    "conditions",
    "led_by",
    "models",
    "painted",
    "sampled_in_two",
    "two_unets",
    "without_video_model",
]

_REPACKAGED = "https://huggingface.co/Comfy-Org/Wan_{}_ComfyUI_{}/tree/main/split_files"
_WAN_21, _WAN_22 = _REPACKAGED.format("2.1", "repackaged"), _REPACKAGED.format("2.2", "Repackaged")
_ENCODER, _VAE, _VISION = (
    "umt5_xxl_fp8_e4m3fn_scaled.safetensors",
    "wan_2.1_vae.safetensors",
    "clip_vision_h.safetensors",
)
_CHECKPOINT = "512-inpainting-ema.safetensors"
COMMON_FILES = f"""\
- `models/text_encoders/{_ENCODER}` and `models/vae/{_VAE}` from {_WAN_21}"""
_LENGTH = """\
**Length and size:** 81 frames of 832 x 480 here. The numbers of our node go on to the model's by themselves: frames \
4 k + 1, sides multiples of 16."""

_VACE_NOTE = f"""\
## Physics leads, VACE paints what is uncovered

*Warped Video* moves the hair and leaves grey holes where it was; *WanVaceToVideo* takes both and paints into the holes.

**Model files:**

- `models/diffusion_models/wan2.1_vace_14B_fp16.safetensors` (or the smaller `wan2.1_vace_1.3B_fp16.safetensors`) from \
{_WAN_21}
{COMMON_FILES}

{_LENGTH}

Without the files, connect *control_video* to *Create Video* and see what the model is given.
"""
_LINES_NOTE = f"""\
## A moving line drawing leads the video

*Line Control Video* bends the sketch along with the motion, as white lines on black. The illustration is the first \
frame; every other one is the model's own painting. *WanVaceToVideo* takes the same control video.

**Model files:**

- `models/diffusion_models/wan2.2_fun_control_high_noise_14B_fp8_scaled.safetensors` and \
`wan2.2_fun_control_low_noise_14B_fp8_scaled.safetensors` from {_WAN_22}
{COMMON_FILES}

{_LENGTH}

Without the files, connect *control_video* to *Create Video* and see what the model is given.
"""
_FRAMES_NOTE = f"""\
## First and last frame from physics, the rest from the model

*First And Last Frame* draws two frames of the motion; *WanFirstLastFrameToVideo* draws what is between them.

**Model files:**

- `models/diffusion_models/wan2.2_i2v_high_noise_14B_fp8_scaled.safetensors` and \
`wan2.2_i2v_low_noise_14B_fp8_scaled.safetensors` from {_WAN_22}
{COMMON_FILES}

Choose frames between which the motion is easy to guess: half a swing, not five.
"""
_TRACKS_NOTE = f"""\
## Tracks lead the video

*Motion to Tracks* follows points of the hair; *WanMoveTrackToVideo* moves the illustration along them.

**Model files:**

- `models/diffusion_models/Wan21-WanMove_fp8_scaled_e4m3fn_KJ.safetensors` from \
https://huggingface.co/Kijai/WanVideo_comfy_fp8_scaled/tree/main/WanMove
- `models/clip_vision/{_VISION}` from {_WAN_21}
{COMMON_FILES}

**For ATI**, use *WanTrackToVideo*: connect *coordinates*, set *frames* to 121, and take \
`Wan2_1-I2V-ATI-14B_fp8_e4m3fn.safetensors` from https://huggingface.co/Kijai/WanVideo_comfy
"""

_DIFFERENTIAL_NOTE = f"""\
## Soft inpainting with the host's own nodes

*Warped Video* moves the hair and leaves grey holes where it was. The holes' mask is blurred, and *Differential \
Diffusion* lets each pixel change as much as the mask says: all in the holes, less and less around them. Each frame is \
painted by itself, as in the paper's ablation: look at what that does from frame to frame. **soft_inpaint** does it \
with our own *Render*, over the composite and with one noise for all frames.

**Model file:** `models/checkpoints/{_CHECKPOINT}` from \
https://huggingface.co/Comfy-Org/stable_diffusion_2.1_repackaged, or any other checkpoint of Stable Diffusion for \
inpainting.

Without the file, connect *control_video* to *Create Video* and see what the model is given.
"""

_PLATE_NOTE = f"""\
## What the motion uncovers, painted once

*Uncovered Area* gives a mask of all that the hair uncovers in the clip, and the picture without it. Any checkpoint \
paints there **once**; the result is *clean_plate* of *Render*, and lies still behind every frame. Outside the mask it \
is our plate to the bit (*ImageCompositeMasked*).

**Model file:** `models/checkpoints/{_CHECKPOINT}` from \
https://huggingface.co/Comfy-Org/stable_diffusion_2.1_repackaged (CreativeML Open RAIL++-M licence), or any other \
checkpoint: one for inpainting with *denoise* 1, any other with 0.6 to 0.9, which begins with what is there.

**Without prompts:** nodes that take *image* and *mask*, such as LaMa's, fit in place of the sampler.

**Large pictures:** models paint best at their own size. Of a larger picture, give the model what is around the mask, \
with a node pack that crops and stitches.

**Layers** need none of this: what is behind their parts is drawn already.

Without the file, disconnect *clean_plate* of *Render*: it paints without a model.
"""

PROMPT = "anime illustration, a girl whose long hair moves in the wind, clean lines, flat colours, still camera"
AVOIDED = "blurry, photographic, deformed, flicker, camera movement, text"
_FORM = {"width": 832, "height": 480}
_SHOWN = {
    "WarpedVideo": 0,
    "LineControlVideo": 0,
    "FirstAndLastFrame": 1,
    "Tracks": 2,
    "Keyframes": 2,
    "UncoveredArea": 0,
    "TimeToMove": 0,
}
_LOADERS = ("UNETLoader", "CheckpointLoaderSimple", "WanVideoModelLoader")


def wan_vace() -> tuple[Group, ...]:
    """Warped frames and their holes for VACE."""
    given = ours("given", "WarpedVideo", image="example.image", motion="simulate.motion")
    inputs = _form("length") | {
        "control_video": "given.control_video",
        "control_masks": "given.control_masks",
        "reference_image": "example.image",
    }
    led = core("led", "WanVaceToVideo", **conditions(), **inputs)
    return (
        *_moved(_VACE_NOTE),
        _given("Warped video and holes", given),
        models(*_unet("model", "wan2.1_vace_14B_fp16.safetensors", 5.0)),
        painted("wan_vace", "given.frame_rate", led, _sampled(20, 6.0, "uni_pc"), trimmed=True),
    )


def wan_lines() -> tuple[Group, ...]:
    """A moving line drawing for the Fun Control model."""
    sketch = ours("sketch", "ExtractSketch", image="example.image")
    given = ours("given", "LineControlVideo", sketch="sketch.sketch", motion="simulate.motion")
    inputs = _form("length") | {"control_video": "given.control_video", "ref_image": "example.image"}
    led = core("led", "Wan22FunControlToVideo", **conditions(), **inputs)
    return (
        *_moved(_LINES_NOTE),
        _given("Moving lines", sketch, given),
        models(*two_unets("wan2.2_fun_control_{}_noise_14B_fp8_scaled.safetensors")),
        painted("wan_lines", "given.frame_rate", led, *sampled_in_two(3.5)),
    )


def wan_first_last_frame() -> tuple[Group, ...]:
    """Two frames of a motion, and a model that draws those between."""
    chosen = {"first_frame": 0, "last_frame": 24}
    given = ours("given", "FirstAndLastFrame", 0, "", chosen, image="example.image", motion="simulate.motion")
    inputs = _form() | {"start_image": "given.start_image", "end_image": "given.end_image"}
    led = core("led", "WanFirstLastFrameToVideo", 0, "", {"length": 33}, **conditions(), **inputs)
    return (
        *_moved(_FRAMES_NOTE),
        _given("First and last frame", given),
        models(*two_unets("wan2.2_i2v_{}_noise_14B_fp8_scaled.safetensors")),
        painted("wan_first_last_frame", 16.0, led, *sampled_in_two(4.0)),
    )


def wan_tracks() -> tuple[Group, ...]:
    """Tracks of a motion for Wan-Move."""
    values = {"frames": 81, **_FORM}
    given = ours("given", "Tracks", 430, "", values, motion="simulate.motion", image="example.image")
    inputs = {"tracks": "given.tracks", "start_image": "example.image", "clip_vision_output": "seen.CLIP_VISION_OUTPUT"}
    led = core("led", "WanMoveTrackToVideo", 0, "", {"length": 81, **_FORM}, **conditions(), **inputs)
    vision = (
        core("vision", "CLIPVisionLoader", 0, "", {"clip_name": _VISION}),
        core("seen", "CLIPVisionEncode", 0, "", {}, clip_vision="vision.CLIP_VISION", image="example.image"),
    )
    return (
        *_moved(_TRACKS_NOTE),
        _given("Tracks", given),
        models(*_unet("model", "Wan21-WanMove_fp8_scaled_e4m3fn_KJ.safetensors", 5.0), *vision),
        painted("wan_tracks", 16.0, led, _sampled(20, 5.0, "uni_pc")),
    )


def differential_diffusion() -> tuple[Group, ...]:
    """Warped frames whose holes an image model paints, each frame by itself, under a soft mask."""
    size = {"frames": 61, "width": 640, "height": 352, "grow": 8}
    given = ours("given", "WarpedVideo", 0, "", size, image="example.image", motion="simulate.motion")
    soft = (
        core("holes", "MaskToImage", mask="given.control_masks"),
        core("blurred", "ImageBlur", 0, "", {"blur_radius": 16, "sigma": 6.0}, image="holes.IMAGE"),
        core("soft", "ImageToMask", 0, "", {"channel": "red"}, image="blurred.IMAGE"),
    )
    file = core("file", "CheckpointLoaderSimple", 0, "", {"ckpt_name": _CHECKPOINT})
    model = core("model", "DifferentialDiffusion", model="file.MODEL")
    conditions = {"positive": "prompt.CONDITIONING", "negative": "avoid.CONDITIONING", "vae": "file.VAE"}
    led = core("led", "InpaintModelConditioning", **conditions, pixels="given.control_video", mask="soft.MASK")
    return (
        *_moved(_DIFFERENTIAL_NOTE),
        _given("Warped video and soft holes", given, *soft),
        Group("4 · Model file", ORANGE, (Column(380, (file, model)),)),
        painted("differential_diffusion", "given.frame_rate", led, _sampled(25, 7.5, "dpmpp_2m"), of=("file", "file")),
    )


def inpaint_plate() -> tuple[Group, ...]:
    """What the motion uncovers, painted once by an image model, behind the frames of the composite."""
    area = ours("given", "UncoveredArea", image="example.image", motion="simulate.motion")
    file = core("file", "CheckpointLoaderSimple", 0, "", {"ckpt_name": _CHECKPOINT})
    texts = {"prompt": "anime illustration, background, clean lines, flat colours", "avoid": "person, hair, blurry"}
    led = core(
        "led",
        "InpaintModelConditioning",
        positive="prompt.CONDITIONING",
        negative="avoid.CONDITIONING",
        vae="file.VAE",
        pixels="given.image",
        mask="given.mask",
    )
    values = {"steps": 25, "cfg": 6.0, "sampler_name": "dpmpp_2m", "scheduler": "karras"}
    kept = {"destination": "given.clean_plate", "source": "decoded.IMAGE", "mask": "given.mask"}
    painted = (
        core("prompt", "CLIPTextEncode", 140, "What is behind", {"text": texts["prompt"]}, clip="file.CLIP"),
        core("avoid", "CLIPTextEncode", 120, "What is not", {"text": texts["avoid"]}, clip="file.CLIP"),
        led,
        core("sampled", "KSampler", 0, "", values, model="file.MODEL", latent_image="led.latent", **_led()),
        core("decoded", "VAEDecode", samples="sampled.LATENT", vae="file.VAE"),
        core("plate", "ImageCompositeMasked", **kept),
    )
    result = (
        core("seen", "PreviewImage", 300, "The plate", images="plate.IMAGE"),
        ours("frames", "Render", image="example.image", motion="simulate.motion", clean_plate="plate.IMAGE"),
        core("video", "CreateVideo", 0, "", {"fps": 24.0}, images="frames.frames"),
        core("save", "SaveVideo", 420, "", {"filename_prefix": "PhysAnimator/inpaint_plate"}, video="video.VIDEO"),
    )
    return (
        *_moved(_PLATE_NOTE),
        Group("3 · What is uncovered", TEAL, (Column(340, (area, file)),)),
        Group("4 · Painted once", ORANGE, (Column(380, painted),)),
        Group("5 · Frames over it", PURPLE, (Column(420, result),)),
    )


def wan_time_to_move() -> tuple[Group, ...]:
    """A crude animation that Wan repaints, with the nodes of ComfyUI-WanVideoWrapper."""
    return time_to_move(_moved, PROMPT, AVOIDED)


def wan_time_to_move_core() -> tuple[Group, ...]:
    """The same with the host's own samplers."""
    return time_to_move_core(_moved, models, PROMPT, AVOIDED)


def _moved(note: str) -> tuple[Group, ...]:
    """The example's hair in the automatic wind: five seconds."""
    body = {"preset": "hair", "attach": "left"}
    bodies = (
        ours("mesh", "MaskToMesh", 340, "Mask to Mesh: hair", mask="example.hair", image="example.image"),
        ours("body", "Body", 0, "Body: hair", body, mesh="mesh.mesh"),
        ours("scene", "AutomaticScene", bodies="body.bodies"),
        ours("simulate", "Simulate", values={"frames": 121}, scene="scene.scene"),
    )
    written = core("note", "MarkdownNote", 520, "Start here", {"": note})
    example = ours("example", "ExampleIllustration", 370)
    return (
        Group("1 · Illustration and masks", BLUE, (Column(400, (written, example)),)),
        Group("2 · Body and simulation", GREEN, (Column(330, bodies),)),
    )


def _given(title: str, *nodes: Node) -> Group:
    return Group(f"3 · {title}", TEAL, (Column(340, nodes),))


def models(*nodes: Node) -> Group:
    loaders = (
        *nodes,
        core("encoder", "CLIPLoader", 0, "", {"clip_name": _ENCODER, "type": "wan"}),
        core("vae", "VAELoader", 0, "", {"vae_name": _VAE}),
    )
    return Group("4 · Model files", ORANGE, (Column(380, loaders),))


def _unet(key: str, name: str, shift: float) -> tuple[Node, ...]:
    loader = core(f"{key}_file", "UNETLoader", 0, "", {"unet_name": name})
    return loader, core(key, "ModelSamplingSD3", 0, "", {"shift": shift}, model=f"{key}_file.MODEL")


def two_unets(name: str, *, names: tuple[str, str] = ("high", "low"), shift: float = 8.0) -> tuple[Node, ...]:
    high, low = (name.format(each) for each in names)
    return (*_unet("model", high, shift), *_unet("model_low", low, shift))


def _form(*more: str) -> dict[str, str]:
    return {name: f"given.{name}" for name in ("width", "height", *more)}


def conditions() -> dict[str, str]:
    return {"positive": "prompt.CONDITIONING", "negative": "avoid.CONDITIONING", "vae": "vae.VAE"}


def _led() -> dict[str, str]:
    return {"positive": "led.positive", "negative": "led.negative"}


def _sampled(steps: int, cfg: float, sampler: str) -> Node:
    values = {"steps": steps, "cfg": cfg, "sampler_name": sampler, "scheduler": "simple"}
    return core("sampled", "KSampler", 0, "", values, model="model.MODEL", latent_image="led.latent", **_led())


def sampled_in_two(cfg: float, *, steps: int = 20, end: int = 10, sampler: str = "euler") -> tuple[Node, Node]:
    """The first steps by the model for strong noise, the others by the one for weak noise."""
    usual = {"steps": steps, "cfg": cfg, "sampler_name": sampler, "scheduler": "simple"}
    strong = usual | {"end_at_step": end, "return_with_leftover_noise": "enable"}
    weak = usual | {"add_noise": "disable", "start_at_step": end}
    return (
        core("strong", "KSamplerAdvanced", 0, "", strong, model="model.MODEL", latent_image="led.latent", **_led()),
        core(
            "sampled", "KSamplerAdvanced", 0, "", weak, model="model_low.MODEL", latent_image="strong.LATENT", **_led()
        ),
    )


def painted(
    name: str,
    rate: str | float,
    led: Node,
    *samplers: Node,
    trimmed: bool = False,
    of: tuple[str, str] = ("encoder", "vae"),
    kept: int = 0,
) -> Group:
    """Prompts, conditioning, sampling and the video; ``kept`` frames of it where that is not 0."""
    encoder, vae = of
    prompts = (
        core("prompt", "CLIPTextEncode", 140, "What is to be seen", {"text": PROMPT}, clip=f"{encoder}.CLIP"),
        core("avoid", "CLIPTextEncode", 120, "What is not", {"text": AVOIDED}, clip=f"{encoder}.CLIP"),
        led,
    )
    trim = (
        (core("trim", "TrimVideoLatent", samples="sampled.LATENT", trim_amount="led.trim_latent"),) if trimmed else ()
    )
    fixed, linked = ({"fps": rate}, {}) if isinstance(rate, float) else ({}, {"fps": rate})
    latent = "trim.LATENT" if trimmed else "sampled.LATENT"
    values = {"batch_index": 0, "length": kept}
    without_last = (core("frames", "ImageFromBatch", 0, "", values, image="decoded.IMAGE"),) if kept else ()
    result = (
        *trim,
        core("decoded", "VAEDecode", samples=latent, vae=f"{vae}.VAE"),
        *without_last,
        core("video", "CreateVideo", 0, "", fixed, images="frames.IMAGE" if kept else "decoded.IMAGE", **linked),
        core("save", "SaveVideo", 420, "", {"filename_prefix": f"PhysAnimator/{name}"}, video="video.VIDEO"),
    )
    return Group("5 · The model paints", PURPLE, (Column(380, (*prompts, *samplers)), Column(420, result)))


def led_by(api: dict[str, Any]) -> str | None:
    """Key of the node of this pack that leads a video model of the host, None where there is none."""
    if not any(node["class_type"] in _LOADERS for node in api.values()):
        return None
    (found,) = [key for key, node in api.items() if node["class_type"].removeprefix("PhysAnimator_") in _SHOWN]
    return found


def without_video_model(api: dict[str, Any]) -> dict[str, Any]:
    """The workflow that saves what the video model would be given; as it is where there is no such model."""
    key = led_by(api)
    if key is None:
        return api
    changed = copy.deepcopy(api)
    (video,) = [node for node in changed.values() if node["class_type"] == "CreateVideo"]
    video["inputs"]["images"] = [key, _SHOWN[changed[key]["class_type"].removeprefix("PhysAnimator_")]]
    needed = [name for name, node in changed.items() if node["class_type"] == "SaveVideo"]
    for name in needed:
        links = [value for value in changed[name]["inputs"].values() if isinstance(value, list)]
        needed += [source for source, _ in links if source not in needed]
    return {name: changed[name] for name in needed}


VIDEO_MODEL_WORKFLOWS = {
    "inpaint_plate": inpaint_plate,
    "wan_vace": wan_vace,
    "wan_lines": wan_lines,
    "wan_first_last_frame": wan_first_last_frame,
    "wan_tracks": wan_tracks,
    "wan_time_to_move": wan_time_to_move,
    "wan_time_to_move_core": wan_time_to_move_core,
    "differential_diffusion": differential_diffusion,
}
