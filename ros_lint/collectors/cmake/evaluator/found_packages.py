"""The packages that the CMake scripts of a run have found."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.state import Properties
from ros_lint.collectors.cmake.evaluator.values import cached_short


@cached_short(4096)
def folded(name: str) -> str:
    """Return the name of a package in lower case, without ``_`` and ``-``, to compare names: ``Foo-Bar`` -> ``foobar``."""
    return name.replace("_", "").replace("-", "").lower()


class FoundPackages:
    """The packages that find_package() and similar commands have found so far."""

    def __init__(self, scripts: Iterable[str]) -> None:
        self.find_modules = {
            path[path.rindex("Find") + 4 : -6]: path
            for path in scripts
            if path.endswith(".cmake") and path.rpartition("/")[2].startswith("Find")
        }
        """Paths of the package's own find modules (FindX.cmake), by the name X."""
        self.certain: Properties = Properties()
        """Packages that are certainly found, by name."""
        self.prefixes: dict[str, bool] = {}
        """Prefixes of the variables that found packages may have set, each with whether the prefix is the name of a package.

        The first argument of pkg_check_modules() is a prefix but not the name of a package."""
        self.included: Properties = Properties()
        """Packages of the workspace whose CMake code has run, by name."""
        self.optional_finds: dict[str, list[Span]] = {}
        """By package: the places of find_package() calls without REQUIRED."""
        self.quiet_finds: set[Span] = set()
        """Places of find_package() calls without REQUIRED that certainly run and have QUIET."""
        self.required_by_check: set[str] = set()
        """Names X for which the script stops with an error if X_FOUND is false."""
        self._spellings: dict[str, list[str]] = {}
        self._spelling_lengths: set[int] = set()
        self._indexed = 0

    def may_set(self, variable: str) -> bool:
        """Return whether a found package may have set a variable, because the variable begins with the name of the package."""
        letters, spellings = folded(variable), self._folded_prefixes()
        return any(letters[:length] in spellings for length in self._spelling_lengths)

    def with_prefix(self, prefix: str) -> str:
        """Return the found package whose variables begin with ``prefix``, "" if there is none: ``OPENCV`` -> ``OpenCV``.

        Case, ``_`` and ``-`` are ignored, as in :func:`folded`.
        """
        if self.prefixes.get(prefix):
            return prefix
        names = self._folded_prefixes().get(folded(prefix), ())
        return next((name for name in names if self.prefixes[name]), names[0] if names else "")

    def _folded_prefixes(self) -> Mapping[str, Sequence[str]]:
        """Return the known prefixes of variables, grouped by their form in lower case without ``_`` and ``-``."""
        if len(self.prefixes) != self._indexed:
            new = list(islice(reversed(self.prefixes), len(self.prefixes) - self._indexed))  # from the end, without the others
            for name in reversed(new):
                letters = folded(name)
                self._spellings.setdefault(letters, []).append(name)
                self._spelling_lengths.add(len(letters))
            self._indexed = len(self.prefixes)
        return self._spellings
