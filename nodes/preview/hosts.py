"""Under which names the host may be reached by those who use the routes of the scene editor.

A page of any name can have that name point to this machine for a while (DNS rebinding), and is then of the same origin
as the host. So a name is let through only if it is known to be the host's own; addresses cannot be pointed elsewhere.
"""

from __future__ import annotations

import os
import socket
import sys
from ipaddress import ip_address
from typing import NamedTuple
from urllib.parse import urlsplit

__all__ = ["HOSTS_VARIABLE", "Authority", "authority_of", "is_own_name", "origin_of", "told_origin"]

HOSTS_VARIABLE = "PHYSANIMATOR_HOSTS"
"""Environment variable with further names of the host, separated by commas; * lets every name through."""

_PORTS = {"http": 80, "https": 443}
_LONGEST = 300


class Authority(NamedTuple):
    """What an address names.

    Attributes:
        name: in lower case, without brackets and trailing dot.
        port: None where none is named.
    """

    name: str
    port: int | None


def authority_of(text: str) -> Authority | None:
    """The name and the port in a Host header, or None where it is none."""
    if not text or len(text) > _LONGEST or not text.isascii() or any(each in text for each in "@/\\?#, \t"):
        return None
    try:
        parts = urlsplit(f"//{text}")
        name, port = (parts.hostname or "").lower(), parts.port
    except ValueError:  # a port that is no number, a bracket too many
        return None
    if text.endswith(":") or not name:
        return None
    return Authority(name[:-1] if name.endswith(".") else name, port)


def origin_of(text: str) -> tuple[str, Authority] | None:
    """The scheme and the authority of an origin such as http://127.0.0.1:8188, its usual port named."""
    scheme, separator, rest = text.partition("://")
    found = authority_of(rest) if separator else None
    if found is None or scheme.lower() not in _PORTS:
        return None
    return scheme.lower(), Authority(found.name, found.port or _PORTS[scheme.lower()])


def is_own_name(name: str) -> bool:
    """Whether a name can only mean this host: a loopback name, an address, or a name that it was told to have."""
    if name == "localhost" or name.endswith(".localhost") or _is_address(name):
        return True
    own = socket.gethostname().lower().rstrip(".")
    names = {own, f"{own.partition('.')[0]}.local", *_told_names(), *_names_of_environment()}
    return name in names or "*" in names


def told_origin() -> str:
    """The origin for which the host was told to enable CORS, empty where there is none."""
    return str(getattr(_arguments(), "enable_cors_header", None) or "").rstrip("/").lower()


def _told_names() -> set[str]:
    """Names that the host was told to listen on, and the one for whose pages it was told to enable CORS."""
    listened = str(getattr(_arguments(), "listen", None) or "").split(",")
    cors = origin_of(told_origin())
    told = {each.strip().lower().rstrip(".") for each in listened if each.strip()}
    return told | ({cors[1].name} if cors else set()) | ({"*"} if told_origin() == "*" else set())


def _names_of_environment() -> set[str]:
    given = os.environ.get(HOSTS_VARIABLE, "").split(",")
    found = {each.strip(): authority_of(each.strip()) for each in given}
    return {"*" if text == "*" else named.name for text, named in found.items() if named is not None or text == "*"}


def _arguments() -> object:
    """The host's command line, where there is a host."""
    return getattr(sys.modules.get("comfy.cli_args"), "args", None)


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
