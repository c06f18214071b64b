"""The one list of this pack's nodes."""

from __future__ import annotations

from comfy_api.latest import ComfyExtension, io

from .animate_nodes import AnimateIllustration
from .artwork_nodes import ArtworkToBodies, FrameAsLayers
from .body_nodes import Body, Material
from .contact_nodes import Contact
from .editable_nodes import SaveSpineOrGltf
from .example_nodes import ExampleIllustration
from .flow_nodes import OpticalFlow, PreviewFlow, SaveMotionVectors
from .host import checked, watch_prompts
from .interpolate_nodes import Interpolate
from .keyframe_nodes import Keyframes, WanKeyframes
from .layer_nodes import LayersFromImageBatch, LoadLayers, SaveLayers, SeeThroughLayers
from .mask_nodes import MaskToMesh, SegmentByPoints
from .metric_nodes import Metrics
from .motion_nodes import PreviewMotion, Simulate
from .noise_nodes import MovingNoise
from .paint_nodes import PaintMaterial
from .preview import register_routes
from .render_nodes import Render
from .rig_nodes import RigPoint
from .save_nodes import SaveAnimation
from .scene_editor_nodes import SceneEditor
from .scene_nodes import AutomaticScene, Scene, SceneFromJSON
from .search_words import findable
from .sketch_nodes import ExtractSketch, WarpSketch
from .stroke_nodes import EnergyStroke
from .time_to_move_nodes import TimeToMove
from .track_nodes import Tracks
from .uncovered_nodes import UncoveredArea
from .video_model_nodes import FirstAndLastFrame, LineControlVideo, WarpedVideo
from .wind_nodes import Wind

__all__ = ["NODES", "PhysAnimatorExtension"]

NODES: list[type[io.ComfyNode]] = [
    AnimateIllustration,
    ExampleIllustration,
    SegmentByPoints,
    MaskToMesh,
    Material,
    PaintMaterial,
    Body,
    EnergyStroke,
    Wind,
    RigPoint,
    Contact,
    Scene,
    AutomaticScene,
    SceneFromJSON,
    SceneEditor,
    Simulate,
    PreviewMotion,
    OpticalFlow,
    PreviewFlow,
    SaveMotionVectors,
    Tracks,
    ExtractSketch,
    WarpSketch,
    Render,
    SaveAnimation,
    SaveSpineOrGltf,
    Interpolate,
    Metrics,
    WarpedVideo,
    LineControlVideo,
    FirstAndLastFrame,
    UncoveredArea,
    TimeToMove,
    MovingNoise,
    Keyframes,
    WanKeyframes,
    LoadLayers,
    LayersFromImageBatch,
    SeeThroughLayers,
    ArtworkToBodies,
    FrameAsLayers,
    SaveLayers,
]


class PhysAnimatorExtension(ComfyExtension):
    async def get_node_list(self) -> list[type[io.ComfyNode]]:
        register_routes()  # here, because host 0.8.0 does not call on_load
        watch_prompts()
        return [checked(findable(node)) for node in NODES]
