"""Where files are; ``standin.StandIn`` points it at a folder of its own."""

from __future__ import annotations

import os
import time
from pathlib import Path

_WEIGHTS = {".ckpt", ".pt", ".pt2", ".bin", ".pth", ".safetensors", ".pkl", ".sft"}
_KINDS = ("checkpoints", "controlnet", "clip_vision", "text_encoders", "vae", "diffusion_models", "frame_interpolation")

base_path = models_dir = ""
folder_names_and_paths: dict[str, tuple[list[str], set[str]]] = {}


def use(folder: Path) -> None:
    """Have input, output, temporary files and models below this folder."""
    global base_path, models_dir
    base_path, models_dir = str(folder), str(folder / "models")
    for kind in _KINDS:
        folder_names_and_paths[kind] = ([os.path.join(models_dir, kind)], _WEIGHTS)
    folder_names_and_paths["diffusers"] = ([os.path.join(models_dir, "diffusers")], {"folder"})
    for name in ("input", "output", "temp", "models"):
        (folder / name).mkdir(parents=True, exist_ok=True)


def get_input_directory() -> str:
    return os.path.join(base_path, "input")


def get_output_directory() -> str:
    return os.path.join(base_path, "output")


def get_temp_directory() -> str:
    return os.path.join(base_path, "temp")


def get_folder_paths(folder_name):
    return folder_names_and_paths[folder_name][0][:]


def get_filename_list(folder_name):
    folders, endings = folder_names_and_paths[folder_name]
    found = [each.relative_to(root) for root in map(Path, folders) for each in root.rglob("*") if each.is_file()]
    return sorted(str(each) for each in found if each.suffix.lower() in endings)


def get_full_path(folder_name, filename):
    places = (os.path.join(folder, filename) for folder in folder_names_and_paths[folder_name][0])
    return next((place for place in places if os.path.isfile(place)), None)


def get_save_image_path(filename_prefix, output_dir, image_width=0, image_height=0):
    now = time.localtime()
    known = {"width": image_width, "height": image_height, "year": now.tm_year, "month": f"{now.tm_mon:02}",
             "day": f"{now.tm_mday:02}", "hour": f"{now.tm_hour:02}", "minute": f"{now.tm_min:02}",
             "second": f"{now.tm_sec:02}"}  # fmt: skip
    for name, value in known.items():
        filename_prefix = filename_prefix.replace(f"%{name}%", str(value))
    subfolder, name = os.path.split(os.path.normpath(filename_prefix))
    folder = os.path.join(output_dir, subfolder)
    if os.path.commonpath((output_dir, os.path.abspath(folder))) != output_dir:
        raise Exception("Saving image outside the output folder is not allowed.")
    os.makedirs(folder, exist_ok=True)
    taken = [each[len(name) + 1 :].split("_")[0] for each in os.listdir(folder) if each.startswith(f"{name}_")]
    number = 1 + max((int(each) for each in taken if each.isdigit()), default=0)
    return folder, name, number, subfolder, filename_prefix
