"""The descriptions of rules and notifications in the sarif format."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from ros_lint.analysis.finding import Severity

if TYPE_CHECKING:
    from ros_lint.analysis.rule import Rule

LEVELS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "note"}
_PROBLEMS = {Severity.ERROR: "error", Severity.WARNING: "warning", Severity.INFO: "recommendation"}
_TAGS = {"1": "workspace", "2": "dependencies", "3": "build", "4": "install", "5": "launch", "9": "ros-lint"}
_LONGEST = 1024
"""Maximum length in characters of a description that GitHub accepts."""


def descriptor(rule: Rule, index: int, url: str = "") -> dict[str, Any]:
    """Return the SARIF descriptor of a rule.

    ``index`` is the position of the rule in the list of rules of the file, from 0. ``url`` is the URL of the rule's page,
    or "".
    """
    summary = capital(rule.summary)
    markdown = rule.doc.strip()
    return {
        "id": rule.code,
        "name": "".join(word.capitalize() for word in rule.name.split("-")),
        "shortDescription": {"text": summary[:_LONGEST]},
        "fullDescription": {"text": _first_paragraph(markdown) or summary[:_LONGEST]},
        "help": {"text": _plain(markdown) or summary, "markdown": markdown or summary},
        # The help is part of this file and may be read anywhere.
        "helpUri": url or f"sarif:/runs/0/tool/driver/rules/{index}/help",
        "defaultConfiguration": {"level": LEVELS[rule.severity], "enabled": rule.default},
        "properties": {
            # Rules that run by default are right at least 99 times in 100, see Confidence.
            "precision": "very-high" if rule.default else "medium",
            "problem.severity": _PROBLEMS[rule.severity],
            "tags": ["ros2", *filter(None, (_TAGS.get(rule.code[3:4]),))],
        },
    }


def sentence(text: str) -> str:
    """Return a message with a full stop at its end.

    After a question mark, a reference to the help of the rule is added instead.
    """
    if text.endswith("?"):
        return f"{text} See the help of the rule."
    return text if text.endswith(".") else f"{text}."


def capital(text: str) -> str:
    """Return a text as a sentence with a capital letter. The text must not begin with a name, because a name must not change."""
    return sentence(f"{text[:1].upper()}{text[1:]}")


def _plain(markdown: str) -> str:
    return re.sub(r"^#+ *", "", markdown, flags=re.MULTILINE)


def _first_paragraph(markdown: str) -> str:
    """Return the first paragraph of a rule's documentation on one line, "" if there is no paragraph."""
    paragraphs = [part for part in re.split(r"\n\s*\n", markdown) if part.strip() and not part.lstrip().startswith("#")]
    text = " ".join(paragraphs[0].replace("`", "'").split()) if paragraphs else ""
    return sentence(text[: _LONGEST - 1].rstrip(":,;")) if text else ""


def _topic(code: str, name: str, short: str, advice: str) -> dict[str, Any]:
    return {
        "id": code,
        "name": name,
        "shortDescription": {"text": short},
        "fullDescription": {"text": f"{short} {advice}"},
        "help": {"text": f"{short} {advice}"},
    }


TOPICS = [
    _topic(
        "RLN001",
        "NotChecked",
        "Something could not be checked.",
        "Findings about it may be missing. The message contains the reason: fix the file, or provide what is missing.",
    ),
    _topic(
        "RLN002",
        "CheckFailed",
        "A rule failed.",
        "This is a bug in ros-lint or in a plugin; please report it. All other rules have run.",
    ),
    _topic(
        "RLN003",
        "NotShown",
        "Some findings are hidden.",
        "Findings of lower confidence are shown with --pedantic. Others are suppressed by comments or ignored by the settings.",
    ),
    _topic(
        "RLN004",
        "NotSeenThrough",
        "Parts of the workspace could not be fully analysed.",
        "Checks for missing things were skipped there. 'ros-lint explain-package NAME' lists the places.",
    ),
    _topic(
        "RLN005",
        "NoPackage",
        "No package was found.",
        "Nothing was checked. Pass the path of a workspace or package: a folder with a package.xml in it or below it.",
    ),
]
"""The SARIF descriptors of all kinds of notifications."""


def topic(name: str) -> dict[str, Any]:
    """Return the SARIF reference to the kind of notification ``name``: its id and index.

    Raises StopIteration for an unknown name.
    """
    return next({"id": entry["id"], "index": index} for index, entry in enumerate(TOPICS) if entry["name"] == name)
