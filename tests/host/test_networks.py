"""The host's model management over the networks of this pack, in a process of the host's own Python."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]

_START = """
import importlib, importlib.util, json, sys, weakref
sys.argv = ["main.py", "--cpu"]
sys.path.insert(0, CHECKOUT)
import comfy.options
comfy.options.enable_args_parsing()
import comfy.cli_args
import comfy.model_management as management
import torch
spec = importlib.util.spec_from_file_location("pack", ROOT + "/__init__.py", submodule_search_locations=[ROOT])
pack = sys.modules["pack"] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pack)
networks = importlib.import_module("pack.nodes.models.networks")
device = management.get_torch_device()
alive = []

class Big(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.inner = torch.nn.Linear(64, 64)
        self.register_buffer("kept", torch.ones(3))
        self.itself = [self]  # a circle, as some networks have
        alive.append(weakref.ref(self))
    def forward(self, x):
        return self.inner(x) + self.kept.sum()

def living():
    return sum(each() is not None for each in alive)

def load():
    counted.append(living())
    return [Big(), Big()]

def run(kind, key):
    made = networks.kept_networks(kind, key, load)
    with made.placement(device).at_work(*made.held, working_bytes=1000):
        at = len(management.current_loaded_models)
        made.held[0](torch.ones(1, 64))
    return at

counted = []

def begin():
    networks._kept.clear()
    management.unload_all_models()
    import gc
    gc.collect()
    assert living() == 0
    counted.clear()

def kept():
    return [run("a", 1), run("a", 1), run("b", 1), len(counted), living()]

def switched():
    run("a", 1), run("a", 2), run("a", 3)
    return [*counted, living()]

def unloaded():
    run("a", 1), run("b", 1)
    management.unload_all_models()
    import gc
    gc.collect()
    return [living(), len(management.current_loaded_models), len(networks._kept), len(gc.callbacks)]

def taken_for_others_and_used_again():
    run("a", 1)
    management.free_memory(1e30, device)
    run("a", 1)
    return [len(counted), living()]

def unloaded_in_use():
    made = networks.kept_networks("a", 1, load)
    with made.placement(device).at_work(made.held[0]):
        management.unload_all_models()
        told = [made.held[0](torch.ones(1, 64)).shape[1], "a" in networks._kept]
    run("a", 1)
    return [*told, len(counted)]

told = {}
with torch.inference_mode():
    for case in (kept, switched, unloaded, taken_for_others_and_used_again, unloaded_in_use):
        begin()
        told[case.__name__] = case()
print(json.dumps(told))
"""


def test_networks_are_the_host_s_to_unload(host: Any) -> None:
    script = f"ROOT, CHECKOUT = {str(ROOT)!r}, {str(host.checkout)!r}\n{_START}"
    done = subprocess.run([host.python, "-c", script], cwd=host.checkout, capture_output=True, text=True, timeout=180)
    assert done.returncode == 0, done.stderr[-3000:]
    told = json.loads(done.stdout.splitlines()[-1])
    assert told["kept"] == [2, 2, 4, 2, 4]  # on the device after each run, times loaded, networks alive
    assert told["switched"] == [0, 0, 0, 2]  # none alive when others are loaded
    assert told["unloaded"] == [0, 0, 0, 0]
    assert told["taken_for_others_and_used_again"][1] == 2
    assert told["unloaded_in_use"] == [64, True, 1]
