"""A file of the cache folder never runs code, whatever it contains; at most the run is slow and says why."""

from __future__ import annotations

import errno
import os
import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from ros_lint.base import files
from ros_lint.base.columns import Codec
from ros_lint.base.text import Span, file_start
from ros_lint.workspace.cache import folder, layout
from ros_lint.workspace.cache.file import CacheFile

CODEC: Codec[tuple[Span, ...]] = Codec(tuple[Span, ...])
SPANS = (file_start("a"), Span("b", 1, 2, 3, 4))


class Place(NamedTuple):
    """A cache folder with the file of a workspace."""

    folder: Path
    workspace: Path

    @property
    def cache(self) -> CacheFile:
        return CacheFile(str(self.folder), str(self.workspace))

    @property
    def file(self) -> Path:
        return Path(self.cache._path)

    def read(self) -> tuple[dict[str, Any], str]:
        """Return the spans by name and the notes."""
        cache = self.cache
        return cache.read(lambda name: name != folder.WORKSPACE, CODEC), "\n".join(cache.notes)

    def write(self, name: str = "spans", spans: tuple[Span, ...] = SPANS, obsolete: tuple[str, ...] = ()) -> str:
        """Write spans and return the notes."""
        cache = self.cache
        cache.write({name: spans}, CODEC, lambda names: obsolete)
        return "\n".join(cache.notes)


@pytest.fixture
def place(tmp_path: Path) -> Place:
    (tmp_path / "ws").mkdir()
    result = Place(tmp_path / "cache", tmp_path / "ws")
    assert result.read() == ({}, "")
    assert result.write() == ""
    assert result.read() == ({"spans": SPANS}, "")
    return result


def test_records_are_added_replaced_and_removed(place: Place) -> None:
    place.write("other", ())
    place.write("spans", SPANS[:1])
    assert list(place.read()[0].items()) == [("other", ()), ("spans", SPANS[:1])]
    place.write("third", obsolete=("other", "absent"))
    assert list(place.read()[0]) == ["spans", "third"]
    assert place.file.stat().st_mode & 0o777 == 0o600
    assert place.folder.stat().st_mode & 0o777 == 0o700
    assert CacheFile("", "").read(lambda name: True, CODEC) == {}


def test_each_workspace_and_installation_has_a_file(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    assert CacheFile(str(place.folder), str(place.folder)).read(lambda name: True, CODEC) == {}
    (place.folder.parent / "link").symlink_to(place.workspace)
    assert CacheFile(str(place.folder), str(place.folder.parent / "link"))._path == str(place.file)
    monkeypatch.setattr("ros_lint.workspace.cache.file.__version__", "99.0")
    assert place.read() == ({}, "")
    place.write("new")
    monkeypatch.undo()
    assert place.read() == ({"spans": SPANS}, "")


def _move_and_link(place: Place) -> None:
    place.file.rename(place.folder / "elsewhere")
    place.file.symlink_to("elsewhere")


def _fifo(place: Place) -> None:
    place.file.unlink()
    os.mkfifo(place.file)


def _directory(place: Place) -> None:
    place.file.unlink()
    place.file.mkdir()


def _flip(at: int) -> Callable[[Place], object]:
    def change(place: Place) -> None:
        data = bytearray(place.file.read_bytes())
        data[at] ^= 1
        place.file.write_bytes(data)

    return change


def _contents(data: bytes) -> Callable[[Place], object]:
    return lambda place: place.file.write_bytes(data)


def _record(data: bytes) -> Callable[[Place], object]:
    """Plant a record with a correct checksum."""
    return lambda place: place.file.write_bytes(layout._pack({"spans": data}))


class Planted:
    def __reduce__(self) -> tuple[Any, ...]:
        return os.mkdir, ("planted",)


UNUSABLE: dict[str, tuple[Callable[[Place], object], str]] = {
    "a file that all can write": (lambda place: place.file.chmod(0o666), "another user owns the file or can write to it"),
    "a file that the group can write": (lambda place: place.file.chmod(0o620), "another user owns the file or can write to it"),
    "a file that cannot be read": (_directory, "Is a directory"),
    "a link": (_move_and_link, "Too many levels of symbolic links"),
    "a broken link": (lambda place: (place.file.unlink(), place.file.symlink_to("gone")), "Too many levels of symbolic links"),
    "a hard link": (lambda place: (place.folder / "other").hardlink_to(place.file), "the file has further hard links"),
    "a FIFO": (_fifo, "not a regular file"),
    "a changed byte in a record": (_flip(-3), "damaged"),
    "a changed byte in the index": (_flip(40), "not a cache file, or damaged"),
    "a changed byte in the head": (_flip(3), "not a cache file, or damaged"),
    "a file that was cut": (lambda place: place.file.write_bytes(place.file.read_bytes()[:-2]), "damaged"),
    "a file that was cut early": (lambda place: place.file.write_bytes(place.file.read_bytes()[:30]), "damaged"),
    "an empty file": (_contents(b""), "not a cache file, or damaged"),
    "zeros": (_contents(bytes(5000)), "not a cache file, or damaged"),
    "a pickle": (_contents(pickle.dumps(Planted())), "not a cache file, or damaged"),
    "a pickle in a record": (_record(pickle.dumps(Planted())), "damaged"),
    "a record of another type": (_record(Codec(tuple[str, ...]).encode(("a", "b"))), "damaged"),
    "an index without an end": (_contents(b"ros-lint cache 1 999999999999 0\n"), "not a cache file, or damaged"),
    "a record without an end": (
        _contents(layout._pack({"spans": b""}).replace(b"spans 0", b"spans 9")), "not a cache file, or damaged"
    ),
    "huge numbers": (_contents(b"ros-lint cache 1 " + b"9" * 5000), "not a cache file, or damaged"),
}  # fmt: skip


@pytest.mark.parametrize(("change", "reason"), UNUSABLE.values(), ids=UNUSABLE)
def test_files_that_cannot_be_trusted_are_not_used(
    place: Place, monkeypatch: pytest.MonkeyPatch, change: Callable[[Place], object], reason: str
) -> None:
    monkeypatch.chdir(place.workspace)
    change(place)
    read, note = place.read()
    assert read == {}
    assert note.startswith(f"the cached results are not used, so this run is slower: '{place.file}': ")
    assert note.endswith(reason)
    if place.file.is_dir():
        assert place.write() == f"the results are not cached, so the next run is slower: '{place.file}': Is a directory"
    else:
        assert place.write() == ""  # the next run is a fast one
        assert place.read() == ({"spans": SPANS}, "")
    assert not any(path.name.endswith(".tmp") for path in place.folder.iterdir())
    assert list(place.workspace.iterdir()) == []


def test_large_files_are_neither_read_nor_written(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(layout, "MOST_BYTES", place.file.stat().st_size - 1)
    assert "is more than the limit of" in place.read()[1]
    before = place.file.read_bytes()
    assert "is more than the limit of" in place.write("spans", SPANS * 9)
    assert place.file.read_bytes() == before


def untouched(place: Place, at: Path) -> bool:
    """Return whether a file is neither read nor written, and no other file is written next to it."""
    content = {file: file.read_bytes() for file in place.folder.iterdir()}
    cache = CacheFile(str(at), str(place.workspace))
    assert cache.read(lambda name: True, CODEC) == {}
    cache.write({"spans": ()}, CODEC, lambda names: ())
    assert [note.rpartition(": ")[2] for note in cache.notes] == ["another user owns the folder or can write to it"] * 2
    return content == {file: file.read_bytes() for file in place.folder.iterdir()}


@pytest.mark.parametrize("mode", [0o777, 0o770, 0o702, 0o1777])
def test_folders_that_others_can_write_are_not_used(place: Place, tmp_path: Path, mode: int) -> None:
    place.folder.chmod(mode)
    (tmp_path / "link").symlink_to(place.folder)
    assert untouched(place, place.folder)
    assert untouched(place, tmp_path / "link")


def test_a_link_to_a_folder_of_the_user_is_followed(place: Place, tmp_path: Path) -> None:
    (tmp_path / "link").symlink_to(place.folder)
    assert place._replace(folder=tmp_path / "link").read() == ({"spans": SPANS}, "")


def test_folders_of_another_user_are_not_used(place: Place, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "link").symlink_to(place.folder)
    other_user = os.geteuid() + 1
    monkeypatch.setattr(os, "geteuid", lambda: other_user)
    assert untouched(place, place.folder)
    assert untouched(place, tmp_path / "link")


def test_a_link_of_another_user_is_not_followed(place: Place, tmp_path: Path) -> None:
    if os.geteuid():
        pytest.skip("only root can give a link to another user")
    (tmp_path / "link").symlink_to(place.folder)
    os.lchown(tmp_path / "link", 65534, 65534)
    assert untouched(place, tmp_path / "link")


def test_a_file_of_another_user_is_not_read_and_is_replaced(place: Place) -> None:
    if os.geteuid():
        pytest.skip("only root can give a file to another user")
    os.chown(place.file, 65534, 65534)
    assert "another user owns the file" in place.read()[1]
    assert place.write() == ""
    assert place.read() == ({"spans": SPANS}, "")


def test_a_failed_write_leaves_the_file_as_it_was(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(place.file))

    wrong: Any = ("no span",)
    assert place.write("spans", wrong).startswith("the results are not cached, so the next run is slower: ")
    monkeypatch.setattr(os, "replace", fail)
    assert place.write("spans", ()).endswith(f"'{place.file}': No space left on device")
    assert [path.name for path in place.folder.iterdir()] == [place.file.name]
    assert place.read() == ({"spans": SPANS}, "")


def test_a_full_disk_leaves_the_file_as_it_was(place: Place) -> None:
    resource = pytest.importorskip("resource")
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    try:
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, limits[1]))
        note = place.write("spans", tuple(file_start(f"a{number}") for number in range(5000)))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, ignored)
    assert "File too large" in note
    assert [path.name for path in place.folder.iterdir()] == [place.file.name]
    assert place.read() == ({"spans": SPANS}, "")


def test_a_folder_that_cannot_be_created_is_noted(place: Place) -> None:
    cache = CacheFile(f"{place.file}/below", str(place.workspace))
    assert cache.read(lambda name: True, CODEC) == {}
    cache.write({}, CODEC, lambda names: ())
    assert cache.notes[-1].startswith(f"the results are not cached, so the next run is slower: '{place.file}")


WRITE_FOREVER = """
import sys
from ros_lint.base.columns import Codec
from ros_lint.base.text import Span, file_start
from ros_lint.workspace.cache.file import CacheFile
spans = tuple(file_start(f"{sys.argv[3]}{n}") for n in range(2000))
number = 0
while True:
    cache = CacheFile(sys.argv[1], sys.argv[2])
    cache.write({f"{sys.argv[3]}-{number % 3}": spans}, Codec(tuple[Span, ...]), lambda names: ())
    cache.read(lambda name: name[0] == sys.argv[3], Codec(tuple[Span, ...]))
    if cache.notes:
        sys.exit(str(cache.notes))
    if not number:
        print("started", flush=True)
    number += 1
"""


@pytest.mark.slow
def test_concurrent_writers_and_killed_ones_leave_a_usable_file(place: Place) -> None:
    command = [sys.executable, "-c", WRITE_FOREVER, str(place.folder), str(place.workspace)]
    for _ in range(4):
        writers = [subprocess.Popen([*command, name], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) for name in "ab"]
        for writer in writers:
            assert writer.stdout is not None
            assert writer.stdout.readline() == "started\n"
        end = time.monotonic() + 0.4
        while time.monotonic() < end:
            read, note = place.read()
            assert note == ""
            assert {len(spans) for spans in read.values()} <= {2, 2000}
        assert [writer.poll() for writer in writers] == [None, None]
        for writer in writers:
            writer.kill()
            writer.communicate()
    place.write()
    assert place.read()[0]["spans"] == SPANS


def test_temporary_files_of_killed_processes_are_removed(place: Place) -> None:
    abandoned, current = place.folder / "a.cache.5-1.tmp", place.folder / "a.cache.5-2.tmp"
    for path in (abandoned, current):
        path.write_bytes(b"")
    os.utime(abandoned, (time.time() - 7200,) * 2)
    place.write()
    assert (abandoned.exists(), current.exists()) == (False, True)


def others(place: Place, *ages: float) -> list[Path]:
    """Create files of further workspaces that were used some days ago."""
    result = []
    for number, age in enumerate(ages):
        workspace = place.workspace.parent / f"ws{number}"
        workspace.mkdir()
        cache = CacheFile(str(place.folder), str(workspace))
        cache.write({"spans": SPANS}, CODEC, lambda names: ())
        os.utime(cache._path, (time.time() - age * 86400,) * 2)
        result.append(Path(cache._path))
    return result


def test_unused_files_are_removed(place: Place) -> None:
    recent, old, read = others(place, 80, 100, 100)
    CacheFile(str(place.folder), str(place.workspace.parent / "ws2")).read(lambda name: True, CODEC)
    place.write()
    assert (recent.exists(), old.exists(), read.exists()) == (True, False, True)


def test_the_folder_stays_below_its_size_limit(place: Place, monkeypatch: pytest.MonkeyPatch) -> None:
    older, newer = others(place, 5, 3)
    size = place.file.stat().st_size
    os.utime(place.file, (0, 0))
    monkeypatch.setattr(folder, "MOST_BYTES", 2 * size + 40)
    place.write()
    assert (older.exists(), newer.exists(), place.file.exists()) == (False, True, True)


def test_files_of_workspaces_that_are_gone_are_removed_when_a_workspace_is_added(place: Place) -> None:
    gone, existing = others(place, 1, 1)
    (place.workspace.parent / "ws0").rmdir()
    place.write()
    assert gone.exists()
    place.file.unlink()
    place.write()
    assert (gone.exists(), existing.exists()) == (False, True)


def test_files_above_the_size_limit_are_not_read(tmp_path: Path) -> None:
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
