"""Edits of ``package.xml``: they are minimal, follow the style of the file and keep comments.

The edits are computed from the spans in a :class:`Manifest` alone, because rules do not have the text of the file.
A line is blank if it has no element, and no comment or text of ``Manifest.other_contents``. Every edit applies to the
text from which the manifest was read. If the text is not well-formed, the edits are based on the part that could be
read.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import groupby, pairwise
from typing import Final, NamedTuple

from ros_lint.base.edit import Edit
from ros_lint.base.text import Span
from ros_lint.collectors.manifest.xml import escaped
from ros_lint.facts.manifest import Depend, Element, Manifest

_USUAL_ORDER: Final = (
    *("buildtool_depend", "buildtool_export_depend", "depend", "build_depend", "build_export_depend", "exec_depend"),
    *("run_depend", "test_depend", "doc_depend", "conflict", "replace", "group_depend", "member_of_group"),
)
"""The order of dependency tags in most manifests. The schemas require only that the last two tags are last."""

_GROUPS = ("group_depend", "member_of_group")

SCHEMA_ORDER: Final = ("name", "version", "description", "maintainer", "license", "url", "author", "", *_GROUPS, "export")
"""The order of tags in the schemas of REP 127, 140 and 149. The entry "" represents all dependency tags."""


def schema_rank(tag: str) -> int:
    """Return the position of a tag in :data:`SCHEMA_ORDER`. Dependency tags and unknown tags have the position of ""."""
    return SCHEMA_ORDER.index(tag) if tag in SCHEMA_ORDER else SCHEMA_ORDER.index("")


def add(manifest: Manifest, tag: str, name: str) -> Edit:
    """Return the edit that adds the dependency ``<tag>name</tag>`` to a manifest.

    The dependency is added to the dependencies with the same tag, in alphabetical order if these are sorted. If the manifest has
    no such dependency, it is placed by the usual order of tags, and a blank line is added if blank lines separate other tags.
    """
    return _insert_by_kind(_layout(manifest), manifest.depends, tag, name, f"<{tag}>{escaped(name)}</{tag}>")


def _insert_by_kind(layout: _Layout, depends: Sequence[Depend], tag: str, name: str, element: str) -> Edit:
    """Return the edit that inserts ``element``, the text of a dependency, next to the dependencies with the tag ``tag``."""
    order = name if _is_sorted(depends, tag) else ""
    return _insert_by_order(layout, depends, tag, order, element)._replace(kind=_USUAL_ORDER.index(tag) + 1, order=order)


def _is_sorted(depends: Sequence[Depend], tag: str) -> bool:
    """Return whether the dependencies with ``tag`` are sorted by name.

    If fewer than two dependencies have ``tag``, the dependencies of every other tag are checked instead. The result is False if
    no tag has two dependencies.
    """
    names: dict[str, list[str]] = {}
    for depend in depends:
        names.setdefault(depend.tag, []).append(depend.name)
    groups = {kind: names_of_kind for kind, names_of_kind in names.items() if len(names_of_kind) > 1}
    compared = [groups[tag]] if tag in groups else list(groups.values())
    return bool(compared) and all(names_of_kind == sorted(names_of_kind) for names_of_kind in compared)


def _insert_by_order(layout: _Layout, depends: Sequence[Depend], tag: str, order: str, element: str) -> Edit:
    """Return the edit that inserts ``element``, the text of a dependency with ``tag``.

    ``order`` is the name of the dependency if the dependencies with ``tag`` are sorted by name, else "".
    """
    manifest = layout.manifest
    siblings = [depend for depend in depends if depend.tag == tag]
    if siblings:
        predecessors = [depend for depend in siblings if depend.name < order] if order else siblings
        return (
            layout.insert_after(predecessors[-1].span, element)
            if predecessors
            else layout.insert_before(siblings[0].span, element)
        )
    if depends:
        blank_line = layout.kinds_apart()
        if tag in _GROUPS:
            return layout.insert_after(depends[-1].span, element, blank_line=blank_line)
        rank = _USUAL_ORDER.index(tag)
        earlier = [depend for depend in depends if _USUAL_ORDER.index(depend.tag) < rank]
        if earlier:
            last = max(earlier, key=lambda depend: (_USUAL_ORDER.index(depend.tag), depend.span))
            return layout.insert_after(last.span, element, blank_line=blank_line)
        return layout.insert_before(layout.with_heading(depends[0].span), element, blank_line=blank_line)
    head = [child for child in manifest.elements if child.tag != "export"]
    if head:
        return layout.insert_after(head[-1].span, element, blank_line=layout.blank_after(head[-1].span))
    if manifest.elements:
        return layout.insert_before(manifest.elements[0].span, element)
    return layout.insert_last(element)


def remove(manifest: Manifest, depend: Depend) -> Edit:
    """Return the edit that removes a dependency, and its line if nothing else is on the line. Comments are kept."""
    return _layout(manifest).removal(depend.span)


def rename(depend: Depend, name: str) -> Edit:
    """Return the edit that replaces the package name in a dependency by ``name``."""
    if not depend.name:
        return Edit(depend.span, _element_text(depend._replace(name=name)))
    return Edit(depend.name_span, escaped(name))


def change_kind(manifest: Manifest, depend: Depend, tag: str, alike: Collection[Depend]) -> tuple[Edit, ...]:
    """Return the edits that change the tag of a dependency, for example from ``depend`` to ``exec_depend``.

    ``tag`` must differ from the present tag. ``alike`` are all dependencies that one fix changes to ``tag``. If the file groups
    dependencies by tag, the dependency is moved to the group of its new tag. It stays in place
    - if its whole group changes to a tag that the file does not have yet, or
    - if it is not alone on its line, has a comment, or has source text that ros-lint would write differently.
    """
    depends = manifest.depends
    runs = [list(run) for _, run in groupby(depends, key=lambda sibling: sibling.tag)]
    run = next(run for run in runs if depend in run)
    kinds = {sibling.tag for sibling in depends}
    is_whole_group = tag not in kinds and all(sibling in alike for sibling in run)
    layout = _layout(manifest)
    if len(runs) > len(kinds) or is_whole_group or not layout.is_alone(depend.span) or not _is_verbatim(depend):
        return change_tag(depend, tag)
    remaining = [sibling for sibling in depends if sibling is not depend]
    return (
        _insert_by_kind(layout, remaining, tag, depend.name, _element_text(depend._replace(tag=tag))),
        layout.removal(depend.span),
    )


def change_tag(depend: Depend, tag: str) -> tuple[Edit, ...]:
    """Return the edits that replace the tag of a dependency by ``tag``, in place."""
    span, tag_length = depend.span, len(depend.tag)
    if not depend.close:
        return (Edit(span, _element_text(depend._replace(tag=tag))),)
    column = span.end_column - depend.close + 2
    return (
        Edit(Span(span.path, span.line, span.column + 1, span.line, span.column + 1 + tag_length), tag),
        Edit(Span(span.path, span.end_line, column, span.end_line, column + tag_length), tag),
    )


def set_build_type(manifest: Manifest, build_type: str) -> Edit:
    """Return the edit that adds ``<build_type>`` to a manifest without build type, and ``<export>`` if it is missing."""
    layout, newline, indent = _layout(manifest), manifest.newline, manifest.indent
    element = f"<build_type>{escaped(build_type)}</build_type>"
    export_element = f"<export>{newline}{indent * 2}{element}{newline}{indent}</export>"
    export = next((child for child in manifest.elements if child.tag == "export"), None)
    if export is None:
        if not manifest.elements and not manifest.depends:
            return layout.insert_last(export_element)
        last = max(children[-1].span for children in (manifest.elements, manifest.depends) if children)
        blank_line = layout.kinds_apart() if manifest.depends else layout.blank_after(last)
        return layout.insert_after(last, export_element, blank_line=blank_line)._replace(kind=len(_USUAL_ORDER) + 1)
    content = export.text_span
    if content.start() == content.end():
        return Edit(export.span, export_element)
    if content.line == export.span.line:
        return Edit(content.start(), element)
    return Edit(content.start(), f"{element}{newline}{' ' * (content.column - 1)}")


def raise_format(manifest: Manifest, format_number: int) -> Edit:
    """Return the edit that sets the attribute ``format`` of ``<package>``. The manifest must have this element."""
    if manifest.format_span is not None:
        return Edit(manifest.format_span, str(format_number))
    begin = manifest.begin or manifest.end
    position = begin._replace(column=begin.column - 1, end_column=begin.column - 1)
    return Edit(position, f' format="{format_number}"')


def sort(manifest: Manifest) -> tuple[Edit, ...]:
    """Return the edits that sort the children of ``<package>`` as the schema requires, with as few moves as possible.

    The result is empty if the children are sorted, or if an element that has to move

    - is on a line with another element,
    - has a comment, or
    - has source text that ros-lint would write differently, such as the markup in ``<description>``.
    """
    children: list[Element | Depend] = sorted((*manifest.elements, *manifest.depends), key=lambda child: child.span)
    ranks = [schema_rank(child.tag) for child in children]
    kept_indexes = _longest_ascent(ranks)
    moved_children = [child for at, child in enumerate(children) if at not in kept_indexes]
    kept_children = [child for at, child in enumerate(children) if at in kept_indexes]
    layout = _layout(manifest)
    if not moved_children or not all(layout.is_alone(child.span) and _is_verbatim(child) for child in moved_children):
        return ()
    edits: list[Edit] = []
    for child in sorted(moved_children, key=lambda child: schema_rank(child.tag)):
        predecessors = [sibling for sibling in kept_children if schema_rank(sibling.tag) <= schema_rank(child.tag)]
        text = _element_text(child)
        edits.append(
            layout.insert_after(predecessors[-1].span, text)
            if predecessors
            else layout.insert_before(kept_children[0].span, text)
        )
    return (*edits, *layout.removals([child.span for child in moved_children]))


class _Neighbours(NamedTuple):
    """The items next to an element on its lines: before it on its first line, and after it on its last line.

    An item is an element, a dependency, a comment or a text. It is None if the element is first or last on the line.
    """

    before: Span | None
    after: Span | None


def _layout(manifest: Manifest) -> _Layout:
    """Return the lines of a manifest with their items. The last result is cached, because a rule may edit each dependency."""
    if not (_LAST and _LAST[0].manifest is manifest):
        _LAST[:] = [_Layout(manifest)]
    return _LAST[0]


class _Layout:
    """The lines of a manifest and the items on them: elements, dependencies, comments and texts."""

    def __init__(self, manifest: Manifest) -> None:
        self.manifest = manifest
        self.path = manifest.path
        self.begin = manifest.begin or manifest.end
        spans = (child.span for children in (manifest.elements, manifest.depends) for child in children)
        self.items = sorted((*spans, *manifest.other_contents))
        self.positions = {item: number for number, item in reversed(list(enumerate(self.items)))}
        self.other_contents = frozenset(manifest.other_contents)
        self.covered = {line for item in self.items for line in range(item.line, item.end_line + 1)}

    def neighbours(self, span: Span) -> _Neighbours:
        """Return the items (elements or comments) next to an item: before it on its first line, after it on its last line."""
        at = self.positions[span]
        previous = self.items[at - 1] if at else self.begin
        following = self.items[at + 1] if at + 1 < len(self.items) else self.manifest.end
        return _Neighbours(
            previous if previous.end_line == span.line else None, following if following.line == span.end_line else None
        )

    def is_alone(self, span: Span) -> bool:
        """Return whether no other element, comment or text is on the lines of an item, and no comment is directly above it."""
        at = self.positions[span]
        heading = at > 0 and self.items[at - 1] in self.other_contents and self.items[at - 1].end_line == span.line - 1
        return self.neighbours(span) == (None, None) and not heading

    def insert_after(self, span: Span, element: str, *, blank_line: bool = False) -> Edit:
        """Return the edit that inserts ``element`` after the element at ``span`` and the comments on its line."""
        tail = span
        while (following := self.neighbours(tail).after) is not None and following in self.other_contents:
            tail = following
        if following is not None:
            # Several elements of one kind on a line are a style, which is kept. Different kinds are separated, unless
            # everything is on one line.
            tags = {depend.span: depend.tag for depend in self.manifest.depends}
            is_mixed = self.neighbours(span).before is None and tags.get(span) != tags.get(following)
            return Edit(span.end(), f"{self.manifest.newline}{self._indent(span)}{element}" if is_mixed else element)
        blank = self.manifest.newline if blank_line else ""
        place = Span(self.path, tail.end_line + 1, 1, tail.end_line + 1, 1)
        return Edit(place, f"{blank}{self._indent(span)}{element}{self.manifest.newline}")

    def insert_before(self, span: Span, element: str, *, blank_line: bool = False) -> Edit:
        """Return the edit that inserts ``element`` before the element or comment at ``span``."""
        if self.neighbours(span).before is not None:
            return Edit(span.start(), element)
        blank = self.manifest.newline if blank_line else ""
        place = Span(self.path, span.line, 1, span.line, 1)
        return Edit(place, f"{self._indent(span)}{element}{self.manifest.newline}{blank}")

    def insert_last(self, element: str) -> Edit:
        """Return the edit that inserts ``element`` into a ``<package>`` without elements."""
        end, newline = self.manifest.end, self.manifest.newline
        if end.line == self.begin.line:
            return Edit(end, f"{newline}{self.manifest.indent}{element}{newline}")
        place = Span(self.path, end.line, 1, end.line, 1)
        return Edit(place, f"{self.manifest.indent}{element}{newline}")

    def removal(self, span: Span) -> Edit:
        """Return the edit that removes the element at ``span``, and its line if nothing else is on the line."""
        previous, following = self.neighbours(span)
        path = self.path
        if previous is not None:
            return Edit(Span(path, previous.end_line, previous.end_column, span.end_line, span.end_column), "")
        if following is not None:
            return Edit(Span(path, span.line, span.column, following.line, following.column), "")
        return self._remove_lines(span.line, span.end_line)

    def removals(self, spans: Iterable[Span]) -> Iterator[Edit]:
        """Yield the edits that remove elements, which must be alone on their lines. ``spans`` are in the order of the file."""
        runs: list[list[int]] = []
        for span in spans:
            if runs and runs[-1][1] == span.line - 1:
                runs[-1][1] = span.end_line
            else:
                runs.append([span.line, span.end_line])
        return (self._remove_lines(first, last) for first, last in runs)

    def _remove_lines(self, first: int, last: int) -> Edit:
        """Return the edit that removes the lines from ``first`` to ``last``, and blank lines that become superfluous."""
        end = last + 1
        while self._is_blank(first - 1) and self._is_blank(end):
            end += 1
        while end == self.manifest.end.line and self._is_blank(first - 1):
            first -= 1
        return Edit(Span(self.path, first, 1, end, 1), "")

    def with_heading(self, span: Span) -> Span:
        """Return the span of the first comment directly above an element, the span of the element if there is no comment."""
        at = self.positions[span]
        while at and self.items[at - 1] in self.other_contents and self.items[at - 1].end_line == span.line - 1:
            if self.neighbours(self.items[at - 1]).before is not None:
                break
            at -= 1
            span = self.items[at]
        return span

    def blank_after(self, span: Span) -> bool:
        """Return whether a blank line follows an element and the comments on its line."""
        while (following := self.neighbours(span).after) is not None and following in self.other_contents:
            span = following
        return self._is_blank(span.end_line + 1)

    def kinds_apart(self) -> bool:
        """Return whether blank lines separate most pairs of adjacent dependencies with different tags.

        If all dependencies have one tag, the result is whether blank lines separate them from the other elements.
        """
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
        """Return the indentation of an element, or the usual indentation if the element does not begin its line."""
        usual = self.manifest.indent
        width = span.column - 1
        if self.neighbours(span).before is not None or width == len(usual):
            return usual
        return ("\t" if usual.startswith("\t") or width == 1 else " ") * width


def _element_text(child: Element | Depend) -> str:
    """Return the XML source of an element or dependency in the form that ros-lint writes."""
    if isinstance(child, Depend):
        condition = (("condition", child.condition),) if child.condition else ()
        return _tagged(child.tag, (*child.versions, *condition), child.name)
    return _tagged(child.tag, child.attributes, child.text)


def _tagged(tag: str, attributes: Iterable[tuple[str, str]], text: str) -> str:
    attribute_text = "".join(f' {name}="{escaped(value).replace(chr(34), "&quot;")}"' for name, value in attributes)
    return f"<{tag}{attribute_text}>{escaped(text)}</{tag}>"


def _is_verbatim(child: Element | Depend) -> bool:
    """Return whether :func:`_element_text` returns the source of ``child``, except for quotes and the order of attributes."""
    span = child.span
    if child.tag in ("description", "export") or span.line != span.end_line:
        return False
    return len(_element_text(child)) == span.end_column - span.column


def _longest_ascent(ranks: list[int]) -> frozenset[int]:
    """Return the indexes of a longest subsequence of ``ranks`` that never decreases: [5, 1, 2] -> {1, 2}."""
    chains: list[tuple[int, int]] = []  # by index: length of the longest run that ends here, previous index
    longest: dict[int, int] = {}  # by rank: the index at which the longest run with this last rank ends
    for at, rank in enumerate(ranks):
        length, previous = max(((chains[i][0], i) for lower, i in longest.items() if lower <= rank), default=(0, -1))
        chains.append((length + 1, previous))
        if rank not in longest or chains[longest[rank]][0] <= length:
            longest[rank] = at
    at = max(longest.values(), key=lambda i: chains[i], default=-1)
    indexes = set()
    while at >= 0:
        indexes.add(at)
        at = chains[at][1]
    return frozenset(indexes)


_LAST: Final[list[_Layout]] = []
"""The lines and items of the manifest that was edited last, [] if no manifest was edited."""
