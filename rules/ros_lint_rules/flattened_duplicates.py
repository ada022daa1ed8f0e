"""
## What it finds

Different files that are installed to the same path. `data_files` ignores the folders of its sources: `a/params.yaml` and
`b/params.yaml` in one entry are both installed as `share/<package>/params.yaml`. `install(FILES)` does the same.

## Why it matters

The second file overwrites the first without a warning.

## How to fix it

Write one entry for each folder: `('share/' + package_name + '/a', ['a/params.yaml'])`. In CMake, use `install(DIRECTORY)`, which
keeps folders.

## Limitations

Not reported:

- Files that are installed under a condition.
- The same file installed twice.
- `__init__.py`.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Finding, InstalledFile, Package, Related, Rule, Severity, Span, Workspace, first_related, names


def check(package: Package, _: Workspace) -> Iterator[Finding]:
    script = package.script
    if script is None or package.builds_with not in ("ament_cmake", "ament_python"):
        return
    by_path: dict[str, dict[str, InstalledFile]] = {}
    for provided in script.products.installs:
        if provided.source and not (provided.conditional or provided.path.endswith("__init__.py")):
            by_path.setdefault(provided.path, {}).setdefault(provided.source, provided)
    by_place: dict[tuple[Span, ...], list[str]] = {}
    for path, sources in by_path.items():
        if len(sources) > 1:
            by_place.setdefault(tuple([provided.span for provided in sources.values()]), []).append(path)
    yield from (_finding(paths, by_path[paths[0]]) for paths in by_place.values())


def _finding(paths: list[str], sources: dict[str, InstalledFile]) -> Finding:
    """Return the finding for the ``sources`` that are installed to the first path; the other paths have the same problem."""
    path, *more = paths
    *earlier, last = sources.values()
    both = " and ".join(f"'{source}'" for source in sources)
    which = f"{both} are both" if len(sources) == 2 else f"{names.shorten_list(sources)} are all"
    places = {file.span: f"'{file.source}' is installed here" for file in reversed(earlier) if file.span != last.span}
    also = f"; the same happens to {names.shorten_list(more)}" if more else ""
    return Finding(
        f"{which} installed as {path}, so only the last one remains{also}",
        last.span,
        path,
        first_related(Related(message, span) for span, message in sorted(places.items())),
    )


RULE = Rule(
    name="flattened-duplicates",
    code="ROS414",
    summary="different files are not installed to the same path",
    severity=Severity.WARNING,
    since="0.1",
    doc=__doc__,
    package=check,
)
