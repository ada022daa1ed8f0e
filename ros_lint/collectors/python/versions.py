"""The Python version of each ROS distribution, and the names of Python's standard library."""

from __future__ import annotations

import builtins
import math
import sys
from collections.abc import Iterable, Iterator, Mapping
from typing import Final

from ros_lint.facts.visibility import NewerSyntax, Problem

Version = tuple[int, int]

PYTHON_OF: Final[Mapping[str, Version]] = {
    "humble": (3, 10),
    "jazzy": (3, 12),
    "kilted": (3, 12),
    "lyrical": (3, 14),
    "rolling": (3, 14),
}
"""The Python version of each ROS distribution: that of its Ubuntu release of tier 1 (Jammy, Noble, Noble, Resolute, Resolute).

Source: REP 2000 up to Kilted, and "Lyrical Luth Supported Platforms" of docs.ros.org ("Python 3.12 - 3.14").
"""

# Modules that only some versions from 3.10 to 3.14 have: the result must not depend on the Python that runs.
_SOME_PYTHONS: Final = """
__future__ __main__ _thread aifc annotationlib asynchat asyncore audioop binhex cgi cgitb chunk compression crypt
distutils imghdr imp lib2to3 mailcap msilib nis nntplib ossaudiodev pipes smtpd sndhdr spwd sunau telnetlib tomllib uu
xdrlib
"""
STANDARD_LIBRARY: Final = frozenset([*_SOME_PYTHONS.split(), *(name for name in sys.stdlib_module_names if name[0] != "_")])
"""Top-level modules of Python's standard library, of any version from 3.10 to 3.14."""
BUILTINS: Final = frozenset(dir(builtins)) | {"BaseExceptionGroup", "ExceptionGroup", "PythonFinalizationError"}
"""The builtin names of Python, of any version from 3.10 to 3.14."""
MATH: Final = frozenset(dir(math)) | {"cbrt", "exp2", "fma", "sumprod"}
"""The names of the module ``math``, of any version from 3.10 to 3.14."""


def too_new(syntax: Iterable[NewerSyntax], distro: str) -> Iterator[Problem]:
    """Yield a problem for each construct that the Python version of a distribution rejects, none if ``distro`` is unknown."""
    runs = PYTHON_OF.get(distro)
    for construct, version, span in syntax:
        if runs is not None and runs < version:
            needs, has = (".".join(map(str, version_pair)) for version_pair in (version, runs))
            yield Problem("newer-python", f"{construct} need Python {needs}; {distro} runs {has}", span)
