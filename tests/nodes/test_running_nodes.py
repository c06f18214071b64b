"""Nodes in the stand-in where the published workflows do not show what they do: choices, caches, files, refusals."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from bar_graphs import core, drawn_bar, moving_bar, ours
from PIL import Image

SCHEMAS: dict[str, Any] = json.loads(Path(__file__).with_name("node_schemas.json").read_text(encoding="utf-8"))
API = (Path(__file__).resolve().parents[2] / "workflows" / "api").glob("*.json")
IN_WORKFLOWS = {node["class_type"] for path in API for node in json.loads(path.read_text(encoding="utf-8")).values()}
RUN_HERE = {"FrameAsLayers", "LayersFromImageBatch", "SaveAnimation", "SaveLayers", "SaveSpineOrGltf",
            "SaveMotionVectors", "MovingNoise"}  # fmt: skip
"""Nodes that stand in no published workflow, all of which are run in test_running_workflows.py."""
FILE_TYPES = SCHEMAS["PhysAnimator_SaveAnimation"]["input"]["required"]["file_type"][1]["options"]


def pictures(standin: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    return np.stack([np.asarray(Image.open(standin.file(saved))).astype(int) for saved in outputs[key]["images"]])


def test_every_node_is_run_here_or_in_a_workflow() -> None:
    assert set(SCHEMAS) - IN_WORKFLOWS == {f"PhysAnimator_{name}" for name in RUN_HERE}


def test_a_bar_moves_and_what_was_not_changed_is_not_computed_again(standin: Any) -> None:
    prompt = drawn_bar()
    frames = pictures(standin, standin.run(prompt), "seen")
    assert frames.shape == (4, 96, 160, 3)
    assert np.abs(frames[3] - frames[0]).max() > 60
    assert {"motion", "render"} <= set(standin.executed)
    assert {node for node, _, _ in standin.progress} >= {"motion", "render"}
    standin.run(prompt)
    assert standin.executed == []
    prompt["scene"]["inputs"]["wind_strength"] = 2.0
    standin.run(prompt)
    assert "mesh" not in standin.executed
    assert {"scene", "motion", "render"} <= set(standin.executed)


def test_the_same_scene_in_another_spelling_is_not_simulated_again(standin: Any) -> None:
    document = {"version": 2, "width": 160, "height": 96, "frame_rate": 12,
                "strokes": [{"kind": "wind", "path": [[10, 40], [150, 40]], "radius": 80, "speed": 300}]}  # fmt: skip
    prompt = drawn_bar(3)
    prompt["scene"] = ours("SceneEditor", scene=json.dumps(document), bodies=["body", 0])
    standin.run(prompt)
    assert "motion" in standin.executed
    document |= {"width": 160.0, "frame_rate": 12.0}
    prompt["scene"]["inputs"]["scene"] = json.dumps(dict(reversed(document.items())), indent=2)
    standin.run(prompt)
    assert standin.executed == []
    document["strokes"][0]["speed"] = 301
    prompt["scene"]["inputs"]["scene"] = json.dumps(document)
    standin.run(prompt)
    assert {"scene", "motion"} <= set(standin.executed)


def test_an_output_is_made_once_somebody_takes_it(standin: Any) -> None:
    prompt = drawn_bar(3)
    standin.run(prompt)
    prompt |= {"alpha": core("MaskToImage", mask=["render", 1]), "shown": core("PreviewImage", images=["alpha", 0])}
    alpha = pictures(standin, standin.run(prompt), "shown")
    assert "render" in standin.executed, "what was made without it does not serve"
    assert "motion" not in standin.executed
    assert alpha[0, 40, 72, 0] == 255
    assert alpha[0, 40, 10, 0] == 0


@pytest.mark.parametrize("file_type", FILE_TYPES)
def test_an_animation_is_saved_in_every_file_type(standin: Any, file_type: str) -> None:
    given = {"image": ["picture", 0], "motion": ["motion", 0], "filename_prefix": "film/bar", "width": 0}
    prompt = drawn_bar(3) | {"saved": ours("SaveAnimation", file_type=file_type, **given)}
    first, second = (standin.run(prompt | {"again": core("PreviewAny", source=["saved", 0])}) for _ in range(2))
    files = [standin.file(each) for each in first["saved"]["images"]]
    assert len(files) == (3 if file_type == "png frames" else 1)
    assert all(file.stat().st_size > 100 for file in files)
    assert first["again"]["text"] == second["again"]["text"], "the second time it comes from the cache"


def test_a_motion_is_saved_for_spine_and_gltf(standin: Any) -> None:
    given = {"image": ["picture", 0], "motion": ["motion", 0], "filename_prefix": "game/bar", "tolerance": 0.25}
    paths = []
    for file_type in ("spine", "glb", "spine"):
        prompt = drawn_bar(5) | {"saved": ours("SaveSpineOrGltf", file_type=file_type, **given)}
        prompt |= {"path": core("PreviewAny", source=["saved", 0])}
        if len(paths) == 2:
            prompt["saved"]["inputs"]["tolerance"] = 0.5
        outputs = standin.run(prompt)
        paths.append(Path(outputs["path"]["text"][0]))
        assert "px from the motion" in outputs["saved"]["text"][0]
    first, scene, second = paths
    assert sorted(file.name for file in first.iterdir() if not file.name.startswith(".")) == [
        f"{first.name}.atlas", f"{first.name}.json", f"{first.name}.png", "images"
    ]  # fmt: skip
    assert scene.read_bytes()[:4] == b"glTF"
    assert second != first
    for name, value in (("tolerance", 0.001), ("filename_prefix", "../up")):
        wrong = drawn_bar(5) | {"saved": ours("SaveSpineOrGltf", file_type="glb", **(given | {name: value}))}
        errors, _ = standin.post(wrong)
        assert f"{name} must be" in errors["saved"][0]["details"]


@pytest.mark.parametrize("colour", [0xFFFFFF, 0x000000])
def test_a_plate_of_another_picture_is_told(standin: Any, colour: int) -> None:
    """Whoever draws with it says so; black is what the picture shows beside the bar."""
    drawn = {"image": ["picture", 0], "motion": ["motion", 0], "clean_plate": ["behind", 0]}
    form = {"frames": 5, "width": 160, "height": 96, "fit": "crop"}
    prompt = moving_bar(5) | {
        "behind": core("EmptyImage", width=160, height=96, batch_size=1, color=colour),
        "render": ours("Render", **drawn),
        "seen": core("PreviewImage", images=["render", 0]),
        "saved": ours("SaveAnimation", file_type="webp", filename_prefix="plate/bar", width=0, **drawn),
        "rigged": ours("SaveSpineOrGltf", file_type="glb", tolerance=0.3, filename_prefix="plate/bar", **drawn),
        "warped": ours("WarpedVideo", grow=0, **drawn, **form),
        "bent": core("PreviewImage", images=["warped", 0]),
        "ends": ours("FirstAndLastFrame", first_frame=0, last_frame=-1, **drawn, **{**form, "frames": 0}),
        "end": core("PreviewImage", images=["ends", 0]),
    }
    del prompt["ends"]["inputs"]["frames"]
    outputs = standin.run(prompt)
    sentence = "clean_plate differs from the picture on 100 % of what does not move"
    for node in ("render", "saved", "rigged", "warped", "ends"):
        told = [each for each in outputs.get(node, {}).get("advice", []) if each.startswith("clean_plate")]
        assert len(told) == (colour > 0), node
        assert all(each.startswith(sentence) for each in told)


def test_moving_noise_is_a_latent_of_a_video(standin: Any) -> None:
    form = {"frames": 9, "width": 160, "height": 96, "fit": "crop"}
    prompt = drawn_bar(3)
    prompt |= {
        "noise": ours("MovingNoise", motion=["motion", 0], channels=4, seed=3, **form),
        "shown": core("PreviewAny", source=["noise", 0]),
    }
    _, run = standin.post(prompt)
    assert [(done, total) for node, done, total in standin.progress if node == "noise"][-1] == (3, 3)
    latent = run.make("noise")[1].outputs[0][0]["samples"]
    assert latent.shape == (1, 4, 3, 12, 20)
    assert abs(float(latent.var()) - 1) < 0.2


def test_motion_vectors_are_saved_in_a_folder_of_their_own(standin: Any) -> None:
    pytest.importorskip("OpenEXR")
    prompt = drawn_bar(3) | {"saved": ours("SaveMotionVectors", motion=["motion", 0], channels="blender")}
    for number in (1, 2):
        prompt["saved"]["inputs"]["filename_prefix"] = "vectors/bar"
        (told,) = standin.run(prompt)["saved"]["text"]
        assert told == f"bar_{number:05}_: 3 files"
        folder = standin.folder / "output" / "vectors" / f"bar_{number:05}_"
        assert len(list(folder.glob("vectors_*.exr"))) == 3
        prompt["scene"]["inputs"]["wind_strength"] = 1.5
    prompt["saved"]["inputs"]["filename_prefix"] = "../out"
    with pytest.raises(Exception, match="filename_prefix must be a name in the output folder"):
        standin.run(prompt)


@pytest.mark.parametrize(("node", "file_type"), [("SaveAnimation", "mov"), ("SaveSpineOrGltf", "spine")])
def test_saving_tells_how_far_it_is_and_leaves_nothing_when_stopped(standin: Any, node: str, file_type: str) -> None:
    import comfy.model_management

    own = {"width": 0} if node == "SaveAnimation" else {"tolerance": 0.3}
    given = {"image": ["picture", 0], "motion": ["motion", 0], "filename_prefix": f"stopped/{file_type}"}
    prompt = drawn_bar(6) | {"saved": ours(node, file_type=file_type, **given, **own)}
    told, stopped = [], standin.progressed

    def stop(done: float, total: float, preview: Any, node_id: str | None = None) -> None:
        stopped(done, total, preview, node_id)
        if node_id == "saved":
            told.append((done, total))
            comfy.model_management.interrupt_current_processing()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("comfy.utils.PROGRESS_BAR_HOOK", stop)
        with pytest.raises(comfy.model_management.InterruptProcessingException):
            standin.run(prompt)
    assert told == [(1, 6 if node == "SaveAnimation" else 2)]
    assert list((standin.folder / "output" / "stopped").iterdir()) == []


def test_layers_from_pictures_move_and_are_saved_frame_by_frame(standin: Any) -> None:
    paper = core("EmptyImage", width=160, height=96, batch_size=1, color=0x4080C0)
    batch = core("ImageBatch", image1=["paper", 0], image2=["picture", 0])
    prompt = {name: node for name, node in drawn_bar().items() if name in ("black", "white", "mask", "picture")}
    prompt |= {
        "paper": paper,
        "everywhere": core("MaskToImage", mask=["all", 0]),
        "all": core("SolidMask", value=1.0, width=160, height=96),
        "batch": batch,
        "shapes": core("ImageBatch", image1=["everywhere", 0], image2=["picture", 0]),
        "both": core("ImageToMask", image=["shapes", 0], channel="red"),
        "layers": ours("LayersFromImageBatch", images=["batch", 0], names="paper\nribbon", white_is="the part",
                       masks=["both", 0]),
        "bodies": ours("ArtworkToBodies", layers=["layers", 0], move="", still="", preset="by name", spacing=8.0,
                       elements_across=2, strands=False),
        "scene": ours("AutomaticScene", bodies=["bodies", 0], wind_strength=3.0, wind_angle=0.0, sway_by_size=True,
                      frame_rate=12.0),
        "motion": ours("Simulate", scene=["scene", 0], frames=5),
        "frame": ours("FrameAsLayers", motion=["motion", 0], frame=-1),
        "saved": ours("SaveLayers", layers=["frame", 0], filename_prefix="layers/bar", file_type="psd"),
        "report": core("PreviewAny", source=["bodies", 2]),
    }  # fmt: skip
    outputs = standin.run(prompt)
    (path,) = outputs["saved"]["text"]
    assert Path(path).read_bytes()[:4] == b"8BPS"
    assert Path(path).parent == standin.folder / "output" / "layers"
    report = outputs["report"]["text"][0]
    assert "ribbon" in report
    assert "paper" in report
    prompt["frame"]["inputs"]["frame"] = 5
    assert "frame must be -5 to 4. Got: 5" in standin.error_of(prompt)


def test_lists_are_gone_through_one_by_one(standin: Any) -> None:
    """A node of the host may give a list: the nodes behind it run for each of its values."""
    from comfy_api.latest import io

    class Strengths(io.ComfyNode):
        @classmethod
        def define_schema(cls) -> Any:
            return io.Schema(node_id="Strengths", outputs=[io.Float.Output(is_output_list=True)])

        @classmethod
        def execute(cls) -> Any:
            return io.NodeOutput([0.5, 3.0])

    standin.known["Strengths"] = Strengths
    prompt = drawn_bar(3) | {"strengths": core("Strengths")}
    prompt["scene"]["inputs"]["wind_strength"] = ["strengths", 0]
    weak, strong = pictures(standin, standin.run(prompt), "seen").reshape(2, 3, 96, 160, 3)
    assert np.abs(weak[0] - strong[0]).max() == 0
    assert np.abs(strong[2] - strong[0]).sum() > 2 * np.abs(weak[2] - weak[0]).sum()


@pytest.mark.parametrize(
    ("key", "inputs", "told"),
    [
        ("motion", {"frames": 0}, "frames"),
        ("motion", {"frames": "many"}, "Failed to convert"),
        ("body", {"preset": "stone"}, "Value not in list"),
        ("render", {"renderer": "crayons"}, "renderer must be"),
        ("render", {"background": "colour", "background.colour": "no colour"}, "colour"),
        ("render", {"renderer": "sketch-guided SVD"}, "renderer.sketches"),
        ("scene", {"bodies": ["mask", 0]}, "Return type mismatch"),
        ("mesh", {"mask": None}, "mask"),
    ],
)
def test_what_a_node_does_not_take_is_refused_before_it_runs(
    standin: Any, key: str, inputs: dict[str, Any], told: str
) -> None:
    prompt = drawn_bar(3)
    prompt[key]["inputs"] |= inputs
    assert told in standin.error_of(prompt)


def test_an_interruption_ends_the_node_that_runs(standin: Any) -> None:
    import comfy.model_management

    prompt = drawn_bar(200)
    prompt["scene"]["inputs"]["wind_angle"] = 15.0
    stopped = standin.progressed

    def stop(*told: Any, **more: Any) -> None:
        stopped(*told, **more)
        comfy.model_management.interrupt_current_processing()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("comfy.utils.PROGRESS_BAR_HOOK", stop)
        with pytest.raises(comfy.model_management.InterruptProcessingException):
            standin.run(prompt)
    assert "render" not in standin.executed
    assert len(standin.progress) < 20


def test_what_a_node_tells_reaches_the_page_and_the_history(standin: Any) -> None:
    prompt = drawn_bar(3)
    prompt["body"]["inputs"]["preset"] = "jelly"
    (sentence,) = standin.run(prompt)["render"]["advice"]
    assert "looks like pixel art" in sentence
    assert standin.server.messages[-1] == (
        "physanimator.advice",
        {"node": "render", "title": "Render (PhysAnimator)", "sentences": [sentence]},
    )


def test_a_class_that_runs_cannot_be_written_to(standin: Any) -> None:
    from comfy_api.latest import io

    class Writer(io.ComfyNode):
        @classmethod
        def define_schema(cls) -> Any:
            return io.Schema(node_id="Writer", is_output_node=True)

        @classmethod
        def execute(cls) -> Any:
            cls.kept = 1
            return io.NodeOutput()

    standin.known["Writer"] = Writer
    assert "Writer.kept cannot be set" in standin.error_of({"1": core("Writer")})


def test_the_editor_s_routes_stand_on_the_server(standin: Any) -> None:
    from physanimator.nodes.preview import server

    before = len(standin.server.routes)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(server, "_registered", type(server._registered)())
        server.register_routes()
    added = [route.path for route in list(standin.server.routes)[before:]]
    assert "/physanimator/preview" in added
