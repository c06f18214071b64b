"""Runs one command, and says by its exit status how it went."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["main"]

INTERRUPTED = 130
NOBODY_READS = 141


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: what follows the program's name; the process's own when None.

    Returns:
        The exit status: 0, 1 when the disk is full or the like, 2 for bad input, 128 and the number of the signal that
        ended it, which is 130 for Ctrl+C and 141 where nobody reads what is printed.
    """
    from ..files import ending_signals, ignore_signals, remove_unfinished
    from .messages import printable_streams, warn

    with printable_streams(), ending_signals():
        try:
            return _status(arguments)
        except KeyboardInterrupt as ended:
            ignore_signals()
            status = getattr(ended, "status", INTERRUPTED)
            warn("physanimator: interrupted" if status == INTERRUPTED else f"physanimator: ended by {ended}")
            return status
        finally:
            remove_unfinished()


def _status(arguments: Sequence[str] | None) -> int:
    """Run a command, and say what went wrong."""
    from ..files import hear_signals
    from .messages import warn

    try:
        from ...physics.linear_algebra import begin_on_one_thread
        from ...physics.threads import chosen_threads, keep_to_threads

        begin_on_one_thread()
        from .commands import command_parser
        from .names import named_by_options

        options = command_parser().parse_args(arguments)
        with named_by_options(options):
            if threads := chosen_threads():
                keep_to_threads(threads)
            options.run(options)
    except BrokenPipeError:
        return NOBODY_READS
    except Exception as error:
        hear_signals()  # Ctrl+C while an extension module is loading arrives as that module's ImportError
        from .failures import failure_of

        failure = failure_of(error)
        if failure is None:
            raise
        warn(f"physanimator: {failure.message}")
        return failure.status
    return int(getattr(options, "status", 0))
