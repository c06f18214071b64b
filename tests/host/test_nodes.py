"""What the nodes give in a real host where the published workflows do not show it."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from PIL import Image

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def ours(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return core(f"PhysAnimator_{node_type}", **inputs)


def ribbon(frames: int) -> dict[str, Any]:
    """The example's ribbon in the automatic wind, rendered."""
    return {
        "example": ours("ExampleIllustration"),
        "mesh": ours("MaskToMesh", mask=["example", 2], spacing=0.0, elements_across=3, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="left"),
        "scene": ours(
            "AutomaticScene", bodies=["body", 0], wind_strength=2.0, wind_angle=0.0, sway_by_size=True, frame_rate=12.0
        ),
        "simulate": ours("Simulate", scene=["scene", 0], frames=frames),
        "render": ours("Render", image=["example", 0], motion=["simulate", 0]),
    }


def pictures(host: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    files = [host.view(saved) for saved in outputs[key]["images"]]
    return np.stack([np.asarray(Image.open(io.BytesIO(file)).convert("RGB")).astype(int) for file in files])


def example(name: str) -> np.ndarray:
    return np.asarray(Image.open(EXAMPLE / name)).astype(int)


def test_the_first_frame_is_the_illustration_and_only_the_moving_part_changes(host: Any) -> None:
    prompt = ribbon(9) | {
        "frames": core("PreviewImage", images=["render", 0]),
        "alpha_picture": core("MaskToImage", mask=["render", 1]),
        "alpha": core("PreviewImage", images=["alpha_picture", 0]),
    }
    outputs = host.run(prompt)
    frames, alpha = pictures(host, outputs, "frames"), pictures(host, outputs, "alpha")
    assert frames.shape == alpha.shape == (9, 720, 1280, 3)
    assert np.abs(frames[0] - example("illustration.png")).max() <= 1
    untouched = (alpha == 0).all(axis=(0, 3)) & (example("mask_ribbon.png") == 0)
    untouched[:200, 400:900] = False  # the soft rim around the ribbon
    assert untouched.mean() > 0.8
    assert (frames[:, untouched] == frames[0][untouched]).all()
    assert np.abs(frames[8] - frames[0]).max() > 60
    agree = (alpha[0, ..., 0] > 127) == (example("mask_ribbon.png") > 127)
    assert agree.mean() > 0.999


def test_a_clean_plate_of_one_s_own_is_used(host: Any) -> None:
    green = {"plate": core("EmptyImage", width=1280, height=720, batch_size=1, color=0x00FF00)}
    prompt = ribbon(2) | green | {"seen": core("PreviewImage", images=["render", 2])}
    prompt["render"]["inputs"]["clean_plate"] = ["plate", 0]
    (plate,) = pictures(host, host.run(prompt), "seen")
    assert (plate[example("mask_ribbon.png") == 255] == (0, 255, 0)).all()


def test_a_scene_survives_its_own_document(host: Any) -> None:
    prompt = ribbon(2) | {
        "again": ours("SceneFromJSON", bodies=["body", 0], scene=["scene", 1]),
        "first": core("PreviewAny", source=["scene", 1]),
        "second": core("PreviewAny", source=["again", 1]),
    }
    outputs = host.run(prompt)
    assert json.loads(outputs["first"]["text"][0]) == json.loads(outputs["second"]["text"][0])


def test_own_materials_regions_and_paths(host: Any) -> None:
    material = {"preset": "custom", "preset.youngs_modulus": 900.0, "preset.poisson_ratio": 0.4, "preset.density": 2.0,
                "preset.damping": 3.0}  # fmt: skip
    prompt = ribbon(3) | {
        "material": ours("Material", **material),
        "wave": ours("RigPoint", position="480,90", body=0, motion="wave",
                     **{"region": "mask", "region.mask": ["example", 2], "motion.amplitude": 30.0,
                        "motion.period": 1.0, "motion.angle": 90.0}),
        "path": ours("RigPoint", position='[{"x": 800, "y": 60}]', body=-1, region="circle", motion="path",
                     rig_points=["wave", 0],
                     **{"region.radius": 40.0, "motion.points": "[[800, 60], [820, 90]]", "motion.times": ""}),
        "seen": core("PreviewAny", source=["scene", 1]),
    }  # fmt: skip
    prompt["body"]["inputs"]["material"] = ["material", 0]
    prompt["scene"]["inputs"]["rig_points"] = ["path", 0]
    document = json.loads(host.run(prompt)["seen"]["text"][0])
    assert document["bodies"][0]["material"]["youngs_modulus"] == 900
    assert document["bodies"][0]["material"]["density"] == 2
    wave, path = document["rig_points"]
    assert wave["position"] == [480, 90]
    assert wave["motion"]["type"] == "wave"
    assert np.allclose(wave["motion"]["direction"], (0, -1), atol=1e-9)
    assert path["motion"]["times"] == [0, 1]


def test_lame_parameters_and_the_papers_integrator(host: Any) -> None:
    material = {"preset": "lame", "preset.mu": 12.0, "preset.lambda": 0.0, "preset.density": 2.0, "preset.damping": 0.0}
    prompt = ribbon(3) | {
        "material": ours("Material", **material),
        "seen": core("PreviewAny", source=["scene", 1]),
        "frames": core("PreviewImage", images=["render", 0]),
    }
    prompt["simulate"]["inputs"] |= {"time_step": 0.001, "strokes_as": "force", "sag": True}
    prompt["mesh"]["inputs"] |= {"spacing": 40.0, "uniform": True}
    prompt["body"]["inputs"]["material"] = ["material", 0]
    outputs = host.run(prompt)
    document = json.loads(outputs["seen"]["text"][0])
    found = document["bodies"][0]["material"]
    assert (found["mu"], found["lambda"], found["density"]) == (12, 0, 2)
    assert "youngs_modulus" not in found
    assert len(outputs["frames"]["images"]) == 3
    prompt["material"]["inputs"]["preset.mu"] = 9000.0
    assert "time_step must be at most 0.000" in host.error_of(prompt)


def test_rig_points_turn_ease_and_fade_out_and_paint_stiffens(host: Any) -> None:
    turned = {
        "region": "circle", "region.radius": 40.0, "motion": "path", "motion.points": "[[480, 90], [500, 90]]",
        "motion.times": "", "motion.easing": "hold", "turn": "rotation", "turn.angles": "[0, 20, 0]",
        "turn.times": "[0, 0.5, 1]", "turn.easing": "ease", "squash": "pulse", "squash.stretch": 1.2,
        "squash.period": 1.0, "squash.phase": -90.0, "squash.angle": 90.0, "squash.keep_area": True, "falloff": 25.0,
    }  # fmt: skip
    prompt = ribbon(3) | {
        "paint": ours("PaintMaterial", mesh=["mesh", 0], preset="ribbon", black=1.0, white=5.0,
                      stiffness=["example", 2], mass=["example", 2]),
        "turned": ours("RigPoint", position="480,90", body=0, **turned),
        "seen": core("PreviewAny", source=["scene", 1]),
    }  # fmt: skip
    prompt["body"]["inputs"]["material"] = ["paint", 0]
    prompt["scene"]["inputs"]["rig_points"] = ["turned", 0]
    document = json.loads(host.run(prompt)["seen"]["text"][0])
    assert document["version"] == 2
    material = document["bodies"][0]["material"]
    assert np.allclose(np.median(material["stiffness_scale"]), 5)
    assert material["density_scale"] == material["stiffness_scale"]
    assert "damping_scale" not in material
    (point,) = document["rig_points"]
    assert point["falloff"] == 25
    path, rotation, pulse = point["motion"]["motions"]
    assert (path["type"], path["easing"]) == ("path", "hold")
    assert (rotation["type"], rotation["angles"], rotation["times"]) == ("rotation", [0, 20, 0], [0, 0.5, 1])
    assert (pulse["type"], pulse["stretch"], pulse["keep_area"]) == ("pulse", 1.2, True)


def test_keyframes_are_kept_and_in_betweens_drawn(host: Any) -> None:
    prompt = {
        "dark": core("EmptyImage", width=64, height=32, batch_size=1, color=0x000000),
        "light": core("EmptyImage", width=64, height=32, batch_size=1, color=0xFFFFFF),
        "keys": core("ImageBatch", image1=["dark", 0], image2=["light", 0]),
        "filled": ours("Interpolate", images=["keys", 0], images_are="keyframes", every=5, backend="blend"),
        "seen": core("PreviewImage", images=["filled", 0]),
    }
    means = pictures(host, host.run(prompt), "seen").mean(axis=(1, 2, 3))
    assert np.allclose(means, np.linspace(0, 255, 6), atol=1)


def test_the_preview_can_lie_over_the_rendered_frames(host: Any) -> None:
    prompt = ribbon(17) | {
        "preview": ours("PreviewMotion", image=["render", 0], motion=["simulate", 0], longest_side=320, every=2),
        "seen": core("PreviewImage", images=["preview", 0]),
    }
    outputs = host.run(prompt)
    assert pictures(host, outputs, "seen").shape == (9, 180, 320, 3)
    animation = Image.open(io.BytesIO(host.view(outputs["preview"]["images"][0])))
    assert animation.format == "WEBP"
    assert animation.n_frames > 3
    assert outputs["preview"]["animated"] == [True]


def test_the_flow_s_colours_show_where_it_moves(host: Any) -> None:
    prompt = ribbon(5) | {
        "flow": ours("OpticalFlow", motion=["simulate", 0]),
        "colours": ours("PreviewFlow", flow=["flow", 0], every=4, largest=0.0),
        "seen": core("PreviewImage", images=["colours", 0]),
    }
    rest, moved = pictures(host, host.run(prompt), "seen")
    assert (rest == 255).all()
    coloured = (moved < 250).any(axis=2)
    assert coloured[example("mask_ribbon.png") == 255].mean() > 0.1
    assert not coloured[300:].any()


def grown_ribbon(frames: int) -> dict[str, Any]:
    """The example's ribbon, cut out by a mask that reaches 7 px beyond it."""
    prompt = ribbon(frames) | {"grown": core("GrowMask", mask=["example", 2], expand=7, tapered_corners=True)}
    prompt["mesh"]["inputs"]["mask"] = ["grown", 0]
    return prompt


def test_a_mesh_ends_where_the_picture_shows_the_part_to_end(host: Any) -> None:
    graph = grown_ribbon(2)
    prompt = {name: graph[name] for name in ("example", "grown")}
    for name, given in (("fitted", {}), ("pixels", {"pixel_art": True})):
        inputs = graph["mesh"]["inputs"] | {"image": ["example", 0]} | given
        prompt |= {name: ours("MaskToMesh", **inputs), f"{name}_seen": core("PreviewImage", images=[name, 1])}
    outputs, ribbon_mask = host.run(prompt), example("mask_ribbon.png") > 127
    away = cv2.distanceTransform((~ribbon_mask).astype(np.uint8), cv2.DIST_L2, cv2.DIST_MASK_PRECISE)
    beyond = {}
    for name in ("fitted", "pixels"):
        (seen,) = pictures(host, outputs, f"{name}_seen")
        beyond[name] = (away[np.abs(seen - example("illustration.png")).max(axis=2) > 30] > 5).sum()
    assert beyond["pixels"] > 1000
    assert beyond["fitted"] < 0.3 * beyond["pixels"]


def test_in_betweens_cut_parts_where_the_picture_shows_them_to_end(host: Any) -> None:
    """A blurred mask must not make the part translucent between the keyframes."""
    prompt = ribbon(9) | {
        "frames": core("PreviewImage", images=["render", 0]),
        "sharp": core("MaskToImage", mask=["example", 2]),
        "blurred": core("ImageBlur", image=["sharp", 0], blur_radius=12, sigma=6.0),
        "soft": core("ImageToMask", image=["blurred", 0], channel="red"),
    }
    prompt["mesh"]["inputs"] |= {"mask": ["soft", 0], "image": ["example", 0]}
    for name, given in (("given", {}), ("fitted", {"image": ["example", 0]})):
        usual = {"images": ["render", 0], "images_are": "all frames", "every": 8, "backend": "motion"}
        prompt[name] = ours("Interpolate", **usual, motion=["simulate", 0], **given)
        prompt[f"{name}_seen"] = core("PreviewImage", images=[name, 0])
    outputs = host.run(prompt)
    rendered = pictures(host, outputs, "frames")[4]
    error = {name: np.abs(pictures(host, outputs, f"{name}_seen")[4] - rendered).mean() for name in ("given", "fitted")}
    assert error["fitted"] < 0.5 * error["given"]


def test_in_betweens_want_the_picture_of_their_motion(host: Any) -> None:
    other = {"other": core("EmptyImage", width=300, height=180, batch_size=1, color=0)}
    prompt = ribbon(3) | other | {"seen": core("PreviewImage", images=["between", 0])}
    usual = {"images": ["render", 0], "images_are": "all frames", "every": 2, "backend": "motion"}
    prompt["between"] = ours("Interpolate", **usual, motion=["simulate", 0], image=["other", 0])
    assert "image must be of the motion's size, 1280 x 720 px. Got: 300 x 180 px" in host.error_of(prompt)


def test_the_editor_is_shown_a_sprite_without_what_is_hidden_in_it(host: Any) -> None:
    prompt = {name: ribbon(2)[name] for name in ("example", "mesh", "body")}
    prompt["hidden"] = core("InvertMask", mask=["example", 2])
    document = '{"version": 2, "width": 1280, "height": 720, "gravity": [0, 1]}'
    given = {"bodies": ["body", 0], "image": ["example", 0], "image_alpha": ["hidden", 0]}
    prompt["editor"] = ours("SceneEditor", scene=document, **given)
    (info,) = host.run(prompt)["editor"]["physanimator_editor"]
    shown = np.asarray(Image.open(io.BytesIO(host.view(info["image"]))))
    assert shown.shape == (720, 1280, 4)
    assert np.abs(shown[..., 3].astype(int) - example("mask_ribbon.png")).max() <= 1
