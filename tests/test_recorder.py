"""Remembered answers with a record of what they have read."""

from __future__ import annotations

from functools import partial

from ros_lint.base.questions import Recorder


def test_answers_that_the_last_run_has_not_read_are_forgotten() -> None:
    recorder = Recorder()
    computed: list[str] = []

    def note(name: str) -> str:
        computed.append(name)
        return name

    def read(name: str, below: str) -> str:
        return note(name) + recorder.ask(below, lambda: note(below))

    for number in range(2000):
        recorder.begin()
        recorder.ask("kept", lambda: read("kept", "below"))
        recorder.ask(number, partial(note, str(number)))
    computed.clear()
    recorder.ask("kept", lambda: read("kept", "below"))
    recorder.ask("below", lambda: note("below"))
    recorder.ask(1999, lambda: note("1999"))
    assert not computed
    recorder.ask(5, lambda: note("5"))
    assert computed == ["5"]
