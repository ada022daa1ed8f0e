"""Read the files of git commits without executing a program that the configuration of the repository names.

Therefore git is called only to read objects. The files are written as git stores them, without filters, hooks, attributes
and work trees. Missing objects of a partial clone are not fetched.
"""

from __future__ import annotations

import os
import subprocess
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_SAFE = {
    "GIT_ALLOW_PROTOCOL": "none",
    "GIT_NO_LAZY_FETCH": "1",
    "GIT_NO_REPLACE_OBJECTS": "1",
    "GIT_OPTIONAL_LOCKS": "0",
    "GIT_TERMINAL_PROMPT": "0",
}
_FILES = (b"100644", b"100755")
_LINK = b"120000"


class GitError(UserError):
    """A commit cannot be read. The message names the commit and the reason."""


class _Blob(NamedTuple):
    """A file or link in a commit: its mode, the name of its object (a hash) and its path."""

    mode: bytes
    name: bytes
    path: str


def merge_base(repository: str, ref: str, environment: Mapping[str, str]) -> str:
    """Return the commit at which the history of ``ref`` diverged from that of HEAD. Raises GitError."""
    named = _git(repository, environment, "rev-parse", "--verify", "--quiet", "--end-of-options", f"{ref}^{{commit}}")
    if not named:
        raise GitError(f"--since: '{ref}' is not a commit of {repository}")
    base = _git(repository, environment, "merge-base", "HEAD", named.decode().strip())
    if not base:
        raise GitError(f"--since: '{ref}' and HEAD have no common commit; if the clone is shallow, fetch more history")
    return base.decode().split()[0]


def write_files(repository: str, commit: str, folder: str, environment: Mapping[str, str]) -> None:
    """Write the files and links of a commit into an empty folder, without submodules. Raises GitError and OSError."""
    listing = _git(repository, environment, "ls-tree", "-r", "-z", "--full-tree", commit)
    blobs = list(_blobs(listing))
    names = b"".join(blob.name + b"\n" for blob in blobs)
    data = _git(repository, environment, "cat-file", "--batch", stdin=names)
    at = 0
    contents: list[bytes] = []
    for blob in blobs:
        end = data.find(b"\n", at)
        fields = data[at:end].split()
        if len(fields) != 3 or fields[1] != b"blob":
            raise GitError(f"--since: {blob.path} of {commit} is not in the clone; fetch all objects first")
        contents.append(data[end + 1 : end + 1 + int(fields[2])])
        at = end + 2 + int(fields[2])
    # Links come last, so that no file is written through a link.
    for blob, content in sorted(zip(blobs, contents, strict=True), key=lambda pair: pair[0].mode == _LINK):
        _write(os.path.join(folder, blob.path), blob.mode, content)


def _write(path: str, mode: bytes, content: bytes) -> None:
    os.makedirs(os.path.dirname(path), exist_ok=True)
    if mode == _LINK:
        os.symlink(content, os.fsencode(path))
        return
    with open(path, "xb") as file:
        file.write(content)
    if mode == b"100755":
        os.chmod(path, 0o700)


def _blobs(listing: bytes) -> Iterator[_Blob]:
    """Yield the files and links in the output of ``git ls-tree -z``.

    Paths that lead out of the folder are left out. Only forged trees have such paths.
    """
    for entry in listing.split(b"\0"):
        head, _, path = entry.partition(b"\t")
        mode, _, rest = head.partition(b" ")
        if mode in (*_FILES, _LINK) and not {b"", b".", b"..", b".git"}.intersection(path.split(b"/")):
            yield _Blob(mode, rest.split()[-1], os.fsdecode(path))


def _git(repository: str, environment: Mapping[str, str], *arguments: str, stdin: bytes = b"") -> bytes:
    """Return the output of a git command, b"" if the command fails. Raises GitError if git cannot be started."""
    try:
        command = ["git", "-C", repository, *arguments]
        safe = {**environment, **_SAFE}
        return subprocess.run(command, input=stdin, env=safe, capture_output=True, check=False).stdout  # noqa: S603
    except OSError as error:
        raise GitError(f"--since: git cannot be run: {error.strerror or error}") from error
