"""
## What it finds

- A remapping of a name to itself. If the launch file has an argument of that name, `$(var name)` was probably intended.
- A remapping that cannot be parsed: an empty name, or a name with white space.
- A remapping of a name that is no topic, service or action of the node, with medium confidence. Only nodes of the workspace
  count whose code uses no other packages that create topics, and that names all its topics with literals.

## Why it matters

A remapping to itself does nothing: it is unnecessary, or one of the two names is wrong. A remapping that cannot be parsed stops
the node: `Couldn't parse remap rule`.

## How to fix it

Remove the remapping, or correct the name.

## Limitations

- Not reported: names that come from an argument or are computed in another way.
- Not reported: launch files of tests and examples.
- The confidence is medium if no argument has the name, because such remappings often list the topics of a node on purpose.
"""

from __future__ import annotations

from collections.abc import Iterator

from ros_lint.api import Confidence, Consequence, Finding, LaunchValue, Package, Rule, Severity, Span, Workspace, launch


def check(package: Package, workspace: Workspace) -> Iterator[Finding]:
    for launch_file in launch.package_launch_files(package):
        actions = list(launch.walk_actions(launch_file.file.actions))
        declarations = [action.target for action in actions if action.kind == "argument" and action.target is not None]
        arguments = {name for target in declarations for name in target.texts}
        findings: dict[Span, Finding] = {}  # a function that creates nodes may be called several times
        for action in actions:
            pairs = list(action.remappings)
            if action.kind == "remap" and action.target is not None and action.value is not None:
                pairs.append((action.target, action.value))
            for before, after in pairs:
                for finding in _of_pair(before, after, arguments):
                    findings.setdefault(finding.span, finding)
        for unused in launch.unused_remappings(launch_file.file, workspace):
            hint = f"; did you mean '{unused.meant}'?" if unused.meant else ", so it has no effect; remove it or correct the name"
            finding = Finding(
                f"'{unused.target}' uses no topic or service '{unused.value.texts[0]}'{hint}",
                unused.value.span,
                unused.value.texts[0],
                confidence=Confidence.MEDIUM,
            )
            findings.setdefault(finding.span, finding)
        yield from findings.values()


def _of_pair(before: LaunchValue, after: LaunchValue, arguments: set[str]) -> Iterator[Finding]:
    for side, value in (("from", before), ("to", after)):
        if len(value.texts) == 1 and launch.is_plain(value.texts[0]) and _is_invalid(value.texts[0]):
            yield Finding(
                f"a remapping {side} {value.texts[0]!r}, which is not a valid name, stops the node; correct or remove it",
                value.span,
                before.texts[0],
                severity=Severity.ERROR,
            )
            return
    if before.exact and after.exact and before.texts == after.texts:
        name = before.texts[0]
        is_argument = name in arguments
        remedy = f"did you mean the value of the argument '{name}'?" if is_argument else "remove the remapping or correct a name"
        yield Finding(
            f"'{name}' is remapped to itself, which does nothing; {remedy}",
            after.span,
            name,
            confidence=Confidence.HIGH if is_argument else Confidence.MEDIUM,
            severity=Severity.WARNING if is_argument else None,
            explains=(Consequence("launch-unused-argument", name),) if is_argument else (),
        )


def _is_invalid(name: str) -> bool:
    return not name.strip() or any(letter.isspace() for letter in name.strip())


RULE = Rule(
    name="remap-no-effect",
    code="ROS512",
    summary="remappings have an effect",
    severity=Severity.INFO,
    since="0.1",
    doc=__doc__,
    package=check,
)
