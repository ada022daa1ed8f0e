"""Find installed headers that dependents cannot include."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from ros_lint.facts.build import BuildScript
from ros_lint.facts.sources import FileFacts


def unusable(script: BuildScript, facts: Mapping[str, FileFacts], files: tuple[str, ...]) -> tuple[str, ...]:
    """Return the installed headers that do not compile outside the package, sorted.

    An unusable header includes a file of the package that is not installed, a header that Qt generates from a form
    (``ui_*.h``), or another unusable header. ``facts``, ``files`` and the result have paths relative to the package.
    """
    provided = [file for file in script.products.installs if file.path.startswith("include/")]
    headers = sorted({file.source for file in provided if file.source in facts})
    if not headers:
        return ()
    installed = {_name(file.path) for file in provided}
    private = {_name(file): file for file in files if _name(file) not in installed}
    result = {header for header in headers if any(_is_private(name, private, installed) for name in _includes(facts[header]))}
    pending = list(result)
    while pending:
        suffix = f"/{pending.pop()}"
        includers = [header for header in headers if header not in result and any(map(suffix.endswith, _endings(facts[header])))]
        result.update(includers)
        pending += includers
    return tuple(sorted(result))


def _is_private(header: str, private: Mapping[str, str], installed: set[str]) -> bool:
    name = _name(header)
    if name in installed:
        return False
    return (name.startswith("ui_") and name.endswith(".h")) or f"/{private.get(name, '')}".endswith(f"/{header}")


def _endings(facts: FileFacts) -> Iterator[str]:
    return (f"/{name}" for name in _includes(facts))


def _includes(facts: FileFacts) -> Iterator[str]:
    """Yield the headers that a file requires; ``../a/b.hpp`` gives ``a/b.hpp``."""
    for mention in facts.mentions:
        if mention.via == "include" and not mention.optional:
            yield mention.name.rpartition("../")[2].removeprefix("./")


def _name(path: str) -> str:
    return path.rpartition("/")[2]
