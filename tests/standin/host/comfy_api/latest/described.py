"""What inputs and outputs of every type have in common."""

from __future__ import annotations

__all__ = ["Input", "Output", "WidgetInput"]


class Input:
    io_type = "*"

    def __init__(self, id, display_name=None, optional=False, tooltip=None, lazy=None, extra_dict=None, raw_link=None):
        self.id, self.optional = id, optional
        self._told = {}
        self._tell(display_name=display_name, tooltip=tooltip, lazy=lazy, rawLink=raw_link, **(extra_dict or {}))

    def _tell(self, **options):
        """Add to what is reported; what is None is left out."""
        self._told |= {name: value for name, value in options.items() if value is not None}

    def as_dict(self):
        return dict(self._told)


class WidgetInput(Input):
    def __init__(self, id, display_name=None, optional=False, tooltip=None, lazy=None, default=None, socketless=None,
                 widget_type=None, force_input=None, extra_dict=None, raw_link=None):  # fmt: skip
        super().__init__(id, display_name, optional, tooltip, lazy, extra_dict, raw_link)
        self._tell(default=default, socketless=socketless, widgetType=widget_type, forceInput=force_input)


class Output:
    io_type = "*"

    def __init__(self, id=None, display_name=None, tooltip=None, is_output_list=False):
        self.id, self.tooltip, self.is_output_list = id, tooltip, is_output_list
        self.display_name = display_name or id
