"""Run a command: from the arguments of the command line to the exit code.

Exit codes: 0 no findings, 1 findings, 2 the run failed. Each command imports the modules that it needs itself, so that
``--version`` and ``--help`` start fast.
"""

from __future__ import annotations

import gc
import os
import sys

from ros_lint.cli.streams import OutputError, prepare

TYPE_CHECKING = False  # as in typing, whose import would take a third of the time of ``--version``
if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn


def run() -> NoReturn:
    """Run the command in the arguments of this process, and exit."""
    gc.disable()  # a run builds one model and exits, and garbage collection would take a seventh of the time
    prepare()
    try:
        code = _flush(main())
    except SystemExit as end:  # from argparse: after help, and for invalid arguments
        code = _flush(end.code if isinstance(end.code, int) else 2)
    except OSError:
        code = 2  # standard error cannot be written
    # All files are written. Freeing the model of a large workspace would take as long as reading it.
    os._exit(code)


def _flush(code: int) -> int:
    """Flush the standard streams. Return ``code``, or 2 if they cannot be flushed."""
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OutputError as error:
        return _report_output_error(error)
    except BrokenPipeError:
        return code or 2  # the reader has exited
    return code


def _report_output_error(error: OutputError) -> int:
    """Print the reason why standard output cannot be written, and discard the remaining output. Return the exit code 2."""
    print(f"ros-lint: {error}", file=sys.stderr)
    _discard_output()
    return 2


def _discard_output() -> None:
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def main(argv: Sequence[str] | None = None) -> int:
    """Run the command in ``argv`` (default: the arguments of this process). Return the exit code.

    Errors are printed. Raises only SystemExit and other exceptions that must end the process.
    """
    arguments = list(sys.argv[1:] if argv is None else argv)
    if arguments == ["--version"]:
        from ros_lint import __version__  # noqa: PLC0415

        print(f"ros-lint {__version__}")
        return 0

    from ros_lint.cli.arguments import parse  # noqa: PLC0415

    try:
        command, options = parse(arguments)
        return _run_command(command, options)
    except BrokenPipeError:
        _discard_output()  # the reader has exited, as in `ros-lint | head`
        return 2
    except OutputError as error:
        return _report_output_error(error)
    except KeyboardInterrupt:
        print("ros-lint: interrupted", file=sys.stderr)
        return 130
    except Exception:  # Python would exit with 1, which means that there are findings
        import traceback  # noqa: PLC0415

        traceback.print_exc()
        print("ros-lint: this is a bug in ros-lint; please report it with the lines above", file=sys.stderr)
        return 2


def _run_command(command: str, options: dict[str, object]) -> int:
    if command in ("rules", "rule", "schema", "completion"):
        from ros_lint.cli.commands import info  # noqa: PLC0415

        return info.run(command, options)
    if command == "cache":
        from ros_lint.cli.commands import cache  # noqa: PLC0415

        return cache.run(options)
    if command == "index":
        from ros_lint.cli.commands import index  # noqa: PLC0415

        return index.run(options)
    if command == "new-rule":
        from ros_lint.cli.commands import new_rule  # noqa: PLC0415

        return new_rule.run(options)
    if command == "check":
        from ros_lint.cli.commands import check  # noqa: PLC0415

        return check.run(options)
    if command == "lsp":
        from ros_lint.cli.commands.lsp import lsp  # noqa: PLC0415

        return lsp.run(options)
    if command == "launch":
        from ros_lint.cli.commands.launch import launch  # noqa: PLC0415

        return launch.run(options)
    from ros_lint.cli.commands import graph_queries  # noqa: PLC0415

    return graph_queries.run(command, options)
