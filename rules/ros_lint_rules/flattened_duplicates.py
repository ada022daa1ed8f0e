"""
## What it finds

Two different files that are installed to one path: `data_files` drops the folders of its sources, so that `a/params.yaml`
and `b/params.yaml` in one entry are both `share/<package>/params.yaml`; `install(FILES)` does the same.

## Why it matters

The second one overwrites the first, and nothing is said.

## How to fix it

One entry for each folder: `('share/' + package_name + '/a', ['a/params.yaml'])`; or `install(DIRECTORY)`, which keeps
folders.

## Limitations

Where one of them is installed under a condition, and where it is the same file twice.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, Package, Provided, Related, Rule, Severity, Span, Workspace, few, several


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    by_path: dict[str, dict[str, Provided]] = {}
    for provided in script.provides:
        if provided.source and not (provided.conditional or provided.path.endswith("__init__.py")):
            by_path.setdefault(provided.path, {}).setdefault(provided.source, provided)
    by_place: dict[tuple[Span, ...], list[str]] = {}
    for path, sources in by_path.items():
        if len(sources) > 1:
            by_place.setdefault(tuple([each.span for each in sources.values()]), []).append(path)
    yield from (_finding(paths, by_path[paths[0]]) for paths in by_place.values())


def _finding(paths: list[str], sources: dict[str, Provided]) -> Finding:
    """Speak of files that are installed to one path; with the ``paths`` after the first one it is the same."""
    path, *more = paths
    *others, last = sources.values()
    which = f"{' and '.join(sources)} are both" if len(sources) == 2 else f"{few(sources)} ({len(sources)} files) are all"
    places = {each.span: f"{each.source} is installed here" for each in reversed(others) if each.span != last.span}
    as_well = f"; so it is with {few(more)}" if more else ""
    return Finding(
        f"{which} installed as {path}; the last one wins{as_well}",
        last.span,
        path,
        several(Related(message, span) for span, message in sorted(places.items())),
    )


RULE = Rule(
    name="flattened-duplicates",
    code="ROS414",
    summary="two files must not be installed to one path",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
