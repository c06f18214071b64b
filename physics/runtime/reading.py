"""Taichi reads the source of kernels anew in every process; some of that is needless, and takes 0.2 s of the start.

Measured with compiled kernels on disk in ten pairs of processes: 0.77 s instead of 0.98 s of processor time for the
first simulation.

For every call of a function it looks for the module and the end of the function, and for every expression it lays out
the source line under which an error would be shown. Here a file is read once, and errors name their line only.
"""

from __future__ import annotations

import ast
import linecache
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import lru_cache
from typing import Any

__all__ = ["quick_reading"]


@contextmanager
def quick_reading() -> Iterator[None]:
    """Let Taichi, which must be imported, read kernels in less time while this lasts, if it is built as we know it."""
    kernels: Any = sys.modules.get("taichi.lang.kernel_impl")
    reading: Any = sys.modules.get("taichi.lang.ast.ast_transformer_utils")
    context = getattr(reading, "ASTTransformerContext", None)
    with ExitStack() as changes:
        for owner, name, quick in (
            (kernels, "getsourcefile", lambda function: function.__code__.co_filename),
            (kernels, "getsourcelines", _quick_lines(getattr(kernels, "getsourcelines", None))),
            (context, "get_pos_info", _position),
        ):
            if hasattr(owner, name):
                changes.enter_context(_replaced(owner, name, quick))
        yield


@contextmanager
def _replaced(owner: Any, name: str, value: Any) -> Iterator[None]:
    original = getattr(owner, name)
    setattr(owner, name, value)
    try:
        yield
    finally:
        setattr(owner, name, original)


def _quick_lines(usual: Any) -> Callable[[Any], tuple[list[str], int]]:
    """As ``inspect.getsourcelines`` for functions of files that are here; the usual way for all others."""

    def lines_of(function: Any) -> tuple[list[str], int]:
        code = function.__code__
        first, end = code.co_firstlineno, _ends(code.co_filename).get(code.co_firstlineno)
        if end is None:
            return usual(function)  # type: ignore[no-any-return]
        return linecache.getlines(code.co_filename)[first - 1 : end], first

    return lines_of


@lru_cache(maxsize=16)
def _ends(filename: str) -> dict[int, int]:
    """The last line of every function of a file by its first one, decorators included."""
    try:
        tree = ast.parse("".join(linecache.getlines(filename)))
    except SyntaxError:
        return {}
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    return {
        min([node.lineno, *(decorator.lineno for decorator in node.decorator_list)]): node.end_lineno or node.lineno
        for node in functions
    }


def _position(context: Any, node: Any) -> str:
    """Where an expression stands."""
    return f'File "{context.file}", line {node.lineno + context.lineno_offset}, in {context.func.func.__name__}:\n'
