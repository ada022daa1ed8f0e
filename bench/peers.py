"""Compare ros-lint with similar tools on workspaces whose undeclared dependencies were judged by hand.

    python bench/peers.py [--write docs/comparison.md] JUDGED.tsv=WORKSPACE...

A line of a judged list has package, dependency, verdict and reason. The verdicts are:

- ``missing``: used, but neither declared nor installed by a declared dependency, as far as this is known,
- ``transitive``: used and installed by a declared dependency,
- ``unbuilt``: used only in files that are neither built, installed nor run,
- ``wrong``: not used, or declared under another name.

The tools are searched in PATH and run as their documentation says. package-xml-validator needs an initialized rosdep.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple
from xml.etree import ElementTree

Pair = tuple[str, str]
"""A package, and a dependency that a tool reports as missing in it."""

_MARKS = ("<!-- made by bench/peers.py: begin -->", "<!-- end -->")
_RULES = frozenset({"undeclared-dependency", "launch-outside-closure", "launch-unknown-package"})
_MISSING = re.compile(r"\tMissing (?:<\w+> |test )?dependencies in ([\w.-]+)/package\.xml(?:: (?P<here>.*)| compared)")


class Findings(NamedTuple):
    """The pairs that a tool reports; None if it cannot check the workspace, with the reason."""

    pairs: frozenset[Pair] | None
    reason: str = ""


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("judged", nargs="+", metavar="JUDGED.tsv=WORKSPACE")
    parser.add_argument("--write", metavar="PAGE", help="page to write the tables into, between its marks")
    options = parser.parse_args()
    tables = "\n".join(table(*pair.split("=", 1)) for pair in options.judged)
    if not options.write:
        print(tables)
        return 0
    with open(options.write, encoding="utf-8") as file:
        before, _, rest = file.read().partition(_MARKS[0])
    after = rest.partition(_MARKS[1])[2]
    with open(options.write, "w", encoding="utf-8") as file:
        file.write(f"{before}{_MARKS[0]}\n{tables}\n{_MARKS[1]}{after}")
    return 0


def table(judged: str, workspace: str) -> str:
    """Return the Markdown table for a workspace. ``judged`` is the path of its judged list."""
    title, verdicts = read(judged)
    total = sum(verdict == "missing" for verdict in verdicts.values())
    lines = [
        f"## {title}",
        "",
        f"{total} dependencies are missing.",
        "",
        "| tool | found | missed | transitive | false | not judged |",
        "|---|---|---|---|---|---|",
    ]
    for name, run in TOOLS.items():
        result = run(os.path.abspath(workspace)) if shutil.which(name.split()[0]) else Findings(None, "not installed")
        if result.pairs is None:
            lines.append(f"| {name} | – | – | – | – | {result.reason} |")
            continue
        count = Counter(verdicts.get(pair, "unknown") for pair in result.pairs)
        false = count["wrong"] + count["unbuilt"]
        correct = count["missing"]
        lines.append(f"| {name} | {correct} | {total - correct} | {count['transitive']} | {false} | {count['unknown']} |")
    return "\n".join((*lines, ""))


def read(path: str) -> tuple[str, Mapping[Pair, str]]:
    """Return the title of a judged list, and the verdict of each pair."""
    with open(path, encoding="utf-8") as file:
        title, _, *rows = file.read().splitlines()
    cells = [row.split("\t") for row in rows]
    return title.lstrip("# ").partition(":")[0], {(package, name): verdict for package, name, verdict, _ in cells}


def _ros_lint(workspace: str, *options: str) -> Findings:
    process = _run("ros-lint", workspace, "--format", "json", "--fail-on", "never", "--no-cache", *options)
    findings = json.loads(process.stdout)["findings"]
    return Findings(frozenset((finding["package"], finding["subject"]) for finding in findings if finding["rule"] in _RULES))


def _validator(workspace: str) -> Findings:
    """Return the pairs that package-xml-validator reports in any of its three messages about missing dependencies."""
    arguments = ("--missing-deps-only", "--compare-with-cmake", "--strict-cmake-checking", workspace)
    process = _run("package-xml-validator", *arguments)
    output = process.stdout + process.stderr
    names = _names(workspace)
    return Findings(frozenset((package, name) for folder, name in _missing(output) for package in names.get(folder, (folder,))))


def _missing(output: str) -> Iterator[Pair]:
    """Yield the pairs in the output of package-xml-validator, with the folder in place of the package."""
    folder = ""
    for line in output.splitlines():
        match = _MISSING.match(line)
        if match and match["here"]:
            yield from ((match[1], name.strip()) for name in match["here"].split(","))
        elif folder and line.startswith("\t\t"):
            yield folder, line.strip()
            continue
        folder = match[1] if match and not match["here"] else ""


def _names(workspace: str) -> dict[str, list[str]]:
    """Return the names of packages by the names of their folders."""
    names_of: dict[str, list[str]] = {}
    for folder, _, files in os.walk(workspace):
        if "package.xml" in files:
            name = ElementTree.parse(os.path.join(folder, "package.xml")).getroot().findtext("name") or ""
            names_of.setdefault(os.path.basename(folder), []).append(name.strip())
    return names_of


def _without_findings(*command: str, output: str, reason: str) -> Callable[[str], Findings]:
    """Return a function that runs a tool that reports nothing about ROS 2 packages.

    Its result has ``reason`` if the tool prints ``output``, else the last line of the tool.
    """

    def run(workspace: str) -> Findings:
        process = _run(*command, ".", cwd=workspace)
        lines = [line.strip() for line in (process.stdout + process.stderr).splitlines() if line.strip()]
        if any(output in line for line in lines):
            return Findings(None, reason)
        return Findings(None, (lines[-1] if lines else "no output").replace("|", "/")[:120])

    return run


def _run(*command: str, cwd: str | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=cwd)


TOOLS: Mapping[str, Callable[[str], Findings]] = {
    "ros-lint": _ros_lint,
    "ros-lint --pedantic": lambda workspace: _ros_lint(workspace, "--pedantic"),
    "package-xml-validator": _validator,
    "catkin_lint": _without_findings(
        "catkin_lint", output="no packages to check", reason="not applicable: checks packages of ROS 1"
    ),
    "deptry": _without_findings(
        "deptry", output="DependencySpecificationNotFoundError", reason="not applicable: reads pyproject.toml only"
    ),
    "colcon": _without_findings(
        "colcon",
        "lint",
        "--base-paths",
        output="No module named 'launch'",
        reason="not run: colcon-lint needs an installation of ROS",
    ),
}


if __name__ == "__main__":
    sys.exit(main())
