"""Packages that the scripts have found."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import islice

from ros_lint.base.text import Span
from ros_lint.collectors.cmake.evaluator.state import Properties
from ros_lint.collectors.cmake.evaluator.values import cached_short


@cached_short(4096)
def folded(name: str) -> str:
    """Return the name of a package in lower case, without ``_`` and ``-``, to compare spellings: ``Foo-Bar`` -> ``foobar``."""
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
        """Packages that are certainly found."""
        self.prefixes: dict[str, bool] = {}
        """Prefixes of variables that found packages may have set, each with whether it is a package name.

        It is not for pkg_check_modules(), whose first argument is the prefix."""
        self.included: Properties = Properties()
        """Packages of the workspace whose CMake code has run."""
        self.optional_finds: dict[str, list[Span]] = {}
        """Places of find_package() calls without REQUIRED, by package."""
        self.quiet_finds: set[Span] = set()
        """Places of these calls that certainly run with QUIET."""
        self.required_by_check: set[str] = set()
        """Names X for which the script stops with an error unless X_FOUND is true."""
        self._spellings: dict[str, list[str]] = {}
        self._spelling_lengths: set[int] = set()
        self._indexed = 0

    def may_set(self, variable: str) -> bool:
        """Return whether a found package may have set a variable, which then has the prefix of the package."""
        letters, spellings = folded(variable), self._folded_prefixes()
        return any(letters[:length] in spellings for length in self._spelling_lengths)

    def with_prefix(self, prefix: str) -> str:
        """Return the found package whose variables have a prefix in any spelling (:func:`folded`); "" if there is none.

        ``OpenCV`` -> ``OpenCV``, because find_package(OpenCV) sets ``OpenCV_LIBS``.
        """
        if self.prefixes.get(prefix):
            return prefix
        names = self._folded_prefixes().get(folded(prefix), ())
        return next((name for name in names if self.prefixes[name]), names[0] if names else "")

    def _folded_prefixes(self) -> Mapping[str, Sequence[str]]:
        """Return the prefixes by their folded spelling. Prefixes are only added, so the index is extended by the new ones."""
        if len(self.prefixes) != self._indexed:
            for name in islice(self.prefixes, self._indexed, None):
                letters = folded(name)
                self._spellings.setdefault(letters, []).append(name)
                self._spelling_lengths.add(len(letters))
            self._indexed = len(self.prefixes)
        return self._spellings
