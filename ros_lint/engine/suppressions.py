"""Apply the comments that suppress findings.

``ros-lint: ignore[rule, ...] reason`` applies to its line. If the line contains only the comment, it applies to the next
line that is not a comment. ``ros-lint: ignore-file[rule, ...] reason`` applies to the whole file; only other comments may
precede it. For details, see docs/suppressions.md.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from itertools import accumulate, chain
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.suggestions import similar_names
from ros_lint.engine.former_rules import former_rule
from ros_lint.facts.suppressions import Name, Suppression, SuppressionUse, UnknownSelector, Unused, lines_of

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Iterator, Mapping

    from ros_lint.analysis.rule import Rule
    from ros_lint.base.text import Span
    from ros_lint.engine.report import Issue


class Outcome(NamedTuple):
    """The result of applying suppression comments to issues."""

    kept: tuple[Issue, ...]
    suppressed: tuple[tuple[Issue, Suppression], ...]
    use: SuppressionUse


def apply_suppressions(
    issues: Iterable[Issue], suppressions: Iterable[Suppression], all_rules: Iterable[Rule], ran: Container[str | None]
) -> Outcome:
    """Return the result of applying the suppression comments to the issues.

    ``all_rules`` are the rules that comments may name. ``ran`` has the names of the rules that ran without a crash,
    because only a suppression of these rules can be recognized as unused. Call this function before issues are hidden for
    other reasons, or else their suppressions would count as unused. Call it again for the issues that rules report about
    suppressions; then only ``kept`` of the result matters.
    """
    names = {key.lower(): rule.name for rule in all_rules for key in (rule.name, rule.code)}
    # Rules about suppressions run later, so their own suppressions cannot be judged yet.
    judged = {rule.name for rule in all_rules if rule.name in ran and not rule.suppressions}
    ordered = sorted(suppressions, key=lambda comment: comment.span.path)
    resolved = [
        (comment, [(name, names.get(name.text.lower())) for name in comment.names]) for comment in ordered if not comment.problem
    ]
    by_place: dict[tuple[str, str], list[tuple[Suppression, Name]]] = {}
    for comment, rules in resolved:
        for name, rule in rules:
            if rule is not None:
                by_place.setdefault((comment.span.path, rule), []).append((comment, name))
    indexes = {key: _LineIndex(entries) for key, entries in by_place.items()}
    kept: list[Issue] = []
    suppressed: list[tuple[Issue, Suppression]] = []
    for issue in issues:
        index = indexes.get((issue.finding.span.path, issue.rule.name))
        hits = index.matching(issue.finding.span) if index else ()
        if hits:
            suppressed.append((issue, hits[0][0]))
        else:
            kept.append(issue)
    used = {entry for index in indexes.values() for entry in index.used}
    unused = [
        (comment, tuple([name for name, rule in rules if rule in judged and (comment, name) not in used]))
        for comment, rules in resolved
    ]
    spellings = {key.lower(): key for rule in all_rules for key in (rule.name, rule.code)}
    unknown = [_unknown(comment, name, spellings) for comment, rules in resolved for name, rule in rules if rule is None]
    return Outcome(
        tuple(kept),
        tuple(suppressed),
        SuppressionUse(
            tuple([Unused(comment, unused_names) for comment, unused_names in unused if unused_names]),
            tuple(unknown),
            tuple([comment for comment in ordered if comment.problem]),
        ),
    )


class _LineIndex:
    """The suppressions of one rule in one file, indexed by line, because a file may have thousands."""

    def __init__(self, entries: Iterable[tuple[Suppression, Name]]) -> None:
        ordered = sorted(entries, key=lambda entry: _lines(entry)[0])
        self._everywhere = [entry for entry in ordered if entry[0].lines is None]
        self._entries = ordered[len(self._everywhere) :]
        self._firsts = [_lines(entry)[0] for entry in self._entries]
        # For each entry, the last line to which it or an earlier entry applies.
        self._reach = list(accumulate([_lines(entry)[1] for entry in self._entries], max))
        self._by_lines: dict[tuple[int, int], tuple[tuple[Suppression, Name], ...]] = {}

    def matching(self, span: Span) -> tuple[tuple[Suppression, Name], ...]:
        """Return the suppressions that apply to a place, each with the Name in it that refers to the rule."""
        lines = lines_of(span)
        found = self._by_lines.get(lines)
        if found is None:
            near = self._entries[bisect_left(self._reach, lines[0]) : bisect_right(self._firsts, lines[1])]
            found = tuple([entry for entry in (*self._everywhere, *near) if entry[0].covers(span)])
            self._by_lines[lines] = found
        return found

    @property
    def used(self) -> Iterator[tuple[Suppression, Name]]:
        """The suppressions that :meth:`matching` has returned; some of them several times."""
        return chain.from_iterable(self._by_lines.values())


def _lines(entry: tuple[Suppression, Name]) -> tuple[int, int]:
    """Return the lines to which a suppression applies; (0, 0), which comes before all others, for a whole file."""
    return entry[0].lines or (0, 0)


def _unknown(comment: Suppression, name: Name, spellings: Mapping[str, str]) -> UnknownSelector:
    """Return the unknown rule name in a comment, with a similar known name or the fate of a former rule.

    ``spellings`` has the names and codes of all rules, by their lower-case form.
    """
    if former := former_rule(name.text):
        return UnknownSelector(comment, name, "", former.fate)
    similar = similar_names(name.text.lower(), spellings)
    return UnknownSelector(comment, name, spellings[similar[0]] if similar else "", "")
