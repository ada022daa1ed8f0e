"""Helpers for tests of the evaluation of CMakeLists.txt."""

from __future__ import annotations

from collections.abc import Mapping

from ros_lint.base.text import Text
from ros_lint.collectors.cmake.evaluate import evaluate
from ros_lint.collectors.cmake.evaluator.sources import Sources
from ros_lint.collectors.cmake.syntax import parse
from ros_lint.facts.build import BuildScript
from ros_lint.facts.sources import Mention
from ros_lint.facts.visibility import Facet

HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(pkg)\n"


def sources(script: str, files: Mapping[str, str] | tuple[str, ...] = (), **fields: object) -> Sources:
    texts = {"CMakeLists.txt": script, "package.xml": "", **(dict.fromkeys(files, "") if isinstance(files, tuple) else files)}
    parsed = {
        path: parse(Text(f"src/pkg/{path}", text))
        for path, text in texts.items()
        if path.endswith(("CMakeLists.txt", ".cmake", ".cmake.in"))
    }
    return Sources("pkg", "src/pkg", sorted(texts), parsed, **fields)  # type: ignore[arg-type]


def run(script: str, files: Mapping[str, str] | tuple[str, ...] = (), **fields: object) -> BuildScript:
    return evaluate(sources(HEAD + script, files, **fields), "jazzy")


def paths(script: BuildScript) -> dict[str, bool]:
    """Return the installed paths, each with whether it is conditional."""
    return {provided.path: provided.conditional for provided in script.products.installs}


def mentioned(script: BuildScript) -> dict[tuple[str, str], Mention]:
    return {(mention.via, mention.name): mention for mention in script.mentions}


def hidden(script: BuildScript) -> Facet:
    facets = Facet(0)
    for opaque in script.opaque:
        facets |= opaque.hides
    return facets
