"""Find the rules in a Python module: the object ``RULE`` of the module and of its direct submodules."""

from __future__ import annotations

import importlib
import os
from collections.abc import Iterator
from types import ModuleType

from ros_lint.analysis.rule import Rule


def rules_of(module: ModuleType) -> Iterator[Rule]:
    """Yield the rules of a module or package. Errors from importing a submodule are passed on."""
    if isinstance(rule := getattr(module, "RULE", None), Rule):
        yield rule
    for name in sorted({name for folder in getattr(module, "__path__", ()) for name in _modules_in(folder)}):
        yield from rules_of(importlib.import_module(f"{module.__name__}.{name}"))


def _modules_in(folder: str) -> Iterator[str]:
    """Yield the names of the modules and packages in a folder. ``pkgutil`` is not used, because its import takes longer."""
    for entry in os.scandir(folder) if os.path.isdir(folder) else ():
        name, dot, suffix = entry.name.partition(".")
        is_module = suffix == "py" or (not dot and os.path.isfile(os.path.join(entry.path, "__init__.py")))
        if is_module and name.isidentifier() and name != "__init__":
            yield name
