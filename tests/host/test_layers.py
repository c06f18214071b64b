"""Layered artwork in a real host: every step takes it, and what stands still is left alone."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from bar_graphs import core, ours
from layered_files import HEIGHT, WIDTH, bust, filled, moved_layers, upload, write_ora
from PIL import Image


@pytest.fixture(scope="module")
def file(host: Any) -> str:
    write_ora(host.folder / "input" / "drawn" / "胸像.ora", bust())
    return "drawn/胸像.ora"


def pictures(host: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    files = outputs[key]["images"]
    return np.stack([np.asarray(Image.open(io.BytesIO(host.view(each))).convert("RGB")) for each in files]).astype(int)


def refusal(host: Any, prompt: dict[str, Any], key: str) -> str:
    """The sentence with which a prompt is refused before it runs."""
    status, answer = host.post("/prompt", {"prompt": prompt, "client_id": host.client})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    return answer["node_errors"][key]["errors"][0]["details"]


def failure(host: Any, prompt: dict[str, Any]) -> str:
    """The sentence with which a node fails."""
    entry = host.wait(host.queue(prompt))
    (message,) = [each[1] for each in entry["status"]["messages"] if each[0] == "execution_error"]
    return str(message["exception_message"])


def test_layers_move_behind_and_before_what_stands_still(host: Any, file: str) -> None:
    outputs = host.run(moved_layers(file))
    frames, flat = pictures(host, outputs, "seen"), pictures(host, outputs, "flat")[0]
    assert frames.shape == (5, HEIGHT, WIDTH, 3)
    assert np.abs(frames[0] - flat).max() <= 1
    moved = np.abs(frames - frames[0]).max(axis=(0, 3)) > 24
    assert moved[60:84, 50:118].mean() > 0.05, "the hair behind moves where it hangs free"
    cheek = slice(44, 60), slice(62, 98)
    assert not moved[cheek].any(), "and not before the face"
    assert (frames[:, cheek[0], cheek[1]] == (250, 220, 180)).all()
    (report,) = outputs["report"]["text"]
    assert report.splitlines()[0].startswith("前髪: moves as hair")
    assert "face: stands still" in report


def test_every_step_takes_layers(host: Any, file: str) -> None:
    motion, image = {"motion": ["motion", 0]}, {"image": ["bodies", 1]}
    form = {"frames": 5, "width": 160, "height": 96, "fit": "stretch"}
    prompt = moved_layers(file) | {
        "animation": ours("SaveAnimation", filename_prefix="layers/bust", file_type="png frames", width=0, **motion,
                          **image),
        "warped": ours("WarpedVideo", grow=2, **form, **motion, **image),
        "holes": core("MaskToImage", mask=["warped", 1]),
        "seen_holes": core("PreviewImage", images=["holes", 0]),
        "seen_warped": core("PreviewImage", images=["warped", 0]),
        "sketch": ours("ExtractSketch", line_width=1.0, threshold=0.02, coherence=3.0, smallest_speck=0, **image),
        "lines": ours("LineControlVideo", sketch=["sketch", 0], lines="black on white", **form, **motion),
        "seen_lines": core("PreviewImage", images=["lines", 0]),
        "both": ours("FirstAndLastFrame", first_frame=0, last_frame=-1, width=160, height=96, fit="stretch", **motion,
                     **image),
        "seen_last": core("PreviewImage", images=["both", 1]),
        "flow": ours("OpticalFlow", **motion),
        "warp": ours("WarpSketch", sketch=["sketch", 0], flow=["flow", 0], mode="layered", blur_sigma=0.0),
        "seen_warp": core("PreviewImage", images=["warp", 0]),
        "flowing": ours("PreviewFlow", flow=["flow", 0], every=1, largest=0.0),
        "tracks": ours("Tracks", points=16, static_points=4, frames=0, width=0, height=0, fit="crop", weighting=0.5,
                       **motion),
        "preview": ours("PreviewMotion", image=["bodies", 1], longest_side=160, every=1, **motion),
        "between": ours("Interpolate", images=["render", 0], images_are="all frames", every=4, backend="motion",
                        **motion, **image),
        "seen_between": core("PreviewImage", images=["between", 0]),
        "metrics": ours("Metrics", images=["render", 0], drawing=["bodies", 1], **motion),
        "frame": ours("FrameAsLayers", frame=-1, **motion),
        "again": ours("ArtworkToBodies", layers=["frame", 0], move="", still="", preset="by name", spacing=8.0,
                      elements_across=2, strands=True),
        "seen_frame": core("PreviewImage", images=["again", 1]),
    }  # fmt: skip
    outputs = host.run(prompt)
    frames = pictures(host, outputs, "seen")
    assert np.abs(pictures(host, outputs, "animation") - frames).max() <= 1
    assert pictures(host, outputs, "seen_holes").max() == 0, "somebody drew what is behind"
    for key, wanted in (("seen_warped", frames), ("seen_last", frames[-1:]), ("seen_frame", frames[-1:])):
        assert np.abs(pictures(host, outputs, key) - wanted).mean() < 1, key
    between = pictures(host, outputs, "seen_between")
    assert np.abs(between - frames).mean() < 6
    still = np.abs(between - between[0]).max(axis=(0, 3))[44:56, 66:94]
    assert still.max() <= 1, "in-betweens leave the face alone"
    for key in ("seen_lines", "seen_warp"):
        lines = pictures(host, outputs, key)
        assert np.abs(lines - lines[0]).max() > 100, "lines move"


def test_layers_go_out_as_a_file_and_come_in_again(host: Any, file: str) -> None:
    from psd_tools import PSDImage

    prompt = {
        "load": ours("LoadLayers", file=file),
        "save": ours("SaveLayers", layers=["load", 0], filename_prefix="art/bust", file_type="psd"),
        "path": core("PreviewAny", source=["save", 0]),
    }
    (path,) = host.run(prompt)["path"]["text"]
    assert path.startswith(str(host.folder / "output" / "art"))
    saved = PSDImage.open(path)
    assert [layer.name for layer in saved] == ["background", "後ろ髪", "face", "前髪"]
    assert [layer.bbox for layer in saved][1:] == [(50, 10, 110, 84), (60, 20, 100, 60), (64, 12, 96, 34)]
    with open(path, "rb") as written:
        answer = upload(host, "saved again.psd", written.read())
    prompt = {"load": ours("LoadLayers", file=answer["name"]), "seen": core("PreviewImage", images=["load", 1])}
    again = pictures(host, host.run(prompt), "seen")[0]
    (host.folder / "input" / answer["name"]).unlink()
    assert (again[70, 80] == (200, 40, 40)).all()
    assert (again[50, 80] == (250, 220, 180)).all()


def test_a_changed_file_is_read_again(host: Any) -> None:
    path = host.folder / "input" / "changing.ora"
    prompt = {"load": ours("LoadLayers", file=path.name), "seen": core("PreviewImage", images=["load", 1])}
    seen = []
    for colour in ((10, 200, 30), (200, 10, 30)):
        write_ora(path, [("all", filled(colour, 0, 0, WIDTH, HEIGHT))])
        seen.append(pictures(host, host.run(prompt), "seen")[0, 0, 0].tolist())
    path.unlink()
    assert seen == [[10, 200, 30], [200, 10, 30]]


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("../../etc/passwd", "file must be a layered file in the host's input folder"),
        ("/etc/passwd", "file must be a layered file in the host's input folder"),
        ("a\0b.psd", "file must be a layered file in the host's input folder"),
        ("", "file must be a layered file in the host's input folder"),
        ("nowhere.psd", "file must be one of the layered files in the input folder"),
        ("note.txt", "file must be a .psd, .psb or .ora file, or a folder of PNG files"),
    ],
)
def test_files_elsewhere_are_refused_before_the_graph_runs(host: Any, name: str, sentence: str) -> None:
    (host.folder / "input" / "note.txt").write_text("no layers")
    prompt = {"load": ours("LoadLayers", file=name), "seen": core("PreviewImage", images=["load", 1])}
    assert sentence in refusal(host, prompt, "load")


def batch(*colours: int) -> dict[str, Any]:
    """Grey pictures of 64 x 48 px as one batch."""
    made = {f"grey{n}": core("EmptyImage", width=64, height=48, batch_size=1, color=c) for n, c in enumerate(colours)}
    made["batch0"] = made.pop("grey0")
    for number in range(1, len(colours)):
        made[f"batch{number}"] = core("ImageBatch", image1=[f"batch{number - 1}", 0], image2=[f"grey{number}", 0])
    return made


def test_a_batch_becomes_layers(host: Any) -> None:
    mask = {
        "none": core("SolidMask", value=0.0, width=64, height=48),
        "some": core("SolidMask", value=1.0, width=20, height=30),
        "mask": core("MaskComposite", destination=["none", 0], source=["some", 0], x=10, y=5, operation="add"),
    }
    layers = ours("LayersFromImageBatch", images=["batch1", 0], names="paper\nribbon", white_is="the part",
                  masks=["mask", 0])  # fmt: skip
    prompt = batch(0x0000FF, 0xFF0000) | mask | {
        "layers": layers,
        "seen": core("PreviewImage", images=["layers", 1]),
        "alpha": core("MaskToImage", mask=["layers", 2]),
        "seen_alpha": core("PreviewImage", images=["alpha", 0]),
        "bodies": ours("ArtworkToBodies", layers=["layers", 0], move="", still="", preset="by name", spacing=0.0,
                       elements_across=3, strands=True),
        "report": core("PreviewAny", source=["bodies", 2]),
    }  # fmt: skip
    outputs = host.run(prompt)
    assert pictures(host, outputs, "seen")[0, 20, 20].tolist() == [255, 0, 0]
    alpha = pictures(host, outputs, "seen_alpha")[0]
    assert alpha[20, 20, 0] == 0
    assert alpha[2, 2, 0] == 255
    assert outputs["report"]["text"][0].splitlines()[0] == "ribbon: moves as ribbon (the name says ribbon)"
    too_many = prompt | {"layers": layers | {"inputs": layers["inputs"] | {"names": "a\nb\nc"}}}
    assert "names must be at most 2, one for each picture" in failure(host, too_many)


def test_bodies_of_layers_and_of_masks_do_not_mix(host: Any, file: str) -> None:
    usual = {"preset": "hair", "layer": 0, "attach": "auto"}
    mask = {"mask": core("SolidMask", value=1.0, width=WIDTH, height=HEIGHT)}
    mesh = {"mesh": ours("MaskToMesh", mask=["mask", 0], spacing=20.0, elements_across=1, mask_index=0)}
    after = {"body": ours("Body", mesh=["mesh", 0], bodies=["bodies", 0], **usual)}
    end = {"scene": ours("Scene", bodies=["body", 0], gravity_x=0.0, gravity_y=1.0, frame_rate=12.0)}
    layers = {key: moved_layers(file)[key] for key in ("load", "bodies")}
    shown = {"shown": core("PreviewAny", source=["scene", 1])}
    assert "bodies of layers and bodies of masks" in failure(host, layers | mask | mesh | after | end | shown)
    before = {"body": ours("Body", mesh=["mesh", 0], **usual)}
    mixed = moved_layers(file, bodies=["body", 0])
    shown = {"shown": core("PreviewAny", source=["bodies", 2])}
    prompt = {"load": mixed["load"], "bodies": mixed["bodies"]} | mask | mesh | before | shown
    assert "bodies of layers and bodies of masks" in failure(host, prompt)


def test_layers_of_one_artwork_can_be_bodies_in_two_nodes(host: Any, file: str) -> None:
    prompt = moved_layers(file, still="前髪") | {
        "more": ours("ArtworkToBodies", layers=["load", 0], move="前髪=ribbon", still="", preset="by name", spacing=5.0,
                     elements_across=2, strands=True, bodies=["bodies", 0]),
        "more_report": core("PreviewAny", source=["more", 2]),
    }  # fmt: skip
    prompt["scene"]["inputs"]["bodies"] = ["more", 0]
    outputs = host.run(prompt)
    frames, flat = pictures(host, outputs, "seen"), pictures(host, outputs, "flat")[0]
    assert np.abs(frames[0] - flat).max() <= 1
    assert "前髪: moves as ribbon (asked for)" in outputs["more_report"]["text"][0]
    again = prompt | {"more": prompt["more"] | {"inputs": prompt["more"]["inputs"] | {"move": "後ろ髪"}}}
    assert "move must be of layers that are no bodies yet" in failure(host, again)


def test_slit_strands_and_contact_go_together(host: Any, file: str) -> None:
    prompt = moved_layers("PhysAnimator example.psd", spacing=0.0, frames=2)
    prompt["contact"] = ours("Contact", friction=0.0, thickness=1.0, self_contact=True)
    prompt["scene"]["inputs"]["contact"] = ["contact", 0]
    frames = pictures(host, host.run(prompt), "seen")
    assert len(frames) == 2
    assert np.abs(frames[0] - frames[1]).max() > 1


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"clean_plate": ["bodies", 1]}, "clean_plate must be left out where the moving parts are layers"),
        ({"pixel_art": True}, "pixel_art must be left out where the moving parts are layers"),
        ({"image": ["small", 0]}, "image must be of the layers' size, 160 x 96 px"),
    ],
)
def test_what_layers_say_already_is_refused(host: Any, file: str, changes: dict[str, Any], sentence: str) -> None:
    prompt = moved_layers(file, frames=2)
    prompt["small"] = core("EmptyImage", width=32, height=32, batch_size=1, color=0)
    prompt["render"]["inputs"] |= changes
    assert sentence in failure(host, prompt)


def test_another_picture_is_told(host: Any, file: str) -> None:
    prompt = moved_layers(file, frames=2)
    prompt["other"] = core("EmptyImage", width=WIDTH, height=HEIGHT, batch_size=1, color=0)
    prompt["render"]["inputs"]["image"] = ["other", 0]
    outputs = host.run(prompt)
    assert outputs["render"]["advice"] == [
        "image is another picture than the layers show: what is drawn are the layers."
    ]
    assert np.abs(pictures(host, outputs, "seen")[0] - pictures(host, outputs, "flat")[0]).max() <= 1


def test_a_still_part_in_front_of_a_flat_picture_s_hair(host: Any) -> None:
    from bar_graphs import moving_bar

    prompt = moving_bar(6)
    arm = {
        "arm_part": core("SolidMask", value=1.0, width=120, height=12),
        "arm": core("MaskComposite", destination=["black", 0], source=["arm_part", 0], x=20, y=44, operation="add"),
        "red": core("EmptyImage", width=160, height=96, batch_size=1, color=0xC04040),
        "drawn": core("ImageCompositeMasked", destination=["picture", 0], source=["red", 0], x=0, y=0,
                      resize_source=False, mask=["arm", 0]),
        "seen_part": core("MaskComposite", destination=["mask", 0], source=["arm", 0], x=0, y=0, operation="subtract"),
        "render": ours("Render", image=["drawn", 0], motion=["motion", 0]),
        "seen": core("PreviewImage", images=["render", 0]),
        "flow": ours("OpticalFlow", motion=["motion", 0]),
        "flowing": ours("PreviewFlow", flow=["flow", 0], every=1, largest=0.0),
        "seen_flow": core("PreviewImage", images=["flowing", 0]),
    }  # fmt: skip
    prompt |= arm
    prompt["mesh"]["inputs"] |= {"mask": ["seen_part", 0], "image": ["drawn", 0], "in_front": ["arm", 0]}
    prompt["scene"]["inputs"]["wind_strength"] = 6.0
    outputs = host.run(prompt)
    frames = pictures(host, outputs, "seen")
    assert (np.abs(frames - frames[0])[:, 46:54, 24:136] <= 1).all(), "the arm stays as drawn"
    below = np.abs(frames - frames[0]).max(axis=(0, 3))[60:80, 56:110]
    assert (below > 60).mean() > 0.05, "and the bar goes on below it"
    flow = pictures(host, outputs, "seen_flow")
    assert (flow[-1, 46:54, 62:82] == flow[0, 46:54, 62:82]).all(), "what shows there does not move"
    assert np.abs(flow[-1, 60:78, 62:82] - flow[0, 60:78, 62:82]).max() > 24
