"""The command line: `pectinate place`, `view`, `interpolate`, `atlas`, `smooth`, `compare` and others."""

from __future__ import annotations

import enum
import sys
from collections.abc import Sequence

from pectinate.cli.arguments import make_parser
from pectinate.cli.files import OutputError
from pectinate.cli.shared_arguments import UsageError
from pectinate.cli.wording import in_flags
from pectinate.errors import Error, InvalidField, InvalidFile, InvalidMesh, InvalidOption

__all__ = ["ExitCode", "main"]


class ExitCode(enum.IntEnum):
    """What the command line returns to the shell."""

    DONE = 0
    FAILED = 1
    USAGE = 2
    REJECTED = 3
    INTERRUPTED = 130


def main(argv: Sequence[str] | None = None) -> int:
    """Run one command.

    Parameters
    ----------
    argv
        The arguments after the name of the program; those of the process when left out.

    Returns
    -------
    int
        An `ExitCode`. Errors are one line on standard error, with `--debug` a traceback.
    """
    words = sys.argv[1:] if argv is None else argv
    try:
        arguments = make_parser().parse_args(words)
        arguments.run(arguments)
    except SystemExit as stop:  # --help and --version
        return int(stop.code or 0)
    except (Exception, KeyboardInterrupt) as error:
        if "--debug" in words:
            raise
        print(f"pectinate: error: {_message(error)}", file=sys.stderr)
        return _exit_code(error)
    return ExitCode.DONE


def _exit_code(error: BaseException) -> ExitCode:
    match error:
        case UsageError() | InvalidOption():
            return ExitCode.USAGE
        case InvalidMesh() | InvalidField() | InvalidFile():
            return ExitCode.REJECTED
        case KeyboardInterrupt():
            return ExitCode.INTERRUPTED
        case _:
            return ExitCode.FAILED


def _message(error: BaseException) -> str:
    """One line about an error."""
    match error:
        case KeyboardInterrupt():
            return "interrupted"
        case MemoryError():
            return "not enough memory"
        case InvalidOption() | InvalidField():
            return in_flags(" ".join(str(error).split()))
        case UsageError() | OutputError() | Error() | OSError():
            return " ".join(str(error).split())
        case _:
            text = " ".join(f"{type(error).__name__}: {error}".split())
            return f"{text} (a fault of pectinate; --debug shows where)"
