"""The reference of the command line, from its own parser."""

from __future__ import annotations

import argparse

from physanimator.rendering.command.commands import command_parser

from .markdown import escaped

__all__ = ["command_page"]


def command_page() -> str:
    """Every command with all its options, as ``--help`` tells them."""
    parser = command_parser()
    commands = next(each for each in parser._actions if isinstance(each, argparse._SubParsersAction))
    summaries = {each.dest: each.help or "" for each in commands._choices_actions}
    parts = [
        "# Command line\n",
        "`physanimator COMMAND --help` prints the same.\n",
        *(f"- [`physanimator {name}`](#physanimator-{name}): {escaped(summaries[name])}" for name in commands.choices),
        "",
    ]
    for name, command in commands.choices.items():
        parts.append(
            f"## physanimator {name}\n\n{escaped(command.description or summaries[name].capitalize() + '.')}\n"
        )
        parts += [_group(group) for group in command._action_groups]
    return "\n".join(parts)


def _group(group: argparse._ArgumentGroup) -> str:
    shown = [each for each in group._group_actions if each.help != argparse.SUPPRESS and each.dest != "help"]
    if not shown:
        return ""
    title = {"positional arguments": "What it works on", "options": "Also"}.get(group.title or "", group.title or "")
    lines = [f"### {escaped(title[:1].upper() + title[1:])}\n"]
    if group.description:
        lines.append(f"{escaped(group.description)}\n")
    lines += [_option(each) for each in shown]
    return "\n".join(lines)


def _option(action: argparse.Action) -> str:
    """A term and its definition."""
    value = _value(action)
    names = [f"`{' '.join([name, value]).strip()}`" for name in action.option_strings] or [f"`{value}`"]
    help_text = argparse.HelpFormatter("physanimator")._expand_help(action) if action.help else ""
    return f"{', '.join(names)}\n: {escaped(help_text) or '...'}\n"


def _value(action: argparse.Action) -> str:
    if action.nargs == 0:
        return ""
    choices = "{" + ",".join(map(str, action.choices)) + "}" if action.choices else ""
    metavar = action.metavar if isinstance(action.metavar, str) else ""
    one = metavar or choices or action.dest.upper()
    return f"{one} [{one} ...]" if action.nargs == "+" else one
