"""Inputs, outputs, schemas and nodes; names and parameters are the host's."""

from __future__ import annotations

from enum import Enum

from .described import Input, Output, WidgetInput
from .node import ComfyNode, NodeOutput, Schema

__all__ = [
    "Boolean",
    "Clip",
    "ClipVision",
    "Combo",
    "ComfyNode",
    "Conditioning",
    "Custom",
    "DynamicCombo",
    "Float",
    "FolderType",
    "Image",
    "Input",
    "Int",
    "Latent",
    "Mask",
    "NodeOutput",
    "Output",
    "Schema",
    "String",
    "Tracks",
    "Vae",
    "Video",
]


class FolderType(str, Enum):
    input = "input"
    output = "output"
    temp = "temp"


def Custom(io_type: str) -> type:
    """A type of wire; its Input and Output know its name."""
    return _wire(io_type)


def _wire(io_type: str, given: type[Input] = Input) -> type:
    kinds = {"Input": type("Input", (given,), {"io_type": io_type})}
    kinds["Output"] = type("Output", (Output,), {"io_type": io_type})
    return type(io_type, (), {"io_type": io_type, **kinds})


class _Boolean(WidgetInput):
    def __init__(self, id, display_name=None, optional=False, tooltip=None, lazy=None, default=None, label_on=None,
                 label_off=None, socketless=None, force_input=None, extra_dict=None, raw_link=None):  # fmt: skip
        super().__init__(id, display_name, optional, tooltip, lazy, default, socketless, None, force_input, extra_dict,
                         raw_link)  # fmt: skip
        self._tell(label_on=label_on, label_off=label_off)


class _Int(WidgetInput):
    def __init__(self, id, display_name=None, optional=False, tooltip=None, lazy=None, default=None, min=None, max=None,
                 step=None, control_after_generate=None, display_mode=None, socketless=None, force_input=None,
                 extra_dict=None, raw_link=None):  # fmt: skip
        super().__init__(id, display_name, optional, tooltip, lazy, default, socketless, None, force_input, extra_dict,
                         raw_link)  # fmt: skip
        self._tell(min=min, max=max, step=step, control_after_generate=control_after_generate, display=display_mode)


class _Float(WidgetInput):
    def __init__(self, id, display_name=None, optional=False, tooltip=None, lazy=None, default=None, min=None, max=None,
                 step=None, round=None, display_mode=None, socketless=None, force_input=None, extra_dict=None,
                 raw_link=None):  # fmt: skip
        super().__init__(id, display_name, optional, tooltip, lazy, default, socketless, None, force_input, extra_dict,
                         raw_link)  # fmt: skip
        self._tell(min=min, max=max, step=step, round=round, display=display_mode)


class _String(WidgetInput):
    def __init__(self, id, display_name=None, optional=False, tooltip=None, lazy=None, multiline=False,
                 placeholder=None, default=None, dynamic_prompts=None, socketless=None, force_input=None,
                 extra_dict=None, raw_link=None):  # fmt: skip
        super().__init__(id, display_name, optional, tooltip, lazy, default, socketless, None, force_input, extra_dict,
                         raw_link)  # fmt: skip
        self._tell(multiline=multiline, placeholder=placeholder, dynamicPrompts=dynamic_prompts)


class _Combo(WidgetInput):
    def __init__(self, id, options=None, display_name=None, optional=False, tooltip=None, lazy=None, default=None,
                 control_after_generate=None, upload=None, image_folder=None, remote=None, socketless=None,
                 extra_dict=None, raw_link=None):  # fmt: skip
        super().__init__(id, display_name, optional, tooltip, lazy, default, socketless, None, None, extra_dict,
                         raw_link)  # fmt: skip
        if upload is not None or image_folder is not None or remote is not None:
            raise NotImplementedError("the stand-in has no combos of uploads")
        self._tell(multiselect=False, options=options, control_after_generate=control_after_generate)


class _ComboOutput(Output):
    io_type = "COMBO"

    def __init__(self, id=None, display_name=None, options=None, tooltip=None, is_output_list=False):
        super().__init__(id, display_name, tooltip, is_output_list)
        self.options = options or []


class _DynamicCombo(Input):
    def __init__(self, id, options, display_name=None, optional=False, tooltip=None, lazy=None, extra_dict=None):
        super().__init__(id, display_name, optional, tooltip, lazy, extra_dict)
        self._tell(options=[option.as_dict() for option in options])


class _Option:
    def __init__(self, key, inputs):
        self.key, self.inputs = key, inputs

    def as_dict(self):
        return {"key": self.key, "inputs": described_inputs(self.inputs)}


def described_inputs(inputs):
    """As a schema reports them: required and optional ones, each a type and its options."""
    found = {"required": {}}
    for each in inputs:
        found.setdefault("optional" if each.optional else "required", {})[each.id] = (each.io_type, each.as_dict())
    return found


Boolean, Int, Float = _wire("BOOLEAN", _Boolean), _wire("INT", _Int), _wire("FLOAT", _Float)
String, Combo = _wire("STRING", _String), _wire("COMBO", _Combo)
Combo.Output = _ComboOutput
Image, Mask, Video, Latent = (_wire(name) for name in ("IMAGE", "MASK", "VIDEO", "LATENT"))
Clip, ClipVision, Tracks = _wire("CLIP"), _wire("CLIP_VISION"), _wire("TRACKS")
Conditioning, Vae = _wire("CONDITIONING"), _wire("VAE")
DynamicCombo = _wire("COMFY_DYNAMICCOMBO_V3", _DynamicCombo)
DynamicCombo.Option = _Option
del DynamicCombo.Output  # nothing gives one
