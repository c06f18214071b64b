"""Words by which people look for a node and which its name does not have."""

from __future__ import annotations

from collections.abc import Mapping
from functools import wraps
from typing import Any

__all__ = ["SEARCH_WORDS", "findable"]

_PHYSICS = ("physics", "soft body", "elastic", "2d physics", "物理演算", "揺れもの", "物理模拟", "物理模擬", "물리")
_MATERIALS = ("hair", "cloth", "ribbon", "leaf", "jelly", "skirt", "髪", "布", "头发", "頭髮", "머리카락")
_WIND = ("wind", "breeze", "gust", "storm", "風", "风", "바람")
_PUPPET = ("puppet", "live2d", "spine", "rig", "bone", "cutout animation", "リグ", "绑定", "綁定", "리깅")
_SWAY = ("wiggle", "sway", "swing", "jiggle", "bounce", "secondary motion", "揺れ", "摇摆", "搖擺", "흔들림")
_LAYERS = ("psd", "layered", "parts", "live2d", "photoshop", "krita", "レイヤー", "图层", "圖層", "레이어")
_CUT = ("cut out", "segment", "segmentation", "mask", "select", "lasso", "切り抜き", "抠图", "去背", "누끼")
_ANIMATE = (
    "animate",
    "animation",
    "animate picture",
    "animate image",
    "image to video",
    "still to video",
    "アニメーション",
    "动画",
    "動畫",
    "애니메이션",
)
_LINES = ("line art", "lineart", "sketch", "線画", "线稿", "線稿", "선화")
_WAN = ("wan", "video model", "image to video", "control video")

SEARCH_WORDS: Mapping[str, tuple[str, ...]] = {
    "PhysAnimator_SaveSpineOrGltf": (
        *_PUPPET,
        "save spine",
        "gltf",
        "glb",
        "export",
        "blender",
        "unity",
        "game engine",
        "skeleton",
        "morph targets",
        "骨骼",
        "スケルトン",
    ),
    "PhysAnimator_AnimateIllustration": (*_PHYSICS, *_ANIMATE, *_MATERIALS, *_SWAY, *_WIND, *_PUPPET, *_CUT, *_LAYERS),
    "PhysAnimator_ArtworkToBodies": (*_LAYERS, *_PHYSICS, *_MATERIALS, *_PUPPET, "wiggle", "sway"),
    "PhysAnimator_AutomaticScene": (*_PHYSICS, *_SWAY, *_WIND, *_ANIMATE, "auto", "hair", "cloth"),
    "PhysAnimator_Body": (*_PHYSICS, *_MATERIALS, *_PUPPET, "wiggle", "sway", "rigid body"),
    "PhysAnimator_Contact": (*_PHYSICS, "collision", "collider", "collide", "friction", "衝突", "碰撞", "충돌"),
    "PhysAnimator_EnergyStroke": (*_WIND, "force", "physics", "field", "push", "repel", "attract", "brush", "spline"),
    "PhysAnimator_ExampleIllustration": (
        "demo",
        "sample",
        "test picture",
        "physics",
        "quickstart",
        "サンプル",
        "示例",
        "예제",
    ),
    "PhysAnimator_ExtractSketch": (*_LINES, "lines", "edges", "preprocessor", "annotator", "informative drawings"),
    "PhysAnimator_FirstAndLastFrame": (*_WAN, "start frame", "end frame", "flf2v", "keyframes"),
    "PhysAnimator_FrameAsLayers": (*_LAYERS, "frame to psd", "paint over"),
    "PhysAnimator_Interpolate": (
        "inbetween",
        "in-betweens",
        "tween",
        "frame interpolation",
        "tooncrafter",
        "keyframes",
        "中割り",
        "补帧",
        "補幀",
        "중간 프레임",
    ),
    "PhysAnimator_Keyframes": (
        *_WAN,
        "inbetween",
        "in-between",
        "key poses",
        "anisora",
        "tooncrafter",
        "tooncomposer",
        "原画",
        "关键帧",
        "키프레임",
    ),
    "PhysAnimator_LayersFromImageBatch": (*_LAYERS, "images to layers", "batch to layers"),
    "PhysAnimator_LineControlVideo": (*_WAN, *_LINES, "fun control", "vace"),
    "PhysAnimator_LoadLayers": (*_LAYERS, "load psd", "open psd", "ora", "openraster"),
    "PhysAnimator_MaskToMesh": (
        "triangulate",
        "triangulation",
        "art mesh",
        "2d mesh",
        "deform",
        "warp mesh",
        "puppet",
        "physics",
        "soft body",
        "アートメッシュ",
        "网格",
        "網格",
        "아트메쉬",
    ),
    "PhysAnimator_Material": (*_MATERIALS, *_PHYSICS, "stiffness", "damping", "young's modulus", "softness", "wiggle"),
    "PhysAnimator_Metrics": ("quality", "measure", "evaluate", "score", "flicker", "fid", "flow warp error"),
    "PhysAnimator_MovingNoise": (
        *_WAN,
        "noise",
        "warped noise",
        "go with the flow",
        "latent",
        "ノイズ",
        "噪声",
        "노이즈",
    ),
    "PhysAnimator_OpticalFlow": (
        "motion vectors",
        "flow",
        "displacement",
        "warp",
        "オプティカルフロー",
        "光流",
        "옵티컬 플로우",
    ),
    "PhysAnimator_PaintMaterial": ("weight paint", "vertex weights", "stiffness map", "mask", *_MATERIALS, "physics"),
    "PhysAnimator_PreviewFlow": ("show flow", "flow to image", "visualize", "motion vectors", "光流"),
    "PhysAnimator_PreviewMotion": (
        "show mesh",
        "wireframe",
        "visualize",
        "physics",
        "debug",
        "プレビュー",
        "预览",
        "預覽",
    ),
    "PhysAnimator_Render": (
        *_ANIMATE,
        "draw frames",
        "warp",
        "composite",
        "svd",
        "lvcd",
        "inpaint",
        "2d",
        "physics",
        "レンダリング",
        "渲染",
        "렌더링",
    ),
    "PhysAnimator_RigPoint": (
        *_PUPPET,
        *_SWAY,
        "pin",
        "puppet pin",
        "anchor",
        "hold",
        "keyframe",
        "squash and stretch",
        "ピン",
        "图钉",
        "圖釘",
        "핀",
    ),
    "PhysAnimator_SaveAnimation": (
        *_ANIMATE,
        "video",
        "mp4",
        "webm",
        "gif",
        "webp",
        "apng",
        "png sequence",
        "export",
        "transparent",
    ),
    "PhysAnimator_SaveLayers": (*_LAYERS, "save psd", "export psd", "psb"),
    "PhysAnimator_SaveMotionVectors": (
        "save flow",
        "optical flow",
        "motion vectors",
        "velocity pass",
        "vector blur",
        "motion blur",
        "openexr",
        "exr",
        "nuke",
        "blender",
        "compositing",
        "光流",
        "動きベクトル",
    ),
    "PhysAnimator_Scene": (*_PHYSICS, "simulation", "gravity", "world", "wind", "2d scene"),
    "PhysAnimator_SceneEditor": (
        *_PHYSICS,
        *_SWAY,
        *_WIND,
        *_PUPPET,
        *_ANIMATE,
        "draw",
        "paint",
        "pin",
        "live preview",
        "hair",
        "cloth",
    ),
    "PhysAnimator_SceneFromJSON": ("load scene", "json", "preset", "physics", "import scene", "document"),
    "PhysAnimator_SeeThroughLayers": (*_LAYERS, "see-through", "decompose", "anime parts"),
    "PhysAnimator_SegmentByPoints": (*_CUT, "points", "click", "sam", "grabcut", "rotoscope", "part", "physics"),
    "PhysAnimator_Simulate": (*_PHYSICS, *_SWAY, *_ANIMATE, "simulation", "solver", "hair", "cloth", "jelly"),
    "PhysAnimator_TimeToMove": (*_WAN, "ttm", "time to move", "cut and drag", "dual clock", "motion transfer", "drag"),
    "PhysAnimator_Tracks": (*_WAN, "trajectory", "point tracks", "motion path", "ati", "wan-move"),
    "PhysAnimator_UncoveredArea": (
        "inpaint mask",
        "inpainting",
        "clean plate",
        "background plate",
        "disocclusion",
        "holes",
        "lama",
        "remove object",
        "physics",
    ),
    "PhysAnimator_WanKeyframes": (
        *_WAN,
        "inbetween",
        "in-between",
        "anisora",
        "first middle last",
        "flf2v",
        "multi frame",
        "中割り",
        "补间",
    ),
    "PhysAnimator_WarpSketch": (*_LINES, "warp", "deform", "move lines", "controlnet lines"),
    "PhysAnimator_WarpedVideo": (*_WAN, "vace", "inpaint holes", "outpaint", "warp"),
    "PhysAnimator_Wind": (*_WIND, "physics", "force", "turbulence", "air", "weather", "sway", "hair"),
}
"""By the node's id. In the languages of ``locales``, because names in them are searched as well."""


def findable(node: Any) -> Any:
    """The node's class with its search words in its schema, or in what an older host tells the page of it.

    Args:
        node: a V3 node.
    """
    if "_physanimator_findable" in vars(node):
        return node
    node._physanimator_findable = True
    schema_of, told_of = vars(node)["define_schema"].__func__, node.GET_NODE_INFO_V1.__func__

    @wraps(schema_of)
    def define_schema(cls: Any) -> Any:
        schema = schema_of(cls)
        if hasattr(schema, "search_aliases"):  # host 0.8.0 does not know them
            schema.search_aliases = _words(schema.node_id)
        return schema

    @wraps(told_of)
    def told(cls: Any) -> dict[str, Any]:
        found: dict[str, Any] = told_of(cls)
        return {"search_aliases": _words(found["name"]), **found}

    node.define_schema, node.GET_NODE_INFO_V1 = classmethod(define_schema), classmethod(told)
    return node


def _words(node_id: str) -> list[str]:
    return list(dict.fromkeys(SEARCH_WORDS.get(node_id, ())))
