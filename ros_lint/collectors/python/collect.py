"""Facts of Python sources: the modules that they import and the packages that they look up."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import TYPE_CHECKING

from ros_lint.collectors.python.import_tree import Import, walk
from ros_lint.collectors.python.imports import IMPORTED_NAMES, added_folders, scan
from ros_lint.collectors.python.lookups import Found, in_excerpt, literals, look_ups
from ros_lint.collectors.python.nodes import node_code
from ros_lint.collectors.python.source_errors import NotPythonError, TooDeepError
from ros_lint.collectors.python.syntax import parse, refusal
from ros_lint.collectors.python.unused_imports import unused_imports
from ros_lint.facts.sources import FileFacts, ImportedType, Mention
from ros_lint.facts.visibility import Facet, Opaque

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from ros_lint.base.text import Span, Text

_IMPORT_LINE = re.compile(r"^[ \t]*(?:from|import)[ \t]+([A-Za-z_][\w.]*)", re.MULTILINE)
_TYPES = re.compile(r"[^\W\d]\w*\.(?:msg|srv|action)")
_ONE = re.compile(r"(?:\A|,)[\s\\]*([^\W\d]\w*)(?:[\s\\]+as[\s\\]+\w+)?[\s\\]*(?=,|\Z)")
_COMMENT = re.compile("#[^\n]*")
_PROGRAM = re.compile(r"""\.py['"]""")
_NAME = re.compile(r"[\w.-]+\Z")
_LONGEST_NAME = 100


def collect(source: Text, *, launch: bool = False) -> FileFacts:
    """Return the modules that a Python file imports and the packages that it looks up.

    - An absolute import becomes a Mention (a name that may belong to another package) of the dotted module, with
      ``via="import"``. Its purpose is "unused" if the source never uses the imported names. Relative imports are omitted.
    - A look-up such as ``get_package_share_directory("p")`` becomes a Mention of ``p``, with ``via="package"``. If the name
      of the package is computed, it becomes an Opaque instead (a place that could not be evaluated).
    - Paths of files in the share folder of a package, such as ``get_package_share_directory("p") + "/a.yaml"``, are in
      ``lookups``.

    ``launch`` is True for a launch file: only its imports are returned, because the collector of launch files returns
    its look-ups. If the source does not parse, a regular expression finds the imports, and all of them are optional.
    """
    try:
        imports, looked_up = _found(source, launch)
    except NotPythonError as error:
        return _unreadable(source, error)
    named = [item for item in imports if item.module and item.module[0] != "."]
    spans = list(source.spans([(item.start, item.start + len(item.module)) for item in named]))
    folders = added_folders(source.text) if "sys.path" in source.text else ()
    added = tuple([span for item, span in zip(named, spans, strict=True) if not item.caught and _is_added(item, folders)])
    unused = unused_imports(source.text, source.path, named)
    mentions = [
        Mention(
            item.module,
            "import",
            span,
            f"import of {item.module}{_remark(item, span in added)}",
            item.optional,
            purpose="unused" if item.start in unused else "",
        )
        for item, span in zip(named, spans, strict=True)
    ]
    opaque = [
        Opaque(Facet.USES, "the name of the module imported here is computed at run time", source.span(item.start, item.start))
        for item in imports
        if not item.module
    ]
    if looked_up.mentions:
        mentions = sorted([*mentions, *looked_up.mentions], key=lambda mention: mention.span)
    return FileFacts(
        tuple(mentions),
        (*opaque, *looked_up.opaque),
        lookups=looked_up.files,
        optional_modules=tuple([item.module for item in imports if item.caught]),
        path_additions=added,
        sets_path="sys.path" in source.text,
        programs=_programs(source.text),
        types=tuple(_types(source, zip(named, spans, strict=True))),
        nodes=None if launch else node_code(source),
    )


def _found(source: Text, launch: bool) -> tuple[list[Import], Found]:
    """Return the imports and the package look-ups of a source. Raises NotPythonError.

    Regular expressions search the text first. The source is parsed only if their result is not certain.
    """
    imports = scan(source.text)
    looked_up = Found() if launch else literals(source)
    if imports is not None and looked_up is None:
        with suppress(NotPythonError):
            looked_up = in_excerpt(source)
    if imports is not None and looked_up is not None:
        return imports, looked_up
    tree = parse(source)
    return walk(source, tree) if imports is None else imports, look_ups(source, tree) if looked_up is None else looked_up


def _types(source: Text, imports: Iterable[tuple[Import, Span]]) -> Iterator[ImportedType]:
    """Yield the generated message, service and action classes that a source imports.

    ``from std_msgs.msg import String`` -> ``std_msgs/msg/String``
    """
    for item, module in imports:
        match = IMPORTED_NAMES.match(source.text, item.start + len(item.module)) if _TYPES.fullmatch(item.module) else None
        if match is None:
            continue
        group = 1 if match[1] is not None else 2
        names = list(_ONE.finditer(_COMMENT.sub(lambda comment: " " * len(comment[0]), match[group])))
        start = match.start(group)
        for match_of_name, span in zip(
            names,
            source.spans([(start + match_of_name.start(1), start + match_of_name.end(1)) for match_of_name in names]),
            strict=True,
        ):
            yield ImportedType(f"{item.module.replace('.', '/')}/{match_of_name[1]}", span, module)


def _programs(text: str) -> tuple[str, ...]:
    """Return the file names at the ends of string literals that end with ``.py``: ``"scripts/a.py"`` -> ``a.py``.

    The search goes backwards from ``.py``, so that its time does not depend on the length of the literals.
    """
    starts = [match.start() for match in _PROGRAM.finditer(text)]
    names = [_NAME.search(text, max(0, start - _LONGEST_NAME), start) for start in starts]
    return tuple(dict.fromkeys([f"{name[0]}.py" for name in names if name is not None]))


def _is_added(item: Import, folders: Sequence[tuple[int, frozenset[str]]]) -> bool:
    """Return whether the source adds a path that contains the imported module to sys.path before the import.

    ``sys.path.append("../utils")`` adds the path for ``import utils``; ``folders`` is the result of ``added_folders()``.
    """
    top = item.module.partition(".")[0]
    return any(at < item.start and top in parts for at, parts in folders)


def _remark(item: Import, added: bool) -> str:
    """Return the remark about an import for messages: ", with the error caught", ", from a folder added to sys.path" or ""."""
    return ", with the error caught" if item.caught else ", from a folder added to sys.path" if added else ""


def _why(source: Text, error: NotPythonError) -> Opaque:
    if isinstance(error, TooDeepError):
        return refusal(source, error).opaque(Facet.USES)
    return Opaque(Facet.USES, "the source is not valid Python 3", source.span(0, 0))


def _unreadable(source: Text, error: NotPythonError) -> FileFacts:
    spans = source.spans([match.span(1) for match in _IMPORT_LINE.finditer(source.text)])
    return FileFacts(
        tuple(
            Mention(module, "import", span, f"import of {module}", optional=True)
            for span in spans
            for module in [source.slice(span)]
        ),
        (_why(source, error),),
    )
