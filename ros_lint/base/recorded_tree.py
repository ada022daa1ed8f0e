"""A file tree that records each query to the disk with its answer, so that a later run can check whether anything changed."""

from __future__ import annotations

import os
import time
from array import array
from collections.abc import Iterable
from itertools import chain, islice
from typing import Literal, NamedTuple

from ros_lint.base.tree import DiskTree, Entry, Stamp, Tree

Query = Literal["list", "read", "stamp", "identity", "untracked"]
"""The method of the tree that was called: "list", "read", "stamp", "identity", or "untracked" for ``is_untracked``."""

TreeAnswer = list[Entry] | Stamp | str | int
"""The answer of a file tree to a query, or the errno of the error that it raised."""


class Answers(NamedTuple):
    """All queries to the disk during a run of ros-lint, e.g. for the entries of a folder, with the answers.

    They are packed into few objects, because a later run mostly only compares them.
    """

    lists: tuple[tuple[str, str], ...] = ()
    """Pairs of a folder and the text of its entries (:func:`_listing`)."""
    files: tuple[str, ...] = ()
    """Paths of the files whose stamps (time, size and other metadata) were requested."""
    stamps: bytes = b""
    """The stamps of ``files``, as an array of 64-bit integers."""
    settled: bytes = b""
    """One byte for each of ``files``: 1 if an equal stamp guarantees equal contents (:meth:`Stamp.is_settled`), else 0."""
    digests: bytes = b""
    """For each of ``files`` the digest of its contents (:func:`content_digest`), NOT_READ if the contents were not read."""
    identities: tuple[tuple[str, str], ...] = ()
    untracked: tuple[tuple[str, bool], ...] = ()
    errors: tuple[tuple[str, Query, int], ...] = ()
    """Failed queries: path, kind of the query, and errno of the error."""


class Queries(NamedTuple):
    """Some queries of a run with the answers, to be sent to another process."""

    answers: dict[tuple[Query, str], TreeAnswer]
    digests: dict[str, bytes]
    steady: bool


class RecordedTree:
    """A disk tree that records all queries and answers. ``steady`` is False if a file changed during the run."""

    def __init__(self, disk: DiskTree) -> None:
        self.disk = disk
        self.steady = True
        self._start = time.time_ns()
        self._answers: dict[tuple[Query, str], TreeAnswer] = {}
        self._digests: dict[str, bytes] = {}
        self._known: dict[tuple[Query, str], TreeAnswer] = {}
        self._renewed: dict[str, Stamp] = {}
        self._taken = (0, 0)

    @property
    def answers(self) -> Answers:
        """The queries of this run to the file system, with their answers."""
        lists, stamps, others, errors = [], {}, [], []
        for (query, path), answer in self._answers.items():
            match answer:
                case int():
                    errors.append((path, query, answer))
                case list():
                    lists.append((path, _listing(answer)))
                case Stamp():
                    stamps[path] = answer
                case _:
                    others.append((query, path, answer))
        return Answers(
            lists=tuple(lists),
            files=tuple(stamps),
            stamps=_packed(stamps.values()),
            settled=bytes([stamp.is_settled(self._start) for stamp in stamps.values()]),
            digests=b"".join([self._digests.get(path, NOT_READ) for path in stamps]),
            identities=tuple([(path, answer) for query, path, answer in others if query == "identity"]),
            untracked=tuple([(path, bool(answer)) for query, path, answer in others if query == "untracked"]),
            errors=tuple(errors),
        )

    def is_unchanged(self, answers: Answers) -> bool:
        """Return whether the disk still gives the answers that were recorded in an earlier run.

        A file counts as unchanged if its mode, size and contents are unchanged; its modification time does not matter. The
        contents matter only if the earlier run read them. The current answers are stored for later queries.
        """
        others: list[tuple[Query, str, TreeAnswer]] = [
            *(("identity", path, identity) for path, identity in answers.identities),
            *(("untracked", path, "untracked" if untracked else "") for path, untracked in answers.untracked),
            *((query, path, number) for path, query, number in answers.errors),
        ]
        return (
            all(
                isinstance(entries := self._current("list", path), list) and _listing(entries) == listing
                for path, listing in answers.lists
            )
            and self._are_unchanged_files(answers)
            and all(self._current(query, path) == answer for query, path, answer in others)
        )

    def _are_unchanged_files(self, answers: Answers) -> bool:
        current = [stamp for path in answers.files if isinstance(stamp := self._current("stamp", path), Stamp)]
        if len(current) != len(answers.files):
            return False
        if _packed(current) == answers.stamps and answers.settled == b"\1" * len(current):
            return True
        digests = [answers.digests[at : at + len(NOT_READ)] for at in range(0, len(answers.digests), len(NOT_READ))]
        for path, stamp, earlier, settled, digest in zip(
            answers.files, current, _unpacked(answers.stamps), answers.settled, digests, strict=True
        ):
            if stamp == earlier and (settled or digest == NOT_READ):
                continue
            if not has_contents(self.disk, path, stamp, earlier, digest):
                return False
            if stamp != earlier or stamp.is_settled(self._start):
                self._renewed[path] = stamp
        return True

    def renewed(self, answers: Answers) -> Answers | None:
        """Return the answers of an earlier run with the current metadata of the files. The answers must be unchanged.

        Return None if the next comparison would not be faster with the current metadata.
        """
        if not self._renewed:
            return None
        settled = [
            was_settled if path not in self._renewed else self._renewed[path].is_settled(self._start)
            for path, was_settled in zip(answers.files, answers.settled, strict=True)
        ]
        stamps = [self._renewed.get(path, stamp) for path, stamp in zip(answers.files, _unpacked(answers.stamps), strict=True)]
        return answers._replace(stamps=_packed(stamps), settled=bytes(settled))

    def note_contents(self, path: str, digest: bytes) -> None:
        """Record the digest of the contents that were read from a file. ``NOT_READ`` means that the file could not be read."""
        if digest != NOT_READ:
            self.steady &= self._digests.setdefault(path, digest) == digest
        else:
            self._note("read", path, self._ask("read", path))

    def new_queries(self) -> Queries:
        """Return the queries of this run since the last call."""
        answers, digests = self._taken
        self._taken = len(self._answers), len(self._digests)
        return Queries(
            dict(islice(self._answers.items(), answers, None)), dict(islice(self._digests.items(), digests, None)), self.steady
        )

    def add(self, queries: Queries) -> None:
        """Record the queries of another process of this run."""
        for (query, path), answer in queries.answers.items():
            self._note(query, path, answer)
        for path, digest in queries.digests.items():
            self.note_contents(path, digest)
        self.steady &= queries.steady

    def list(self, path: str) -> list[Entry]:
        answer = self._answer("list", path)
        assert isinstance(answer, list)
        return answer

    def read(self, path: str) -> bytes:
        try:
            self.stamp(path)  # before reading, so that a file that changes meanwhile counts as changed
            data = self.disk.read(path)
        except OSError as error:
            self._note("read", path, error.errno or 0)
            raise
        self.note_contents(path, content_digest(data))
        return data

    def stamp(self, path: str) -> Stamp:
        answer = self._answers.get(("stamp", path)) or self._answer("stamp", path)
        if not isinstance(answer, Stamp):
            raise self._error(answer, path)
        return answer

    def identity(self, path: str) -> str:
        answer = self._answer("identity", path)
        assert isinstance(answer, str)
        return answer

    def is_untracked(self, path: str) -> bool:
        return bool(self._answer("untracked", path))

    def _current(self, query: Query, path: str) -> TreeAnswer:
        current = self._known[query, path] = self._ask(query, path)
        return current

    def _answer(self, query: Query, path: str) -> TreeAnswer:
        answer = self._known.pop((query, path), None)
        if answer is None:
            answer = self._ask(query, path)
        self._note(query, path, answer)
        if isinstance(answer, int):
            raise self._error(answer, path)
        return answer

    def _ask(self, query: Query, path: str) -> TreeAnswer:
        disk = self.disk
        try:
            if query == "list":
                return disk.list(path)
            if query == "stamp":
                return disk.stamp(path)
            if query == "identity":
                return disk.identity(path)
            if query == "untracked":
                return "untracked" if disk.is_untracked(path) else ""
            disk.read(path)
        except OSError as error:
            return error.errno or 0
        return "read"

    def _note(self, query: Query, path: str, answer: TreeAnswer) -> None:
        if self._answers.setdefault((query, path), answer) != answer:
            self.steady = False

    def _error(self, answer: object, path: str) -> OSError:
        number = answer if isinstance(answer, int) else 0
        return OSError(number, os.strerror(number), self.disk.place(path))


NOT_READ = bytes(16)
"""Value in place of the digest of a file whose contents were not read."""


def _listing(entries: Iterable[Entry]) -> str:
    """Return the entries of a folder as one text, for comparisons."""
    return "\0".join([f"{name}/{kind}/" if link else f"{name}/{kind}" for name, kind, link in entries])


def _packed(stamps: Iterable[Stamp]) -> bytes:
    return array("q", chain.from_iterable(stamps)).tobytes()


def _unpacked(stamps: bytes) -> list[Stamp]:
    numbers = array("q")
    numbers.frombytes(stamps)
    rows = iter(numbers)
    return list(map(Stamp._make, zip(rows, rows, rows, rows, rows, strict=True)))


def content_digest(data: bytes) -> bytes:
    """Return a digest of the contents of a file."""
    from hashlib import blake2b  # noqa: PLC0415  (not needed if nothing has changed)

    return blake2b(data, digest_size=16).digest()


def has_contents(disk: Tree, path: str, current: Stamp, earlier: Stamp, digest: bytes) -> bool:
    """Return whether a file has the same mode, size and contents as earlier.

    ``current`` and ``earlier`` are its stamps, and ``digest`` is that of the earlier contents. If ``digest`` is
    ``NOT_READ``, the contents are not compared.
    """
    if (current.mode, current.size) != (earlier.mode, earlier.size):
        return False
    try:
        return digest == NOT_READ or content_digest(disk.read(path)) == digest
    except OSError:
        return False
