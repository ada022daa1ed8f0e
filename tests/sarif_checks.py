"""What must be so in a SARIF file that GitHub takes (reference, section 1), said anew and without the reporter's help.

It covers what the multitool's validation, GitHub's limits and a look at the sources would complain about.
"""

from __future__ import annotations

import gzip
import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote_to_bytes

import jsonschema

SCHEMA = json.loads((Path(__file__).parent / "golden" / "sarif-2.1.0.schema.json").read_text("utf-8"))
LINK = re.compile(r"(?<!\\)\[[^\]]*\]\((\d+)\)")

Tree = Callable[[str], bytes | None]
"""Gives the bytes of a file below the root, or None."""


def complaints(text: str, tree: Tree) -> list[str]:
    """Return what is wrong with a SARIF file."""
    found: list[str] = ["byte order mark"] if text.startswith("\ufeff") else []
    document = json.loads(text.removeprefix("\ufeff"), parse_constant=lambda word: found.append(f"constant {word}"))
    errors = jsonschema.Draft202012Validator(SCHEMA).iter_errors(document)
    found += [f"schema: {error.json_path}: {error.message[:100]}" for error in errors]
    return found or list(_in_document(document, text, tree))


def _in_document(document: dict[str, Any], text: str, tree: Tree) -> Iterator[str]:
    if not re.fullmatch(r"https://\S*sarif\S*2\.1\.0\S*", document.get("$schema", "")):
        yield "$schema"
    if len(gzip.compress(text.encode())) > 10_000_000:
        yield "more than 10 MB compressed"
    if re.search(r"file:/|\"/(?:home|root|tmp|work|usr)/", text):
        yield "absolute path"
    runs = document["runs"]
    if len(runs) > 20:
        yield "more than 20 runs"
    categories = [run.get("automationDetails", {}).get("id", "").rpartition("/")[0] for run in runs]
    if len(set(categories)) < len(runs) or not all(categories):
        yield "category"
    for run in runs:
        yield from _in_run(run)
        yield from _in_rules(run["tool"]["driver"])
        yield from _in_results(run, tree)


def _in_run(run: dict[str, Any]) -> Iterator[str]:
    driver = run["tool"]["driver"]
    if run.get("columnKind") != "unicodeCodePoints":
        yield "columnKind"
    if len(run.get("results", [])) > 25_000:
        yield "more than 25,000 results"
    if not run.get("invocations") or not all(entry["executionSuccessful"] for entry in run["invocations"]):
        yield "unsuccessful execution"
    if not re.fullmatch(r"\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?(\+[0-9A-Za-z.-]+)?", driver.get("semanticVersion", "")):
        yield "semanticVersion"
    if not _is_absolute(driver.get("informationUri", "")):
        yield "informationUri"
    for entry in run.get("versionControlProvenance", [{}]):
        if not _is_absolute(entry.get("repositoryUri", "")) or "uriBaseId" not in entry.get("mappedTo", {}):
            yield "versionControlProvenance"
    for base in run.get("originalUriBaseIds", {}).values():
        if "uri" in base:
            yield "a base that differs from machine to machine"
    topics = driver.get("notifications", [])
    for topic in topics:
        if not topic.get("help", {}).get("text"):
            yield f"{topic['id']} help"
    for note in run["invocations"][0].get("toolExecutionNotifications", []) if run.get("invocations") else []:
        if topics[note["descriptor"]["index"]]["id"] != note["descriptor"]["id"]:
            yield "descriptor"
        yield from _in_message(note["message"]["text"], set(), "notification")
        if "associatedRule" in note and driver["rules"][note["associatedRule"]["index"]]["id"] != note["associatedRule"]["id"]:
            yield "associatedRule"


def _in_rules(driver: dict[str, Any]) -> Iterator[str]:
    ids = [rule["id"] for rule in driver["rules"]]
    if len(set(ids)) < len(ids):
        yield "two rules of one id"
    for rule in driver["rules"]:
        properties = rule.get("properties", {})
        if "security-severity" in properties:
            yield f"{rule['id']} security-severity"
        if properties.get("precision") not in ("very-high", "high", "medium", "low"):
            yield f"{rule['id']} precision"
        if properties.get("problem.severity") not in ("error", "warning", "recommendation"):
            yield f"{rule['id']} problem.severity"
        if not 0 < len(properties.get("tags", [])) <= 10:
            yield f"{rule['id']} tags"
        for key in ("shortDescription", "fullDescription"):
            words = rule.get(key, {}).get("text", "")
            if not 0 < len(words) <= 1024 or not words.endswith("."):
                yield f"{rule['id']} {key}"
        if not re.fullmatch(r"[A-Z]+\d+", rule["id"]) or not re.fullmatch(r"(?:[A-Z][A-Za-z0-9]*)+", rule.get("name", "")):
            yield f"{rule['id']} id or name"
        if not (rule.get("help", {}).get("text") and rule["help"].get("markdown")):
            yield f"{rule['id']} help"
        if not _is_absolute(rule.get("helpUri", "")):
            yield f"{rule['id']} helpUri"
        if rule.get("defaultConfiguration", {}).get("level") not in ("error", "warning", "note"):
            yield f"{rule['id']} level"


def _in_results(run: dict[str, Any], tree: Tree) -> Iterator[str]:
    ids = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    alerts: set[tuple[str, str, str]] = set()
    for number, result in enumerate(run["results"]):
        name = f"results[{number}]"
        if ids[result["ruleIndex"]] != result["ruleId"]:
            yield f"{name} ruleIndex"
        if result.get("kind", "fail") != "fail" and result.get("level", "warning") != "none":
            yield f"{name} kind and level"
        if result.get("suppressions"):
            yield f"{name} is suppressed: GitHub shows it as open"
        if len(result["locations"]) != 1 or len(result.get("relatedLocations", [])) > 100:
            yield f"{name} locations"
        have = {location.get("id") for location in result.get("relatedLocations", [])}
        yield from _in_message(result["message"]["text"], have, name)
        flows = [flow["locations"] for code in result.get("codeFlows", []) for flow in code["threadFlows"]]
        places = [*result["locations"], *result.get("relatedLocations", []), *(s["location"] for f in flows for s in f)]
        for place in places:
            yield from _in_artifact(place["physicalLocation"]["artifactLocation"], run, name)
            if "message" in place:
                yield from _in_message(place["message"]["text"], set(), name)
        physical = result["locations"][0]["physicalLocation"]
        fingerprint = result.get("partialFingerprints", {}).get("primaryLocationLineHash", "")
        alert = (result["ruleId"], physical["artifactLocation"]["uri"], fingerprint)
        if alert in alerts or not fingerprint:
            yield f"{name} would be one alert with another"
        alerts.add(alert)
        yield from _against_source(result, physical, tree, name)


def _in_message(text: str, have: set[Any], name: str) -> Iterator[str]:
    if not text.endswith("."):
        yield f"{name} full stop"
    if missing := {int(number) for number in LINK.findall(text)} - have:
        yield f"{name} links {missing}"
    if re.search(r"(?<!\\)[\[\]]", LINK.sub("", text)):
        yield f"{name} unescaped bracket"


def _in_artifact(artifact: dict[str, Any], run: dict[str, Any], name: str) -> Iterator[str]:
    if artifact.get("uriBaseId") not in run.get("originalUriBaseIds", {}):
        yield f"{name} uriBaseId"
    if not re.fullmatch(r"(?!/)(?:[\w.~!$&'()*+,;=@/-]|%[0-9A-F]{2})+", artifact["uri"], re.ASCII) or "//" in artifact["uri"]:
        yield f"{name} uri"


def _against_source(result: dict[str, Any], physical: dict[str, Any], tree: Tree, name: str) -> Iterator[str]:
    region, context = physical["region"], physical.get("contextRegion")
    if region["startLine"] != region["endLine"]:
        yield f"{name} has several lines"
    data = tree(unquote_to_bytes(physical["artifactLocation"]["uri"]).decode("utf-8", "surrogateescape"))
    if data is None:
        if "snippet" in region:
            yield f"{name} quotes a file that is not there"
        return
    source = data.decode("utf-8", "replace").removeprefix("\ufeff")
    lines = re.split(r"\r\n|\r|\n", source)
    line = lines[region["startLine"] - 1]
    if region.get("snippet", {}).get("text") != line[region["startColumn"] - 1 : region["endColumn"] - 1]:
        yield f"{name} snippet"
    if region["endColumn"] > len(line) + 1 or region["startColumn"] > region["endColumn"]:
        yield f"{name} columns"
    if context is None or context["snippet"]["text"] not in source:
        yield f"{name} contextRegion"
    else:
        inner = ((region["startLine"], region["startColumn"]), (region["endLine"], region["endColumn"]))
        outer = ((context["startLine"], context["startColumn"]), (context["endLine"], context["endColumn"]))
        if not (outer[0] <= inner[0] and inner[1] <= outer[1] and inner != outer):
            yield f"{name} contextRegion is not around it"
    if result["partialFingerprints"].get("primaryLocationLineHash") != rolling_hashes(source)[region["startLine"] - 1]:
        yield f"{name} fingerprint"


def rolling_hashes(source: str) -> list[str]:
    """Return the hash of every line, the long way: unit by unit, each line for itself."""
    encoded = re.sub(r"\r\n?", "\n", source).encode("utf-16-le")
    units = [int.from_bytes(encoded[at : at + 2], "little") for at in range(0, len(encoded), 2)]
    units = [unit for unit in units if unit not in (9, 32)]
    starts = [0, *(at + 1 for at, unit in enumerate(units) if unit == 10)]
    units += [0xFFFF, *[0] * 100]
    seen: dict[int, int] = {}
    found = []
    for start in starts:
        value = 0
        for unit in units[start : start + 100]:
            value = (value * 37 + unit) & 0xFFFFFFFFFFFFFFFF
        seen[value] = seen.get(value, 0) + 1
        found.append(f"{value:x}:{seen[value]}")
    return found


def _is_absolute(uri: str) -> bool:
    return re.fullmatch(r"[a-z][a-z0-9+.-]*:\S+", uri) is not None


def changed(document: dict[str, Any], path: str, value: Any) -> str:
    """Return a document as text, with one value replaced, for checking the checks. ``path`` goes by dots."""
    copy = json.loads(json.dumps(document))
    *way, last = path.split(".")
    at: Any = copy
    for step in way:
        at = at[int(step)] if isinstance(at, list) else at[step]
    if isinstance(at, list):
        at[int(last)] = value
    elif value is None:
        del at[last]
    else:
        at[last.replace("|", ".")] = value
    return json.dumps(copy)
