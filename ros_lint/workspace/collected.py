"""The facts of one file: the data that collectors extract from its text."""

from __future__ import annotations

from typing import NamedTuple

from ros_lint.collectors.cmake.syntax import ParsedScript
from ros_lint.facts.launch import LaunchFile
from ros_lint.facts.sources import FileFacts, MachinePath
from ros_lint.facts.suppressions import Suppression


class Collected(NamedTuple):
    """The facts of one file: the data that collectors extract from its text."""

    facts: FileFacts | None = None
    launch: LaunchFile | None = None
    commands: ParsedScript | None = None
    suppressions: tuple[Suppression, ...] = ()
    machine_paths: tuple[MachinePath, ...] = ()
    unreadable: str = ""
    """Reason why the file was not read, "" if it was read."""


class ReadFile(NamedTuple):
    """A file with its facts (extracted data), which were collected in this run or found in the cache."""

    digest: bytes
    """Digest of the contents, ``NOT_READ`` if the file could not be read."""
    collected: Collected
