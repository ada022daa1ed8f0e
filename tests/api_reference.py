"""Writes docs/api.md from the sources of `ros_lint.api`: signatures, types and docstrings, read by `ast`.

Nothing is imported. A name is followed through the imports of the modules up to its definition, so that names imported for
type checkers only are resolved, too.
"""

import ast
import re
from collections.abc import Iterator
from functools import cache
from inspect import cleandoc
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parent.parent
API = "ros_lint.api"
Function = ast.FunctionDef
Assignment = ast.Assign | ast.AnnAssign

VOCABULARY = {
    "Rules and findings": (
        "Rule", "Finding", "Consequence", "Fix", "Edit", "Related", "Severity", "Confidence", "Span",
        "first_related", "cached_by_package", "cached_by_workspace",
    ),
    "Packages": ("Workspace", "Package", "TargetDistro"),
    "Manifests": ("Manifest", "Depend", "Declared", "Role", "Element"),
    "Uses": ("Use", "Mention", "MachinePath", "PluginLoader", "Registration", "Suggestion"),
    "Limits of the analysis": ("Facet", "ALL_FACETS", "Opaque", "Problem", "SuppressionUse"),
    "Launch files": ("LaunchFile", "LaunchAction", "LaunchReference", "LaunchValue", "LaunchCondition"),
    "Build scripts": (
        "BuildScript", "BuildProject", "BuildProducts", "BuildTarget", "InstalledFile", "Component", "BuildFiles", "ScriptFile",
        "BuildExports", "ExportedTarget", "CMakeCommands", "Call", "CMakeBuild", "SetupScript",
    ),
    "Plugins and Python": (),
}  # fmt: skip
"""The sections of the vocabulary in the order of the page. Names without a place are in the last section."""

DATA = frozenset({"Index", "InstallPrefix", "Installed", "Knowledge", "Names", "Rosdep"})
"""Types of the data of released packages and of underlays. They are not part of the API."""

TESTING = ("read_cases", "differences", "bless")
"""What a plugin needs of `ros_lint.testing`."""


class Definition(NamedTuple):
    """A class, function, constant or type alias."""

    module: str
    name: str
    node: ast.ClassDef | Function | Assignment
    doc: str


class Attribute(NamedTuple):
    name: str
    type: str
    doc: str
    default: str = ""


@cache
def tree(module: str) -> ast.Module:
    path = ROOT.joinpath(*module.split("."))
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return ast.parse(file.read_text("utf-8"))


def is_module(name: str) -> bool:
    path = ROOT.joinpath(*name.split("."))
    return name.startswith("ros_lint.") and (path.is_dir() or path.with_suffix(".py").is_file())


def statements(body: list[ast.stmt]) -> Iterator[tuple[ast.stmt, str]]:
    """Yield statements, those for type checkers included, each with the text literal that follows it."""
    for statement, follower in zip(body, [*body[1:], None], strict=True):
        if isinstance(statement, ast.If):
            yield from statements(statement.body)
        else:
            yield statement, literal(follower)


def literal(statement: ast.stmt | None) -> str:
    value = statement.value if isinstance(statement, ast.Expr) else None
    return cleandoc(value.value) if isinstance(value, ast.Constant) and isinstance(value.value, str) else ""


@cache
def names(module: str) -> dict[str, Definition | tuple[str, str]]:
    """Return the names of a module: definitions, and imports as a pair of module and name."""
    result: dict[str, Definition | tuple[str, str]] = {}
    for statement, text in statements(tree(module).body):
        if isinstance(statement, ast.ImportFrom):
            for alias in statement.names:
                result[alias.asname or alias.name] = (statement.module or "", alias.name)
        elif isinstance(statement, ast.ClassDef | ast.FunctionDef):
            result[statement.name] = Definition(module, statement.name, statement, ast.get_docstring(statement) or "")
        elif isinstance(statement, ast.Assign | ast.AnnAssign):
            target = statement.targets[0] if isinstance(statement, ast.Assign) else statement.target
            if isinstance(target, ast.Name):
                result[target.id] = Definition(module, target.id, statement, text)
    return result


def resolve(module: str, name: str) -> Definition | str | None:
    """Return the definition of a name, the name of a module of ros_lint, or None for anything else."""
    found = names(module).get(name)
    if found is None or isinstance(found, Definition):
        return found
    origin, original = found
    if is_module(f"{origin}.{original}"):
        return f"{origin}.{original}"
    return resolve(origin, original) if is_module(origin) else None


def exports(module: str) -> list[str]:
    """Return `__all__`, or else the public functions and constants."""
    for statement in tree(module).body:
        if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == "__all__":
            return list(ast.literal_eval(statement.value))
    public = [definition for definition in names(module).values() if isinstance(definition, Definition)]
    return [definition.name for definition in public if not definition.name.startswith("_")]


# What a class contains.


def decorators(node: Function) -> set[str]:
    return {ast.unparse(decorator) for decorator in node.decorator_list}


def is_property(node: ast.stmt) -> bool:
    return isinstance(node, ast.FunctionDef) and not decorators(node).isdisjoint({"property", "cached_property"})


def attributes(node: ast.ClassDef) -> Iterator[Attribute]:
    """Yield the public attributes of a class: fields, members, attributes set in the constructor, properties."""
    for statement, text in statements(node.body):
        if isinstance(statement, ast.AnnAssign):
            default = f" = {ast.unparse(statement.value)}" if statement.value else ""
            yield Attribute(ast.unparse(statement.target), ast.unparse(statement.annotation), text, default)
        elif isinstance(statement, ast.Assign):
            yield Attribute(ast.unparse(statement.targets[0]), "", text)
    for statement in node.body:
        if isinstance(statement, ast.FunctionDef) and statement.name == "__init__":
            yield from constructed(statement)
    for statement in node.body:
        if isinstance(statement, ast.FunctionDef) and is_property(statement):
            returns = ast.unparse(statement.returns) if statement.returns else ""
            yield Attribute(statement.name, returns, ast.get_docstring(statement) or "")


def constructed(constructor: Function) -> Iterator[Attribute]:
    types = {argument.arg: argument.annotation for argument in constructor.args.args}
    for statement, text in statements(constructor.body):
        if isinstance(statement, ast.Assign) and isinstance(statement.value, ast.Name):
            annotation = types.get(statement.value.id)
            yield Attribute(own_name(statement.targets[0]), ast.unparse(annotation) if annotation else "", text)
        elif isinstance(statement, ast.AnnAssign):
            yield Attribute(own_name(statement.target), ast.unparse(statement.annotation), text)
        elif isinstance(statement, ast.Assign):
            yield Attribute(own_name(statement.targets[0]), "", text)


def own_name(target: ast.expr) -> str:
    return ast.unparse(target).removeprefix("self.")


def public_attributes(node: ast.ClassDef) -> list[Attribute]:
    return [attribute for attribute in attributes(node) if not attribute.name.startswith("_")]


def methods(node: ast.ClassDef) -> list[Function]:
    functions = [statement for statement in node.body if isinstance(statement, ast.FunctionDef)]
    return [function for function in functions if not function.name.startswith("_") and not is_property(function)]


def signature(function: Function, name: str) -> str:
    """Return the signature as `ruff format` writes it: on one line, or with a line for each parameter."""
    parameters = [parameter for parameter in parameters_of(function.args) if parameter not in ("self", "cls")]
    returns = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    line = f"{name}({', '.join(parameters)}){returns}"
    if len(line) > 110:
        line = f"{name}(\n    " + ",\n    ".join(parameters) + f",\n){returns}"
    return short(line)


def parameters_of(arguments: ast.arguments) -> Iterator[str]:
    plain = [*arguments.posonlyargs, *arguments.args]
    defaults: list[ast.expr | None] = [*[None] * (len(plain) - len(arguments.defaults)), *arguments.defaults]
    yield from map(parameter, plain, defaults)
    if arguments.vararg:
        yield f"*{parameter(arguments.vararg, None)}"
    elif arguments.kwonlyargs:
        yield "*"
    yield from map(parameter, arguments.kwonlyargs, arguments.kw_defaults)


def parameter(argument: ast.arg, default: ast.expr | None) -> str:
    return ast.unparse(argument) + (f" = {ast.unparse(default)}" if default else "")


def short(code: str) -> str:
    """Return code with double quotes, as in the sources, and without the modules of types."""
    return re.sub(r"""'([^'"]*)'""", r'"\1"', re.sub(r"\b[a-z_]+\.(?=[A-Z])", "", code))


# Which types the page shows.


def annotations(definition: Definition) -> Iterator[str]:
    """Yield the types in the signature of a function, or in the public attributes and methods of a class."""
    if isinstance(definition.node, ast.FunctionDef):
        yield from function_annotations(definition.node)
    elif isinstance(definition.node, ast.ClassDef):
        yield from (attribute.type for attribute in public_attributes(definition.node))
        for method in methods(definition.node):
            yield from function_annotations(method)
    elif isinstance(definition.node, ast.AnnAssign):
        yield ast.unparse(definition.node.annotation)
    else:
        yield ast.unparse(definition.node.value)


def function_annotations(function: Function) -> Iterator[str]:
    given = [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs, function.args.vararg]
    yield from (ast.unparse(argument.annotation) for argument in given if argument and argument.annotation)
    if function.returns:
        yield ast.unparse(function.returns)


def types_of(definition: Definition) -> Iterator[Definition]:
    """Yield the types of ros_lint that a definition leads to directly."""
    for annotation in annotations(definition):
        for name in re.findall(r"\b[A-Za-z_]\w*", re.sub(r"'[^']*'|\"[^\"]*\"", "", annotation)):
            found = resolve(definition.module, name)
            if isinstance(found, Definition) and is_type(found):
                yield found


def is_type(definition: Definition) -> bool:
    if isinstance(definition.node, ast.ClassDef):
        return True
    value = definition.node.value if isinstance(definition.node, ast.Assign) else None
    return isinstance(value, ast.Subscript)


class Section(NamedTuple):
    title: str
    text: str
    members: tuple[tuple[str, Definition], ...]
    """Names as a rule writes them, with their definitions."""


def sections() -> list[Section]:
    """Return what the page shows: the vocabulary, the namespaces, the types that they lead to, and the tests of rules."""
    vocabulary, spaces = {}, []
    for name in exports(API):
        found = resolve(API, name)
        if isinstance(found, Definition):
            vocabulary[name] = found
        elif isinstance(found, str):
            spaces += namespaces(name, found)
    placed = {name for listed in VOCABULARY.values() for name in listed}
    *order, (last, _) = VOCABULARY.items()
    order.append((last, tuple(name for name in vocabulary if name not in placed)))
    shown = [Section(title, "", tuple((name, vocabulary[name]) for name in listed)) for title, listed in order]
    shown += spaces
    testing = tuple((name, found) for name in TESTING if isinstance(found := names("ros_lint.testing")[name], Definition))
    return [*shown, Section("Further types", FURTHER, tuple(further(shown))), Section("Tests of rules", TESTS, testing)]


def further(shown: list[Section]) -> list[tuple[str, Definition]]:
    """Return the types that the sections lead to and do not contain, by name."""
    waiting = [definition for section in shown for _, definition in section.members]
    seen = {(definition.module, definition.name) for definition in waiting}
    result = []
    while waiting:
        for definition in types_of(waiting.pop()):
            if (definition.module, definition.name) not in seen and definition.name not in DATA:
                seen.add((definition.module, definition.name))
                result.append((definition.name, definition))
                waiting.append(definition)
    return sorted(result)


def namespaces(name: str, module: str) -> Iterator[Section]:
    members, inner = [], []
    for member in exports(module):
        found = resolve(module, member)
        if isinstance(found, Definition):
            members.append((f"{name}.{member}", found))
        elif isinstance(found, str):
            inner.append((f"{name}.{member}", found))
    yield Section(name, ast.get_docstring(tree(module)) or "", tuple(members))
    for inner_name, inner_module in inner:
        yield from namespaces(inner_name, inner_module)


TESTS = "These names are imported from `ros_lint.testing`; see [Writing a rule](writing-a-rule.md#the-cases)."
FURTHER = "Attributes and results have these types. A rule does not import them."


# The page.


def page(head: str) -> str:
    """Return the page: its head, the contents, and the sections."""
    shown = sections()
    anchors = anchors_of(shown)
    contents = "\n".join(contents_line(section, anchors) for section in shown)
    return "\n\n".join([head, "## Contents", contents, *(section_text(section, anchors) for section in shown)]) + "\n"


def contents_line(section: Section, anchors: dict[str, str]) -> str:
    links = (f"[{name.removeprefix(f'{section.title}.')}](#{anchors[name]})" for name, _ in section.members)
    return f"- [{section.title}](#{anchors[section.title]})" + ("" if not section.members else f": {', '.join(links)}")


def anchors_of(shown: list[Section]) -> dict[str, str]:
    """Return the anchor of each heading as GitHub forms it: a repeated anchor gets a number."""
    result: dict[str, str] = {}
    for section in shown:
        for heading in (section.title, *(name for name, _ in section.members)):
            plain = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
            repeated = sum(re.fullmatch(rf"{plain}(-\d+)?", anchor) is not None for anchor in result.values())
            result[heading] = f"{plain}-{repeated}" if repeated else plain
    return result


def section_text(section: Section, anchors: dict[str, str]) -> str:
    parts = [f"## {section.title}", *([markdown(section.text)] if section.text else [])]
    links = {name.rpartition(".")[2]: anchor for name, anchor in anchors.items()}
    parts += [member_text(name, definition, links) for name, definition in section.members]
    return "\n\n".join(parts)


def member_text(name: str, definition: Definition, links: dict[str, str]) -> str:
    node = definition.node
    parts = [f"### {name}"]
    if isinstance(node, ast.FunctionDef):
        parts += [f"```text\n{signature(node, name)}\n```", markdown(definition.doc)]
    elif isinstance(node, ast.ClassDef):
        items = [attribute_text(attribute, links) for attribute in public_attributes(node)]
        items += [method_text(method, definition.name) for method in methods(node)]
        parts += [markdown(definition.doc), "\n".join(items)]
    else:
        parts += [constant_text(node), markdown(definition.doc)]
    return "\n\n".join(part for part in parts if part)


def constant_text(node: Assignment) -> str:
    """Return the value of a constant or type alias, "" if it is computed."""
    computed = (ast.comprehension, ast.Starred)
    if node.value is None or any(isinstance(inner, computed) for inner in ast.walk(node.value)):
        return ""
    return f"`{short(ast.unparse(node.value))}`"


def attribute_text(attribute: Attribute, links: dict[str, str]) -> str:
    if not attribute.type:
        return bullet(f"`{attribute.name}`", attribute.doc)
    code = f"`{short(attribute.type + attribute.default)}`"
    targets = [links[name] for name in re.findall(r"\w+", attribute.type) if name in links]
    return bullet(f"`{attribute.name}`: " + (f"[{code}](#{targets[0]})" if targets else code), attribute.doc)


def method_text(method: Function, owner: str) -> str:
    name = f"{owner}.{method.name}" if "classmethod" in decorators(method) else method.name
    return bullet(f"`{' '.join(signature(method, name).split())}`", ast.get_docstring(method) or "")


def bullet(head: str, doc: str) -> str:
    first, _, rest = markdown(doc).partition("\n\n")
    text = f"- {head}" + (f"  \n  {indented(first)}" if first else "")
    return text + (f"\n\n  {indented(rest)}" if rest else "")


def indented(text: str) -> str:
    return re.sub(r"\n(?=.)", "\n  ", text)


def markdown(doc: str) -> str:
    """Return a docstring as Markdown: roles and double backquotes become code, other angle brackets are escaped."""
    text = re.sub(r":\w+:`(?:~?ros_lint\.(?:\w+\.)*)?([\w.]+)`", r"`\1`", doc)
    text = re.sub(r"``(.+?)``", r"`\1`", text, flags=re.DOTALL)
    return "".join(part if part.startswith("`") else part.replace("<", "&lt;") for part in re.split(r"(`[^`]*`)", text))
