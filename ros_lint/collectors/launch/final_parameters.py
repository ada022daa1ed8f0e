"""The parameters with which a node starts: parameter files and single parameters, in the order in which later ones override.

Nodes read them as rcl and rclcpp do (``rcl_parse_yaml_file()``, ``rclcpp::parameter_map_from()``): all files and single
parameters fill one table with a row for each node name as written. The rows that match the node apply in the order in which
their names first occurred. Components get them from launch (``to_parameters_list()`` in launch_ros), which applies the
row of any node (``/**``) and then the row of the component, file by file.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from itertools import pairwise, product
from typing import TYPE_CHECKING, Final, NamedTuple

from ros_lint.collectors.symbolic_text import UNKNOWN, is_plain, is_settled, readable
from ros_lint.facts.sources import ANY_NODE, PARAMETERS_KEY

if TYPE_CHECKING:
    from ros_lint.base.text import Span
    from ros_lint.facts.sources import ParameterFile

Texts = tuple[str, ...]
"""The possible values of a text."""
_MOST_NAMES: Final = 8
"""Maximum number of possible full names of a node for which the parameters are computed."""


class FilledChange(NamedTuple):
    """A change of a parameter file, as :class:`ros_lint.facts.launch.FileChange`, with the values in one scope."""

    kind: str
    values: tuple[tuple[str, Texts], ...] = ()
    keys: tuple[tuple[str, Texts], ...] = ()
    root: Texts = ()
    complete: bool = True
    certain: bool = True
    """False if it is unknown whether the conditions of the change hold."""


class GivenParameter(NamedTuple):
    """A parameter or parameter file that a launch file gives to a node."""

    name: str
    """Name of the parameter, "" for a file."""
    texts: Texts
    """Possible values, or possible paths of the file."""
    span: Span | None = None
    """The place in the launch file."""
    certain: bool = True
    """False if it is given under a condition of unknown truth."""
    changes: tuple[FilledChange, ...] = ()
    """Changes of the file before the node reads it."""
    is_rule: bool = False
    """True for a parameter that applies to all nodes of a process: SetParameter, or ``-p name:=value``."""


class FinalParameter(NamedTuple):
    """A parameter with which a node starts."""

    name: str
    """Name of the parameter."""
    texts: Texts
    """Possible values."""
    span: Span | None
    """The place of the parameter that takes effect: in a parameter file or in a launch file."""
    certain: bool = True
    """False if the parameter is perhaps not set, or perhaps overridden by a parameter that is not known."""


class FinalParameters(NamedTuple):
    """All parameters with which a node starts, as far as they are known."""

    parameters: tuple[FinalParameter, ...] = ()
    """The parameters, sorted by name."""
    unknown: tuple[str, ...] = ()
    """Reasons why there may be further parameters, as clauses of a message."""


class _Row(NamedTuple):
    """One parameter of a file or of the launch file."""

    node: str
    """The node name as rcl stores it; ``/**`` for any node."""
    name: str
    texts: Texts
    span: Span | None
    certain: bool = True


Contents = Callable[[str], "ParameterFile | None"]
"""A function that returns the parameter file at a path, None if it is not in sight."""


_Rows = tuple[_Row, ...] | None
"""What one entry of ``parameters`` gives; None if that is not known."""


class NodeNames(NamedTuple):
    """The names by which parameter files can mean a node."""

    names: Texts
    """Possible names, () or "" among them if the program may set the name."""
    namespaces: Texts
    """Possible namespaces."""
    program: Texts = ()
    """Possible names of the executable, which is often the name that the program sets."""

    @property
    def full(self) -> Texts:
        """The possible full names; those with UNKNOWN are not known."""
        pairs = product(self.namespaces or ("",), [name or UNKNOWN for name in self.names] or (UNKNOWN,))
        return tuple(dict.fromkeys([full_name(space, name) for space, name in pairs]))[:_MOST_NAMES]


def full_name(namespace: str, name: str) -> str:
    """Return the name of a node with its namespace: ``/arm/driver``, or ``/driver`` for the namespace ``""`` or ``/``."""
    return f"/{namespace.strip('/')}/{name}".replace("//", "/")


def final_parameters(
    node: NodeNames,
    given: Sequence[GivenParameter],
    contents: Contents,
    substitute: Callable[[str], Texts],
    process: Sequence[GivenParameter] = (),
    *,
    component: bool = False,
) -> FinalParameters:
    """Return the parameters with which a node or component starts.

    ``given`` are the parameters and parameter files in their order, for a component without those of its container, which
    are in ``process``. ``contents`` returns a file by its path, and ``substitute`` performs the substitutions of launch in a
    text (``allow_substs``).
    """
    unknown: dict[str, None] = {}
    full = node.full
    own = full[0] if len(full) == 1 and is_plain(full[0]) else ANY_NODE
    shared = [_rows(parameter, ANY_NODE, contents, substitute, unknown) for parameter in process]
    sources = [_rows(parameter, own, contents, substitute, unknown) for parameter in given]
    results: list[dict[str, FinalParameter]] = []
    for name in full:
        meant = _Meant(name, _only_name(node.program, [*shared, *sources]), unknown)
        result: dict[str, FinalParameter] = {}
        if component:
            _apply_table(shared, meant, result)
            for rows in sources:
                _apply_to_component(rows, meant, result)
        else:
            _apply_table([*shared, *sources], meant, result)
        results.append(result)
    return FinalParameters(tuple(_joined(results)), tuple(unknown))


def _only_name(program: Texts, sources: Iterable[_Rows]) -> str:
    """Return the last part of the node name that a program of unknown node name probably has, "" if there are several.

    It is the name of the program, if a row has it, or the only name of all rows.
    """
    names = {row.node.rpartition("/")[2] for rows in sources for row in rows or ()} - {"*", "**"}
    return next((name for name in program if name in names), next(iter(names)) if len(names) == 1 else "")


class _Meant:
    """Decides which rows are for a node, given its full name, which ends with UNKNOWN if the program sets the name."""

    def __init__(self, full_name: str, probable: str, unknown: dict[str, None]) -> None:
        self._name = full_name
        self._is_known = is_plain(full_name)
        self._probable = probable
        self._unknown = unknown

    def by_rcl(self, row: str) -> bool | None:
        """Return whether rclcpp takes a row for the node, None if that is unknown."""
        if row == ANY_NODE or self._is_known:
            return row == ANY_NODE or matches(row, self._name)
        return self._perhaps(row)

    def by_launch(self, row: str) -> bool | None:
        """Return whether launch takes a row for the component, None if that is unknown."""
        name = row.strip("/")
        if name == "**" or self._is_known:
            return name == "**" or name == self._name.lstrip("/")
        return self._perhaps(row)

    def _perhaps(self, row: str) -> bool | None:
        last = row.rpartition("/")[2]
        if last in (self._probable, "*", "**"):
            return None
        self._unknown["it is unknown which node name the program sets"] = None
        return False


@lru_cache(maxsize=4_096)
def matches(row: str, full_name: str) -> bool:
    """Return whether rclcpp takes the parameters below the name ``row`` for a node (``parameter_map_from()``).

    In ``row``, ``*`` is one part of a name and ``**`` is any number of parts. ``full_name`` begins with a slash.
    """
    pattern = re.escape(row if row.startswith("/") else f"/{row}").replace(r"/\*\*", r"(?:/\w+)*").replace(r"/\*", r"/\w+")
    return re.fullmatch(pattern, full_name, re.ASCII) is not None


def _apply_table(sources: Sequence[_Rows], meant: _Meant, result: dict[str, FinalParameter]) -> None:
    """Apply files and parameters as rcl and rclcpp do."""
    table: dict[str, dict[str, FinalParameter]] = {}
    first: dict[str, int] = {}
    last_unknown = -1
    for number, rows in enumerate(sources):
        if rows is None:
            last_unknown = number
        for row in rows or ():
            first.setdefault(row.node, number)
            _set(table.setdefault(row.node, {}), row)
    for node, row_values in table.items():
        truth = meant.by_rcl(node)
        if truth is False:
            continue
        for value in row_values.values():
            sure = value.certain and truth is True and last_unknown < first[node]
            _put(result, value._replace(certain=sure))


def _set(values: dict[str, FinalParameter], row: _Row) -> None:
    _put(values, FinalParameter(row.name, row.texts, row.span, row.certain))


def _put(values: dict[str, FinalParameter], new: FinalParameter) -> None:
    """Set a parameter. One that is perhaps set adds its values to the previous ones."""
    before = values.get(new.name)
    if before is not None and not new.certain:
        new = new._replace(texts=tuple(dict.fromkeys((*before.texts, *new.texts))), certain=before.certain)
    values[new.name] = new


def _apply_to_component(rows: _Rows, meant: _Meant, result: dict[str, FinalParameter]) -> None:
    """Apply one file or parameter as launch does for components."""
    if rows is None:
        result.update({name: value._replace(certain=False) for name, value in result.items()})
    for row in sorted(rows or (), key=lambda row: row.node.strip("/") != "**"):
        truth = meant.by_launch(row.node)
        if truth is not False:
            _set(result, row._replace(certain=row.certain and truth is True))


def _joined(results: Sequence[dict[str, FinalParameter]]) -> Iterator[FinalParameter]:
    """Yield the parameters of a node with several possible names, sorted by name."""
    for name in sorted({name for result in results for name in result}):
        values = [result[name] for result in results if name in result]
        texts = tuple(dict.fromkeys([text for value in values for text in value.texts]))
        certain = len(values) == len(results) and all(value.certain for value in values)
        yield values[0]._replace(texts=texts, certain=certain)


# --- the rows of one entry ---------------------------------------------------------------------------------------------


def _rows(
    parameter: GivenParameter, own: str, contents: Contents, substitute: Callable[[str], Texts], unknown: dict[str, None]
) -> _Rows:
    if parameter.name == UNKNOWN:
        unknown["parameters are computed in a way that ros-lint cannot follow"] = None
        return None
    if parameter.name:
        node = ANY_NODE if parameter.is_rule else own
        return (_Row(node, parameter.name, parameter.texts, parameter.span, parameter.certain),)
    rows: list[_Row] = []
    certain = parameter.certain and len(parameter.texts) == 1
    for path in parameter.texts:
        file = contents(path) if is_settled(path) else None
        if file is None:
            unknown[f"the file {readable(path)} is not in the workspace"] = None
            return None
        in_file = [_Row(p.node, p.name, (p.text,), p.span, certain) for p in file.parameters]
        for change in parameter.changes:
            in_file = _changed(in_file, change, substitute)
        rows += in_file
    return tuple(rows)


def _changed(rows: list[_Row], change: FilledChange, substitute: Callable[[str], Texts]) -> list[_Row]:
    match change.kind:
        case "rewrite":
            result = _rewritten(rows, change)
        case "exchange":
            result = [_exchanged(row, dict(change.values)) for row in rows]
        case "replace":
            result = [_replaced(row, change.values) for row in rows]
        case _:
            result = [_substituted(row, substitute) for row in rows]
    if not change.complete:
        result = [row._replace(texts=(*row.texts, UNKNOWN)) for row in result]
    if change.certain:
        return result
    renames = bool(change.root or change.keys)
    return [
        *[row._replace(certain=row.certain and not renames) for row in rows],
        *[row._replace(certain=False) for row in result],
    ]


def _rewritten(rows: Iterable[_Row], change: FilledChange) -> list[_Row]:
    """Return rows as RewrittenYaml (nav2_common) changes them. It also sorts the nodes by name."""
    values, keys = dict(change.values), {old: new[0] for old, new in change.keys if len(new) == 1}
    root = change.root[0] if len(change.root) == 1 else UNKNOWN if change.root else ""
    paths = set()
    result: list[_Row] = []
    for row in rows:
        path = f"{row.node[:1]}{row.node[1:].replace('/', '.')}.{PARAMETERS_KEY}.{row.name}"
        paths.add(path)
        texts = values.get(path, values.get(row.name.rpartition(".")[2], row.texts))
        result.append(row._replace(texts=texts))
    for path, texts in change.values:
        node, mark, name = path.partition(f".{PARAMETERS_KEY}.")
        if mark and path not in paths:
            result.append(_Row(node.replace(".", "/"), name, texts, None))
    if keys:
        result = [
            row._replace(
                node="/".join([keys.get(part, part) for part in row.node.split("/")]),
                name=".".join([keys.get(part, part) for part in row.name.split(".")]),
            )
            for row in result
        ]
    result.sort(key=lambda row: row.node.split("/"))
    if root:
        result = [row._replace(node=f"{root}{'' if root.endswith('/') else '/'}{row.node}") for row in result]
    return result


def _exchanged(row: _Row, values: Mapping[str, Texts]) -> _Row:
    """Return a row in which a value that equals a text is replaced; a list that may contain such a value is not known."""
    texts: dict[str, None] = {}
    for text in row.texts:
        is_list = text.startswith("[") and any(old in text for old in values)
        texts.update(dict.fromkeys((UNKNOWN,) if is_list else values.get(text, (text,))))
    return row._replace(texts=tuple(texts))


def _replaced(row: _Row, values: Iterable[tuple[str, Texts]]) -> _Row:
    """Return a row in which texts are replaced."""
    for old, new in values:
        if not old:
            continue
        texts = [text.replace(old, one) for text in row.texts for one in (new if old in text else new[:1])]
        row = row._replace(
            node=row.node.replace(old, new[0]), name=row.name.replace(old, new[0]), texts=tuple(dict.fromkeys(texts))
        )
    return row


def _substituted(row: _Row, substitute: Callable[[str], Texts]) -> _Row:
    """Return a row whose substitutions are performed."""
    if not any("$(" in text for text in (row.node, row.name, *row.texts)):
        return row
    node, name = (substitute(text)[0] if "$(" in text else text for text in (row.node, row.name))
    texts = [result for text in row.texts for result in (substitute(text) if "$(" in text else (text,))]
    return row._replace(node=node, name=name, texts=tuple(dict.fromkeys(texts)))


# --- the command line --------------------------------------------------------------------------------------------------


def of_command_line(words: Sequence[Texts]) -> Iterator[GivenParameter]:
    """Yield the parameters in the command-line arguments of a node (``--ros-args -p name:=value --params-file file``)."""
    single = [texts[0] if len(texts) == 1 else UNKNOWN for texts in words]
    for option, word in pairwise([part for text in single for part in (text.split() if is_plain(text) else [text])]):
        name, mark, value = word.partition(":=")
        if option in ("-p", "--param") and mark:
            yield GivenParameter(name.rpartition(":")[2], (value,), is_rule=True)
        elif option == "--params-file":
            yield GivenParameter("", (word,))
