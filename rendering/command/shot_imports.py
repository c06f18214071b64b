"""All that a worker needs to animate shots, imported at once: by the process from which workers are forked.

Taichi is not part of it, which has threads once it is initialised. What is missing here is imported by each worker.
"""

# ruff: noqa: E402, F401
from __future__ import annotations

import gc
import signal

signal.signal(signal.SIGINT, signal.SIG_IGN)  # first of all: Ctrl+C reaches this process too, and is not meant for it

import av
import cv2
import distributed.nanny
import PIL.ImageCms
import pythoncdt
import scipy.cluster.hierarchy
import scipy.fft
import scipy.ndimage
import scipy.sparse.csgraph
import scipy.sparse.linalg
import scipy.spatial

from .. import artwork, editable, layer_sequences, peaks, pipeline, saved_meanwhile, segmentation, shots, strands
from ..pictures import mask_files
from . import animating, failures, files, inputs, messages, networks, outputs, shot_task, watching

shot_task.shot_parser()
PIL.Image.init()
gc.freeze()  # so that no worker copies the memory of what is known here only to count who uses it
