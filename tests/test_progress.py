"""The line on the terminal: late, seldom, and gone when it is over."""

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


def test_a_short_run_says_nothing() -> None:
    stream, clock = Terminal(), Clock()
    with Progress(stream, clock=clock) as progress:
        for done in range(100):
            clock.now += 0.004
            progress.update("reading", done, 100)
    assert stream.getvalue() == ""


def test_a_long_run_overwrites_one_line_and_takes_it_away() -> None:
    stream, clock = Terminal(), Clock()
    with Progress(stream, clock=clock) as progress:
        for done in range(8):
            progress.update("reading", done, 10)
            clock.now += 0.15
        progress.update("joining", 0, 0)
    assert stream.getvalue() == (
        "\rreading 4/10\x1b[K\rreading 5/10\x1b[K\rreading 6/10\x1b[K\rreading 7/10\x1b[K\rjoining\x1b[K\r\x1b[K"
    )


def test_the_line_goes_away_when_the_run_fails() -> None:
    stream, clock = Terminal(), Clock()
    with pytest.raises(RuntimeError), Progress(stream, clock=clock) as progress:  # noqa: PT012
        clock.now += 1
        progress.update("reading", 1, 2)
        raise RuntimeError
    assert stream.getvalue().endswith("\r\x1b[K")


def test_not_without_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = Clock()
    monkeypatch.setenv("TERM", "dumb")
    for stream, wanted in ((io.StringIO(), True), (Terminal(), False), (Terminal(), True)):
        progress = Progress(stream, wanted, clock)
        clock.now += 10
        progress.update("reading", 1, 2)
        progress.clear()
        assert stream.getvalue() == ""


def test_on_a_real_terminal_the_line_is_no_longer_than_the_screen() -> None:
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, 40, 0, 0))
    clock = Clock()
    with os.fdopen(theirs, "w") as stream, Progress(stream, clock=clock) as progress:
        clock.now += 1
        progress.update("x" * 1000, 1, 2)
        progress.clear()
        wanted = f"\r{'x' * 39}\x1b[K\r\x1b[K"
        written = ""
        while len(written) < len(wanted) and select.select([ours], [], [], 10)[0]:
            written += os.read(ours, 4096).decode()
    os.close(ours)
    assert written == wanted


def test_a_terminal_that_has_gone_is_no_error() -> None:
    class Gone(Terminal):
        def write(self, text: str) -> int:
            raise OSError(5, "Input/output error")

    clock = Clock()
    with Progress(Gone(), clock=clock) as progress:
        clock.now += 1
        progress.update("reading", 1, 2)
