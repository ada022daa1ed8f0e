"""Read the files of rosdistro: the index (REP 153), distribution files (REP 143) and manifest caches.

This is the only module that uses the network, and only for ``ros-lint index refresh`` with a URL.
"""

from __future__ import annotations

import gzip
import os
import zlib
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base.safe_yaml import YamlError, load
from ros_lint.base.text import Text
from ros_lint.collectors.manifest import collect
from ros_lint.knowledge.describe import context, describe
from ros_lint.knowledge.index import Released
from ros_lint.knowledge.store import KnowledgeError

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

_TIMEOUT = 60.0
_MOST_BYTES = 1 << 28


class DistributionSource(NamedTuple):
    """The files of rosdistro about one distribution, as paths or URLs."""

    name: str
    files: tuple[str, ...]
    """Distribution files. A later file overrides an earlier one; a private overlay, for example, is appended."""
    cache: str
    active: bool
    """True for a ROS 2 distribution before its end of life."""


def sources(place: str) -> dict[str, DistributionSource]:
    """Return the distributions in an ``index-v4.yaml``, by name. ``place`` is the path or URL of the file.

    Raises KnowledgeError if the file is unreadable or invalid.
    """
    index = _with_mapping(place, load_yaml(place), "distributions")["distributions"]
    result = {}
    for name, entry in index.items():
        if not isinstance(entry, dict) or not isinstance(entry.get("distribution"), list):
            raise KnowledgeError(f"{place}: distribution '{name}' has no list of files")
        files = tuple(_resolve_place(place, str(file)) for file in entry["distribution"])
        cache = str(entry.get("distribution_cache") or "")
        active = entry.get("distribution_type") == "ros2" and entry.get("distribution_status") != "end-of-life"
        result[str(name)] = DistributionSource(str(name), files, _resolve_place(place, cache) if cache else "", active)
    return result


def packages(source: DistributionSource) -> Iterator[Released]:
    """Yield the package index entries of a distribution. Raises KnowledgeError if a file is unreadable or invalid."""
    if not source.cache:
        raise KnowledgeError(f"the index has no cache for '{source.name}', so its dependencies are unknown")
    cache = _with_mapping(source.cache, load_yaml(source.cache), "release_package_xmls")
    released_manifests = cache["release_package_xmls"] or {}
    source_manifests = {
        name: entry[1]
        for repository in (cache.get("source_repo_package_xmls") or {}).values()
        for name, entry in repository.items()
        if isinstance(entry, list) and len(entry) == 2
    }
    repositories: dict[str, Any] = {}
    for file in source.files:
        repositories.update(_with_mapping(file, load_yaml(file), "repositories")["repositories"] or {})
    variables = context(source.name)
    for repository, entry in repositories.items():
        release = (entry or {}).get("release")
        if not release:
            continue
        version = str(release.get("version") or "").rpartition("-")[0]
        end_of_life_flag = "E" * (entry.get("status") in ("end-of-life", "unmaintained"))
        for name in map(str, release.get("packages") or [repository]):
            listed = Released(name, version, f"?{'' if version else 'U'}", str(repository), {})
            if name in released_manifests:
                yield _described(source, listed, released_manifests[name], variables, end_of_life_flag)
            elif name in source_manifests:
                yield _described(source, listed, source_manifests[name], variables, end_of_life_flag)
            else:
                yield listed._replace(flags=listed.flags if not version else "?-")


def _described(
    source: DistributionSource, listed: Released, xml: object, variables: Mapping[str, str], end_of_life_flag: str
) -> Released:
    """Return the entry ``listed`` of a distribution file, with the dependencies and flags from its manifest ``xml``."""
    manifest = collect.collect(Text(f"{source.cache}: {listed.name}", str(xml)))
    if manifest.name != listed.name:
        return listed._replace(flags="?-")
    package = describe(manifest, variables)
    # The cache may be older than the distribution file.
    state = "U" if not listed.version else "~" if package.version != listed.version else ""
    return listed._replace(flags=package.flags + state + end_of_life_flag, depends=package.depends)


def load_yaml(place: str) -> Any:
    """Return the contents of a YAML file as Python values. ``place`` is its path or URL. A gzip file is unpacked first.

    Raises KnowledgeError if the file is unreadable or invalid.
    """
    data = read(place)
    try:
        return load(data.decode("utf-8-sig"))
    except (YamlError, UnicodeDecodeError) as error:
        raise KnowledgeError(f"{place} is not valid YAML: {' '.join(str(error).split())}") from error


def read(place: str) -> bytes:
    """Return the bytes of a file. ``place`` is its path or URL (http, https, file). A gzip file is unpacked.

    Raises KnowledgeError.
    """
    try:
        data = _download(place) if _is_url(place) else _open(place)
        return gzip.decompress(data) if data.startswith(b"\x1f\x8b") else data
    except (OSError, EOFError, ValueError, zlib.error) as error:
        reason = getattr(error, "reason", None) or getattr(error, "strerror", None) or error
        raise KnowledgeError(f"{place} cannot be read: {reason}") from error


def _open(place: str) -> bytes:
    with open(place, "rb") as file:
        return file.read()


def _download(url: str) -> bytes:
    from urllib.request import Request, urlopen  # noqa: PLC0415  (only a refresh needs it)

    if not url.startswith(("https://", "http://", "file://")):
        raise ValueError("only http, https and file URLs are supported")
    request = Request(url, headers={"User-Agent": "ros-lint"})  # noqa: S310  (checked above)
    with urlopen(request, timeout=_TIMEOUT) as answer:  # noqa: S310
        data: bytes = answer.read(_MOST_BYTES + 1)
    if len(data) > _MOST_BYTES:
        raise ValueError(f"it is larger than {_MOST_BYTES >> 20} MB")
    return data


def _is_url(place: str) -> bool:
    return "://" in place


def _resolve_place(index: str, place: str) -> str:
    """Return the path or URL of a file that the rosdistro index lists.

    A relative ``place`` is relative to the folder of ``index``.
    """
    if _is_url(place) or os.path.isabs(place):
        return place
    folder = index.rpartition("/")[0] if _is_url(index) else os.path.dirname(index)
    return f"{folder}/{place}" if folder else place


def _with_mapping(place: str, document: object, key: str) -> dict[str, Any]:
    if not isinstance(document, dict) or not isinstance(document.get(key, ""), dict | None):
        raise KnowledgeError(f"{place} has no mapping {key!r}, so it is not the expected file")
    return document
