"""Devices, interruption, and the models on the device; there is only the CPU."""

from __future__ import annotations

import torch

current_loaded_models = []
_interrupted = False


class InterruptProcessingException(Exception): ...


class LoadedModel:
    def __init__(self, model):
        self.model = model


def get_torch_device():
    return torch.device("cpu")


def should_use_fp16(device=None, model_params=0, prioritize_performance=True, manual_cast=False):
    return False


def should_use_bf16(device=None, model_params=0, prioritize_performance=True, manual_cast=False):
    return False


def load_models_gpu(models, memory_required=0, force_patch_weights=False, minimum_memory_required=None,
                    force_full_load=False):  # fmt: skip
    for model in models:
        if not any(each.model is model for each in current_loaded_models):
            model.load(model.load_device, full_load=force_full_load)
            current_loaded_models.insert(0, LoadedModel(model))


def unload_all_models():
    while current_loaded_models:
        current_loaded_models.pop().model.detach()


def interrupt_current_processing(value=True):
    global _interrupted
    _interrupted = value


def throw_exception_if_processing_interrupted():
    if _interrupted:
        interrupt_current_processing(False)
        raise InterruptProcessingException
