"""The published workflows in which Wan repaints a crude animation (Time-to-Move)."""

from __future__ import annotations

from typing import Any

from graphs import ORANGE, PURPLE, TEAL, Column, Group, Node, core, ours

__all__ = ["time_to_move", "time_to_move_core"]

_STEPS, _WEAK, _STRONG, _BOUNDARY = 50, 3, 7, 18
_MODEL = {"shift": 5.0}
"""Of 50 steps at shift 5 the eighteenth is the first below a noise of 0.9, where Wan 2.2 changes its model."""

_ABOUT = """\
*Time-to-Move Inputs* gives the animation of the physics as a crude one, the mask of its moving parts and its first \
frame. Until step **3** of 50 nothing is made: the crude animation is noised so far. From **3** to **7** the moving \
parts are put back after each step and the rest goes on freely; from then on all is free. These are the published \
steps for parts that are cut out and moved; 2 and 5 where the whole picture moves. \
A lower second number lets parts drift from the physics, a higher one makes them stiff."""
_COMMON = """\
**Licence:** Wan 2.2 and Time-to-Move are Apache-2.0, for commercial work and in all countries; read the files' own \
pages.

**Memory:** each of the two models is a file of 14 GB in fp8, and one is used at a time: a GPU of 24 GB should do (by \
the files' sizes; not measured by us). With less, {less} Fewer frames or a smaller *size* help most.

**Fewer steps** (with a distilled LoRA, say): scale all numbers alike, such as 1, 2 and 4 of 10.

**Length and size** go on to the model by themselves; *rules* says what became of yours. 81 frames at 16 a second are \
what Wan knows best.

Without the files, connect *crude_animation* to *Create Video* and see what the model is given.
"""
_WRAPPER_NOTE = f"""\
## Physics moves, Wan repaints (Time-to-Move)

{_ABOUT}

**Needs the node pack ComfyUI-WanVideoWrapper** (Apache-2.0; its nodes are red until it is installed): \
https://github.com/kijai/ComfyUI-WanVideoWrapper

**Model files:**

- `models/diffusion_models/Wan2_2-I2V-A14B-HIGH_fp8_e4m3fn_scaled_KJ.safetensors` and the same with `LOW` from \
https://huggingface.co/Kijai/WanVideo_comfy_fp8_scaled/tree/main/I2V
- `models/text_encoders/umt5-xxl-enc-bf16.safetensors` and `models/vae/Wan2_1_VAE_bf16.safetensors` from \
https://huggingface.co/Kijai/WanVideo_comfy

{_COMMON.format(less="connect the pack's *WanVideo Block Swap* to both model loaders.")}"""
_CORE_NOTE = f"""\
## Physics moves, Wan repaints (Time-to-Move), with the host's own nodes

{_ABOUT}

No node pack is needed: a sampler that starts at step 3 with *Set Latent Noise Mask* holds the moving parts until step \
7. *free_latents* has one pixel for each latent, so that no strand is lost. Keep *euler*: it remembers nothing of what \
was put back.

**Model files:**

- `models/diffusion_models/wan2.2_i2v_high_noise_14B_fp8_scaled.safetensors` and \
`wan2.2_i2v_low_noise_14B_fp8_scaled.safetensors` from \
https://huggingface.co/Comfy-Org/Wan_2.2_ComfyUI_Repackaged/tree/main/split_files
- `models/text_encoders/umt5_xxl_fp8_e4m3fn_scaled.safetensors` and `models/vae/wan_2.1_vae.safetensors` from \
https://huggingface.co/Comfy-Org/Wan_2.1_ComfyUI_repackaged/tree/main/split_files

{_COMMON.format(less="the host keeps parts of the model in the computer's memory.")}"""


def time_to_move(moved: Any, prompt: str, avoid: str) -> tuple[Group, ...]:
    """For the nodes of ComfyUI-WanVideoWrapper.

    Args:
        moved: the groups before, made from a note.
        prompt: what is to be seen.
        avoid: what is not.
    """
    files = (
        *(_wrapper_model(key, level) for key, level in (("model", "HIGH"), ("model_low", "LOW"))),
        core("vae", "WanVideoVAELoader", 0, "", {"model_name": "Wan2_1_VAE_bf16.safetensors"}),
        core("encoder", "LoadWanVideoT5TextEncoder", 0, "", {"model_name": "umt5-xxl-enc-bf16.safetensors"}),
    )
    form = {"width": "given.width", "height": "given.height", "num_frames": "given.length"}
    prompts = {"positive_prompt": prompt, "negative_prompt": avoid}
    steps = {"start_step": _WEAK, "end_step": _STRONG}
    still = {"fun_or_fl2v_model": False}
    first = {"vae": "vae.vae", "start_image": "given.first_frame", **form}
    given = (
        core("prompts", "WanVideoTextEncode", 260, "", prompts, t5="encoder.wan_t5_model"),
        core("start", "WanVideoImageToVideoEncode", 0, "", still, **first),
        core("crude", "WanVideoEncode", vae="vae.vae", image="given.crude_animation"),
        core(
            "led", "WanVideoAddTTMLatents", 0, "", steps, embeds="start.image_embeds",
            reference_latents="crude.samples", mask="given.mask",
        ),
    )  # fmt: skip
    both = {"image_embeds": "led.image_embeds", "text_embeds": "prompts.text_embeds"}
    usual = {"steps": _STEPS, "cfg": 3.5, "shift": _MODEL["shift"], "scheduler": "euler"}
    high, low = usual | {"end_step": _BOUNDARY}, usual | {"start_step": _BOUNDARY}
    samplers = (
        core("strong", "WanVideoSampler", 0, "", high, model="model.model", **both),
        core("sampled", "WanVideoSampler", 0, "", low, model="model_low.model", samples="strong.samples", **both),
    )
    decoded = core("decoded", "WanVideoDecode", vae="vae.vae", samples="sampled.samples")
    return (
        *moved(_WRAPPER_NOTE),
        _given(),
        Group("4 · Model files", ORANGE, (Column(420, files),)),
        Group("5 · What the model is given", PURPLE, (Column(400, given),)),
        Group(
            "6 · The model repaints", PURPLE, (Column(400, samplers), _result("wan_time_to_move", decoded, "images"))
        ),
    )


def time_to_move_core(moved: Any, models: Any, prompt: str, avoid: str) -> tuple[Group, ...]:
    """For the host's own samplers.

    Args:
        moved: see :func:`time_to_move`.
        models: the group of model files, made from their loaders.
        prompt: what is to be seen.
        avoid: what is not.
    """
    name = "wan2.2_i2v_{}_noise_14B_fp8_scaled.safetensors"
    pairs = (("model", "high"), ("model_low", "low"))
    loaders = [node for key, level in pairs for node in _core_model(key, name.format(level))]
    form = {name: f"given.{name}" for name in ("width", "height", "length")}
    conditions = {"positive": "prompt.CONDITIONING", "negative": "avoid.CONDITIONING", "vae": "vae.VAE"}
    given = (
        core("prompt", "CLIPTextEncode", 140, "What is to be seen", {"text": prompt}, clip="encoder.CLIP"),
        core("avoid", "CLIPTextEncode", 120, "What is not", {"text": avoid}, clip="encoder.CLIP"),
        core("led", "WanImageToVideo", start_image="given.first_frame", **conditions, **form),
        core("crude", "VAEEncode", 0, "Crude animation", {}, pixels="given.crude_animation", vae="vae.VAE"),
        core("held", "SetLatentNoiseMask", 0, "Hold what moves", {}, samples="crude.LATENT", mask="given.free_latents"),
    )
    samplers = (
        _sampler("strong", "model", "held.LATENT", _WEAK, _STRONG, first=True),
        core("all", "SolidMask", 0, "All of it", {"value": 1.0}),
        core("free", "SetLatentNoiseMask", 0, "Hold nothing", {}, samples="strong.LATENT", mask="all.MASK"),
        _sampler("on", "model", "free.LATENT", _STRONG, _BOUNDARY),
        _sampler("sampled", "model_low", "on.LATENT", _BOUNDARY, None),
    )
    decoded = core("decoded", "VAEDecode", samples="sampled.LATENT", vae="vae.VAE")
    result = _result("wan_time_to_move_core", decoded, "IMAGE")
    return (
        *moved(_CORE_NOTE),
        _given(),
        models(*loaders),
        Group("5 · What the model is given", PURPLE, (Column(380, given),)),
        Group("6 · The model repaints", PURPLE, (Column(340, samplers), result)),
    )


def _given() -> Group:
    given = (
        ours("given", "TimeToMove", image="example.image", motion="simulate.motion"),
        core("rules", "PreviewAny", 160, "What became of length and size", {}, source="given.rules"),
    )
    return Group("3 · Crude animation and its mask", TEAL, (Column(360, given),))


def _wrapper_model(key: str, level: str) -> Node:
    name = f"Wan2_2-I2V-A14B-{level}_fp8_e4m3fn_scaled_KJ.safetensors"
    return core(key, "WanVideoModelLoader", 0, "", {"model": name, "quantization": "fp8_e4m3fn_scaled"})


def _core_model(key: str, name: str) -> tuple[Node, Node]:
    loader = core(f"{key}_file", "UNETLoader", 0, "", {"unet_name": name})
    return loader, core(key, "ModelSamplingSD3", 0, "", _MODEL, model=f"{key}_file.MODEL")


def _sampler(key: str, model: str, latent: str, start: int, end: int | None, *, first: bool = False) -> Node:
    """Some of the steps by one of the models."""
    values = {"steps": _STEPS, "cfg": 3.5, "sampler_name": "euler", "scheduler": "simple", "start_at_step": start}
    values |= {} if first else {"add_noise": "disable"}
    values |= {} if end is None else {"end_at_step": end, "return_with_leftover_noise": "enable"}
    led = {"positive": "led.positive", "negative": "led.negative"}
    return core(key, "KSamplerAdvanced", 0, "", values, model=f"{model}.MODEL", latent_image=latent, **led)


def _result(name: str, decoded: Node, output: str) -> Column:
    prefix = {"filename_prefix": f"PhysAnimator/{name}"}
    video = core("video", "CreateVideo", images=f"decoded.{output}", fps="given.frame_rate")
    return Column(420, (decoded, video, core("save", "SaveVideo", 420, "", prefix, video="video.VIDEO")))
