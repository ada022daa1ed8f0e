"""Read rule files of rosdep (``base.yaml``, ``python.yaml`` ...; REP 111) as rosdep's resolver does."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ros_lint.knowledge.rosdep import LETTERS, RosdepKey
from ros_lint.knowledge.store import KnowledgeError

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

_KNOWN_INSTALLERS = "apt dnf gem homebrew macports npm opkg pacman pip portage slackpkg snap source yum zypper"
_INSTALLERS = frozenset(_KNOWN_INSTALLERS.split())
_APT = ("ubuntu", "debian")
_ONLY_OSX = frozenset({"osx"})


def keys(files: Iterable[tuple[str, object]]) -> dict[str, RosdepKey]:
    """Return the rosdep keys in rule files. ``files`` are pairs of the path or URL of a file and its parsed contents.

    The files are in the order of rosdep's list of sources. If several files have a rule for a key, the first rule counts;
    but a rule for macOS only is combined with the rules for other systems. Raises KnowledgeError for a file without
    rules.
    """
    merged: dict[str, dict[str, object]] = {}
    for place, rules in files:
        if not isinstance(rules, dict):
            raise KnowledgeError(f"{place} is not a file of rosdep rules")
        for name, rule in rules.items():
            if not isinstance(rule, dict):
                raise KnowledgeError(f"{place}: the rule of '{name}' is not a mapping from systems")
            known_rule = merged.get(str(name), {})
            if known_rule.keys() <= _ONLY_OSX:
                merged[str(name)] = {**rule, **known_rule}
    # A package for Linux cannot use a key that exists on macOS only.
    return {name: _key(name, rule) for name, rule in merged.items() if rule.keys() - _ONLY_OSX}


def _key(name: str, rule: Mapping[str, object]) -> RosdepKey:
    platforms = tuple(platform for platform in LETTERS.values() if _resolve(rule, platform) is not None)
    apt = {
        package
        for platform in platforms
        if platform.partition(":")[0] in _APT
        for installer, package in _resolve(rule, platform) or ()
        if installer in ("apt", "")
    }
    return RosdepKey(name, platforms, tuple(sorted(apt)), tuple(sorted(set(_pip(rule)))))


def _pip(rule: object) -> Iterator[str]:
    """Yield the pip packages of a rule for any platform."""
    if isinstance(rule, dict):
        for name, inside in rule.items():
            if name == "pip":
                yield from _words(inside.get("packages", ()) if isinstance(inside, dict) else inside)
            else:
                yield from _pip(inside)


def _resolve(rule: Mapping[str, object], platform: str) -> tuple[tuple[str, str], ...] | None:
    """Return pairs of installer and package for a platform; None if the rule has no entry for the platform.

    The installer is "" if the rule names none. The default installer of the platform is then used.
    """
    system, _, version = platform.partition(":")
    entry = rule[system] if system in rule else rule.get("*")
    for _ in range(3):  # the version, the installer, its packages
        if isinstance(entry, dict):
            if entry.keys() & _INSTALLERS:
                break
            entry = entry[version] if version in entry else entry.get("*")
    if isinstance(entry, dict):
        installer = sorted(entry.keys() & _INSTALLERS)
        if not installer:
            return None
        inside = entry[installer[0]]
        packages = inside.get("packages", ()) if isinstance(inside, dict) else inside
        return tuple((installer[0], name) for name in _words(packages))
    return None if entry is None else tuple(("", name) for name in _words(entry))


def _words(packages: object) -> list[str]:
    if isinstance(packages, str):
        return packages.split()
    return [str(name) for name in packages] if isinstance(packages, list) else []
