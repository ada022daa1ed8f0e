"""Seeds: workspaces that mutators begin with."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Final, NamedTuple

from ros_lint.testing import read_cases

_ROOT: Final = Path(__file__).parents[2]
_MOST_FILES: Final = 60
_MOST_BYTES: Final = 100_000


class Other(NamedTuple):
    """A directory entry that is no regular file."""

    kind: str
    """``link``, ``folder``, ``fifo``, ``socket`` or ``program``, which is a regular file with the executable bit."""
    content: bytes = b""
    """The target of a link, the content of a program."""


Files = Mapping[str, bytes | Other]
"""Contents by path. Bytes of a path that are not UTF-8 are surrogate escapes."""


class Seed(NamedTuple):
    name: str
    files: Files


@cache
def of_cases() -> tuple[Seed, ...]:
    """Return the workspaces of the cases of all rules."""
    return tuple(
        Seed(
            f"{source.stem}: {case.title}",
            {
                path: Other("program", text.encode()) if path in case.executable else text.encode()
                for path, text in case.files.items()
            },
        )
        for source in sorted((_ROOT / "fixtures").glob("*.md"))
        for case in read_cases(source)
    )


def of_folder(folder: str) -> Iterator[Seed]:
    """Yield the packages below a folder, each as a workspace, with no more than the first files of moderate size."""
    for place, folders, names in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        if "package.xml" in names:
            yield Seed(os.path.relpath(place, folder), dict(_files(place)))
            folders.clear()


def _files(package: str) -> Iterator[tuple[str, bytes]]:
    count = 0
    for place, folders, names in os.walk(package):
        folders.sort()
        for name in sorted(names):
            path = os.path.join(place, name)
            if os.path.isfile(path) and not os.path.islink(path) and os.path.getsize(path) <= _MOST_BYTES:
                yield f"p/{os.path.relpath(path, package)}", Path(path).read_bytes()
                count += 1
                if count == _MOST_FILES:
                    return


def write(files: Files, root: str) -> None:
    """Create the files below a folder. What cannot be created, such as a file below a file, is left out."""
    for path, content in files.items():
        place = os.path.join(root, path)
        try:
            os.makedirs(os.path.dirname(place), exist_ok=True)
            _create(place, content)
        except (OSError, ValueError):
            continue


def _create(place: str, content: bytes | Other) -> None:
    if isinstance(content, bytes):
        Path(place).write_bytes(content)
    elif content.kind == "program":
        Path(place).write_bytes(content.content)
        os.chmod(place, 0o755)
    elif content.kind == "link":
        os.symlink(content.content, os.fsencode(place))
    elif content.kind == "folder":
        os.mkdir(place)
    elif content.kind == "fifo":
        os.mkfifo(place)
    else:
        os.mknod(place, 0o140644)
