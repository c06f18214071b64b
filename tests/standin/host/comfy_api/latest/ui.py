"""What nodes show, and the files behind it."""

from __future__ import annotations

import os
import random
from typing import Any

import folder_paths
import numpy as np
from PIL import Image

from .io import FolderType

__all__ = ["ImageSaveHelper", "PreviewImage", "SavedImages", "SavedResult"]


class SavedResult(dict):
    def __init__(self, filename, subfolder, type):
        super().__init__(filename=filename, subfolder=subfolder, type=type.value)


class SavedImages:
    def __init__(self, results, is_animated=False):
        self.results, self.is_animated = results, is_animated

    def as_dict(self) -> dict[str, Any]:
        return {"images": self.results} | ({"animated": (True,)} if self.is_animated else {})


class PreviewImage:
    def __init__(self, image, animated=False, cls=None, **kwargs):
        name = f"ComfyUI_temp_{random.randrange(16**8):08x}"
        self.values = ImageSaveHelper.save_images(image, name, FolderType.temp, cls, 1)
        self.animated = animated

    def as_dict(self) -> dict[str, Any]:
        return {"images": self.values, "animated": (self.animated,)}


class ImageSaveHelper:
    @staticmethod
    def save_images(images, filename_prefix, folder_type, cls, compress_level=4) -> list[SavedResult]:
        folder, name, number, subfolder = _place(images, filename_prefix, folder_type)
        results = []
        for count, image in enumerate(_pictures(images)):
            file = f"{name}_{number + count:05}_.png"
            image.save(os.path.join(folder, file), compress_level=compress_level)
            results.append(SavedResult(file, subfolder, folder_type))
        return results

    @staticmethod
    def save_animated_webp(images, filename_prefix, folder_type, cls, fps, lossless, quality, method) -> SavedResult:
        folder, name, number, subfolder = _place(images, filename_prefix, folder_type)
        first, *others = _pictures(images)
        file = f"{name}_{number:05}_.webp"
        timing = {"save_all": True, "append_images": others, "duration": int(1000.0 / fps)}
        first.save(os.path.join(folder, file), lossless=lossless, quality=quality, method=method, **timing)
        return SavedResult(file, subfolder, folder_type)


def _place(images, prefix, kind) -> tuple[str, str, int, str]:
    root = {
        FolderType.input: folder_paths.get_input_directory,
        FolderType.output: folder_paths.get_output_directory,
        FolderType.temp: folder_paths.get_temp_directory,
    }[kind]()
    return folder_paths.get_save_image_path(prefix, root, images[0].shape[1], images[0].shape[0])[:4]


def _pictures(images) -> list[Image.Image]:
    return [Image.fromarray(np.clip(255.0 * each.cpu().numpy(), 0, 255).astype(np.uint8)) for each in images]
