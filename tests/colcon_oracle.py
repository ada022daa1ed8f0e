"""A folder as colcon reads it: its packages, their dependencies, and whether it can order them."""

from __future__ import annotations

import contextlib
import logging
import os
import warnings
from argparse import ArgumentParser
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

CONTEXT = {"ROS_VERSION": "2", "ROS_PYTHON_VERSION": "3", "ROS_DISTRO": "jazzy"}


class Listing(NamedTuple):
    """A line of ``colcon list`` for each package, and its dependencies by category."""

    packages: frozenset[tuple[str, str, str]]
    """Name, path relative to the base, type."""
    needs: Mapping[str, Mapping[str, frozenset[str]]]
    """By path, then by name of the dependency: the categories."""
    order: tuple[str, ...] | None
    """Names as ``colcon list -t`` prints them, None if it fails."""


def colcon_list(base: Path) -> Listing:
    """Run the discovery, identification, augmentation and ordering of colcon in a folder."""
    with _quiet(), _inside(base):
        return _list()


def _list() -> Listing:
    # Not at the top: colcon warns while it is imported, which would be an error.
    from colcon_core.location import set_default_config_path
    from colcon_core.package_augmentation import augment_packages
    from colcon_core.package_discovery import add_package_discovery_arguments, discover_packages
    from colcon_core.package_identification import get_package_identification_extensions
    from colcon_core.topological_order import topological_order_packages
    from colcon_metadata import metadata
    from colcon_python_setup_py.package_identification import python_setup_py as setup_py
    from colcon_ros.package_identification import ros

    for cache in (
        metadata.metadata_by_name,
        metadata.metadata_by_path,
        ros._cached_packages,
        setup_py._setup_information_cache,
    ):
        cache.clear()
    set_default_config_path(path="/nonexistent")
    parser = ArgumentParser()
    add_package_discovery_arguments(parser)
    extensions = get_package_identification_extensions()
    result: set[Any] = discover_packages(parser.parse_args(["--ignore-user-meta"]), extensions)
    augment_packages(result)
    paths = {package: "" if str(package.path) == "." else str(package.path) for package in result}
    dependencies: dict[str, dict[str, frozenset[str]]] = {}
    for package, path in paths.items():
        for category, names in package.dependencies.items():
            for name in names:
                own_names = dependencies.setdefault(path, {})
                own_names[str(name)] = own_names.get(str(name), frozenset()) | {category}
    order: tuple[str, ...] | None = None
    with contextlib.suppress(RuntimeError, AssertionError):
        order = tuple(d.descriptor.name for d in topological_order_packages(result, recursive_categories=("run",)))
    return Listing(frozenset((package.name, path, package.type) for package, path in paths.items()), dependencies, order)


@contextlib.contextmanager
def _inside(base: Path) -> Iterator[None]:
    here = os.getcwd()
    before = dict(os.environ)
    os.environ.update(CONTEXT)
    os.chdir(base)
    try:
        yield
    finally:
        os.chdir(here)
        os.environ.clear()
        os.environ.update(before)


@contextlib.contextmanager
def _quiet() -> Iterator[None]:
    with warnings.catch_warnings(), open(os.devnull, "w") as nowhere, contextlib.redirect_stderr(nowhere):
        warnings.simplefilter("ignore")
        logging.disable(logging.CRITICAL)
        try:
            yield
        finally:
            logging.disable(logging.NOTSET)
