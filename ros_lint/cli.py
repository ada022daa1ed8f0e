"""The command line: argv in, exit code out. 0 clean, 1 findings, 2 the tool could not do its job.

Everything heavy is imported by the command that needs it: ``--version`` and ``--help`` are part of every shell's start-up.
"""

from __future__ import annotations

import os
import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import NoReturn


def run() -> NoReturn:
    """Run the command of this process and end it."""
    code = main()
    try:
        sys.stdout.flush()
        sys.stderr.flush()
    except OSError:
        code = code or 2  # whoever read along has gone
    # Nothing is left to be saved. Taking a model of a large workspace to pieces would take as long as reading it.
    os._exit(code)


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command. Returns the exit code; raises nothing but what ends the process."""
    arguments = list(sys.argv[1:] if argv is None else argv)
    if arguments == ["--version"]:
        from ros_lint import __version__  # noqa: PLC0415

        print(f"ros-lint {__version__}")
        return 0
    import gc  # noqa: PLC0415

    from ros_lint.arguments import parse  # noqa: PLC0415

    gc.disable()  # a run makes a model once and ends: looking for garbage in it again and again takes a seventh of it

    try:
        command, options = parse(arguments)
        return _run(command, options)
    except BrokenPipeError:
        # The reader has gone, as in `ros-lint | head`. Keep the interpreter from complaining about it once more.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 2
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
        from ros_lint.commands import papers  # noqa: PLC0415

        return papers.run(command, options)
    if command == "index":
        from ros_lint.commands import index  # noqa: PLC0415

        return index.run(options)
    if command == "check":
        from ros_lint.commands import check  # noqa: PLC0415

        return check.run(options)
    if command == "launch":
        from ros_lint.commands import launch  # noqa: PLC0415

        return launch.run(options)
    from ros_lint.commands import graphs  # noqa: PLC0415

    return graphs.run(command, options)
