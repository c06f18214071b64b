"""The published workflows for LTX and AniSora, and for a loop by Wan; see video_model_graphs.py for the others."""

from __future__ import annotations

from typing import Any

from graphs import BLUE, GREEN, ORANGE, PURPLE, TEAL, Column, Group, Node, core, ours
from video_model_graphs import AVOIDED, COMMON_FILES, PROMPT, conditions, models, painted, sampled_in_two, two_unets

__all__ = ["MORE_VIDEO_MODEL_WORKFLOWS"]

_UNTRIED = "Made from the nodes' and the model's own documentation: it was checked by the host, not run with weights."
_SEE = "Without the files, connect *{0}* to *Create Video* and see what the model is given."

_LTX_CHECKPOINT = "ltx-2.3-22b-dev-fp8.safetensors"
_LTX_ENCODER = "gemma_3_12B_it_fp4_mixed.safetensors"
_LTX_FAST = "ltx-2.3-22b-distilled-lora-384.safetensors"
_LTX_LINES = "ltx-2.3-22b-ic-lora-union-control-ref0.5.safetensors"
_LTX_TRACKS = "ltx-2.3-22b-ic-lora-motion-track-control-ref0.5.safetensors"
_LTX_SIGMAS = "1.0, 0.99375, 0.9875, 0.98125, 0.975, 0.909375, 0.725, 0.421875, 0.0"
_LTX_FORM = {"frames": 121, "width": 960, "height": 512}
_LTX_COMMON = f"""\
- `models/checkpoints/{_LTX_CHECKPOINT}` from https://huggingface.co/Lightricks/LTX-2.3-fp8
- `models/loras/{_LTX_FAST}` from https://huggingface.co/Lightricks/LTX-2.3
- `models/text_encoders/{_LTX_ENCODER}` from https://huggingface.co/Comfy-Org/ltx-2"""
_LTX_TERMS = f"""\
**Length and size:** 8 k + 1 frames; sides multiples of 64, because the control video goes in at half the size.

**Licence:** LTX-2 Community License: free below USD 10 million of yearly revenue, otherwise ask Lightricks; \
worldwide, except where US export controls and sanctions forbid it. Gemma has terms of its own.

**Memory:** a GPU with 32 GB or more, as Lightricks says, and 100 GB of disk.

{_UNTRIED}"""
_LTX_LINES_NOTE = f"""\
## A moving line drawing leads LTX-2.3

*Line Control Video* bends the sketch along with the motion, white on black, as the edges that the union control LoRA \
knows. The illustration is the first frame. **Needs a ComfyUI with *Get IC-LoRA Parameters*; no other pack.**

**Model files:**

{_LTX_COMMON}
- `models/loras/{_LTX_LINES}` from https://huggingface.co/Lightricks/LTX-2.3-22b-IC-LoRA-Union-Control

{_LTX_TERMS} {_SEE.format("control_video")}
"""
_LTX_TRACKS_NOTE = f"""\
## Tracks lead LTX-2.3

*Motion to Tracks* follows points of the hair; *LTX Draw Sparse Tracks* takes its *coordinates* as they are and draws \
them for the motion track LoRA. **Needs the pack ComfyUI-LTXVideo, and a ComfyUI with *Get IC-LoRA Parameters*.**

**Model files:**

{_LTX_COMMON}
- `models/loras/{_LTX_TRACKS}` from https://huggingface.co/Lightricks/LTX-2.3-22b-IC-LoRA-Motion-Track-Control

Numbers stand in three nodes: width and height in *Motion to Tracks*, *Draw Sparse Tracks* and *Empty Latent*, frames \
in two of them and in the audio.

{_LTX_TERMS} {_SEE.format("preview")}
"""
_REPACKED = "https://huggingface.co/Kijai/WanVideo_comfy_fp8_scaled/tree/main/I2V/AniSora"
_ANISORA = "Wan2_2-I2V_AniSoraV3_2_{}_14B_fp8_e4m3fn_scaled_KJ.safetensors"
_ANISORA_NOTE = f"""\
## Keyframes from physics, in-betweens from AniSora

*Keyframes* draws the motion at chosen frames; *Keyframes to Wan Video* shows them to the model in their places. \
Save the keyframes, paint over them, load them instead: the model follows your hand. AniSora V3.2 was made for first, \
middle and last frames, at multiples of 8, in 8 steps without guidance.

**Model files:**

- `models/diffusion_models/{_ANISORA.format("HIGH")}` and `{_ANISORA.format("LOW")}` from {_REPACKED}
{COMMON_FILES}

**Length and size:** 4 k + 1 frames at 16 a second, sides multiples of 16.

**Licence:** Apache-2.0, no territory excluded. **Memory:** two models of about 14 GB in fp8, one at a time in \
use; the host keeps in main memory what a GPU cannot hold.

{_UNTRIED} {_SEE.format("control_video")}
"""
_LOOP_NOTE = f"""\
## A loop by Wan: it ends where it begins

*Simulate* makes a loop; one frame of it is both *start_image* and *end_image* of *WanFirstLastFrameToVideo*. The \
model draws 81 frames, of which the last is the first again: *Image From Batch* leaves it out, so that no frame comes \
twice at the wrap. Keep its *length* one below the model's *length*, which is 4 k + 1.

If the model's picture stands still, say in the prompt how things move, or use **anisora_inbetweens** with more frames \
of the loop.

**Model files:**

- `models/diffusion_models/wan2.2_i2v_high_noise_14B_fp8_scaled.safetensors` and \
`wan2.2_i2v_low_noise_14B_fp8_scaled.safetensors` from \
https://huggingface.co/Comfy-Org/Wan_2.2_ComfyUI_Repackaged/tree/main/split_files
{COMMON_FILES}

**Licence:** Apache-2.0, no territory excluded. **Memory:** two models of about 14 GB in fp8, one at a time in \
use; the host keeps in main memory what a GPU cannot hold.

{_UNTRIED} {_SEE.format("end_image")}
"""


def ltx_lines() -> tuple[Group, ...]:
    """A moving line drawing for LTX with its union control LoRA."""
    sketch = ours("sketch", "ExtractSketch", image="example.image")
    given = ours("given", "LineControlVideo", 0, "", dict(_LTX_FORM), sketch="sketch.sketch", motion="simulate.motion")
    told = {name: f"given.{name}" for name in ("width", "height", "length")}
    return (
        *_moved(_LTX_LINES_NOTE, {"frames": 121}),
        _given("Moving lines", sketch, given),
        _ltx_models(_LTX_LINES),
        *_ltx_painted("ltx_lines", "given.control_video", told, "given.frame_rate"),
    )


def ltx_tracks() -> tuple[Group, ...]:
    """Tracks of a motion for LTX with its motion track LoRA."""
    given = ours("given", "Tracks", 430, "", dict(_LTX_FORM), motion="simulate.motion", image="example.image")
    size = {name: _LTX_FORM[name] for name in ("width", "height")}
    drawn = core("drawn", "LTXVDrawTracks", 0, "", size, tracks="given.coordinates")
    return (
        *_moved(_LTX_TRACKS_NOTE, {"frames": 121}),
        _given("Tracks", given, drawn),
        _ltx_models(_LTX_TRACKS),
        *_ltx_painted("ltx_tracks", "drawn.IMAGE", size | {"length": _LTX_FORM["frames"]}, 24.0),
    )


def anisora_inbetweens() -> tuple[Group, ...]:
    """Keyframes of a motion, between which AniSora draws."""
    given = ours("given", "Keyframes", image="example.image", motion="simulate.motion")
    inputs = {name: f"given.{name}" for name in ("width", "height", "length", "keyframes", "indices")}
    led = ours("led", "WanKeyframes", **conditions(), **inputs)
    steps = {"steps": 8, "end": 3, "sampler": "uni_pc"}
    return (
        *_moved(_ANISORA_NOTE, {"frames": 121}),
        _given("Keyframes", given),
        models(*two_unets(_ANISORA, names=("HIGH", "LOW"), shift=5.0)),
        painted("anisora_inbetweens", "given.frame_rate", led, *sampled_in_two(1.0, **steps)),
    )


def wan_loop() -> tuple[Group, ...]:
    """One frame of a loop as first and last frame, and a model that draws what is between."""
    chosen = {"first_frame": 0, "last_frame": 0}
    given = ours("given", "FirstAndLastFrame", 0, "", chosen, image="example.image", motion="simulate.motion")
    inputs = {"width": "given.width", "height": "given.height"}
    inputs |= {"start_image": "given.start_image", "end_image": "given.end_image"}
    led = core("led", "WanFirstLastFrameToVideo", 0, "", {"length": 81}, **conditions(), **inputs)
    return (
        *_moved(_LOOP_NOTE, {"loop": 5.0, "frames": 120}),
        _given("A frame of the loop", given),
        models(*two_unets("wan2.2_i2v_{}_noise_14B_fp8_scaled.safetensors")),
        painted("wan_loop", 16.0, led, *sampled_in_two(4.0), kept=80),
    )


def _moved(note: str, simulated: dict[str, Any]) -> tuple[Group, ...]:
    """The example's hair in the automatic wind."""
    bodies = (
        ours("mesh", "MaskToMesh", 340, "Mask to Mesh: hair", mask="example.hair", image="example.image"),
        ours("body", "Body", 0, "Body: hair", {"preset": "hair", "attach": "left"}, mesh="mesh.mesh"),
        ours("scene", "AutomaticScene", bodies="body.bodies"),
        ours("simulate", "Simulate", values=simulated, scene="scene.scene"),
    )
    written = core("note", "MarkdownNote", 640, "Start here", {"": note})
    example = ours("example", "ExampleIllustration", 370)
    return (
        Group("1 · Illustration and masks", BLUE, (Column(440, (written, example)),)),
        Group("2 · Body and simulation", GREEN, (Column(330, bodies),)),
    )


def _given(title: str, *nodes: Node) -> Group:
    return Group(f"3 · {title}", TEAL, (Column(340, nodes),))


def _ltx_models(control: str) -> Group:
    fast = {"lora_name": _LTX_FAST, "strength_model": 0.5}
    nodes = (
        core("file", "CheckpointLoaderSimple", 0, "", {"ckpt_name": _LTX_CHECKPOINT}),
        core("fast", "LoraLoaderModelOnly", 0, "Few steps", fast, model="file.MODEL"),
        core("model", "LoraLoaderModelOnly", 0, "Control", {"lora_name": control}, model="fast.MODEL"),
        core("small", "GetICLoRAParameters", iclora_model="model.MODEL"),
        core("encoder", "LTXAVTextEncoderLoader", 0, "", {"text_encoder": _LTX_ENCODER, "ckpt_name": _LTX_CHECKPOINT}),
        core("audio_vae", "LTXVAudioVAELoader", 0, "", {"ckpt_name": _LTX_CHECKPOINT}),
    )
    return Group("4 · Model files", ORANGE, (Column(400, nodes),))


def _ltx_painted(name: str, control: str, told: dict[str, Any], rate: str | float) -> tuple[Group, ...]:
    """The illustration as first frame, and the control video as guide; the model's sound is left out."""
    linked = {key: value for key, value in told.items() if isinstance(value, str)}
    fixed = {key: value for key, value in told.items() if not isinstance(value, str)}
    sound_linked = {"frames_number": linked["length"]} if "length" in linked else {}
    sound_fixed = {"frame_rate": 24} | ({"frames_number": fixed["length"]} if "length" in fixed else {})
    shown = {} if isinstance(rate, float) else {"frame_rate": rate}
    shows = {"fps": rate} if isinstance(rate, float) else {}
    fps = {} if isinstance(rate, float) else {"fps": rate}
    led = {"positive": "led.positive", "negative": "led.negative"}
    prepared = (
        core("prompt", "CLIPTextEncode", 140, "What is to be seen", {"text": PROMPT}, clip="encoder.CLIP"),
        core("avoid", "CLIPTextEncode", 120, "What is not", {"text": AVOIDED}, clip="encoder.CLIP"),
        core(
            "timed", "LTXVConditioning", 0, "", {} if shown else {"frame_rate": rate},
            positive="prompt.CONDITIONING", negative="avoid.CONDITIONING", **shown,
        ),
        core("empty", "EmptyLTXVLatentVideo", 0, "", fixed, **linked),
        core("first", "LTXVImgToVideoInplace", vae="file.VAE", image="example.image", latent="empty.LATENT"),
        core(
            "led", "LTXVAddGuide", positive="timed.positive", negative="timed.negative", vae="file.VAE",
            latent="first.latent", image=control, iclora_parameters="small.iclora_parameters",
        ),
        core("sound", "LTXVEmptyLatentAudio", 0, "", sound_fixed, audio_vae="audio_vae.Audio VAE", **sound_linked),
        core("both", "LTXVConcatAVLatent", video_latent="led.latent", audio_latent="sound.Latent"),
    )  # fmt: skip
    sampled = (
        core("noise", "RandomNoise"),
        core("guider", "CFGGuider", 0, "", {"cfg": 1.0}, model="model.MODEL", **led),
        core("sampler", "KSamplerSelect", 0, "", {"sampler_name": "euler_ancestral_cfg_pp"}),
        core("sigmas", "ManualSigmas", 0, "", {"sigmas": _LTX_SIGMAS}),
        core(
            "sampled", "SamplerCustomAdvanced", noise="noise.NOISE", guider="guider.GUIDER",
            sampler="sampler.SAMPLER", sigmas="sigmas.SIGMAS", latent_image="both.latent",
        ),
    )  # fmt: skip
    result = (
        core("parted", "LTXVSeparateAVLatent", av_latent="sampled.output"),
        core("cropped", "LTXVCropGuides", latent="parted.video_latent", **led),
        core("decoded", "VAEDecodeTiled", samples="cropped.latent", vae="file.VAE"),
        core("video", "CreateVideo", 0, "", shows, images="decoded.IMAGE", **fps),
        core("save", "SaveVideo", 420, "", {"filename_prefix": f"PhysAnimator/{name}"}, video="video.VIDEO"),
    )
    columns = (Column(380, prepared), Column(340, sampled), Column(420, result))
    return (Group("5 · The model paints", PURPLE, columns),)


MORE_VIDEO_MODEL_WORKFLOWS = {
    "ltx_lines": ltx_lines,
    "ltx_tracks": ltx_tracks,
    "anisora_inbetweens": anisora_inbetweens,
    "wan_loop": wan_loop,
}
