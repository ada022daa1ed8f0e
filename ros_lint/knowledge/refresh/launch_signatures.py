"""Print a table of the classes of launch and launch_ros with their arguments, from the sources of several distributions.

Run it as a script::

    python -m ros_lint.knowledge.refresh.launch_signatures humble=DIR jazzy=DIR > signatures.tsv

Each DIR contains the sources of launch and launch_ros that the distribution releases, in any subfolders. The sources are
parsed, not imported. The format of the table is described in ``docs/knowledge.md``.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

_PARTS = frozenset({"actions", "conditions", "descriptions", "event_handlers", "launch_description_sources", "substitutions"})
"""Python packages of launch and launch_ros with the classes that launch files use."""
_MODULES = frozenset({"launch_description", "launch_description_source", "parameter_descriptions"})
"""Python modules of launch and launch_ros with further classes that launch files use."""
_LIBRARIES = frozenset({"launch", "launch_ros"})


class Parameter(NamedTuple):
    """A parameter of a constructor."""

    name: str
    positional: bool
    """True if an argument can be passed by position, without a keyword."""
    required: bool
    kind: str
    """Kind of the accepted values, judging by the annotation: "text", "texts", "float", "parameters", ...; "" for any other."""


class Signature(NamedTuple):
    """The parameters of a class's constructor."""

    parameters: tuple[Parameter, ...]
    closed: bool
    """False if the constructor accepts further arguments (``*args`` or ``**kwargs``)."""


def signatures(folder: Path) -> dict[str, Signature]:
    """Return the signatures of the public classes in the sources below a folder, by class name.

    Raises OSError and SyntaxError for a source that cannot be read or parsed.
    """
    classes: dict[str, ast.ClassDef] = {}
    public: set[str] = set()
    aliases: dict[str, str] = {}
    for path in sorted(folder.rglob("*.py")):
        parts = path.parts
        if "test" in parts or not any(parts[i] == parts[i + 1] in _LIBRARIES for i in range(len(parts) - 1)):
            continue
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.ImportFrom) and path.stem == "__init__":
                aliases |= {alias.asname: alias.name for alias in node.names if alias.asname is not None}
            if not isinstance(node, ast.ClassDef):
                continue
            is_public = bool(_PARTS.intersection(parts)) or path.stem in _MODULES | _PARTS
            if is_public or node.name not in public:  # events have the names of actions
                classes[node.name] = node
            if is_public and not node.name.startswith("_") and not any(map(_is_exception, node.bases)):
                public.add(node.name)
    names = {name: name for name in public} | {alias: name for alias, name in aliases.items() if name in public}
    return {name: _signature(names[name], classes) for name in sorted(names)}


def _is_exception(base: ast.expr) -> bool:
    return ast.unparse(base).endswith(("Error", "Exception"))


def _signature(name: str, classes: Mapping[str, ast.ClassDef]) -> Signature:
    node = classes.get(name)
    if node is None:
        return Signature((), closed=name in ("object", "Generic", "ABC", "Protocol"))
    definitions = [item for item in node.body if isinstance(item, ast.FunctionDef) and item.name == "__init__"]
    constructor = definitions[-1] if definitions else None  # overloads precede the implementation
    bases = [ast.unparse(base).partition("[")[0].rpartition(".")[2] for base in node.bases]
    inherited = _signature(bases[0], classes) if bases else Signature((), closed=True)
    if constructor is None:
        return inherited
    spec = constructor.args
    own = tuple(_parameters(spec))
    if spec.vararg is not None:
        return Signature(own, closed=False)
    if spec.kwarg is None:
        return Signature(own, closed=True)
    passed, count = _passed(constructor)
    names = {parameter.name for parameter in own} | passed
    rest = [parameter._replace(positional=False) for parameter in inherited.parameters[count:] if parameter.name not in names]
    return Signature((*own, *rest), inherited.closed)


def _parameters(spec: ast.arguments) -> Iterator[Parameter]:
    positional = [*spec.posonlyargs, *spec.args][1:]
    first_default = len(positional) - len(spec.defaults)
    for index, argument in enumerate(positional):
        yield Parameter(argument.arg, positional=True, required=index < first_default, kind=_kind(argument.annotation))
    for argument, default in zip(spec.kwonlyargs, spec.kw_defaults, strict=True):
        yield Parameter(argument.arg, positional=False, required=default is None, kind=_kind(argument.annotation))


def _passed(constructor: ast.FunctionDef) -> tuple[set[str], int]:
    """Return what a constructor passes to the constructor of the base class: keywords, and the number of positional arguments."""
    for node in ast.walk(constructor):
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "__init__":
            return {keyword.arg for keyword in node.keywords if keyword.arg}, len(node.args)
    return set(), 0


def _kind(annotation: ast.expr | None) -> str:
    text = ast.unparse(annotation).strip("'") if annotation is not None else ""
    while text.startswith("Optional[") and text.endswith("]"):
        text = text[len("Optional[") : -1]
    if text in ("SomeSubstitutionsType", "SomeParameters", "SomeRemapRules", "Text", "str"):
        return {"SomeParameters": "parameters", "SomeRemapRules": "remappings"}.get(text, "text")
    if text in ("Iterable[SomeSubstitutionsType]", "List[SomeSubstitutionsType]"):
        return "texts"
    if text == "Union[float, SomeSubstitutionsType]":
        return "float"
    return "entities" if text in ("Iterable[LaunchDescriptionEntity]", "Iterable[Action]") else ""


def table(by_distro: Mapping[str, Mapping[str, Signature]]) -> Iterator[str]:
    """Yield the lines of the table, given the signatures of the classes by distribution."""
    yield f"#launch-signatures 1 distros={' '.join(by_distro)}"
    for name in sorted({name for classes in by_distro.values() for name in classes}):
        known = {distro: classes[name] for distro, classes in by_distro.items() if name in classes}
        most = max(sum(parameter.positional for parameter in signature.parameters) for signature in known.values())
        closed = all(signature.closed for signature in known.values())
        words = " ".join(_words(known))
        yield "\t".join([name, " ".join(known) if len(known) < len(by_distro) else "", str(most) if closed else "", words])


def _words(known: Mapping[str, Signature]) -> Iterable[str]:
    names = dict.fromkeys(parameter.name for signature in known.values() for parameter in signature.parameters)
    for name in names:
        found = {distro: p for distro, signature in known.items() for p in signature.parameters if p.name == name}
        required = len(found) == len(known) and all(parameter.required for parameter in found.values())
        kinds = {parameter.kind for parameter in found.values()}
        kind = kinds.pop() if len(kinds) == 1 else ""
        since = f"@{','.join(found)}" if len(found) < len(known) else ""
        yield f"{name}{'!' if required else ''}{f':{kind}' if kind else ''}{since}"


def main(arguments: Iterable[str]) -> None:
    """Print the table for arguments such as ``humble=DIR``."""
    pairs = [argument.partition("=") for argument in arguments]
    for line in table({distro: signatures(Path(folder)) for distro, _, folder in pairs}):
        print(line)


if __name__ == "__main__":
    main(sys.argv[1:])
