"""
## What it finds

- Headers that are installed without a folder that the includes in another package of the workspace contain: `install(DIRECTORY
  include/robot/ DESTINATION include)` with `#include <robot/robot.hpp>`.
- Headers that are installed to `include/${PROJECT_NAME}`, while the package exports only `include`.
- Headers that are installed with an additional folder: without a slash at the end, `install(DIRECTORY include DESTINATION
  include)` puts `robot/robot.hpp` into `include/include`.

## Why it matters

Packages that depend on this one do not find its headers: "fatal error: robot/robot.hpp: No such file or directory".

## How to fix it

`install(DIRECTORY include/ DESTINATION include/${PROJECT_NAME})`, with the same folder in `target_include_directories(...
$<INSTALL_INTERFACE:include/${PROJECT_NAME}>)`. The fix adds the slash, or changes the
exported folder.

## Limitations

Not reported:

- Packages without `include/`, and packages that cannot be fully analysed.
- Includes in a package that adds a folder outside of itself to its include directories by hand, and includes in tests.

An additional folder is reported with medium confidence if the library is exported but may be loaded instead of linked, and with
low confidence if it is not exported.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from ros_lint.api import Confidence, Finding, Fix, InstalledFile, Package, Rule, Severity, Workspace, build, edits, files


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    headers = build.own_headers(package, workspace)
    if headers is not None and headers.installed:
        yield from _misplaced(package, headers.included)
        yield from _doubled(package, headers)
        yield from _below_export(package, headers)


def _misplaced(package: Package, wanted: build.Includes) -> Iterator[Finding]:
    """Yield one finding for headers that other packages include as ``a/b.hpp``, but that are installed without the folder ``a``.

    ``wanted``: the includes of headers of this package in other packages.
    """
    installed = [file for file in package.built.products.installs if file.source.endswith(files.HEADERS) and not file.conditional]
    provided = {file.source: file for file in installed}
    paths = [file.path for file in package.built.products.installs]
    lost = [
        (file, other, use)
        for other, use in wanted
        for file in [f"include/{use.name}"]
        if file in provided and "/" in use.name and not any(path.endswith(f"/{use.name}") for path in paths)
    ]
    if lost:
        (file, other, use), *_ = lost
        folder = provided[file].path.rpartition("/")[0]
        yield Finding(
            f"'{file}' is installed to {folder}, so '{other.name}' cannot include it as '{use.name}'; "
            f"install it to {folder}/{use.name.rpartition('/')[0]}",
            provided[file].span,
            file,
            build.related_includes([(other, use) for _, other, use in lost]),
        )


def _doubled(package: Package, headers: build.OwnHeaders) -> Iterator[Finding]:
    """Yield a finding for headers that are installed to include/include/, where compilers do not search."""
    script = package.built
    sources = [file for file in script.products.installs if file.source.endswith(files.HEADERS)]
    own = [file for file in sources if file.source.startswith("include/")]
    first = next((file for file in own if file.path.startswith("include/")), None)
    if first is None or build.has_extras(package) or not all(_is_doubled(file) for file in own):
        return
    folder = first.path.removesuffix(first.source.removeprefix("include")).removeprefix("/")
    words = (re.sub(r"\$\{\w*PROJECT_NAME\}", script.project.name, text) for call in script.commands.calls for text in call.texts)
    if any(folder in word for word in words):
        return  # the script names it, probably as an include directory
    library = any(file.path.startswith("lib/lib") for file in script.products.installs)
    exported = library and bool(headers.exports or any(True for _ in package.calls(*build.EXPORTING_LIBRARIES)))
    needed = bool(headers.included) or (exported and not headers.loaded)
    places = ((call, at) for call in package.calls("install", anywhere=True) for at in range(len(call.args)))
    call, at = next(((call, at) for call, at in places if call.span(at) == first.span), (None, 0))
    fix = Fix.of("write include/ with a slash at the end", edits.cmake.write(call, at, f"{call.texts[at]}/")) if call else None
    name = first.source.rpartition("/")[2]
    yield Finding(
        f"the headers in 'include/' ('{name}' ...) are installed to {folder}, where compilers do not find them; "
        "write include/ with a slash at the end",
        first.span,
        "include/",
        build.related_includes(headers.included),
        fix,
        Confidence.HIGH if needed else Confidence.MEDIUM if exported else Confidence.LOW,
        None if needed else Severity.WARNING,
    )


def _below_export(package: Package, headers: build.OwnHeaders) -> Iterator[Finding]:
    """Yield a finding for headers that are installed to include/<folder>/, although only include/ is exported."""
    script, exports = package.built, headers.exports
    own = [
        file for file in script.products.installs if file.source.startswith("include/") and file.source.endswith(files.HEADERS)
    ]
    if not (own and exports) or script.exports.targets or build.has_extras(package) or any(file.conditional for file in own):
        return
    if all(map(_is_doubled, own)):
        return
    exported = {build.evaluated_name(package, text) for call in exports for text in call.texts}
    folders = {file.path.removesuffix(file.source.removeprefix("include/")) for file in own}
    if not exported <= {"include", "include/"} or len(folders) != 1:
        return
    folder = folders.pop().rstrip("/")
    if not folder.startswith("include/"):
        return
    call, name = exports[0], own[0].source.rpartition("/")[2]
    needed = bool(headers.included) or (headers.library and not headers.loaded)
    written = "include/${PROJECT_NAME}" if folder == f"include/{script.project.name}" else folder
    yield Finding(
        f"the headers in 'include/' ('{name}' ...) are installed to {folder}, but only include is exported, so other "
        f"packages do not find them; write ament_export_include_directories({written})",
        call.span(0),
        "include/",
        build.related_includes(headers.included),
        Fix.of(f"export {written}", edits.cmake.write(call, 0, written), safe=False) if call.texts[1:] == () else None,
        Confidence.HIGH if needed else Confidence.MEDIUM,
        None if needed else Severity.WARNING,
    )


def _is_doubled(provided: InstalledFile) -> bool:
    """Return whether a header is installed with its whole path below another folder, in every build.

    ``include/a/b.hpp`` is installed as ``include/a/include/a/b.hpp``.
    """
    return provided.path.startswith("include/") and provided.path.endswith(f"/{provided.source}") and not provided.conditional


RULE = Rule(
    name="misplaced-headers",
    code="ROS428",
    summary="headers are installed to the folder by which other packages include them",
    severity=Severity.ERROR,
    since="0.1",
    doc=__doc__,
    fixable=True,
    package=check,
)
