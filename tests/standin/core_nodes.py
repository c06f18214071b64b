"""Nodes of the host that graphs without models use."""

from __future__ import annotations

import os
from fractions import Fraction
from typing import Any, NamedTuple

import folder_paths
import numpy as np
import torch
from comfy_api.latest import io, ui
from PIL import Image

__all__ = ["NODES"]


class Clip(NamedTuple):
    images: torch.Tensor
    rate: Fraction


def _schema(name: str, inputs: list[Any], *outputs: Any, saves: bool = False) -> io.Schema:
    return io.Schema(node_id=name, inputs=inputs, outputs=list(outputs), is_output_node=saves)


class LoadImage(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        files = sorted(os.listdir(folder_paths.get_input_directory()))
        return _schema("LoadImage", [io.Combo.Input("image", options=files)], io.Image.Output(), io.Mask.Output())

    @classmethod
    def execute(cls, image: str) -> io.NodeOutput:
        with Image.open(os.path.join(folder_paths.get_input_directory(), image)) as opened:
            pixels = torch.from_numpy(np.array(opened.convert("RGBA"))).float() / 255
        return io.NodeOutput(pixels[None, ..., :3], 1 - pixels[None, ..., 3])


class CreateVideo(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        fps = io.Float.Input("fps", default=30.0, min=1.0, max=120.0, step=1.0)
        return _schema("CreateVideo", [io.Image.Input("images"), fps], io.Video.Output())

    @classmethod
    def execute(cls, images: torch.Tensor, fps: float) -> io.NodeOutput:
        return io.NodeOutput(Clip(images, Fraction(fps)))


class SaveVideo(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        inputs = [
            io.Video.Input("video"),
            io.String.Input("filename_prefix", default="video/ComfyUI"),
            io.Combo.Input("format", options=["auto", "mp4"], default="auto"),
            io.Combo.Input("codec", options=["auto", "h264"], default="auto"),
        ]
        return _schema("SaveVideo", inputs, saves=True)

    @classmethod
    def execute(cls, video: Clip, filename_prefix: str, format: str, codec: str) -> io.NodeOutput:
        import av

        height, width = video.images.shape[1:3]
        folder, name, number, subfolder, _ = folder_paths.get_save_image_path(
            filename_prefix, folder_paths.get_output_directory(), width, height
        )
        file = f"{name}_{number:05}_.mp4"
        with av.open(os.path.join(folder, file), "w") as container:
            stream = container.add_stream("h264", rate=Fraction(round(video.rate * 1000), 1000))
            stream.width, stream.height, stream.pix_fmt = width, height, "yuv420p"
            for image in video.images:
                frame = av.VideoFrame.from_ndarray((image[..., :3] * 255).clamp(0, 255).byte().numpy(), format="rgb24")
                container.mux(stream.encode(frame.reformat(format="yuv420p")))
            container.mux(stream.encode(None))
        saved = ui.SavedResult(file, subfolder, io.FolderType.output)
        return io.NodeOutput(ui=ui.SavedImages([saved], is_animated=True))


class SaveAnimatedWEBP(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        inputs = [
            io.Image.Input("images"),
            io.String.Input("filename_prefix", default="ComfyUI"),
            io.Float.Input("fps", default=6.0, min=0.01, max=1000.0, step=0.01),
            io.Boolean.Input("lossless", default=True),
            io.Int.Input("quality", default=80, min=0, max=100),
            io.Combo.Input("method", options=["default", "fastest", "slowest"]),
        ]
        return _schema("SaveAnimatedWEBP", inputs, saves=True)

    @classmethod
    def execute(cls, images: torch.Tensor, filename_prefix: str, method: str, **others: Any) -> io.NodeOutput:
        effort = {"default": 4, "fastest": 0, "slowest": 6}[method]
        saved = ui.ImageSaveHelper.save_animated_webp(
            images, filename_prefix, io.FolderType.output, None, method=effort, **others
        )
        return io.NodeOutput(ui=ui.SavedImages([saved], is_animated=len(images) > 1))


class PreviewImage(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return _schema("PreviewImage", [io.Image.Input("images")], saves=True)

    @classmethod
    def execute(cls, images: torch.Tensor) -> io.NodeOutput:
        return io.NodeOutput(ui=ui.PreviewImage(images))


class PreviewAny(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return _schema("PreviewAny", [io.Custom("*").Input("source")], saves=True)

    @classmethod
    def execute(cls, source: Any = None) -> io.NodeOutput:
        return io.NodeOutput(ui={"text": (source if isinstance(source, str) else str(source),)})


class EmptyImage(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        sides = [io.Int.Input(name, default=512, min=1, max=16384) for name in ("width", "height")]
        more = [io.Int.Input("batch_size", default=1, min=1, max=4096), io.Int.Input("color", default=0, min=0)]
        return _schema("EmptyImage", [*sides, *more], io.Image.Output())

    @classmethod
    def execute(cls, width: int, height: int, batch_size: int, color: int) -> io.NodeOutput:
        colour = torch.tensor([color >> 16 & 255, color >> 8 & 255, color & 255]) / 255
        return io.NodeOutput(colour.expand(batch_size, height, width, 3).clone())


class RepeatImageBatch(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        amount = io.Int.Input("amount", default=1, min=1, max=4096)
        return _schema("RepeatImageBatch", [io.Image.Input("image"), amount], io.Image.Output())

    @classmethod
    def execute(cls, image: torch.Tensor, amount: int) -> io.NodeOutput:
        return io.NodeOutput(image.repeat(amount, 1, 1, 1))


class ImageBatch(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return _schema("ImageBatch", [io.Image.Input("image1"), io.Image.Input("image2")], io.Image.Output())

    @classmethod
    def execute(cls, image1: torch.Tensor, image2: torch.Tensor) -> io.NodeOutput:
        return io.NodeOutput(torch.cat((image1, image2)))


class SolidMask(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        sides = [io.Int.Input(name, default=512, min=1, max=16384) for name in ("width", "height")]
        value = io.Float.Input("value", default=1.0, min=0.0, max=1.0, step=0.01)
        return _schema("SolidMask", [value, *sides], io.Mask.Output())

    @classmethod
    def execute(cls, value: float, width: int, height: int) -> io.NodeOutput:
        return io.NodeOutput(torch.full((1, height, width), value))


class MaskComposite(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        corner = [io.Int.Input(name, default=0, min=0, max=16384) for name in "xy"]
        inputs = [io.Mask.Input("destination"), io.Mask.Input("source"), *corner]
        return _schema("MaskComposite", [*inputs, io.Combo.Input("operation", options=["add"])], io.Mask.Output())

    @classmethod
    def execute(cls, destination: torch.Tensor, source: torch.Tensor, x: int, y: int, operation: str) -> io.NodeOutput:
        made = destination.clone()
        height, width = source.shape[-2:]
        part = made[:, y : y + height, x : x + width]
        made[:, y : y + height, x : x + width] = (part + source[:, : part.shape[1], : part.shape[2]]).clamp(0, 1)
        return io.NodeOutput(made)


class MaskToImage(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return _schema("MaskToImage", [io.Mask.Input("mask")], io.Image.Output())

    @classmethod
    def execute(cls, mask: torch.Tensor) -> io.NodeOutput:
        return io.NodeOutput(mask.reshape(-1, *mask.shape[-2:])[..., None].repeat(1, 1, 1, 3))


class ImageToMask(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        channel = io.Combo.Input("channel", options=["red", "green", "blue", "alpha"])
        return _schema("ImageToMask", [io.Image.Input("image"), channel], io.Mask.Output())

    @classmethod
    def execute(cls, image: torch.Tensor, channel: str) -> io.NodeOutput:
        return io.NodeOutput(image[..., ("red", "green", "blue", "alpha").index(channel)])


class InvertMask(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return _schema("InvertMask", [io.Mask.Input("mask")], io.Mask.Output())

    @classmethod
    def execute(cls, mask: torch.Tensor) -> io.NodeOutput:
        return io.NodeOutput(1 - mask)


class FeatherMask(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        sides = [io.Int.Input(name, default=0, min=0, max=16384) for name in ("left", "top", "right", "bottom")]
        return _schema("FeatherMask", [io.Mask.Input("mask"), *sides], io.Mask.Output())

    @classmethod
    def execute(cls, mask: torch.Tensor, left: int, top: int, right: int, bottom: int) -> io.NodeOutput:
        if left or top or bottom:
            raise NotImplementedError("the stand-in fades the right side alone")
        made = mask.clone()
        made[..., made.shape[-1] - right :] *= torch.linspace(1, 1 / right, right)
        return io.NodeOutput(made)


class ImageScale(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        sides = [io.Int.Input(name, default=512, min=0, max=16384) for name in ("width", "height")]
        methods = ["nearest-exact", "bilinear", "area", "bicubic", "lanczos"]
        method = io.Combo.Input("upscale_method", options=methods)
        crop = io.Combo.Input("crop", options=["disabled", "center"])
        return _schema("ImageScale", [io.Image.Input("image"), method, *sides, crop], io.Image.Output())

    @classmethod
    def execute(cls, image: torch.Tensor, upscale_method: str, width: int, height: int, crop: str) -> io.NodeOutput:
        scaled = torch.nn.functional.interpolate(image.movedim(-1, 1), (height, width), mode=upscale_method)
        return io.NodeOutput(scaled.movedim(1, -1))


class ImageStitch(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        inputs = [
            io.Image.Input("image1"),
            io.Combo.Input("direction", options=["right", "down", "left", "up"], default="right"),
            io.Boolean.Input("match_image_size", default=True),
            io.Int.Input("spacing_width", default=0, min=0, max=1024, step=2),
            io.Combo.Input("spacing_color", options=["white", "black", "red", "green", "blue"], default="white"),
            io.Image.Input("image2", optional=True),
        ]
        return _schema("ImageStitch", inputs, io.Image.Output())

    @classmethod
    def execute(cls, image1: torch.Tensor, direction: str, image2: torch.Tensor, **others: Any) -> io.NodeOutput:
        return io.NodeOutput(torch.cat((image1, image2), {"right": 2, "down": 1}[direction]))


def _of_this_file() -> list[type[io.ComfyNode]]:
    return [each for each in list(globals().values()) if isinstance(each, type) and issubclass(each, io.ComfyNode)]


NODES = _of_this_file()
