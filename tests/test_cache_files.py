"""A file of the cache folder never runs code, whatever it contains; at most the run is slow."""

from __future__ import annotations

import builtins
import operator
import os
import pickle
import sys
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from pkgutil import walk_packages
from types import ModuleType
from typing import Any, NamedTuple

import pytest

import ros_lint
from ros_lint.analysis.finding import Confidence, Severity
from ros_lint.base import files
from ros_lint.base.sealed import Sealed
from ros_lint.base.text import Span, file_start
from ros_lint.facts.visibility import Facet, Opaque
from ros_lint.workspace import cache_files

ATTRIBUTES = ("__dict__", "__class__", "__setstate__", "__call__", "__new__", "__doc__", "anything")


def modules() -> list[ModuleType]:
    ours = [
        modules_found.name
        for modules_found in walk_packages(ros_lint.__path__, "ros_lint.")
        if not modules_found.name.endswith("__main__")
    ]
    return [*map(import_module, ours), ros_lint, builtins, operator, os, pickle, sys]


def names(module: ModuleType) -> Iterator[str]:
    """Yield every name that a pickle can request from a module, with the dotted names of protocol 4."""
    for name in {*vars(module), *dir(module), "", ".", "nothing"}:
        yield name
        yield from (f"{name}.{attribute}" for attribute in dir(getattr(module, name, None)))


def test_unpickling_can_create_only_facts() -> None:
    reached_names: set[tuple[str, str]] = set()
    for module in modules():
        for name in names(module):
            try:
                created = cache_files.maker(module.__name__, name)
            except LookupError:
                continue
            reached_names.add((module.__name__, name))
            assert not isinstance(created, type), name
            modules_found = getattr(module, name)
            assert (modules_found.__module__, modules_found.__qualname__) == (module.__name__, name)
            assert issubclass(modules_found, tuple | Sealed), name
            # An object takes no state: it has none, or refuses it. No opcode calls a method of it.
            assert issubclass(modules_found, Sealed) or modules_found.__dictoffset__ == 0, name
            assert not any(hasattr(modules_found, method) for method in ("append", "extend", "add", "__setitem__")), name
            for attribute in ATTRIBUTES:
                with pytest.raises((AttributeError, TypeError)):
                    setattr(created, attribute, tuple)
    assert {
        ("ros_lint.engine.report", "Report"),
        ("ros_lint.facts.visibility", "Opaque"),
        ("ros_lint.analysis.finding", "Severity"),
    } <= reached_names
    assert {module for module, _ in reached_names} == set(cache_files.MODULES)


def test_all_classes_of_facts_can_be_cached() -> None:
    for module in cache_files.MODULES:
        for modules_found in cache_files.classes(module).values():
            assert cache_files.maker(module, modules_found.__qualname__)
    assert {Facet, Opaque, Severity, Confidence, Span} <= set(cache_files._reducers())


def write(path: Path, pickled: bytes, state: str = "state") -> None:
    path.write_bytes(cache_files._head(state, pickled) + b"\n" + pickled)


def text(value: str) -> bytes:
    return b"X" + len(value.encode()).to_bytes(4, "little") + value.encode()


SPAN = b"cros_lint.base.text\nSpan\n(" + text("a") + b"K\x01K\x01K\x01K\x01tR"
MEMBER = b"cros_lint.analysis.finding\nSeverity\nK\x03\x85R"
CLASS = b"cros_lint.analysis.finding\nSeverity\n"
STATE = b"}" + text("_value_") + b"K\x01s"
SLOTS = b"N}" + text("__doc__") + b"K\x01s\x86"


@pytest.mark.parametrize("state", [STATE, SLOTS], ids=["state", "slots"])
@pytest.mark.parametrize(
    "of", [SPAN, MEMBER, CLASS, b"cros_lint.base.text\nSpan\n"], ids=["fact", "member", "enumeration", "class"]
)
def test_no_cached_object_accepts_a_pickled_state(tmp_path: Path, of: bytes, state: bytes) -> None:
    content = [dict(vars(modules_found)) for modules_found in (Span, Severity, Severity.ERROR)]
    write(tmp_path / "kept", of + b".")
    assert cache_files.load(str(tmp_path / "kept"), "state") is not None
    write(tmp_path / "kept", of + state + b"b.")
    assert cache_files.load(str(tmp_path / "kept"), "state") is None
    assert [dict(vars(modules_found)) for modules_found in (Span, Severity, Severity.ERROR)] == content


KEPT = (file_start("a"), Facet.USES | Facet.SHARE, Severity.ERROR, {"b": [1, "c"]})


class Place(NamedTuple):
    """Create a cache folder with a readable file."""

    folder: Path
    file: Path


@pytest.fixture
def place(tmp_path: Path) -> Place:
    file = tmp_path / "cache" / "kept"
    assert cache_files.save(str(file), "state", KEPT)
    assert cache_files.load(str(file), "state") == KEPT
    assert cache_files.load(str(file), "another state") is None
    return Place(file.parent, file)


def _link(place: Place) -> None:
    place.file.rename(place.folder / "elsewhere")
    place.file.symlink_to("elsewhere")


def _fifo(place: Place) -> None:
    place.file.unlink()
    os.mkfifo(place.file)


def _flip(place: Place) -> None:
    data = bytearray(place.file.read_bytes())
    data[-3] ^= 1
    place.file.write_bytes(data)


NOT_READ: dict[str, Callable[[Place], object]] = {
    "a file that all can write": lambda place: place.file.chmod(0o666),
    "a file that the group can write": lambda place: place.file.chmod(0o620),
    "a link": _link,
    "a FIFO": _fifo,
    "a folder": lambda place: (place.file.unlink(), place.file.mkdir()),
    "a byte that changed": _flip,
    "a file that was cut": lambda place: place.file.write_bytes(place.file.read_bytes()[:-2]),
    "an empty file": lambda place: place.file.write_bytes(b""),
}


@pytest.mark.parametrize("change", NOT_READ.values(), ids=NOT_READ)
def test_damaged_and_foreign_files_are_not_read(place: Place, change: Callable[[Place], object]) -> None:
    change(place)
    assert cache_files.load(str(place.file), "state") is None
    if not place.file.is_dir():
        assert cache_files.save(str(place.file), "state", KEPT)  # the next run is a fast one
        assert cache_files.load(str(place.file), "state") == KEPT


def test_large_files_are_not_read(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cache_files, "_MAX_BYTES", place.file.stat().st_size - 1)
    assert cache_files.load(str(place.file), "state") is None
    other_file = place.folder / "other"
    assert not cache_files.save(str(other_file), "state", KEPT)  # it could not be read again
    assert [path.name for path in place.folder.iterdir()] == ["kept"]


def untouched(place: Place, path: Path) -> bool:
    """Return whether a file is neither read nor written, and no other file is written next to it."""
    content = {file: file.read_bytes() for file in place.folder.iterdir()}
    assert cache_files.load(str(path), "state") is None
    assert not cache_files.save(str(path), "state", ("other",))
    return content == {file: file.read_bytes() for file in place.folder.iterdir()}


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o702, 0o1777])
def test_folders_that_others_can_write_are_not_used(place: Place, tmp_path: Path, mode: int) -> None:
    place.folder.chmod(mode)
    (tmp_path / "link").symlink_to(place.folder)
    assert untouched(place, place.file)
    assert untouched(place, tmp_path / "link" / "kept")


def test_a_link_to_a_folder_of_the_user_is_followed(place: Place, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(place.folder)
    assert cache_files.load(str(tmp_path / "link" / "kept"), "state") == KEPT


def test_folders_of_another_user_are_not_used(place: Place, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "link").symlink_to(place.folder)
    other_file = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: other_file)
    assert untouched(place, place.file)
    assert untouched(place, tmp_path / "link" / "kept")


def test_a_link_of_another_user_is_not_followed(place: Place, tmp_path: Path) -> None:
    if os.geteuid():
        pytest.skip("only root can give a link to another user")
    (tmp_path / "link").symlink_to(place.folder)
    os.lchown(tmp_path / "link", 65534, 65534)
    assert untouched(place, tmp_path / "link" / "kept")


def test_a_file_of_another_user_is_not_read_and_is_replaced(place: Place) -> None:
    if os.geteuid():
        pytest.skip("only root can give a file to another user")
    os.chown(place.file, 65534, 65534)
    assert cache_files.load(str(place.file), "state") is None
    assert cache_files.save(str(place.file), "state", KEPT)
    assert cache_files.load(str(place.file), "state") == KEPT


def test_a_failed_write_leaves_no_file(place: Place) -> None:
    deep: Any = ()
    for _ in range(100_000):
        deep = (deep,)
    for value in (deep, lambda: None):
        assert not cache_files.save(str(place.file), "state", value)
        assert [path.name for path in place.folder.iterdir()] == ["kept"]
    assert cache_files.load(str(place.file), "state") == KEPT


def test_files_above_the_size_limit_are_not_written(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"12345")
    assert files.read(str(tmp_path / "a"), 5) == b"12345"
    with pytest.raises(OSError, match="is more than the limit of 1 KB"):
        files.read(str(tmp_path / "a"), 4)
    (tmp_path / "link").symlink_to("a")
    assert files.read(str(tmp_path / "link"), 5) == b"12345"
    os.mkfifo(tmp_path / "fifo")
    for path in (tmp_path / "fifo", Path("/dev/zero")):
        with pytest.raises(OSError, match="not a regular file"):
            files.read(str(path), 5)
    with pytest.raises(IsADirectoryError):
        files.read(str(tmp_path), 5)
