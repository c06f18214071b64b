"""Taichi reads the same source in less time, and is left as it was."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from types import FunctionType
from typing import Any

import pytest
from physanimator.physics.runtime import taichi_runtime
from physanimator.physics.runtime.reading import quick_reading


def plain(x: int) -> int:
    return x


@functools.lru_cache(
    maxsize=4,
)
def decorated(
    x: int,
) -> int:
    """Of several lines.

    One is empty.
    """

    return x


def nested() -> Callable[[int], int]:
    @functools.wraps(plain)
    def inner(x: int) -> int:
        return x + 1  # the last one

    return inner


@pytest.fixture(scope="module")
def reader() -> Any:
    taichi_runtime.run(taichi_runtime.compiled, vars)  # who imports Taichi first has it for the process
    from taichi.lang import kernel_impl

    return kernel_impl


@pytest.mark.parametrize("function", [plain, decorated.__wrapped__, inspect.unwrap(nested(), stop=lambda f: True)])
def test_the_lines_of_a_function_are_those_that_python_finds(reader: Any, function: Any) -> None:
    code = function.__code__
    expected = inspect.getsourcelines(code)
    with quick_reading():
        assert reader.getsourcelines(function) == expected
        assert reader.getsourcefile(function) == inspect.getsourcefile(code)


def test_a_function_without_a_file_is_left_to_python(reader: Any) -> None:
    made = FunctionType(plain.__code__.replace(co_filename="<made>"), {})
    with quick_reading(), pytest.raises(OSError, match="source"):
        reader.getsourcelines(made)


def test_taichi_is_left_as_it_was(reader: Any) -> None:
    from taichi.lang.ast.ast_transformer_utils import ASTTransformerContext

    before = reader.getsourcelines, reader.getsourcefile, ASTTransformerContext.get_pos_info
    with quick_reading():
        assert reader.getsourcelines is not before[0]
    with pytest.raises(ZeroDivisionError), quick_reading():
        _ = 1 / 0
    assert before == (reader.getsourcelines, reader.getsourcefile, ASTTransformerContext.get_pos_info)


def test_an_error_in_a_kernel_names_its_line() -> None:
    def build(ti: Any) -> Any:
        @ti.kernel
        def wrong() -> ti.i32:
            return missing  # noqa: F821

        return wrong

    with pytest.raises(Exception, match=r'test_reading.py", line \d+, in wrong'):
        taichi_runtime.run(lambda: taichi_runtime.compiled(build)())
