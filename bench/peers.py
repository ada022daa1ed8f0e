"""Compare ros-lint with its peers on workspaces whose undeclared dependencies were judged by hand, and write a table.

    python bench/peers.py [--write docs/comparison.md] JUDGED.tsv=WORKSPACE...

A judged list names package, dependency, verdict and reason: ``missing`` (used, and neither declared nor brought by what
is declared, as far as anything is known of it), ``brought`` (used, and brought by what is declared), ``aside`` (used in a
file that is neither built, installed nor run), ``wrong`` (not used, or declared under another name). The tools are
taken from PATH as their documentation runs them; rosdep must be set up for package-xml-validator.
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
"""A package, and a dependency that it is said to lack."""

_MARKS = ("<!-- made by bench/peers.py: begin -->", "<!-- end -->")
_RULES = frozenset({"undeclared-dependency", "launch-outside-closure", "launch-unknown-package"})
_ERROR = re.compile(r"E(?:rror|RROR):")
_MISSING = re.compile(r"\tMissing (?:<\w+> |test )?dependencies in ([\w.-]+)/package\.xml(?:: (?P<here>.*)| compared)")


class Answer(NamedTuple):
    """What a tool said: pairs, or why there are none."""

    pairs: frozenset[Pair] | None
    reason: str = ""


def main() -> int:
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("judged", nargs="+", metavar="JUDGED.tsv=WORKSPACE")
    parser.add_argument("--write", metavar="PAGE", help="put the tables between the marks of a page, not on standard output")
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
    """Return the table of one workspace, as Markdown."""
    title, verdicts = read(judged)
    total = sum(verdict == "missing" for verdict in verdicts.values())
    lines = [
        f"### {title}",
        "",
        f"{total} dependencies are missing.",
        "",
        "| tool | found | missed | transitive | false | not judged |",
        "|---|---|---|---|---|---|",
    ]
    for name, run in TOOLS.items():
        answer = run(os.path.abspath(workspace)) if shutil.which(name.split()[0]) else Answer(None, "not installed")
        if answer.pairs is None:
            lines.append(f"| {name} | – | – | – | – | {answer.reason} |")
            continue
        count = Counter(verdicts.get(pair, "unknown") for pair in answer.pairs)
        false = count["wrong"] + count["aside"]
        correct = count["missing"]
        lines.append(f"| {name} | {correct} | {total - correct} | {count['brought']} | {false} | {count['unknown']} |")
    return "\n".join((*lines, ""))


def read(path: str) -> tuple[str, Mapping[Pair, str]]:
    """Return the title of a judged list and its verdicts."""
    with open(path, encoding="utf-8") as file:
        title, _, *rows = file.read().splitlines()
    cells = [row.split("\t") for row in rows]
    return title.lstrip("# ").partition(":")[0], {(package, name): verdict for package, name, verdict, _ in cells}


def _ros_lint(workspace: str, *more: str) -> Answer:
    done = _run("ros-lint", workspace, "--format", "json", "--fail-on", "never", "--no-cache", *more)
    findings = json.loads(done.stdout)["findings"]
    return Answer(frozenset((finding["package"], finding["subject"]) for finding in findings if finding["rule"] in _RULES))


def _validator(workspace: str) -> Answer:
    """Of package-xml-validator, the pairs of its three ways to say that something is missing."""
    arguments = ("--missing-deps-only", "--compare-with-cmake", "--strict-cmake-checking", workspace)
    done = _run("package-xml-validator", *arguments)
    output = done.stdout + done.stderr
    names = _names(workspace)
    return Answer(frozenset((package, name) for folder, name in _missing(output) for package in names.get(folder, (folder,))))


def _missing(output: str) -> Iterator[Pair]:
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


def _unable(*command: str) -> Callable[[str], Answer]:
    """Return how to run a tool that so far has never got to say anything of a package: its error or last line is the answer."""

    def run(workspace: str) -> Answer:
        done = _run(*command, ".", cwd=workspace)
        lines = [line.strip() for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        message = next((line for line in lines if _ERROR.search(line)), lines[-1] if lines else "says nothing")
        return Answer(None, message.replace("|", "/")[:120])

    return run


def _run(*command: str, cwd: str | None = None) -> subprocess.CompletedProcess[str]:
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=cwd)


TOOLS: Mapping[str, Callable[[str], Answer]] = {
    "ros-lint": _ros_lint,
    "ros-lint --pedantic": lambda workspace: _ros_lint(workspace, "--pedantic"),
    "package-xml-validator": _validator,
    "catkin_lint": _unable("catkin_lint"),
    "deptry": _unable("deptry"),
    "colcon": _unable("colcon", "lint", "--base-paths"),
}


if __name__ == "__main__":
    sys.exit(main())
