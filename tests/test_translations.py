"""Everything that the pack says in the host's page is there in every language, and nothing that it does not say."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from help_labels import HELP, labelled, unlabelled
from translations import (
    LANGUAGES,
    LOCALES,
    SCRIPTS,
    WORDS,
    categories,
    editor_texts,
    node_texts,
    page_texts,
    schemas,
    texts_in,
)

SCRIPTS_OF = {
    "ja": "\u3040-\u30ff\u4e00-\u9fff",
    "ko": "\uac00-\ud7a3",
    "zh": "\u4e00-\u9fff",
    "zh-TW": "\u4e00-\u9fff",
}
SIMPLIFIED = set("这们图层节网线时间动画头发择设为开关应显边长强弯")
"""Characters of zh that zh-TW writes in another way."""
NOT_SHOWN = "shapes.js"
"""Its titles of handles are for programmers."""


def read(language: str, name: str) -> Any:
    return json.loads((LOCALES / language / name).read_text(encoding="utf-8"))


def pairs(language: str) -> list[tuple[str, str]]:
    """English texts and their translations."""
    found = []
    for name in ("nodeDefs.json", "main.json"):
        english, translated = (texts_in(read(each, name)) for each in ("en", language))
        found += [(text, translated[path]) for path, text in english.items()]
    return found + list(json.loads((WORDS / f"{language}.json").read_text(encoding="utf-8")).items())


def test_english_is_what_the_nodes_say() -> None:
    """Otherwise run tests/translations.py."""
    assert read("en", "nodeDefs.json") == node_texts(schemas(), str)
    assert read("en", "main.json") == categories(schemas(), str)


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_text_is_there_and_no_other(language: str) -> None:
    for name in ("nodeDefs.json", "main.json"):
        english, translated = (texts_in(read(each, name)) for each in ("en", language))
        assert list(translated) == list(english)
    words = json.loads((WORDS / f"{language}.json").read_text(encoding="utf-8"))
    assert set(words) == {*editor_texts(), *page_texts(schemas())}
    assert all(translated.strip() for _, translated in pairs(language))


def test_there_is_something_to_translate() -> None:
    nodes = schemas()
    shown = {"wind", "by name", "yes", "no"}
    assert {*shown, "cut to its middle", "fp16", "512 x 320"} & set(page_texts(nodes)) == shown
    assert {"Undo", "repel", "Body {number}", "degrees"} <= set(editor_texts())
    render = read("en", "nodeDefs.json")["PhysAnimator_Render"]
    assert render["inputs"]["renderer_steps"]["tooltip"].startswith("sketch-guided SVD: ")
    assert render["inputs"]["renderer_steps"]["tooltip"].count("\n") == 2
    assert set(render["outputs"]) == {"0", "1", "2"}


@pytest.mark.parametrize("language", LANGUAGES)
def test_sentences_are_in_the_language(language: str) -> None:
    letters = re.compile(f"[{SCRIPTS_OF[language]}]")
    english = [(text, translated) for text, translated in pairs(language) if " " in text.strip() and len(text) > 20]
    assert [pair for pair in english if not letters.search(pair[1])] == []
    if language == "zh-TW":
        assert [translated for _, translated in pairs(language) if set(translated) & SIMPLIFIED] == []


@pytest.mark.parametrize("language", LANGUAGES)
def test_values_numbers_and_units_agree(language: str) -> None:
    for kind in (
        r"\{\w+\}",
        r"\d+(?:\.\d+)?",
        r"\[(?:px|s|Hz|px/s|1/s|px\^2)\]",
        r"\b\w+\.(?:ckpt|pth|safetensors)\b",
        r"%\w+%",
    ):
        for text, translated in pairs(language):
            assert set(re.findall(kind, text, re.ASCII)) <= set(re.findall(kind, translated, re.ASCII)), (
                text,
                translated,
            )


@pytest.mark.parametrize("language", ["en", *LANGUAGES])
def test_the_hosts_messages_hold_none_of_their_own_syntax(language: str) -> None:
    texts = [*texts_in(read(language, "nodeDefs.json")).values(), *texts_in(read(language, "main.json")).values()]
    assert [text for text in texts if re.search(r"[{}@|]", text)] == []


def test_what_the_page_shows_is_said() -> None:
    """Texts stand in say() as literals, because a translation is looked up by them."""
    shown = re.compile(
        r"""(?:\b(?:title|hint|tooltip|placeholder|label)|"aria-label"): ["`][^"`$]*[A-Za-z]{2}|Error\(["`][^$]"""
    )
    odd = re.compile(r"""\bsay\(\s*(?:[`']|"(?:[^"\\]|\\.)*"\s*\+)""")
    for path in sorted(SCRIPTS.rglob("*.js")):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            assert not shown.search(line) or path.name == NOT_SHOWN, f"{path.name}:{number}: {line.strip()}"
            assert not odd.search(line), f"{path.name}:{number}: {line.strip()}"


def _alike(page: str, node_id: str) -> tuple[list[str], set[str], set[str]]:
    """What a help page has in every language: depths of headings, names of inputs and outputs, pictures and code."""
    described = schemas()[node_id]
    page = unlabelled(page)
    own = {*described["input"].get("required", {}), *described["input"].get("optional", {}), *described["output_name"]}
    depths = [line.split(" ")[0] for line in page.splitlines() if line.startswith("#")]
    kept = re.findall(r"\]\(([^)]+)\)|`([^`\n]+)`", page)
    return depths, own & set(re.findall(r"^\| (\w+) \|", page, re.MULTILINE)), {"".join(each) for each in kept}


@pytest.mark.parametrize("path", sorted(HELP.glob("*/*.md")), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_a_translated_help_page_has_all_that_the_english_one_has(path: Path) -> None:
    translated = path.read_text(encoding="utf-8")
    node_id = path.parent.name
    assert _alike(translated, node_id) == _alike((HELP / f"{node_id}.md").read_text(encoding="utf-8"), node_id)
    titles = json.loads((LOCALES / path.stem / "nodeDefs.json").read_text(encoding="utf-8"))
    assert translated.splitlines()[0] == f"# {titles[node_id]['display_name']}"


@pytest.mark.parametrize("path", sorted(HELP.glob("*/*.md")), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_a_translated_help_page_has_the_words_on_the_node_beside_the_names(path: Path) -> None:
    """Otherwise run tests/translations.py."""
    node_id, page = path.parent.name, path.read_text(encoding="utf-8")
    words = json.loads((WORDS / f"{path.stem}.json").read_text(encoding="utf-8"))
    assert page == labelled(page, schemas()[node_id], read(path.stem, "nodeDefs.json")[node_id], words)


@pytest.mark.parametrize("language", LANGUAGES)
def test_translated_help_calls_nodes_as_the_page_does(language: str) -> None:
    english, told = read("en", "nodeDefs.json"), read(language, "nodeDefs.json")
    shown = {key: node["display_name"].removesuffix(" (PhysAnimator)") for key, node in english.items()}
    other = {name for key, name in shown.items() if not told[key]["display_name"].startswith(name)}
    assert len(other) > 30
    for path in HELP.glob(f"*/{language}.md"):
        bold = set(re.findall(r"\*\*([^*\n]+)\*\*", path.read_text(encoding="utf-8")))
        assert bold & {*other, "Load Image", "Create Video", "Save Image"} == set(), path


def test_help_that_is_translated_is_so_in_each_language_that_has_any() -> None:
    pages = {(path.parent.name, path.stem) for path in HELP.glob("*/*.md")}
    nodes, languages = ({each[place] for each in pages} for place in (0, 1))
    assert {"PhysAnimator_AnimateIllustration", "PhysAnimator_SceneEditor"} <= nodes
    assert languages == set(LANGUAGES)
    assert pages == {(node, language) for node in nodes for language in languages}
