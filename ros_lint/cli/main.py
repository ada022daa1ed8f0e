"""The command line: argv in, exit code out. 0 clean, 1 findings, 2 the tool could not do its job.

Everything heavy is imported by the command that needs it: ``--version`` and ``--help`` are part of every shell's start-up.
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

from ros_lint.cli.streams import OutputError, prepare

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn


def run() -> NoReturn:
    """Run the command of this process and end it."""
    prepare()
    try:
        code = _flushed(main())
    except SystemExit as end:  # of argparse: after help, and for arguments that it refuses
        code = _flushed(end.code if isinstance(end.code, int) else 2)
    except OSError:
        code = 2  # standard error cannot be written
    # Nothing is left to be saved. Taking a model of a large workspace to pieces would take as long as reading it.
    os._exit(code)


def _flushed(code: int) -> int:
    """Write out what is left to be written. Returns the exit code, which is 2 when that is not possible."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OutputError as error:
        return _without_output(error)
    except BrokenPipeError:
        return code or 2  # the reader has ended
    return code


def _without_output(error: OutputError) -> int:
    """Say why standard output cannot be written, and drop what it still holds. Returns the exit code."""
    print(f"ros-lint: {error}", file=sys.stderr)
    _drop_output()
    return 2


def _drop_output() -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit code; raises nothing but what ends the process."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if arguments == ["--version"]:
        from ros_lint import __version__  # noqa: PLC0415

        print(f"ros-lint {__version__}")
        return 0
    import gc  # noqa: PLC0415

    from ros_lint.cli.arguments import parse  # noqa: PLC0415

    gc.disable()  # a run makes a model once and ends: looking for garbage in it again and again takes a seventh of it

    try:
        command, options = parse(arguments)
        return _run(command, options)
    except BrokenPipeError:
        _drop_output()  # the reader has ended, as in `ros-lint | head`
        return 2
    except OutputError as error:
        return _without_output(error)
    except KeyboardInterrupt:
        print("ros-lint: interrupted", file=sys.stderr)
        return 130
    except Exception:  # exit code 1 would say that there are findings
        import traceback  # noqa: PLC0415

        traceback.print_exc()
        print("ros-lint: this is a bug in ros-lint; please report it with the lines above", file=sys.stderr)
        return 2


def _run(command: str, options: dict[str, object]) -> int:
    if command in ("rules", "rule", "schema", "completion"):
        from ros_lint.cli.commands import info as papers  # noqa: PLC0415

        return papers.run(command, options)
    if command == "index":
        from ros_lint.cli.commands import index  # noqa: PLC0415

        return index.run(options)
    if command == "check":
        from ros_lint.cli.commands import check  # noqa: PLC0415

        return check.run(options)
    if command == "launch":
        from ros_lint.cli.commands.launch import launch  # noqa: PLC0415

        return launch.run(options)
    from ros_lint.cli.commands import graph_queries as graphs  # noqa: PLC0415

    return graphs.run(command, options)
