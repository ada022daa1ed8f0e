"""Mutators of trees: names, kinds and places of files."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Final

from tests.fuzz.seeds import Files, Other

NAMES: Final = (
    "a\nb", "a\rb", "a\x1b[31mb", "a\u202eb", "a\u2028b", "a\x85b", "a\udcffb", "a\ud800b".encode("utf-8", "surrogatepass").decode("utf-8", "surrogateescape"),
    "::error::x", "##[error]x", "-rf", " a ", "a" * 200, "%0A", "a%b", "a;b", "a'b\"c", "<b>", "]]>", "a,b", "$(a)", "{{a}}", "~", "*", "[a]",
    "?", "\\", "a\tb", "CON", "ÄÖ", "e\u0301", "A", "build", "install", "log", ".git", ".hidden", "launch", "src", "package.xml", "setup.py",
)  # fmt: skip
"""Names of files and folders."""

_LINKS: Final = (
    b".",
    b"..",
    b"/",
    b"/etc/passwd",
    b"/dev/zero",
    b"/proc/self/mem",
    b"nowhere",
    b"package.xml",
    b"../package.xml",
    b"self",
)

Tree = dict[str, "bytes | Other"]


def rename(random: Random, files: Tree) -> None:
    path = random.choice(list(files))
    files[
        f"{path.rpartition('/')[0] or '.'}/{random.choice(NAMES)}{random.choice(('', '.py', '.xml', '.launch.py', '.cpp'))}"
    ] = files.pop(path)


def rename_folder(random: Random, files: Tree) -> None:
    folders = sorted({path.rpartition("/")[0] for path in files if "/" in path})
    if folders:
        old, new = random.choice(folders), random.choice(NAMES)
        for path in list(files):
            if path.startswith(f"{old}/"):
                files[f"{new}{path[len(old) :]}"] = files.pop(path)


def copy(random: Random, files: Tree) -> None:
    prefix = random.choice(("c/", "c/d/e/", "build/", "q/"))
    files.update({prefix + path: content for path, content in list(files.items())})


def replace(random: Random, files: Tree) -> None:
    path = random.choice(list(files))
    kind = random.choice(("link", "link", "folder", "fifo", "socket"))
    files[path] = Other(kind, random.choice(_LINKS) if kind == "link" else b"")


def link_to_another(random: Random, files: Tree) -> None:
    path, other = random.choice(list(files)), random.choice(list(files))
    files[path] = Other("link", ("../" * path.count("/") + other).encode("utf-8", "surrogateescape"))


def remove(random: Random, files: Tree) -> None:
    if len(files) > 1:
        del files[random.choice(list(files))]


def exchange(random: Random, files: Tree) -> None:
    first, second = random.choice(list(files)), random.choice(list(files))
    files[first], files[second] = files[second], files[first]


def deepen(random: Random, files: Tree) -> None:
    prefix = "d/" * random.choice((1, 3, 40, 400))
    for path in list(files):
        files[prefix + path] = files.pop(path)


_MUTATORS: Final[tuple[Callable[[Random, Tree], None], ...]] = (
    rename, rename, rename_folder, copy, replace, link_to_another, remove, exchange, deepen,
)  # fmt: skip


def mutate(random: Random, files: Files) -> Files:
    """Return the tree after one or more mutations."""
    tree = dict(files)
    for _ in range(random.choice((1, 1, 2, 3))):
        random.choice(_MUTATORS)(random, tree)
    return tree
