"""What the pack says in the host's page, and its translations.

    python tests/translations.py [--add LANGUAGE FILE]

Writes ``locales/en`` anew from tests/nodes/node_schemas.json. A text that has not changed keeps its translations,
wherever it stands now; what is not used any more goes. Texts without a translation are printed, as a JSON object to
fill in and to hand back as FILE. Help pages get the translated names beside the English ones.
"""

from __future__ import annotations

import argparse
import json
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from help_labels import write_labels

__all__ = [
    "LANGUAGES",
    "LOCALES",
    "SCRIPTS",
    "WORDS",
    "categories",
    "editor_texts",
    "node_texts",
    "page_texts",
    "schemas",
    "texts_in",
]

ROOT = Path(__file__).resolve().parents[1]
LOCALES, WORDS, SCRIPTS = ROOT / "locales", ROOT / "nodes" / "web" / "words", ROOT / "nodes" / "web" / "js"
LANGUAGES = ("ja", "ko", "zh", "zh-TW")
_DYNAMIC = "COMFY_DYNAMICCOMBO_V3"
_LITERAL = r'"(?:[^"\\]|\\.)*"'
_SAID = re.compile(rf"\bsay\(\s*({_LITERAL})")
_LISTED = re.compile(rf"\bwords\(\s*({_LITERAL}(?:,\s*{_LITERAL})*),?\s*\)")
_OF_FILES = re.compile(r"(^|_)model$|^file$")
"""Names of inputs whose options are files."""
_FILE = re.compile(r"\.\w{2,11}$|/$")

Translate = Callable[[str], str]
Leaves = dict[tuple[str, ...], str]


def schemas() -> dict[str, Any]:
    """The nodes as the host reports them."""
    return json.loads((ROOT / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))


def node_texts(nodes: Mapping[str, Any], said: Translate) -> dict[str, Any]:
    """``nodeDefs.json``: names and tooltips of the nodes, their inputs and their outputs.

    Args:
        nodes: see :func:`schemas`.
        said: a text in another language.
    """
    return {node_id: _node_texts(node, said) for node_id, node in nodes.items()}


def _node_texts(node: Mapping[str, Any], said: Translate) -> dict[str, Any]:
    tooltips = node["output_tooltips"] or [None] * len(node["output_name"])
    return {
        "display_name": said(node["display_name"]),
        "description": said(node["description"]),
        "inputs": {name: _slot(title, told, said) for name, (title, told) in _inputs(node["input"], "").items()},
        "outputs": {
            str(place): _slot(name, {"": tooltip} if tooltip else {}, said)
            for place, (name, tooltip) in enumerate(zip(node["output_name"], tooltips, strict=True))
        },
    }


def _slot(title: str, told: Mapping[str, str], said: Translate) -> dict[str, str]:
    """Its name, and its tooltip; where choices bring inputs of one name, a line for each that says something else."""
    if not told:
        return {"name": said(title)}
    apart = len(set(told.values())) > 1
    lines = [f"{said(choice)}: {said(text)}" if apart else said(text) for choice, text in told.items()]
    return {"name": said(title), "tooltip": "\n".join(dict.fromkeys(lines))}


def _inputs(described: Mapping[str, Any], prefix: str) -> dict[str, tuple[str, dict[str, str]]]:
    """Title and tooltips, by the choice that brings them, of all inputs. The host writes ``_`` for dots in keys."""
    found: dict[str, tuple[str, dict[str, str]]] = {}
    for name, (kind, options) in _listed(described):
        tooltip = options.get("tooltip")
        found[prefix + name] = options.get("display_name") or name, {"": tooltip} if tooltip else {}
        for choice in options["options"] if kind == _DYNAMIC else ():
            for inner, (title, told) in _inputs(choice["inputs"], f"{prefix}{name}_").items():
                lines = found.setdefault(inner, (title, {}))[1]
                if told:
                    lines[choice["key"]] = "\n".join(told.values())
    return found


def _listed(described: Mapping[str, Any]) -> Iterator[tuple[str, tuple[Any, dict[str, Any]]]]:
    for group in ("required", "optional"):
        for name, (kind, *options) in described.get(group, {}).items():
            yield name, (kind, options[0] if options else {})


def page_texts(nodes: Mapping[str, Any]) -> dict[str, None]:
    """What the page itself translates of the nodes: options, and tooltips of inputs that a choice brings."""
    found: dict[str, None] = {}
    for node in nodes.values():
        _collect(node["input"], found, brought=False)
    return found


def _collect(described: Mapping[str, Any], found: dict[str, None], *, brought: bool) -> None:
    for name, (kind, options) in _listed(described):
        if brought and options.get("tooltip"):
            found[options["tooltip"]] = None
        for choice in options.get("options", ()):
            if kind == _DYNAMIC:
                found[choice["key"]] = None
                _collect(choice["inputs"], found, brought=True)
            elif re.search("[a-z]{3}|^[a-z]+$", choice) and not (_OF_FILES.search(name) or _FILE.search(choice)):
                found[choice] = None


def categories(nodes: Mapping[str, Any], said: Translate) -> dict[str, Any]:
    """``main.json``: the parts of the menu."""
    parts = {part: None for node in nodes.values() for part in node["category"].split("/")[1:]}
    return {"nodeCategories": {part: said(part) for part in parts}}


def editor_texts() -> dict[str, None]:
    """What the scripts of the page say."""
    found: dict[str, None] = {}
    for path in sorted(SCRIPTS.rglob("*.js")):
        script = path.read_text(encoding="utf-8")
        for literals in (*_SAID.findall(script), *_LISTED.findall(script)):
            found.update(dict.fromkeys(json.loads(each) for each in re.findall(_LITERAL, literals)))
    return found


def texts_in(data: Any, path: tuple[str, ...] = ()) -> Leaves:
    """Every text of nested objects by its path."""
    if isinstance(data, str):
        return {path: data}
    return {place: text for key, value in data.items() for place, text in texts_in(value, (*path, key)).items()}


def _read(path: Path) -> Any:
    return json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}


def _write(path: Path, data: Any) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(data, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")


def _known(language: str) -> dict[str, str]:
    """Translations by their English texts."""
    found: dict[str, str] = {}
    for name in ("nodeDefs.json", "main.json"):
        english, translated = (texts_in(_read(LOCALES / each / name)) for each in ("en", language))
        found |= {text: translated[path] for path, text in english.items() if path in translated}
    return found | _read(WORDS / f"{language}.json")


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    parser.add_argument("--add", nargs=2, metavar=("LANGUAGE", "FILE"), action="append", default=[])
    added = {language: _read(Path(file)) for language, file in parser.parse_args().add}
    known = {language: _known(language) | added.get(language, {}) for language in LANGUAGES}
    nodes = schemas()
    for language in ("en", *LANGUAGES):
        missing: dict[str, str] = {}
        translations = known.get(language)

        def said(text: str, translations: Any = translations, missing: dict[str, str] = missing) -> str:
            if translations is None:
                return text
            return translations[text] if text in translations else missing.setdefault(text, "")

        _write(LOCALES / language / "nodeDefs.json", node_texts(nodes, said))
        _write(LOCALES / language / "main.json", categories(nodes, said))
        if translations is not None:
            _write(WORDS / f"{language}.json", {text: said(text) for text in editor_texts() | page_texts(nodes)})
        if missing:
            print(language, json.dumps(missing, indent=1, ensure_ascii=False))
    write_labels(nodes, LOCALES, WORDS)


if __name__ == "__main__":
    main()
