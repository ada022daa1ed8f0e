"""From mentions to uses: whose name is it, what is it needed for, and is the place alive?

Names are not packages: a header path, a Python module, the argument of find_package and a package name live in four name
spaces (reference, sections C2b, D6, E3.8). This module is the only one that goes from one to the other.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

from ros_lint.facts import BuildScript, FileFacts, LaunchFile, Mention, Opaque, Role, Use, Via
from ros_lint.liveness import HEADERS, Liveness
from ros_lint.text import Span

if TYPE_CHECKING:
    from ros_lint.world import Providers


class Names(Protocol):
    """The look-ups of the world that evidence needs."""

    def by_cmake(self, name: str) -> Providers: ...
    def by_include(self, header: str) -> Providers: ...
    def by_import(self, module: str) -> Providers: ...
    def is_package(self, name: str) -> bool: ...


class Source(NamedTuple):
    """What evidence needs to know of one package."""

    name: str
    path: str
    files: tuple[str, ...]
    """Relative to the package."""
    script: BuildScript | None
    facts: Mapping[str, FileFacts]
    """By path relative to the package."""
    launch: tuple[LaunchFile, ...]
    builds_with: str


_BUILD_MODULES = frozenset({"setuptools", "distutils", "pkg_resources", "pip"})
"""Whoever builds a Python package has these (reference, section D1.9)."""

_LOOKED_UP = Role.EXEC
"""A package whose files are looked up at run time is not compiled against (reference, section E2, rows 17 and 24)."""


def resolve(source: Source, names: Names, headers: Mapping[str, tuple[str, ...]]) -> tuple[Use, ...]:
    """Return every use of another package, sorted by place.

    ``headers`` maps the include path of each header that the workspace has below an include folder to its packages.
    """
    launched = frozenset(_relative(source, launch.path) for launch in source.launch)
    tests = frozenset(_relative(source, launch.path) for launch in source.launch if launch.test)
    own = Liveness(source.name, source.files, source.script, source.facts, launched)
    uses: list[Use] = []
    if source.script is not None:
        for mention in source.script.mentions:
            role = Role.TEST if mention.test else _script_role(source, mention)
            only_named = mention.what.startswith(_BY_NAME_ONLY)
            uses += _use(
                source, own, names, headers, mention._replace(optional=True) if only_named else mention, role, sure=True
            )
        uses += _unspoken(source, names)
    for path, facts in source.facts.items():
        role, sure = own.place(path)
        role = Role.TEST if path in tests else role
        for mention in facts.mentions:
            if mention.via == "package" and path in launched:
                continue  # the launch collector has it, too
            needed = Role.TEST if mention.test else _LOOKED_UP if mention.via == "package" and role != Role.TEST else role
            uses += _use(source, own, names, headers, mention, needed, sure)
    for launch in source.launch:
        uses += _launch_uses(source, own, names, launch)
    return tuple(sorted({(use.span, use.package, use.via): use for use in uses}.values(), key=_order))


def _order(use: Use) -> tuple[object, ...]:
    return (use.span, use.package, use.via)


def _unspoken(source: Source, names: Names) -> Iterator[Use]:
    """Yield what generated code needs without being told: actions are made of it (reference, section C4.4)."""
    script = source.script
    assert script is not None
    if source.name == _ACTIONS or not any(each.startswith("action/") for each in script.interfaces):
        return
    for mention in script.mentions:
        if mention.via == "macro" and mention.what == "rosidl_generate_interfaces()" and names.is_package(_ACTIONS):
            role = Role.TEST if mention.test else Role.BUILD | Role.EXPORT | Role.EXEC
            yield Use(_ACTIONS, (_ACTIONS,), role, "an action", "interface", mention.optional, mention.span)


_ACTIONS = "action_msgs"


def _script_role(source: Source, mention: Mention) -> Role:
    if source.builds_with == "ament_python" or mention.via == "macro":
        return Role.TOOL
    return Role.EXPORT if mention.what.startswith("ament_export_dependencies") else Role.BUILD


_BY_NAME_ONLY = "plugins for "
"""Names the package that loads the plugin, which may as well be one that need not be there."""


def _use(
    source: Source,
    own: Liveness,
    names: Names,
    headers: Mapping[str, tuple[str, ...]],
    mention: Mention,
    role: Role,
    sure: bool,
) -> Iterator[Use]:
    providers, known = _providers(source, own, names, headers, mention)
    if not providers or source.name in providers:
        return
    what = mention.what or _WHAT[mention.via].format(mention.name)
    yield Use(providers[0], providers, role, what, mention.via, mention.optional, mention.span, sure and known)


_WHAT: Mapping[Via, str] = {
    "package": "{}",
    "cmake": "find_package({})",
    "macro": "{}()",
    "target": "{}",
    "include": "#include <{}>",
    "import": "import {}",
    "interface": "{}",
    "key": "{}",
    "launch": "{}",
}


def _providers(
    source: Source, own: Liveness, names: Names, headers: Mapping[str, tuple[str, ...]], mention: Mention
) -> tuple[tuple[str, ...], bool]:
    """Return whose name a mention is, and whether that is sure."""
    name = mention.name
    match mention.via:
        case "include":
            if own.has_header(name, _relative(source, mention.span.path)):
                return _NOBODY
            if found := headers.get(name):
                first = name.partition("/")[0]
                return tuple(sorted(found, key=lambda package: package != first)), True
            return _told(names.by_include(name))
        case "import":
            top = name.partition(".")[0]
            if own.has_module(top) or (top in _BUILD_MODULES and mention.span.path.endswith("setup.py")):
                return _NOBODY
            return _told(names.by_import(name))
        case "cmake":
            return _told(names.by_cmake(name))
        case "target" | "macro":
            return _told(names.by_cmake(name.partition("::")[0]))
        case "interface":
            package = name.partition("/")[0]
            return ((package,), True) if names.is_package(package) else _NOBODY
        case "package" | "launch":
            return ((name,), True) if names.is_package(name) else _NOBODY
        case "key":
            return (name,), True


_NOBODY: tuple[tuple[str, ...], bool] = ((), True)


def _told(providers: Providers) -> tuple[tuple[str, ...], bool]:
    return providers.names, providers.sure


def _relative(source: Source, path: str) -> str:
    return path.removeprefix(f"{source.path}/") if source.path else path


def _launch_uses(source: Source, own: Liveness, names: Names, launch: LaunchFile) -> Iterator[Use]:
    role, sure = own.place(_relative(source, launch.path))
    role = Role.TEST if launch.test else role
    for reference in launch.references:
        package = reference.package
        if package == source.name or not names.is_package(package):
            continue
        what = package if reference.kind == "package" else f"{reference.kind} {reference.name}"
        yield Use(package, (package,), role, what, "launch", False, reference.package_span, sure)


def include_index(sources: Iterable[Source]) -> dict[str, tuple[str, ...]]:
    """Return, for every header below an ``include`` folder of the workspace, the packages that have it, by include path."""
    found: dict[str, tuple[str, ...]] = {}
    for source in sources:
        for file in source.files:
            if not file.endswith(HEADERS):
                continue
            _, marker, header = f"/{file}".partition("/include/")
            if not marker:
                continue
            # include/<package>/<package>/x.hpp and include/<package>/x.hpp are both written <package>/x.hpp.
            for spelling in {header, header.removeprefix(f"{source.name}/") if header.count("/") > 1 else header}:
                have = found.get(spelling, ())
                if source.name not in have:
                    found[spelling] = (*have, source.name)
    return found


def opaque_of(source: Source) -> tuple[Opaque, ...]:
    """Return everything that hides a side of the package."""
    found: list[Opaque] = list(source.script.opaque) if source.script else []
    for facts in source.facts.values():
        found += facts.opaque
    for launch in source.launch:
        found += launch.opaque
    return tuple(sorted(found, key=lambda opaque: (opaque.span, opaque.reason)))


def unused_names(declared: Sequence[str], uses: Sequence[Use]) -> tuple[str, ...]:
    """Return the declared names that no use, sure or not, is satisfied by."""
    used = used_names(declared, uses)
    return tuple(name for name in dict.fromkeys(declared) if name not in used)


def used_names(declared: Iterable[str], uses: Iterable[Use]) -> frozenset[str]:
    """Return the names that satisfy a use. Of several that would do, the best does it if it is declared."""
    names = frozenset(declared)
    return frozenset(
        name for use in uses for name in ((use.package,) if use.package in names else use.providers)
    )


def traces(names: Sequence[str], files: Iterable[tuple[str, bytes]]) -> dict[str, Span]:
    """Return a place for every name that stands as a word in one of the files, dashes and underscores taken as equal.

    ``files`` are paths with contents, which are searched as they are: few of them have a name in question.
    """
    spellings = {name: _spellings(name) for name in names}
    found: dict[str, Span] = {}
    for path, data in files:
        for name in [name for name in spellings if name not in found]:
            for spelling in spellings[name]:
                if (start := _find_word(data, spelling.encode())) >= 0:
                    line = data.count(b"\n", 0, start) + 1
                    column = len(data[data.rfind(b"\n", 0, start) + 1 : start].decode("utf-8", "replace")) + 1
                    found[name] = Span(path, line, column, line, column + len(spelling))
                    break
        if len(found) == len(spellings):
            break
    return found


def _spellings(name: str) -> tuple[str, ...]:
    """Return how a package may be written: with dashes, as a nested namespace or include folder.

    Conversions of tf2 are found by the types of their arguments, and bear no name but tf2.
    """
    found = {name, name.replace("-", "_"), name.replace("_", "-"), name.replace("_", "::", 1), name.replace("_", "/", 1)}
    return tuple(sorted(found | {"tf2"} if name.startswith("tf2_") else found))


def _find_word(data: bytes, word: bytes) -> int:
    """Return the offset of a word, -1 when there is none. A search for letters is many times faster than for a pattern."""
    start = data.find(word)
    while start >= 0:
        before, after = data[max(start - 1, 0) : start], data[start + len(word) : start + len(word) + 1]
        if not (before.isalnum() or after.isalnum()):
            return start
        start = data.find(word, start + 1)
    return -1
