"""Who is let through to the routes of the scene editor, and what becomes of bodies that cannot be read."""

from __future__ import annotations

import asyncio
import gzip
import json
import sys
import zlib
from types import SimpleNamespace

import pytest
from physanimator.nodes.preview.hosts import HOSTS_VARIABLE, authority_of, is_own_name
from served_previews import Served, in_a_server

Headers = list[tuple[str, str]]


async def asked(server: Served, headers: Headers, body: bytes | None = None) -> tuple[int, bytes]:
    """Status and body of the answer to a preview request of these headers, which a client could not send so."""
    port = server.client.server.port
    data = json.dumps(server.body()).encode() if body is None else body
    named = [] if any(name == "Host" for name, _ in headers) else [("Host", f"127.0.0.1:{port}")]
    lines = [*named, ("Content-Type", "application/json"), ("Content-Length", str(len(data))), ("Connection", "close")]
    head = "".join(f"{name}: {value}\r\n" for name, value in (*lines, *headers))
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(b"POST /physanimator/preview HTTP/1.1\r\n" + head.encode("latin-1") + b"\r\n" + data)
    answer = await asyncio.wait_for(reader.read(), 60)
    writer.close()
    return int(answer.split()[1]), answer.partition(b"\r\n\r\n")[2]


EVIL = "evil.example"


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ([("Host", EVIL)], 403),
        ([("Host", EVIL), ("Origin", f"http://{EVIL}")], 403),
        ([("Host", EVIL), ("Origin", f"https://{EVIL}")], 403),
        ([("Host", EVIL), ("Sec-Fetch-Site", "same-origin")], 403),
        ([("Host", EVIL), ("Origin", f"http://{EVIL}"), ("Sec-Fetch-Site", "same-origin")], 403),
        ([("Host", EVIL), ("X-Forwarded-Host", "localhost")], 403),
        (
            [
                ("Host", "8188.proxied.example"),
                ("Origin", "https://8188.proxied.example"),
                ("Sec-Fetch-Site", "same-origin"),
            ],
            200,
        ),
        ([("Sec-Fetch-Site", "same-origin"), ("Sec-Fetch-Site", "cross-site")], 403),
        ([("Origin", "http://127.0.0.1"), ("Origin", f"http://{EVIL}")], 403),
        ([("Sec-Fetch-Site", "none"), ("Origin", f"http://{EVIL}")], 403),
        ([("Sec-Fetch-Site", "same-origin, cross-site")], 403),
        ([("Host", "LOCALHOST.:8188"), ("Origin", "http://localhost:8188")], 200),
        ([("Host", "[::1]:8188"), ("Origin", "http://[::1]:8188")], 200),
        ([("Host", "[fe80::1%eth0]:8188")], 200),
        ([("Host", "192.168.1.20"), ("Origin", "http://192.168.1.20:80")], 200),
        ([("Host", "[::1")], 403),
        ([("Host", f"localhost@{EVIL}")], 403),
        ([("Host", f"{EVIL}@localhost")], 403),
        ([("Host", "localhost.evil.example")], 403),
        ([("Host", "127.0.0.1.nip.io")], 403),
        ([("Host", "2130706433")], 403),
        ([("Host", "127.0.0.1:99999")], 403),
        ([("Host", "")], 403),
    ],
)
def test_a_name_that_may_be_a_foreign_page_s_is_not_answered(headers: Headers, status: int) -> None:
    async def test(server: Served) -> None:
        assert (await asked(server, headers))[0] == status

    in_a_server(test)


def test_names_that_the_host_was_told_to_have(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("studio.lan", "paint.example", "front.example", "other.example")
    assert not any(map(is_own_name, names))
    arguments = SimpleNamespace(listen="0.0.0.0,Studio.lan", enable_cors_header="https://front.example:3000")
    monkeypatch.setitem(sys.modules, "comfy.cli_args", SimpleNamespace(args=arguments))  # type: ignore[arg-type]
    monkeypatch.setenv(HOSTS_VARIABLE, "paint.example, ")
    assert [is_own_name(name) for name in names] == [True, True, True, False]
    monkeypatch.setenv(HOSTS_VARIABLE, "*")
    assert is_own_name("other.example")


def test_names_are_compared_without_case_dot_and_port() -> None:
    assert authority_of("LocalHost.:80") == ("localhost", 80)
    assert authority_of("[::1]:8188") == ("::1", 8188)
    assert not any(map(authority_of, ("", "a b", "a/b", "user@a", "a:x", "a:", "[a", "\u00e4.example")))


@pytest.mark.parametrize(
    ("encoding", "pack", "status"),
    [
        ("gzip", gzip.compress, 200),
        ("deflate", zlib.compress, 200),
        ("gzip", lambda body: body, 400),
        ("gzip", lambda body: gzip.compress(body) + b"more", 400),
        ("deflate", lambda body: b"\xff" * 50, 400),
        ("gzip", lambda body: gzip.compress(b" " * 50_000_000), 413),
        ("br", lambda body: b"\xff" * 50, 400),
    ],
)
def test_packed_bodies_are_unpacked_or_refused(encoding: str, pack: object, status: int) -> None:
    async def test(server: Served) -> None:
        packed = pack(json.dumps(server.body()).encode())  # type: ignore[operator]
        assert (await asked(server, [("Content-Encoding", encoding)], packed))[0] == status

    in_a_server(test)
