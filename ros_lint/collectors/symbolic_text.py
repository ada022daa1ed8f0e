"""Symbolic texts: texts of launch files with parts that are unknown until launch.

The value of a launch configuration, the install place of a package and the output of a command are known only when
the launch file runs. Marks, which are characters of the private use area, represent them, so that symbolic texts can be
joined, split and formatted like other texts. Later, known values can replace the marks:

- ``UNKNOWN`` for a text of which nothing is known;
- ``OWN_FOLDER`` for the folder of the launch file;
- an absolute path that no file system has, for the install prefix of a package;
- marks around the name of a launch configuration, a Python expression or a command;
- marks between the parts of a joined path of which one is known only at launch;
- marks around the name of an open argument, and around an expression with open arguments. The value of an open argument is
  chosen after the evaluation, as in the page of ``ros-lint launch --format html``.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Container, Iterable, Iterator, Mapping
from functools import lru_cache
from posixpath import normpath
from typing import NamedTuple

UNKNOWN = "\ue000"
_ROOT = "\ue001"
OWN_FOLDER = "/\ue002"
"""The folder of the launch file, which differs between source and install space."""

_CONFIGURATION = ("\ue010", "\ue011")
_EXPRESSION = ("\ue012", "\ue013")
_COMMAND = ("\ue014", "\ue015")
_XACRO_COMMAND = f"{_COMMAND[0]}xacro"
_DEFAULT = "\ue016"
_PRESENT = "\ue017"
_OPEN = ("\ue018", "\ue019")
_OPEN_EXPRESSION = ("\ue01a", "\ue01b")
_JOINED = "/\ue01c"
"""A slash between two parts of a joined path, one of which is known only at launch and may be empty or absolute."""
_APPENDED = "\ue01d"
"""The place between two parts of a joined path if the first part ends with a slash and the second is known only at launch."""

MOST = 24
"""The maximum number of possible values of a text."""

_MAX_DEPTH = 30
_MAX_FILLED = 400
"""The maximum number of launch configurations that are replaced by their values in one text, nested ones included.

Real texts need up to 34.
"""
LONGEST = 20_000
"""The maximum length of a text in characters."""

_ANY_MARK = re.compile("[\ue000-\ue01d]")
_UNSETTLED = re.compile("[\ue000\ue003-\ue01d]")
_OPEN_ARGUMENT = re.compile("\ue018([^\ue018\ue019]*)\ue019")
_INNER_OPEN_EXPRESSION = re.compile("\ue01a([^\ue01a\ue01b]*)\ue01b")
# A path ends where a command line or a list of paths continues; an unknown piece belongs to it.
_PREFIX = re.compile(rf"/{_ROOT}([^/\s]*)((?:/[^/\s'\":;,\ue012-\ue015]*)*)")
_INNERMOST = re.compile("\ue010([^\ue010\ue011]*)\ue011")
# A computed name begins with the mark of another configuration.
_NAME_OF_CONFIGURATION = re.compile("\ue010([^\ue010\ue011\ue016]*)([\ue010\ue011\ue016])")
BRACKETS = re.compile("([\ue010\ue012\ue014])|[\ue011\ue013\ue015]")
"""Matches the mark that begins (group 1) or ends a part of a text that is known only at launch."""
_EXPRESSION_MARKS = re.compile("([\ue012\ue013])")
_NEGATION = re.compile("\ue012(?:not (\ue010[^\ue010-\ue013]*\ue011)|_not(_equals\\(.*\\)))\ue013")
_INNER_EXPRESSION = re.compile("\ue012([^\ue012\ue013]*)\ue013")
_ENDS = re.compile("\ue010\\$|[\ue010-\ue015]")
_SHOWN = {"\ue010$": "$(env ", "\ue010": "$(var ", "\ue012": "$(eval ", "\ue014": "$(command "}
_LOGIC = re.compile(r"_(and|or|not|if|equals|not_equals)\((.*)\)", re.DOTALL)
_ROOTED = re.compile(rf"/{_ROOT}([^/:;,'\"]*)(?:/share/([^\s'\":;,{_ROOT}]*))?")
_RENAMES = ("__node:=", "__name:=", "__ns:=")
# The same path characters as in _PREFIX.
_IN_OWN_FOLDER = re.compile(rf"{OWN_FOLDER}((?:/[^/\s'\":;,\ue012-\ue015]*)+)")
_JOINTS = re.compile("/?\ue01c|\ue01d")
_PATH_END = re.compile("[\\s'\":;,]")
"""Matches a character that cannot be in a path."""
_TWICE_ROOTED = re.compile(rf".*/(?=/(?:{_ROOT}|\ue002))", re.DOTALL)


class InstallPlace(NamedTuple):
    """A place in the install space of a package."""

    package: str
    path: str
    """The path relative to the prefix of the package, such as ``share/<package>/launch/a.launch.py``."""

    @property
    def known(self) -> bool:
        """True if the name of the package is known, and not computed at launch."""
        return bool(self.package) and is_plain(self.package)

    @property
    def share(self) -> str | None:
        """The path below share/<package>, "" for the folder itself; None if the path is elsewhere or not fully known."""
        folder = f"share/{self.package}"
        if not is_plain(self.path) or not (self.path == folder or self.path.startswith(folder + "/")):
            return None
        return self.path[len(folder) + 1 :]

    @property
    def executable(self) -> str:
        """The name of the executable if the path is in lib/<package>, "" if the path is elsewhere."""
        folder, _, name = self.path.rpartition("/")
        return name if folder == f"lib/{self.package}" and is_plain(name) else ""


def prefix(package: str) -> str:
    """Return the path that represents the install prefix of a package, which is unknown until launch."""
    return f"/{_ROOT}{package}"


def share(package: str) -> str:
    """Return the path that represents the share folder of a package, which is unknown until launch."""
    return f"/{_ROOT}{package}/share/{package}"


def configuration(name: str, default: str | None = None) -> str:
    """Return a text in special characters (marks) that represents the value of a launch configuration.

    ``default`` is the value if nothing sets the configuration, None if there is no default.
    """
    inner = name if default is None else f"{name}{_DEFAULT}{default}"
    return f"{_CONFIGURATION[0]}{inner}{_CONFIGURATION[1]}"


@lru_cache(maxsize=8_192)
def named_in(text: str) -> tuple[str, ...] | None:
    """Return the names of the launch configurations in a text, in order; None if a name is computed."""
    names = _NAME_OF_CONFIGURATION.findall(text)
    return None if any(mark == _CONFIGURATION[0] for _, mark in names) else tuple([name for name, _ in names])


def expression(text: str) -> str:
    """Return a text in special characters (marks) that represents the value of the Python expression ``text``."""
    return f"{_EXPRESSION[0]}{text}{_EXPRESSION[1]}"


def has_expression(text: str) -> bool:
    """Return whether a text contains a Python expression that is known only at launch, made by :func:`expression`."""
    return _EXPRESSION[0] in text


def quoted(text: str) -> str:
    """Return a text as a Python string literal.

    Marks and expressions are not escaped, because their values replace them inside of the literal.
    """
    if not has_expression(text):
        return f"'{_escaped(text)}'"
    depth, parts = 0, []
    for part in _EXPRESSION_MARKS.split(text):
        depth += (part == _EXPRESSION[0]) - (part == _EXPRESSION[1])
        parts.append(part if depth else _escaped(part))
    return f"'{''.join(parts)}'"


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("'", "\\'").replace("\n", "\\n")


def join_path(parts: Iterable[str]) -> str:
    """Return a path joined from parts, as os.path.join() does. Parts that are known only at launch are joined by :func:`fill`."""
    result = ""
    for part in parts:
        if not result or part.startswith("/"):
            result = part
        else:
            is_known = not (_ENDS.match(part) or _ENDS.match(result[-1]))
            slash = "" if result.endswith("/") else "/"
            result += f"{slash}{part}" if is_known else f"{_JOINED if slash else _APPENDED}{part}"
    return result


def without_joints(text: str) -> str:
    """Return a text in which the parts of each joined path are separated by a slash, even if a part is empty or absolute."""
    return text.replace(_JOINED[1:], "").replace(_APPENDED, "")


def _rejoined(text: str) -> str:
    """Return a text in which the parts of each joined path are joined, as PathJoinSubstitution does: empty parts do not count."""
    first, *parts = _JOINTS.split(text)
    before, path = _before_path(first)
    finished = [before]
    for part in parts:
        before, end = _before_path(part)
        if part.startswith("/"):
            path = ""
        elif part and path and not path.endswith("/"):
            path += "/"
        if before:
            finished.append(path + before)
            path = ""
        path += end
    return "".join([*finished, path])


def _before_path(text: str) -> tuple[str, str]:
    """Return a text in two parts: the path at its end, which may be empty, and what is before the path."""
    end = max([match.end() for match in _PATH_END.finditer(text)], default=0)
    return text[:end], text[end:]


def command(text: str) -> str:
    """Return a text in special characters (marks) that represents the output of the command line ``text``."""
    return f"{_COMMAND[0]}{text}{_COMMAND[1]}"


def presence(package: str) -> str:
    """Return a text that represents the condition that a package is installed. Whether it holds is unknown until launch."""
    return f"{_PRESENT}{package}"


def package_of_presence(text: str) -> str:
    """Return the package in a text that :func:`presence` returned, "" for any other text."""
    return text[1:] if text.startswith(_PRESENT) else ""


def certain_part(text: str) -> str:
    """Return the literal characters of a text, that is, without its marks and without the names and expressions in marks."""
    while match := _INNERMOST.search(text) or _INNER_EXPRESSION.search(text):
        text = text[: match.start()] + text[match.end() :]
    return _ANY_MARK.sub("", text)


def is_plain(text: str) -> bool:
    """Return whether a text is fully known: it contains no marks for values that are known only at launch."""
    return text.isascii() or not _ANY_MARK.search(text)


def is_settled(text: str) -> bool:
    """Return whether a text is known before launch, except for install prefixes of packages and the folder of the launch file."""
    return text.isascii() or not _UNSETTLED.search(text)


def configurations(text: str) -> Iterator[tuple[str, bool, str]]:
    """Yield the launch configurations in a text: name, whether it has a default, and the characters that represent it.

    A configuration whose name or default contains another configuration is left out.
    """
    for match in _INNERMOST.finditer(text):
        name, mark, _ = match[1].partition(_DEFAULT)
        yield name, bool(mark), match[0]


def runs_xacro(text: str) -> bool:
    """Return whether a text is a command line of xacro, or contains the output of a command line of xacro."""
    return text.startswith("xacro ") or _XACRO_COMMAND in text


def is_node_renaming(word: str) -> bool:
    """Return whether an argument of a node may change the name or namespace of the node (``-r __ns:=/front``)."""
    return any(mark in word for mark in _RENAMES)


def readable(text: str) -> str:
    """Return a text for messages: substitutions as in XML launch files, and ? for unknown parts."""
    if _OPEN[0] in text or _OPEN_EXPRESSION[0] in text:
        text = _OPEN_ARGUMENT.sub(lambda match: configuration(match[1]), text)
        text = text.replace(_OPEN_EXPRESSION[0], _EXPRESSION[0]).replace(_OPEN_EXPRESSION[1], _EXPRESSION[1])
    text = _with_logic(text) if f"{_EXPRESSION[0]}_" in text else text
    text = _ENDS.sub(lambda match: _SHOWN.get(match[0], ")"), text.replace(f"{OWN_FOLDER}/", "$(dirname)/"))
    text = text.replace(OWN_FOLDER, "$(dirname)").replace(_PRESENT, "").replace(_DEFAULT, " ")
    return _ROOTED.sub(_readable_root, without_joints(text)).replace(UNKNOWN, "?")


def _with_logic(text: str) -> str:
    """Return a text in which each expression such as ``_and('a', 'b')`` is replaced by a substitution: ``$(and a b)``."""
    while match := _INNER_EXPRESSION.search(text):
        prefix, substitution = text[: match.start()], _logic_substitution(match[1])
        is_inside = prefix.count(_EXPRESSION[0]) > prefix.count(_EXPRESSION[1])
        text = f"{prefix}{quoted(substitution)[1:-1] if is_inside else substitution}{text[match.end() :]}"
    return text


def _logic_substitution(inner: str) -> str:
    from ros_lint.base.python_parser import literal  # noqa: PLC0415  (only for messages)

    match = _LOGIC.fullmatch(inner)
    try:
        words = literal(f"({match[2]},)") if match else ()
    except ValueError:
        words = ()
    if match is None or not words or not isinstance(words, tuple) or not all(isinstance(word, str) for word in words):
        return f"$(eval {inner})"
    joined_words = " ".join(
        f"'{word}'" if not word or (" " in certain_part(word) and word[:2] != "$(") else word for word in words
    )
    return f"$({match[1].replace('_', '-')} {joined_words})"


def _readable_root(match: re.Match[str]) -> str:
    package, path = match[1], match[2]
    if path is None:
        return f"$(find-pkg-prefix {package})"
    if path == package or path.startswith(f"{package}/"):
        return f"$(find-pkg-share {package}){path[len(package) :]}"
    return f"$(find-pkg-prefix {package})/share/{path}"


def may_contain_place(text: str, configurations: Container[str] = ()) -> bool:
    """Return whether the value of a text may contain an install place of a package, a file beside the launch file, or xacro.

    ``configurations`` are the launch configurations whose values may contain such a place or a command of xacro.
    """
    if _ROOT in text or OWN_FOLDER in text or "xacro" in text:
        return True
    return any(mark == _CONFIGURATION[0] or name in configurations for name, mark in _NAME_OF_CONFIGURATION.findall(text))


def configurations_with_places(values: Mapping[str, tuple[str, ...]]) -> frozenset[str]:
    """Return the names of the launch configurations whose values may contain an install place or a command of xacro.

    ``values`` has the possible values of each configuration, by name. A value may contain another configuration.
    """
    result: set[str] = set()
    candidates: dict[str, tuple[str, ...]] = {}
    for name, texts in values.items():
        for text in texts:
            if not text.isascii() or "xacro" in text:
                candidates[name] = texts
                break
    while matches := [name for name, texts in candidates.items() if any(may_contain_place(text, result) for text in texts)]:
        result.update(matches)
        for name in matches:
            del candidates[name]
    return frozenset(result)


def installed(text: str) -> Iterator[InstallPlace]:
    """Yield the install places of packages in a text, in order. A command line may contain several."""
    if _ROOT not in text:
        return
    for match in _PREFIX.finditer(text):
        parts: list[str] = []
        for part in match[2].split("/"):
            if part == ".." and parts:
                parts.pop()
            elif part not in ("", ".", ".."):
                parts.append(part)
        yield InstallPlace(match[1], "/".join(parts))


def installed_place(text: str) -> InstallPlace | None:
    """Return the only install place in a text, None if there is none or there are several."""
    places = list(installed(text))
    return places[0] if len(places) == 1 else None


def files_beside(text: str) -> Iterator[str]:
    """Yield the known paths in a text that begin with the folder of the launch file, relative to that folder, normalized."""
    for match in _IN_OWN_FOLDER.finditer(text) if OWN_FOLDER in text else ():
        path = normpath(match[1].strip("/")) if match[1].strip("/") else "."
        if path != "." and is_plain(path):
            yield path


def negated(text: str) -> str:
    """Return the launch configuration or comparison that the expression ``text`` negates, "" if it is not a negation."""
    match = _NEGATION.fullmatch(text)
    return "" if match is None else match[1] or expression(match[2])


def fill(
    text: str, values: Callable[[str], tuple[str, ...] | None], evaluate: Callable[[str], str], *, rejoin: bool = True
) -> tuple[str, ...]:
    """Return the possible values of a text after its launch configurations and expressions are replaced by their values.

    ``values(name)`` returns the possible values of a configuration, None if the configuration is not set. ``evaluate`` returns
    the value of an expression without unknown parts, UNKNOWN if it cannot be computed. If ``rejoin`` is False, an empty part
    of a joined path remains visible as two slashes.
    """
    filled = _Filling(values).of(text, frozenset()) if _CONFIGURATION[0] in text else (text,)
    if any(map(_JOINTS.search, filled)):
        filled = tuple(map(_rejoined if rejoin else without_joints, filled))
    if len(filled) == 1:
        return (_evaluate_expressions(filled[0], evaluate),)
    return tuple(dict.fromkeys([_evaluate_expressions(candidate, evaluate) for candidate in filled]))


class _Filling:
    """Replaces launch configurations in a text by their values. Each step can double the text, so their number is limited."""

    __slots__ = ("_remaining", "_values")

    def __init__(self, values: Callable[[str], tuple[str, ...] | None]) -> None:
        self._values = values
        self._remaining = _MAX_FILLED

    def of(self, text: str, busy: frozenset[str]) -> tuple[str, ...]:
        """Return the possible values of a text after its launch configurations are replaced by their values.

        ``busy`` are the configurations whose values contain ``text``. They are replaced by their defaults, because
        otherwise a value would contain itself without end.
        """
        pending = [text]
        done: dict[str, None] = {}
        while pending:
            candidate = pending.pop()
            match = _INNERMOST.search(candidate) if _CONFIGURATION[0] in candidate else None
            if match is None:
                done[candidate] = None
                continue
            self._remaining -= 1
            alternatives = self._values_of(match[1], busy)
            if len(pending) + len(done) + len(alternatives) > MOST or len(candidate) > LONGEST or self._remaining < 0:
                return (UNKNOWN,)
            start, end = match.span()
            pending += [candidate[:start] + value + candidate[end:] for value in reversed(alternatives)]
        return tuple(done)

    def _values_of(self, configuration: str, busy: frozenset[str]) -> tuple[str, ...]:
        name, mark, default = configuration.partition(_DEFAULT)
        values = None if not mark else self._values(name)
        if values is not None and f"{_CONFIGURATION[0]}{configuration}{_CONFIGURATION[1]}" in values:
            return (default,)  # the argument has this default, whichever alternative applies
        # A default that reads its own argument is evaluated before the argument has a value.
        values = None if name in busy or len(busy) > _MAX_DEPTH else self._values(name)
        if values is None:
            return (default,) if mark else (UNKNOWN,)
        if len(values) > MOST:
            return (UNKNOWN,)
        if len(values) == 1 and _CONFIGURATION[0] not in values[0]:
            return values
        busy |= {name}
        return tuple([inner for value in values for inner in self.of(value, busy)])


def open_argument(name: str) -> str:
    """Return a text in marks that represents the value of a launch argument, which is chosen after the evaluation."""
    return f"{_OPEN[0]}{name}{_OPEN[1]}"


def open_arguments(text: str) -> tuple[str, ...]:
    """Return the names of the open arguments in a text, each once, in order."""
    return tuple(dict.fromkeys(_OPEN_ARGUMENT.findall(text)))


def open_pieces(text: str) -> list[str]:
    """Return a text split at its open arguments: literals, and at odd places the names of the arguments."""
    return _OPEN_ARGUMENT.split(text)


def with_open_arguments(text: str, values: Mapping[str, str], evaluate: Callable[[str], str]) -> str:
    """Return a text in which launch arguments that were left open get ``values``, by name.

    Expressions with these arguments are replaced by their results, which ``evaluate`` returns.
    """
    text = _OPEN_ARGUMENT.sub(lambda match: values.get(match[1], UNKNOWN), text)
    while match := _INNER_OPEN_EXPRESSION.search(text):
        value = evaluate(match[1]) if is_settled(match[1]) else UNKNOWN
        text = text[: match.start()] + value + text[match.end() :]
    return text


def has_open_expression(text: str) -> bool:
    """Return whether a text contains an expression with open arguments."""
    return _OPEN_EXPRESSION[0] in text


def _kept_open(expression: str) -> str:
    """Return an expression with open arguments in marks, UNKNOWN if other parts of it are unknown."""
    known = _OPEN_ARGUMENT.sub("", expression)
    is_open = known != expression or _OPEN_EXPRESSION[0] in expression
    is_known = is_settled(known.replace(_OPEN_EXPRESSION[0], "").replace(_OPEN_EXPRESSION[1], ""))
    return f"{_OPEN_EXPRESSION[0]}{expression}{_OPEN_EXPRESSION[1]}" if is_open and is_known else UNKNOWN


def _evaluate_expressions(text: str, evaluate: Callable[[str], str]) -> str:
    while has_expression(text) and (match := _INNER_EXPRESSION.search(text)):
        value = evaluate(match[1]) if is_settled(match[1]) else _kept_open(match[1])
        text = text[: match.start()] + value + text[match.end() :]
    # A configuration with an absolute path replaces the path that it was joined to.
    return _TWICE_ROOTED.sub("", text) if "//" in text else text
