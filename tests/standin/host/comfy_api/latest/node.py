"""A node's schema, its class and its result."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

__all__ = ["ComfyNode", "NodeOutput", "Schema"]


@dataclass
class Schema:
    node_id: str
    display_name: str | None = None
    category: str = "sd"
    inputs: list[Any] = field(default_factory=list)
    outputs: list[Any] = field(default_factory=list)
    hidden: list[Any] = field(default_factory=list)
    description: str = ""
    is_input_list: bool = False
    is_output_node: bool = False
    is_deprecated: bool = False
    is_experimental: bool = False
    is_api_node: bool = False
    not_idempotent: bool = False
    enable_expand: bool = False

    def validate(self) -> None:
        for kind, ids in (("Input", [each.id for each in self.inputs]), ("Output", [each.id for each in self.outputs])):
            named = [each for each in ids if each is not None]
            if len(set(named)) != len(named):
                raise ValueError(f"{kind} ids must be unique. Got: {named}")

    def _told_inputs(self) -> dict[str, Any]:
        from .io import described_inputs

        found = described_inputs(self.inputs)
        if self.is_output_node:  # the host hands it the prompt, to be written into the file
            found["hidden"] = {"prompt": ("PROMPT",), "extra_pnginfo": ("EXTRA_PNGINFO",)}
        return found


class _NodeClass(type):
    """What the host asks of a node's class; a class that is being run cannot be written to."""

    def __setattr__(cls, name: str, value: Any) -> None:
        if vars(cls).get("_locked"):
            raise AttributeError(f"{cls.__name__}.{name} cannot be set while the node runs")
        super().__setattr__(name, value)

    @property
    def RETURN_TYPES(cls) -> list[str]:
        return [each.io_type for each in cls.define_schema().outputs]

    @property
    def OUTPUT_IS_LIST(cls) -> list[bool]:
        return [each.is_output_list for each in cls.define_schema().outputs]

    @property
    def INPUT_IS_LIST(cls) -> bool:
        return cls.define_schema().is_input_list

    @property
    def OUTPUT_NODE(cls) -> bool:
        return cls.define_schema().is_output_node


class ComfyNode(metaclass=_NodeClass):
    RELATIVE_PYTHON_MODULE: str | None = None
    FUNCTION = "EXECUTE_NORMALIZED"
    hidden: Any = None

    @classmethod
    def define_schema(cls) -> Schema:
        raise NotImplementedError

    @classmethod
    def execute(cls, **kwargs: Any) -> NodeOutput:
        raise NotImplementedError

    @classmethod
    def validate_inputs(cls, **kwargs: Any) -> bool | str:
        raise NotImplementedError

    @classmethod
    def fingerprint_inputs(cls, **kwargs: Any) -> Any:
        raise NotImplementedError

    @classmethod
    def INPUT_TYPES(cls) -> dict[str, Any]:
        return cls.define_schema()._told_inputs()

    @classmethod
    def GET_SCHEMA(cls) -> Schema:
        schema = cls.define_schema()
        schema.validate()
        cls.SCHEMA = schema
        return schema

    @classmethod
    def GET_NODE_INFO_V1(cls) -> dict[str, Any]:
        schema = cls.GET_SCHEMA()
        inputs, outputs = schema._told_inputs(), schema.outputs
        return {
            "input": inputs,
            "input_order": {group: list(each) for group, each in inputs.items()},
            "output": [each.io_type for each in outputs],
            "output_is_list": [each.is_output_list for each in outputs],
            "output_name": [each.display_name or each.io_type for each in outputs],
            "output_tooltips": [each.tooltip or None for each in outputs],
            "output_matchtypes": None,
            "name": schema.node_id,
            "display_name": schema.display_name,
            "description": schema.description,
            "python_module": cls.RELATIVE_PYTHON_MODULE or "nodes",
            "category": schema.category,
            "output_node": schema.is_output_node,
            "deprecated": schema.is_deprecated,
            "experimental": schema.is_experimental,
            "api_node": schema.is_api_node,
        }

    @classmethod
    def PREPARE_CLASS_CLONE(cls, v3_data: Any) -> type[ComfyNode]:
        """The class as the host runs it: another one of the same kind, that cannot be written to."""
        return _NodeClass(cls.__name__, (cls,), {"_locked": True})

    @classmethod
    def EXECUTE_NORMALIZED(cls, *args: Any, **kwargs: Any) -> NodeOutput:
        made = cls.execute(*args, **kwargs)
        if not isinstance(made, NodeOutput):
            raise TypeError(f"{cls.__name__}.execute must give a NodeOutput. Got: {type(made)}")
        return made


class NodeOutput:
    def __init__(self, *args: Any, ui: Any = None, expand: Any = None, block_execution: str | None = None) -> None:
        if expand is not None:
            raise NotImplementedError("the stand-in cannot expand graphs")
        self.args, self.ui, self.expand, self.block_execution = args, ui, expand, block_execution

    @property
    def result(self) -> tuple[Any, ...] | None:
        return self.args or None
