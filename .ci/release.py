"""What a release needs: ``python .ci/release.py check --tag v0.1.0``; Python 3.11 or later, nothing else.

``check``    refuses, with a line for each reason, what must not be published.
``address``  writes the repository's public address, and the addresses that follow from it, into pyproject.toml.
``notes``    prints what CHANGELOG.md says of this version.
``archive``  lists what the ComfyUI registry's packer would take, with the sizes.
"""

from __future__ import annotations

import argparse
import datetime
import itertools
import json
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import tomllib

ROOT = Path(__file__).resolve().parents[1]
ADDRESSES = {
    "Repository": "",
    "Documentation": "/tree/HEAD/nodes/docs",
    "Issues": "/issues",
    "Bug Tracker": "/issues",
    "Changelog": "/blob/HEAD/CHANGELOG.md",
    "Icon": "/raw/HEAD/nodes/docs/emblem/icon.png",
    "Banner": "/raw/HEAD/nodes/docs/emblem/banner.jpg",
}
"""What follows the repository's address in each of the other keys of pyproject.toml."""
KINDS = ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security")
_VERSION = r"(0|[1-9]\d*)\.(0|[1-9]\d*)\.(0|[1-9]\d*)"
_HEADING = re.compile(rf"## \[(?P<version>{_VERSION})\] - (?P<date>unreleased|\d{{4}}-\d\d-\d\d)")


@dataclass(frozen=True)
class Section:
    """One version of the changelog: its number, its date or ``unreleased``, and its text without the heading."""

    version: str
    date: str
    text: str

    @property
    def numbers(self) -> tuple[int, ...]:
        return tuple(map(int, self.version.split(".")))


def main(arguments: list[str] | None = None, *, root: Path = ROOT) -> int:
    """Run one of the commands; the exit code."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    check = commands.add_parser("check", help="refuse what must not be published")
    check.add_argument("--tag", help="the tag that is published, such as v0.1.0")
    address = commands.add_parser("address", help="write the repository's public address into pyproject.toml")
    address.add_argument("url", help="such as https://HOST/OWNER/physanimator")
    commands.add_parser("notes", help="print what the changelog says of this version")
    commands.add_parser("archive", help="list what the registry's packer would take")
    told = parser.parse_args(arguments)
    if told.command == "check":
        return _report(problems(root, tag=told.tag))
    if told.command == "address":
        return _report(set_address(root, told.url))
    if told.command == "notes":
        print(notes(root))
        return 0
    return _list_archive(root)


def _report(found: list[str]) -> int:
    for each in found:
        print(f"error: {each}", file=sys.stderr)
    return 1 if found else 0


def problems(root: Path, *, tag: str | None = None) -> list[str]:
    """Every reason, a sentence each, why this tree must not be published (under this tag)."""
    project = _project(root)
    version = project["project"]["version"]
    found = changelog_problems((root / "CHANGELOG.md").read_text(encoding="utf-8"))
    if not re.fullmatch(_VERSION, version):
        found.append(f"the version in pyproject.toml must be X.Y.Z. Got: {version}")
    if tag is not None and tag != f"v{version}":
        found.append(f"the tag must be the version in pyproject.toml, v{version}. Got: {tag}")
    found += _top_problems(sections((root / "CHANGELOG.md").read_text(encoding="utf-8")), version)
    found += _address_problems(project)
    return found + _workflow_problems(root, version)


def _top_problems(all_sections: list[Section], version: str) -> list[str]:
    if not all_sections or all_sections[0].version != version:
        got = all_sections[0].version if all_sections else "no heading"
        return [f"CHANGELOG.md must begin with version {version} of pyproject.toml. Got: {got}"]
    if all_sections[0].date == "unreleased":
        return [f"the heading of {version} in CHANGELOG.md must have a date. Got: unreleased"]
    return []


def _address_problems(project: dict[str, Any]) -> list[str]:
    told = {**project["project"]["urls"], **project["tool"]["comfy"]}
    repository = urlsplit(told["Repository"])
    if repository.scheme != "https" or not repository.netloc or repository.netloc.endswith(".invalid"):
        return [
            "the repository has no public address yet: run `python .ci/release.py address URL`."
            f" Got: {told['Repository']}"
        ]
    return [
        f"{name} in pyproject.toml must be {told['Repository']}{path}. Got: {told.get(name)}"
        for name, path in ADDRESSES.items()
        if name != "Documentation" and told.get(name) != told["Repository"] + path
    ]


def _workflow_problems(root: Path, version: str) -> list[str]:
    """Workflows that say with which version of these nodes they were made say this one."""
    found = []
    for path in sorted((root / "workflows").glob("*.json")):
        nodes = json.loads(path.read_text(encoding="utf-8")).get("nodes", [])
        told = {
            node.get("properties", {}).get("ver", version)
            for node in nodes
            if node.get("properties", {}).get("cnr_id") == "physanimator"
        }
        found += [f"{path.name} must name version {version}. Got: {each}" for each in sorted(told - {version})]
    return found


def changelog_problems(text: str) -> list[str]:
    """Where a changelog breaks the rules of Keep a Changelog: headings, order, dates and kinds."""
    found = []
    for line in text.splitlines():
        if line.startswith("## ") and not _HEADING.fullmatch(line):
            found.append(f"a heading of CHANGELOG.md must be `## [X.Y.Z] - YYYY-MM-DD` or `unreleased`. Got: {line}")
        if line.startswith("### ") and line.removeprefix("### ") not in KINDS:
            found.append(f"a kind of change must be one of {', '.join(KINDS)}. Got: {line}")
    all_sections = sections(text)
    for newer, older in itertools.pairwise(all_sections):
        if newer.numbers <= older.numbers:
            found.append(f"versions in CHANGELOG.md must go down. Got: {newer.version} above {older.version}")
    for number, section in enumerate(all_sections):
        found += _section_problems(section, newest=number == 0)
    return found


def _section_problems(section: Section, *, newest: bool) -> list[str]:
    found = []
    if section.date == "unreleased":
        if not newest:
            found.append(f"only the newest version may be unreleased. Got: {section.version}")
    else:
        try:
            datetime.date.fromisoformat(section.date)
        except ValueError:
            found.append(f"the date of {section.version} must be in the calendar. Got: {section.date}")
    if not re.search(r"^- \S", section.text, re.MULTILINE):
        found.append(f"version {section.version} must have at least one entry. Got: none")
    kinds = re.findall(r"^### (.+)$", section.text, re.MULTILINE)
    if len(kinds) != len(set(kinds)):
        found.append(f"each kind of change must stand once in {section.version}. Got: {', '.join(kinds)}")
    return found


def sections(text: str) -> list[Section]:
    """The versions of a changelog, as they follow each other."""
    headings = [match for match in re.finditer(rf"^{_HEADING.pattern}$", text, re.MULTILINE)]
    ends = [*(match.start() for match in headings[1:]), len(text)][: len(headings)]
    return [
        Section(match["version"], match["date"], text[match.end() : end].strip())
        for match, end in zip(headings, ends, strict=True)
    ]


def notes(root: Path) -> str:
    """What the changelog says of the version of this tree; empty where it says nothing."""
    version = _project(root)["project"]["version"]
    all_sections = sections((root / "CHANGELOG.md").read_text(encoding="utf-8"))
    return next((section.text for section in all_sections if section.version == version), "")


def set_address(root: Path, url: str) -> list[str]:
    """Write an address and all that follow from it into pyproject.toml; a sentence if it cannot be one."""
    url = url.rstrip("/").removesuffix(".git")
    parts = urlsplit(url)
    if parts.scheme != "https" or not parts.netloc or '"' in url or parts.query or parts.fragment:
        return [f"the address must begin with https:// and name a repository. Got: {url}"]
    path = root / "pyproject.toml"
    text = path.read_text(encoding="utf-8")
    for name, ending in ADDRESSES.items():
        key = f'"{name}"' if " " in name else name
        text, count = re.subn(
            rf'^({key} = )"[^"]*"', lambda match, end=ending: f'{match[1]}"{url}{end}"', text, flags=re.M
        )
        if count != 1:
            return [f"pyproject.toml must have one line with {name}. Got: {count}"]
    path.write_text(text, encoding="utf-8", newline="\n")
    return []


def archive(root: Path) -> list[str]:
    """The files that the registry's packer takes: those in git, without those that .comfyignore names."""
    in_git = _git(root, "ls-files", "-z", "--cached")
    left_out = _git(root, "ls-files", "-z", "--cached", "--ignored", f"--exclude-from={root / '.comfyignore'}")
    return sorted(set(in_git) - set(left_out))


def _git(root: Path, *arguments: str) -> list[str]:
    done = subprocess.run(["git", "-C", str(root), *arguments], capture_output=True, check=True)
    return [name for name in done.stdout.decode().split("\0") if name]


def _list_archive(root: Path) -> int:
    total = 0
    for name in archive(root):
        size = (root / name).stat().st_size
        total += size
        print(f"{size:>10,}  {name}")
    print(f"{total:>10,}  in all")
    return 0


def _project(root: Path) -> dict[str, Any]:
    return tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))


if __name__ == "__main__":
    sys.exit(main())
