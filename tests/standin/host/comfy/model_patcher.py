"""What the host manages a network by: on its device, or away from it."""

from __future__ import annotations


class ModelPatcher:
    def __init__(self, model, load_device, offload_device, size=0, weight_inplace_update=False):
        self.model, self.load_device, self.offload_device = model, load_device, offload_device
        self.callbacks = {}

    def add_callback(self, call_type, callback):
        self.callbacks.setdefault(call_type, []).append(callback)

    def load(self, device_to=None, lowvram_model_memory=0, force_patch_weights=False, full_load=False):
        self.model.to(device_to)

    def detach(self, unpatch_all=True):
        self.model.to(self.offload_device)
        for callback in self.callbacks.get("on_detach", []):
            callback(self, unpatch_all)
        return self.model
