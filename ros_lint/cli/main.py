"""The command line: argv in, exit code out.

Exit codes: 0 no findings, 1 findings, 2 the run failed. Each command imports its own dependencies, so that
``--version`` and ``--help`` start fast.
"""

from __future__ import annotations

import gc
import os
import sys
from typing import TYPE_CHECKING

from ros_lint.cli.streams import OutputError, prepare

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn


def run() -> NoReturn:
    """Run the command of this process and exit."""
    gc.disable()  # a run builds one model and exits: garbage collection would take a seventh of the time
    prepare()
    try:
        code = _flushed(main())
    except SystemExit as end:  # from argparse: after help, and for invalid arguments
        code = _flushed(end.code if isinstance(end.code, int) else 2)
    except OSError:
        code = 2  # standard error cannot be written
    # Nothing is left to be saved. Freeing the model of a large workspace would take as long as reading it.
    os._exit(code)


def _flushed(code: int) -> int:
    """Flush the standard streams. Returns the exit code, which is 2 if that fails."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OutputError as error:
        return _without_output(error)
    except BrokenPipeError:
        return code or 2  # the reader has exited
    return code


def _without_output(error: OutputError) -> int:
    """Print why standard output cannot be written, and drop its buffer. Returns the exit code."""
    print(f"ros-lint: {error}", file=sys.stderr)
    _drop_output()
    return 2


def _drop_output() -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit code; only raises exceptions that end the process."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if arguments == ["--version"]:
        from ros_lint import __version__  # noqa: PLC0415

        print(f"ros-lint {__version__}")
        return 0

    from ros_lint.cli.arguments import parse  # noqa: PLC0415

    try:
        command, options = parse(arguments)
        return _run(command, options)
    except BrokenPipeError:
        _drop_output()  # the reader has exited, as in `ros-lint | head`
        return 2
    except OutputError as error:
        return _without_output(error)
    except KeyboardInterrupt:
        print("ros-lint: interrupted", file=sys.stderr)
        return 130
    except Exception:  # exit code 1 would mean that there are findings
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
