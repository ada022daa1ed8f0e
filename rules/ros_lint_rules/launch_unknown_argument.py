"""
## What it finds

An include that passes an argument which neither the included launch file nor any file included from there declares or uses.

## Why it matters

The argument has no effect, and no message says so. Mostly it was renamed or removed in the included file, so the default
applies.

## How to fix it

Correct the name, or remove the argument. The message names a similar argument of the included file, an argument with the name of
the configuration that is passed, or a variant of the included file that declares the argument.

## Limitations

Not reported:

- Arguments that launch itself reads when the included file starts a process or a node, such as `emulate_tty` and `launch-prefix`.
- Arguments that another file uses, if the include chooses between several files.
- Includes whose file or arguments cannot be determined from the launch files alone, and arguments that are passed under an
  unknown condition, such as what a function finds out about the included file.
- Arguments passed to a file that includes a launch file from outside the workspace, because that file may use or declare them.
- Arguments that something later in the same scope may read, such as a launch file from outside the workspace. A passed argument
  stays set until the end of the enclosing scoped group.

The confidence is medium in these cases:

- The included file fills in parameters from launch configurations.
- Something later in a file that includes this one may read the argument. Exception: the name resembles an argument that is not
  passed.

The severity is info, or warning if the name resembles an argument that is not passed.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator

from ros_lint.api import (
    Confidence,
    Finding,
    LaunchFile,
    LaunchValue,
    Package,
    Rule,
    Severity,
    Span,
    Workspace,
    cached_by_workspace,
    launch,
    names,
)


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    filled = _filled(workspace)
    for launch_file in launch.run_launch_files(package):
        by_place: dict[Span, list[launch.PlacedInclude]] = {}
        for include in launch.includes(launch_file.file):
            by_place.setdefault(include.action.span, []).append(include)
        for includes in by_place.values():
            taken = _taken_by_any(includes, launch_file.file, workspace) if len(includes) > 1 else frozenset()
            if taken is not None:
                for include in includes:
                    yield from _of_include(include, launch_file.file, workspace, (filled, taken))


@cached_by_workspace
def _filled(workspace: Workspace) -> frozenset[str]:
    """Return the launch configurations that parameter files of the workspace read."""
    files = (file for package in workspace.packages for file in package.parameter_files)
    return frozenset([name for file in files for name in file.configurations_read])


def _taken_by_any(includes: Iterable[launch.PlacedInclude], source: LaunchFile, workspace: Workspace) -> frozenset[str] | None:
    """Return the configurations that at least one of the files accepts between which a single include chooses.

    The result is None if one of the files may accept any configuration.
    """
    resolver = launch.include_resolver(workspace)
    targets = [resolver.target(include.action.target, source) for include in includes]
    accepted = [resolver.takes(target.file) if target is not None else None for target in targets]
    known = [takes.known for takes in accepted if takes is not None and takes.complete]
    return frozenset().union(*known) if len(known) == len(accepted) else None


def _of_include(
    include: launch.PlacedInclude, source: LaunchFile, workspace: Workspace, used: tuple[Container[str], Container[str]]
) -> Iterator[Finding]:
    """Yield the findings of an include.

    ``used`` has the launch configurations that parameter files of the workspace read, and those that another file accepts which
    the include may choose instead.
    """
    filled, elsewhere = used
    action, resolver, leaks = include.action, launch.include_resolver(workspace), launch.scope_leaks(workspace)
    target = resolver.target(action.target, source)
    places = action.argument_spans or [value.span for _, value in action.arguments]
    passed = {name: (value, place) for (name, value), place in zip(action.arguments, places, strict=True) if name}
    if target is None or not all(launch.is_plain(name) for name in passed):
        return
    takes = resolver.takes(target.file)
    file = f"{target.package.name}/{target.path}"
    sure = not launch.include_tree(workspace).fill(target.file)
    not_passed = sorted(takes.known - passed.keys())
    free = frozenset(not_passed)
    for name, (value, place) in passed.items() if takes.complete else ():
        if name in takes.known or name in elsewhere or name in action.conditional_arguments or (name in filled and not sure):
            continue
        if not leaks.is_taken_later(name, include, source):
            alone = not leaks.is_taken_above(name, include, source)
            near = names.similar_names(name, not_passed, 1, 0.85)
            hint = names.did_you_mean(near or sorted(free.intersection(_configurations(value))))
            hint = hint or _in_sibling(name, target.file, target.package, source, workspace) or "; remove it"
            yield _useless(file, name, place, hint, sure=sure and (bool(near) or alone), is_similar=bool(near))


def _configurations(value: LaunchValue) -> Iterator[str]:
    """Yield the name of the launch configuration if a value is nothing but that configuration: ``mode`` for ``$(var mode)``.

    A launch file often passes on its own argument to an argument of the same name.
    """
    for text in value.texts:
        yield from (name for name, _, whole in launch.configurations(text) if whole == text)


def _in_sibling(name: str, target: LaunchFile, package: Package, source: LaunchFile, workspace: Workspace) -> str:
    """Return the hint that a variant of the included file declares the argument, "" unless exactly one in ``package`` does.

    A variant is in or below the folder of the included file and has a longer name: ``base_imu`` for ``base``. The including
    file ``source`` is no variant, although it often declares the arguments that it passes on.
    """
    folder, tree = target.path.rpartition("/")[0], launch.include_tree(workspace)
    declaring = [
        path
        for file, path, _, _ in launch.package_launch_files(package)
        if file not in (source, target)
        and file.path.startswith(f"{folder}/")
        and _stem(file).startswith(_stem(target))
        and name in tree.names(file).declared
    ]
    return f"; '{declaring[0]}' declares it: include that file, or remove the argument" if len(declaring) == 1 else ""


def _stem(file: LaunchFile) -> str:
    """Return the name of a launch file without its suffix: ``base`` for ``launch/base.launch.py``."""
    return file.path.rpartition("/")[2].removesuffix(launch.launch_suffix(file.path))


def _useless(file: str, name: str, place: Span, hint: str, *, sure: bool, is_similar: bool) -> Finding:
    """Return the finding for the argument ``name`` that is passed to the included ``file``, although the file does not use it.

    ``is_similar``: the file uses an argument of a similar name that is not passed.
    """
    return Finding(
        f"'{file}' does not use the argument '{name}', so it has no effect{hint}",
        place,
        f"{file}:{name}",
        confidence=Confidence.HIGH if sure else Confidence.MEDIUM,
        severity=None if is_similar else Severity.INFO,
    )


RULE = Rule(
    name="launch-unknown-argument",
    code="ROS514",
    summary="includes pass only arguments that the included launch files use",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
