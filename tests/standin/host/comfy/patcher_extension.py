"""Names of a model's events."""


class CallbacksMP:
    ON_DETACH = "on_detach"
