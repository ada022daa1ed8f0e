"""The progress line appears late, changes seldom and is cleared at the end."""

from __future__ import annotations

import fcntl
import io
import os
import pty
import select
import struct
import termios

import pytest

from ros_lint.cli.progress import Progress


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


class Clock:
    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture(autouse=True)
def _terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TERM", "xterm")


def test_a_short_run_shows_no_progress() -> None:
    stream, clock = Terminal(), Clock()
    with Progress(stream, clock=clock) as progress:
        for done in range(100):
            clock.now += 0.004
            progress.update("reading", done, 100)
    assert stream.getvalue() == ""


def test_a_long_run_overwrites_one_line_and_clears_it() -> None:
    stream, clock = Terminal(), Clock()
    with Progress(stream, clock=clock) as progress:
        for done in range(8):
            progress.update("reading", done, 10)
            clock.now += 0.15
        progress.update("joining", 0, 0)
    assert stream.getvalue() == (
        "\rreading 4/10\x1b[K\rreading 5/10\x1b[K\rreading 6/10\x1b[K\rreading 7/10\x1b[K\rjoining\x1b[K\r\x1b[K"
    )


def test_the_line_is_cleared_if_the_run_fails() -> None:
    stream, clock = Terminal(), Clock()
    with pytest.raises(RuntimeError), Progress(stream, clock=clock) as progress:  # noqa: PT012
        clock.now += 1
        progress.update("reading", 1, 2)
        raise RuntimeError
    assert stream.getvalue().endswith("\r\x1b[K")


def test_without_a_terminal_no_progress_is_shown(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setenv("TERM", "dumb")
    for stream, expected in ((io.StringIO(), True), (Terminal(), False), (Terminal(), True)):
        progress = Progress(stream, expected, clock)
        clock.now += 10
        progress.update("reading", 1, 2)
        progress.clear()
        assert stream.getvalue() == ""


def test_the_line_is_shortened_to_the_width_of_the_terminal() -> None:
    controller, terminal = pty.openpty()
    fcntl.ioctl(terminal, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 40, 0, 0))
    clock = Clock()
    with os.fdopen(terminal, "w") as stream, Progress(stream, clock=clock) as progress:
        clock.now += 1
        progress.update("x" * 1000, 1, 2)
        progress.clear()
        expected = f"\r{'x' * 39}\x1b[K\r\x1b[K"
        written = ""
        while len(written) < len(expected) and select.select([controller], [], [], 10)[0]:
            written += os.read(controller, 4096).decode()
    os.close(controller)
    assert written == expected


def test_a_closed_terminal_raises_no_error() -> None:
    class ClosedTerminal(Terminal):
        def write(self, text: str) -> int:
            raise OSError(5, "Input/output error")

    clock = Clock()
    with Progress(ClosedTerminal(), clock=clock) as progress:
        clock.now += 1
        progress.update("reading", 1, 2)
