"""Edits of ``package.xml``: minimal, in the style of the file, comments kept.

They are computed from the places in a :class:`Manifest` alone, because rules do not have the text. What is between the
elements is known from ``Manifest.asides``, so all other lines are known to be blank. Every edit applies to the text
that the manifest was read from. If the text is not well-formed, the edits are based on the part that could be read.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import groupby, pairwise
from typing import Final, NamedTuple

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span
from ros_lint.collectors.manifest.xml import escaped
from ros_lint.facts.manifest import Depend, Element, Manifest

_HABIT: Final = (
    *("buildtool_depend", "buildtool_export_depend", "depend", "build_depend", "build_export_depend", "exec_depend"),
    *("run_depend", "test_depend", "doc_depend", "conflict", "replace", "group_depend", "member_of_group"),
)
"""The order of dependency tags in most manifests. The schemas only require the last two to be last."""

_GROUPS = ("group_depend", "member_of_group")

SCHEMA_ORDER: Final = ("name", "version", "description", "maintainer", "license", "url", "author", "", *_GROUPS, "export")
"""The order of tags in the schemas of REP 127, 140 and 149; "" is the place of all dependency tags."""


def schema_rank(tag: str) -> int:
    """Return the position of a tag in :data:`SCHEMA_ORDER`."""
    return SCHEMA_ORDER.index(tag) if tag in SCHEMA_ORDER else SCHEMA_ORDER.index("")


def add(manifest: Manifest, tag: str, name: str) -> Edit:
    """Return the edit that declares a dependency without attributes.

    The new tag is added to the tags of its kind, in alphabetical order if these are sorted. If there are none, it is
    placed by the usual order of kinds, separated by a blank line if the file does so.
    """
    return _put(_Layout(manifest), manifest.depends, tag, name, f"<{tag}>{escaped(name)}</{tag}>")


def _put(layout: _Layout, depends: Sequence[Depend], tag: str, name: str, element: str) -> Edit:
    """Return the edit that inserts an element for a dependency next to those of its kind."""
    order = name if _is_sorted(depends, tag) else ""
    return _place(layout, depends, tag, order, element)._replace(kind=_HABIT.index(tag) + 1, order=order)


def _is_sorted(depends: Sequence[Depend], tag: str) -> bool:
    """Return whether the dependencies of a kind are sorted by name, or all others if it has less than two."""
    names: dict[str, list[str]] = {}
    for depend in depends:
        names.setdefault(depend.tag, []).append(depend.name)
    several = {kind: names_of_kind for kind, names_of_kind in names.items() if len(names_of_kind) > 1}
    asked = [several[tag]] if tag in several else list(several.values())
    return bool(asked) and all(names_of_kind == sorted(names_of_kind) for names_of_kind in asked)


def _place(layout: _Layout, depends: Sequence[Depend], tag: str, order: str, element: str) -> Edit:
    """Return the edit for an element at the place of ``order``, the name if names are sorted, else ""."""
    manifest = layout.manifest
    siblings = [depend for depend in depends if depend.tag == tag]
    if siblings:
        before = [depend for depend in siblings if depend.name < order] if order else siblings
        return layout.after(before[-1].span, element) if before else layout.before(siblings[0].span, element)
    if depends:
        apart = layout.kinds_apart()
        if tag in _GROUPS:
            return layout.after(depends[-1].span, element, apart=apart)
        rank = _HABIT.index(tag)
        lower = [depend for depend in depends if _HABIT.index(depend.tag) < rank]
        if lower:
            last = max(lower, key=lambda depend: (_HABIT.index(depend.tag), depend.span))
            return layout.after(last.span, element, apart=apart)
        return layout.before(layout.with_heading(depends[0].span), element, apart=apart)
    head = [child for child in manifest.elements if child.tag != "export"]
    if head:
        return layout.after(head[-1].span, element, apart=layout.blank_after(head[-1].span))
    if manifest.elements:
        return layout.before(manifest.elements[0].span, element)
    return layout.last(element)


def remove(manifest: Manifest, depend: Depend) -> Edit:
    """Return the edit that removes a dependency, with its line if nothing else is on it.

    Comments are kept.
    """
    return _Layout(manifest).removal(depend.span)


def rename(depend: Depend, name: str) -> Edit:
    """Return the edit that changes the name in a dependency."""
    if not depend.name:
        return Edit(depend.span, _written(depend._replace(name=name)))
    return Edit(depend.name_span, escaped(name))


def change_kind(manifest: Manifest, depend: Depend, tag: str, alike: Collection[Depend]) -> tuple[Edit, ...]:
    """Return the edits that change the kind of a dependency. It must have another kind before.

    If the file groups dependencies by kind, it is moved to its new kind. Otherwise its place is kept. The place is also
    kept if a whole group changes to a kind that does not exist yet; ``alike`` are the dependencies that change to the
    same kind.
    """
    depends = manifest.depends
    runs = [list(run) for _, run in groupby(depends, key=lambda sibling: sibling.tag)]
    row = next(run for run in runs if depend in run)
    kinds = {sibling.tag for sibling in depends}
    whole = tag not in kinds and all(sibling in alike for sibling in row)
    layout = _Layout(manifest)
    if len(runs) > len(kinds) or whole or not layout.alone(depend.span) or not _is_verbatim(depend):
        return change_tag(depend, tag)
    remaining = [sibling for sibling in depends if sibling is not depend]
    return (_put(layout, remaining, tag, depend.name, _written(depend._replace(tag=tag))), layout.removal(depend.span))


def change_tag(depend: Depend, tag: str) -> tuple[Edit, ...]:
    """Return the edits that change the kind of a dependency without moving it."""
    span, old = depend.span, len(depend.tag)
    if not depend.close:
        return (Edit(span, _written(depend._replace(tag=tag))),)
    column = span.end_column - depend.close + 2
    return (
        Edit(Span(span.path, span.line, span.column + 1, span.line, span.column + 1 + old), tag),
        Edit(Span(span.path, span.end_line, column, span.end_line, column + old), tag),
    )


def set_build_type(manifest: Manifest, build_type: str) -> Edit:
    """Return the edit that adds a build type to a manifest without one, in ``<export>``."""
    layout, newline, indent = _Layout(manifest), manifest.newline, manifest.indent
    element = f"<build_type>{escaped(build_type)}</build_type>"
    whole = f"<export>{newline}{indent * 2}{element}{newline}{indent}</export>"
    export = next((child for child in manifest.elements if child.tag == "export"), None)
    if export is None:
        if not manifest.elements and not manifest.depends:
            return layout.last(whole)
        last = max(children[-1].span for children in (manifest.elements, manifest.depends) if children)
        apart = layout.kinds_apart() if manifest.depends else layout.blank_after(last)
        return layout.after(last, whole, apart=apart)._replace(kind=len(_HABIT) + 1)
    content = export.text_span
    if content.start() == content.end():
        return Edit(export.span, whole)
    if content.line == export.span.line:
        return Edit(content.start(), element)
    between = ("\t" if indent.startswith("\t") else " ") * (content.column - 1)
    return Edit(content.start(), f"{element}{newline}{between}")


def raise_format(manifest: Manifest, form: int) -> Edit:
    """Return the edit that changes the format of a manifest. It must have a ``<package>``."""
    if manifest.format_span is not None:
        return Edit(manifest.format_span, str(form))
    begin = manifest.begin or manifest.end
    before = begin._replace(column=begin.column - 1, end_column=begin.column - 1)
    return Edit(before, f' format="{form}"')


def sort(manifest: Manifest) -> tuple[Edit, ...]:
    """Return the edits that sort the children of ``<package>`` by the schemas, with the fewest moves.

    Empty if they are sorted, or if an element would have to move that shares its line, has a comment, or cannot be
    written again without its text.
    """
    children: list[Element | Depend] = sorted((*manifest.elements, *manifest.depends), key=lambda child: child.span)
    ranks = [schema_rank(child.tag) for child in children]
    kept = _longest_ascent(ranks)
    moved = [child for at, child in enumerate(children) if at not in kept]
    stay = [child for at, child in enumerate(children) if at in kept]
    layout = _Layout(manifest)
    if not moved or not all(layout.alone(child.span) and _is_verbatim(child) for child in moved):
        return ()
    edits: list[Edit] = []
    for child in sorted(moved, key=lambda child: schema_rank(child.tag)):
        before = [sibling for sibling in stay if schema_rank(sibling.tag) <= schema_rank(child.tag)]
        written = _written(child)
        edits.append(layout.after(before[-1].span, written) if before else layout.before(stay[0].span, written))
    return (*edits, *layout.removals([child.span for child in moved]))


class _Line(NamedTuple):
    """The items that share the first and the last line of an element."""

    before: Span | None
    after: Span | None


class _Layout:
    """The lines of a manifest and the items on them."""

    def __init__(self, manifest: Manifest) -> None:
        self.manifest = manifest
        self.path = manifest.path
        self.begin = manifest.begin or manifest.end
        spans = (child.span for children in (manifest.elements, manifest.depends) for child in children)
        self.items = sorted((*spans, *manifest.asides))
        self.covered = {self.begin.line, manifest.end.line}
        for item in self.items:
            self.covered.update(range(item.line, item.end_line + 1))

    def neighbours(self, span: Span) -> _Line:
        """Return the item that ends on the first line of an item, and the item that starts on its last line."""
        at = self.items.index(span)
        previous = self.items[at - 1] if at else self.begin
        following = self.items[at + 1] if at + 1 < len(self.items) else self.manifest.end
        return _Line(previous if previous.end_line == span.line else None, following if following.line == span.end_line else None)

    def alone(self, span: Span) -> bool:
        """Return whether an item shares no line with another one and has no comment directly above it."""
        at = self.items.index(span)
        heading = at > 0 and self.items[at - 1] in self.manifest.asides and self.items[at - 1].end_line == span.line - 1
        return self.neighbours(span) == (None, None) and not heading

    def after(self, span: Span, element: str, *, apart: bool = False) -> Edit:
        """Return the edit that inserts an element after an item and the comments on its line."""
        tail = span
        while (following := self.neighbours(tail).after) is not None and following in self.manifest.asides:
            tail = following
        if following is not None:
            # Several elements of one kind on a line are a habit. Two kinds are a mistake, unless everything is on one
            # line.
            tags = {depend.span: depend.tag for depend in self.manifest.depends}
            slip = self.neighbours(span).before is None and tags.get(span) != tags.get(following)
            return Edit(span.end(), f"{self.manifest.newline}{self._indent(span)}{element}" if slip else element)
        blank = self.manifest.newline if apart else ""
        place = Span(self.path, tail.end_line + 1, 1, tail.end_line + 1, 1)
        return Edit(place, f"{blank}{self._indent(span)}{element}{self.manifest.newline}")

    def before(self, span: Span, element: str, *, apart: bool = False) -> Edit:
        """Return the edit that inserts an element before an item."""
        if self.neighbours(span).before is not None:
            return Edit(span.start(), element)
        blank = self.manifest.newline if apart else ""
        place = Span(self.path, span.line, 1, span.line, 1)
        return Edit(place, f"{self._indent(span)}{element}{self.manifest.newline}{blank}")

    def last(self, element: str) -> Edit:
        """Return the edit that inserts an element into a package without any."""
        end, newline = self.manifest.end, self.manifest.newline
        if end.line == self.begin.line:
            return Edit(end, f"{newline}{self.manifest.indent}{element}{newline}")
        place = Span(self.path, end.line, 1, end.line, 1)
        return Edit(place, f"{self.manifest.indent}{element}{newline}")

    def removal(self, span: Span) -> Edit:
        """Return the edit that removes an item without a trace."""
        before, after = self.neighbours(span)
        path = self.path
        if before is not None:
            return Edit(Span(path, before.end_line, before.end_column, span.end_line, span.end_column), "")
        if after is not None:
            return Edit(Span(path, span.line, span.column, after.line, after.column), "")
        return self._lines_out(span.line, span.end_line)

    def removals(self, spans: Iterable[Span]) -> Iterator[Edit]:
        """Yield the edits that remove items that share no lines, in the order of the file."""
        runs: list[list[int]] = []
        for span in spans:
            if runs and runs[-1][1] == span.line - 1:
                runs[-1][1] = span.end_line
            else:
                runs.append([span.line, span.end_line])
        return (self._lines_out(first, last) for first, last in runs)

    def _lines_out(self, first: int, last: int) -> Edit:
        """Return the edit that removes lines, with adjacent blank lines that have nothing left to separate."""
        end = last + 1
        while self._is_blank(first - 1) and self._is_blank(end):
            end += 1
        while end == self.manifest.end.line and self._is_blank(first - 1):
            first -= 1
        return Edit(Span(self.path, first, 1, end, 1), "")

    def with_heading(self, span: Span) -> Span:
        """Return the span from the first of the comments directly above an item to the item."""
        at = self.items.index(span)
        while at and self.items[at - 1] in self.manifest.asides and self.items[at - 1].end_line == span.line - 1:
            if self.neighbours(self.items[at - 1]).before is not None:
                break
            at -= 1
            span = self.items[at]
        return span

    def blank_after(self, span: Span) -> bool:
        """Return whether a blank line follows an item and the comments on its line."""
        while (following := self.neighbours(span).after) is not None and following in self.manifest.asides:
            span = following
        return self._is_blank(span.end_line + 1)

    def kinds_apart(self) -> bool:
        """Return whether blank lines separate the kinds of dependencies, or the only kind from other elements."""
        depends = self.manifest.depends
        changes = [(depend.span, following.span) for depend, following in pairwise(depends) if depend.tag != following.tag]
        if changes:
            return 2 * sum(
                any(map(self._is_blank, range(depend.end_line, following.line))) for depend, following in changes
            ) > len(changes)
        return self._is_blank(self.with_heading(depends[0].span).line - 1) and self.blank_after(depends[-1].span)

    def _is_blank(self, line: int) -> bool:
        return self.begin.line < line < self.manifest.end.line and line not in self.covered

    def _indent(self, span: Span) -> str:
        """Return the white space before an item, or the usual indentation if it does not start its line."""
        usual = self.manifest.indent
        width = span.column - 1
        if self.neighbours(span).before is not None or width == len(usual):
            return usual
        return ("\t" if usual.startswith("\t") or width == 1 else " ") * width


def _written(child: Element | Depend) -> str:
    """Return an element in its usual notation."""
    if isinstance(child, Depend):
        condition = (("condition", child.condition),) if child.condition else ()
        return _tagged(child.tag, (*child.versions, *condition), child.name)
    return _tagged(child.tag, child.attributes, child.text)


def _tagged(tag: str, attributes: Iterable[tuple[str, str]], text: str) -> str:
    written = "".join(f' {name}="{escaped(value).replace(chr(34), "&quot;")}"' for name, value in attributes)
    return f"<{tag}{written}>{escaped(text)}</{tag}>"


def _is_verbatim(child: Element | Depend) -> bool:
    """Return whether :func:`_written` reproduces a child, except for quotes and the order of attributes."""
    span = child.span
    if child.tag in ("description", "export") or span.line != span.end_line:
        return False
    return len(_written(child)) == span.end_column - span.column


def _longest_ascent(ranks: list[int]) -> frozenset[int]:
    """Return the indexes of a longest subsequence in which ranks never decrease."""
    chains: list[tuple[int, int]] = []  # by index: length of the longest run that ends here, previous index
    longest: dict[int, int] = {}  # by rank: the index at which the longest run with this last rank ends
    for at, rank in enumerate(ranks):
        length, previous = max(((chains[i][0], i) for lower, i in longest.items() if lower <= rank), default=(0, -1))
        chains.append((length + 1, previous))
        if rank not in longest or chains[longest[rank]][0] <= length:
            longest[rank] = at
    at = max(longest.values(), key=lambda i: chains[i], default=-1)
    kept = set()
    while at >= 0:
        kept.add(at)
        at = chains[at][1]
    return frozenset(kept)
