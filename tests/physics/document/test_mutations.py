"""Some of the mutated documents and requests of ``benchmarks/hostile.py``: each is a scene or a printable sentence."""

from __future__ import annotations

from mutations import mutated_document, mutated_request, patches
from physanimator.nodes.preview import preview_scene, read_request
from physanimator.physics.assembly import plan
from physanimator.physics.document import read_json, scene_from_dict
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.scene import Body


def told(seed: int, bodies: list[Body]) -> str | None:
    """What is said of a document or a request; None where it is a scene that can be planned."""
    try:
        if seed % 2:
            scene, _ = preview_scene(read_request(mutated_request(seed)), bodies)
        else:
            scene = scene_from_dict(read_json(mutated_document(seed)), meshes=[body.mesh for body in bodies])
        plan(scene, frames=3)
    except InvalidInputError as error:
        return str(error)
    return None


def test_whatever_a_document_holds_it_is_a_scene_or_a_sentence() -> None:
    bodies = patches()
    sentences = [told(seed, bodies) for seed in range(120)]
    assert sentences.count(None) > 20
    assert max(len(each) for each in sentences if each is not None) < 1300
