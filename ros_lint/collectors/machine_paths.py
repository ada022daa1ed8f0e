"""Paths in files that exist on one machine only.

These are:
- paths below a home directory,
- paths into the sources relative to the workspace, which only work in that folder,
- paths into ``/opt/ros``, which only work with one distribution.
"""

from __future__ import annotations

import re

from ros_lint.base.text import Text
from ros_lint.collectors.comments import comments
from ros_lint.facts.sources import MachinePath

_PATH = re.compile(r"(?<![\w.$}~)*/-])(?:file://)?(?P<path>/(?:home|Users)/[\w.+-]+/[^\s\"'`<>|;:,()\[\]{}&$\\*?#]+)")
_ANY = re.compile(r"/(?:home|Users|opt/ros)/")
_OF_DISTRIBUTION = re.compile(
    r"(?<![\w.$}~)*/-])(?:file://)?(?P<path>/opt/ros/[a-z]+/(?:share|lib)/[^\s\"'`<>|;:,()\[\]{}&$\\*?#]+)"
)
_OF_WORKSPACE = re.compile(r"""(?P<path>~(?<=["']~)/(?:[\w.+-]+/)+(?:src|install)/[^\s"'`<>|;:,()\[\]{}&$\\*?#%]+)(?=["'])""")
_SOURCES = ("'src/", '"src/', "'./src/", '"./src/')
_RELATIVE = re.compile(
    r"""(?:[=(:\[{]|\breturn|["']\s*,)\s*[rbu]?(?P<quote>["'])"""
    r"""(?P<path>(?:\./)?src/[\w.+-]+/[^\s"'`<>|;:,()\[\]{}&$\\*?#%]+)(?P=quote)"""
)
_JOINED = re.compile(r"join(?:path)?\([^()]*\Z")
_NEAR = 200
_WRITTEN = re.compile(r"""["']\s*,\s*(?:(?:mode\s*=\s*)?["'][wax]|std::ios(?:_base)?::(?:out|app|trunc)\b)""")
_WRITES = re.compile(
    r"\bofstream\b[^;]*\Z|\b(?:imwrite|imsave|save|savefig|savetxt|to_csv|makedirs|mkdir)\(\s*f?[\"']\Z"
    r"|\b\w*(?:output|save)_(?:path|dir|directory|folder|file)[\"']?\s*[,:=]\s*(?:std::string\()?f?[\"']?\Z"
)
_BESIDE = re.compile(r"\b(?:mesh|texture|asset)dir\s*=\s*[\"']\Z")
"""Attributes of MuJoCo models whose values are relative to the folder of the model."""
_DEFAULT = re.compile(r"\bdeclare_parameter(?:<[\w:]+>)?\(\s*[\"'][\w./-]+[\"']\s*,\s*(?:std::string\(|\{)?\s*[\"']\Z")
_UNREAD = re.compile(r"^([ ]*)Description File:[^\n]*\n\1Description Source: Topic\b", re.MULTILINE)
"""Matches a file that RViz stores in a display but does not read: the description is from a topic."""


def collect(text: Text) -> tuple[MachinePath, ...]:
    """Return the machine-specific paths of a file: in a home directory, in ``src`` or in ``/opt/ros``.

    Paths below ``~`` count only if they lead into a workspace. A path ends where a value is substituted. Left out are:
    - comments and docstrings,
    - paths that RViz stores but does not read,
    - computed paths (``"/home/" + user``, ``join(root, "src/robot")``),
    - folders that all users have.
    """
    content = text.text
    hits = [*_PATH.finditer(content), *_OF_DISTRIBUTION.finditer(content)] if _ANY.search(content) else []
    if "~" in content:  # one letter is searched ten times as fast as two
        hits += _OF_WORKSPACE.finditer(content)
    if "src/" in content and any(start in content for start in _SOURCES):
        hits += [hit for hit in _RELATIVE.finditer(content) if not _JOINED.search(content, hit.start() - _NEAR, hit.start() + 1)]
    if not hits:
        return ()
    hits.sort(key=lambda hit: hit.start("path"))
    beside = [*comments(text), *(_docstrings(text) if text.path.endswith(".py") else ())]
    if text.path.endswith(".rviz"):
        beside += [unread.span() for unread in _UNREAD.finditer(content)]
    reported = [hit for hit in hits if not any(start <= hit.start("path") < end for start, end in beside)]
    return tuple([_found(text, hit) for hit in reported])


def _found(text: Text, hit: re.Match[str]) -> MachinePath:
    path = hit["path"].rstrip("./")
    start = hit.start("path")
    before = max(0, start - _NEAR)
    written = _WRITTEN.match(text.text, hit.end("path")) or _WRITES.search(text.text, before, start)
    beside = _BESIDE.search(text.text, before, hit.start())
    default = _DEFAULT.search(text.text, before, start)
    return MachinePath(path, text.span(start, start + len(path)), bool(written), bool(beside), bool(default))


def _docstrings(text: Text) -> list[tuple[int, int]]:
    """Return the ranges of strings that are statements: documentation, and disabled code."""
    import ast  # noqa: PLC0415

    from ros_lint.collectors.python.source_errors import NotPythonError  # noqa: PLC0415
    from ros_lint.collectors.python.syntax import parse, range_of  # noqa: PLC0415

    try:
        tree = parse(text)
    except NotPythonError:
        return []
    alone = (node.value for node in ast.walk(tree) if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant))
    return [range_of(text, node) for node in alone if isinstance(node.value, str)]
