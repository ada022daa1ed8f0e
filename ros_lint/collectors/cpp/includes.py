"""The include directives of C and C++, and which of them depend on the build.

Directives in comments, in raw strings and under ``#if 0`` do not count. Most files need no lexing: a file is searched for
directives, and if a directive may be in a comment or a raw string, these are replaced by blanks and the search is repeated.
"""

from __future__ import annotations

import re
from bisect import bisect_left, bisect_right
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from ros_lint.base.text import Span
from ros_lint.facts.sources import Mention

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence, Set

    from ros_lint.base.text import Text

# "#" first: the regular expression engine searches a literal much faster than the start of a line.
# Groups: 1 is empty if characters precede "#" on its line, or the line is a continuation; 2 quote and 3 name of an include;
# 4 macro that expands to the name; 5 word and 6 condition of a conditional.
_DIRECTIVE = re.compile(
    r"""\#(?:(?<=[^\\\r]\n\#)|())[ \t]*
    (?:(?:include(?:_next)?|import)\b[ \t]*(?:([<"])([^<>"\n]+)[>"]|([A-Za-z_][^\n]*))
    |(if(?:n?def)?|el(?:if(?:n?def)?|se)|endif)\b([^\n]*))""",
    re.VERBOSE,
)
_NAMED, _COMPUTED, _CONDITIONAL = 3, 4, 6  # the last group that matches

_TOKENS = re.compile(
    r"""//(?:[^\\\n]|\\(?:\r\n|.))*
    |/\*.*?(?:\*/|\Z)
    |(?P<raw>\b(?:u8|[uUL])?R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)")
    |"(?:[^"\\\n]|\\(?:\r\n|.))*"
    |(?<![0-9a-fA-F])'(?:[^'\\\n]|\\(?:\r\n|.))*'
    |^[ \t]*\#[ \t]*(?:include(?:_next)?|import)[ \t]*<[^>\n]+>
    |\\\r?\n""",
    re.VERBOSE | re.DOTALL | re.MULTILINE,
)
_MARKS = ("//", "/*", 'R"', "\\\n", "\\\r")
"""The beginnings of what :func:`blank_comments` replaces."""
# The rarer character is first, because the regular expression engine searches a literal fast.
_RAW = re.compile(r'"(?<=R")([^()\\\s]{0,16})\(')
_COMMENT = re.compile(r"\*(?<=/\*)")
_DEFINE = re.compile(r"#[ \t]*define[ \t]+(\w+)")
_DEFINED = re.compile(r"(!?)\s*defined\s*\(?\s*(\w+)\s*\)?")

# Macros that have one value in every C++ compiler and build. Only Qt's moc, no compiler, has Q_MOC_RUN.
_ALWAYS_DEFINED = frozenset({"__cplusplus"})
_NEVER_DEFINED = frozenset({"Q_MOC_RUN"})

_STANDARD = (
    "algorithm any array atomic barrier bit bitset cassert cctype cerrno cfenv cfloat charconv chrono cinttypes "
    "climits clocale cmath codecvt compare complex concepts condition_variable coroutine csetjmp csignal cstdarg "
    "cstdbool cstddef cstdint cstdio cstdlib cstring ctime cuchar cwchar cwctype deque exception execution "
    "expected filesystem format forward_list fstream functional future generator initializer_list iomanip ios "
    "iosfwd iostream istream iterator latch limits list locale map mdspan memory memory_resource mutex new "
    "numbers numeric optional ostream print queue random ranges ratio regex scoped_allocator semaphore set "
    "shared_mutex source_location span spanstream sstream stack stacktrace stdexcept stdfloat stop_token "
    "streambuf string string_view strstream syncstream system_error thread tuple type_traits typeindex typeinfo "
    "unordered_map unordered_set utility valarray variant vector version "
    "assert.h complex.h ctype.h errno.h fenv.h float.h inttypes.h iso646.h limits.h locale.h math.h setjmp.h "
    "signal.h stdalign.h stdarg.h stdatomic.h stdbool.h stddef.h stdint.h stdio.h stdlib.h stdnoreturn.h "
    "string.h tgmath.h threads.h time.h uchar.h wchar.h wctype.h"
)
STANDARD = frozenset(_STANDARD.split())
"""Headers of the C and C++ standard libraries; about half of all includes name one of them."""


_NONE: frozenset[int] = frozenset()
_make = tuple.__new__


class Include(NamedTuple):
    """An include directive that the preprocessor may reach."""

    start: int
    """The offset of the name of the header."""
    name: str
    """The name of the header without quotes or brackets, or the macro that expands to the name."""
    quote: str
    """``"`` or ``<``, or "" if a macro expands to the name."""
    optional: bool


class IncludeScan(NamedTuple):
    """The result of scanning the directives of a source."""

    mentions: list[Mention]
    """The includes of headers that are named without a macro, in order."""
    code: list[int]
    """The offsets of the includes, which are certainly code: neither in a comment nor in a string."""
    computed: list[Include]
    """Includes whose name is a macro."""
    directives: list[re.Match[str]]
    """The directives for :func:`branches`. Empty if no directive is conditional, or only an include guard is."""


def scan_includes(source: Text) -> IncludeScan:
    """Return the includes of a C or C++ source, without standard headers and without includes in ``#if 0``.

    An include between ``#if`` and ``#endif`` is optional, unless each branch includes a header from the same folder. A condition
    that holds in every build, such as an include guard, does not make an include optional.
    """
    return _scan_fast(source) or scan_exactly(source)


def scan_exactly(source: Text) -> IncludeScan:
    """Return the includes of a C or C++ source like :func:`scan_includes`, but by a slower method that suits every text."""
    text = blank_comments(source.text)
    directives = [match for match in _DIRECTIVE.finditer(text) if not _before(text, match.start()).strip()]
    guarded = _is_guarded(text, directives)
    includes = _includes(text, directives, guarded)
    named = [item for item in includes if item.quote]
    spans = source.spans([(item.start, item.start + len(item.name)) for item in named])
    return IncludeScan(
        [_mention(item.name, span, item.quote, item.optional) for item, span in zip(named, spans, strict=True)],
        [item.start for item in named],
        [item for item in includes if not item.quote],
        [] if guarded else directives,
    )


def _mention(name: str, span: Span, quote: str, optional: bool) -> Mention:
    quotation = f"#include <{name}>" if quote == "<" else f'#include "{name}"'
    return _make(Mention, (name, "include", span, quotation, optional, False, ""))


def _scan_fast(source: Text) -> IncludeScan | None:
    """Return the includes by one scan that does not remove comments, None if the result may be wrong.

    It may be wrong if a directive may be in a comment or a raw string, or if the name of an include is a macro.
    """
    text, path = source.text, source.path
    if "\r" in text and text.count("\r") != text.count("\r\n"):
        return None
    count = text.count
    result: list[Mention] = []
    starts: list[int] = []
    directives: list[re.Match[str]] = []
    conditional = False
    line, at = 1, 0
    for match in _DIRECTIVE.finditer(text):
        hash_offset = match.start()
        is_irregular = match[1] is not None
        if is_irregular and not (may_be_directive := _may_be_directive(text, hash_offset)):
            if may_be_directive is None:
                return None
            continue
        directives.append(match)
        if match.lastindex == _NAMED:
            name, quotation, name_column, width = _parse_include(match[0])
            if name:
                line += count("\n", at, hash_offset)
                at = hash_offset
                column = name_column + (len(_before(text, hash_offset)) if is_irregular else 0)
                span = _make(Span, (path, line, column, line, column + width))
                result.append(_make(Mention, (name, "include", span, quotation, False, False, "")))
                starts.append(hash_offset)
        elif match.lastindex == _CONDITIONAL:
            conditional = True
        else:
            return None
    guarded = not conditional or _is_guarded(text, directives)
    if starts and not guarded:
        if _may_hide(text, [match.start() for match in directives]):
            return None
        return IncludeScan(*_mark_conditional(text, directives, result, starts), [], directives)
    if _may_hide(text, starts):
        return None
    return IncludeScan(result, starts, [], [] if guarded else directives)


@cache
def _parse_include(directive: str) -> tuple[str, str, int, int]:
    """Return the header in an include directive: its name, the directive, and the column and the length of the name.

    ``#include  <a.h>`` -> ``("a.h", "#include <a.h>", 12, 3)``. The result for a standard header is ``("", "", 0, 0)``.
    Results are cached, because packages include the same headers repeatedly.
    """
    match = _DIRECTIVE.match(directive)
    assert match is not None
    name = match[_NAMED]
    if name in STANDARD:
        return "", "", 0, 0
    quotation = f"#include <{name}>" if match[2] == "<" else f'#include "{name}"'
    return name, quotation, match.start(_NAMED) + 1, len(name)


def _mark_conditional(
    text: str, directives: list[re.Match[str]], mentions: list[Mention], starts: list[int]
) -> tuple[list[Mention], list[int]]:
    """Return the includes outside ``#if 0``, and their offsets. Includes that depend on the build become optional."""
    skipped, optional = _conditional(text, directives)
    rows = [
        (mention._replace(optional=True) if start in optional else mention, start)
        for mention, start in zip(mentions, starts, strict=True)
        if start not in skipped
    ]
    return [mention for mention, _ in rows], [start for _, start in rows]


def _includes(text: str, directives: list[re.Match[str]], guarded: bool) -> list[Include]:
    skipped, optional = (_NONE, _NONE) if guarded else _conditional(text, directives)
    result = []
    for match in directives:
        at = match.start()
        if match[_NAMED]:
            start, name, quote = match.start(_NAMED), match[_NAMED], match[2]
        elif match[_COMPUTED]:
            start, name, quote = match.start(_COMPUTED), _without_comments(match[_COMPUTED]), ""
        else:
            continue
        if name not in STANDARD and at not in skipped:
            result.append(Include(start, name, quote, at in optional))
    return result


def blank_comments(text: str) -> str:
    """Return the text with blanks for comments, quotes for raw strings, and continued lines joined.

    Offsets are unchanged.
    """
    return _TOKENS.sub(_blank, text) if any(mark in text for mark in _MARKS) else text


def blank_comments_near(text: str, places: Iterable[int], code: Sequence[int]) -> str:
    """Return the text like :func:`blank_comments`, but at least in the 500 characters after each of the offsets ``places``.

    ``code`` has sorted offsets that are certainly outside of comments and strings. If a place may be in a comment, the
    comments of the whole text are blanked.
    """
    starts = sorted(places)
    if may_be_comments(text, starts, code):
        return blank_comments(text)
    parts, end = [], 0
    for at, near in _joined(starts):
        parts += [text[end:at], blank_comments(text[at:near])]
        end = near
    return "".join([*parts, text[end:]])


def _joined(starts: Sequence[int]) -> list[tuple[int, int]]:
    """Return the ranges of 500 characters from each of the sorted offsets, with overlapping ranges joined."""
    result: list[tuple[int, int]] = []
    for at in starts:
        first = result.pop()[0] if result and at <= result[-1][1] else at
        result.append((first, at + 500))
    return result


def may_be_comments(text: str, places: Sequence[int], code: Sequence[int]) -> bool:
    """Return whether one of the sorted offsets ``places`` may be in a comment or a raw string.

    ``code`` has sorted offsets that are certainly outside of comments and strings.
    """
    clear = sorted([*code, *places])  # each place is checked after those before it
    return any(may_be_comment(text, at, clear) for at in places)


def may_be_comment(text: str, at: int, code: Sequence[int] = ()) -> bool:
    """Return whether an offset may be in a comment or a raw string.

    ``code`` has sorted offsets that are certainly outside of comments and strings.
    """
    clear = last_before(code, at)
    return (
        text.find("//", text.rfind("\n", 0, at) + 1, at) >= 0
        or _RAW.search(text, clear, at) is not None
        or (_COMMENT.search(text, clear, at) is not None and text.rfind("/*", clear, at) > text.rfind("*/", clear, at))
    )


def last_before(offsets: Sequence[int], at: int) -> int:
    """Return the last of the sorted offsets before ``at``, 0 if there is none."""
    position = bisect_left(offsets, at)
    return offsets[position - 1] if position else 0


def _blank(match: re.Match[str]) -> str:
    token = match[0]
    if match["raw"]:
        return '"' * len(token)
    # A block comment is one space for the preprocessor, including its line ends.
    return " " * len(token) if token[0] in "/\\" else token.replace("\n", " ")


def _before(text: str, at: int) -> str:
    """Return the text between the start of the line and the offset ``at``."""
    return text[text.rfind("\n", 0, at) + 1 : at]


def _without_comments(line: str) -> str:
    """Return the operand of a directive without a comment after it: ``DEBUG  // only here`` -> ``DEBUG``."""
    return line.partition("//")[0].partition("/*")[0].strip()


def _may_be_directive(text: str, at: int) -> bool | None:
    """Return whether the ``#`` at an offset begins a directive, because only blanks precede it in its line.

    The result is None if a comment or a continued line precedes the ``#``, so that an exact scan must decide.
    """
    before = _before(text, at)
    if before and not before.isspace():
        return None if before.rstrip().endswith("*/") else False
    line = at - len(before)
    continued = line > 1 and text[line - 2] in "\\\r" and text[line - 3 : line - 1].endswith(("\\", "\\\r"))
    return None if continued else True


def _is_guarded(text: str, directives: list[re.Match[str]]) -> bool:
    """Return whether a file has no ``#if`` and the like, or only an include guard or a condition that always holds."""
    conditionals = [match for match in directives if match.lastindex == _CONDITIONAL]
    if len(conditionals) != 2:
        return not conditionals
    begin, end = conditionals
    return end[5] == "endif" and (text.startswith(f"\n#define{begin[6]}", begin.end()) or _value(text, begin, first=True) is True)


def _may_hide(text: str, starts: Sequence[int]) -> bool:
    """Return whether any of the offsets ``starts`` may be in a comment or a raw string."""
    if not starts:
        return False
    last = starts[-1]
    raw = _RAW.search(text, 0, last)
    while raw:
        if _any_between(starts, raw.start(), text.find(f'){raw[1]}"', raw.end())):
            return True
        # The search continues inside the match, because it may not really be a string or comment.
        raw = _RAW.search(text, raw.start() + 1, last)
    comment = _COMMENT.search(text, 0, last)
    while comment:
        if _any_between(starts, comment.start(), text.find("*/", comment.end())):
            return True
        comment = _COMMENT.search(text, comment.end(), last)
    return False


def _any_between(starts: Sequence[int], begin: int, end: int) -> bool:
    """Return whether one of the sorted offsets ``starts`` is between ``begin`` and ``end``; -1 as ``end`` means no limit."""
    at = bisect_right(starts, begin)
    return at < len(starts) and (end < 0 or starts[at] < end)


class _Conditional:
    """An ``#if`` whose ``#endif`` was not read yet, and the includes in its branches so far."""

    __slots__ = ("common", "complete", "folders", "includes", "live")

    def __init__(self, value: bool | None) -> None:
        self.includes: list[tuple[int, str]] = []  # start and folder
        self.folders: set[str] = set()  # included by the current branch whenever it is taken
        self.common: set[str] | None = None  # included by every earlier branch
        self.live = value is not False  # whether the current branch can be taken
        self.complete = value is True  # whether a branch is always taken

    def branch(self, value: bool | None) -> None:
        """Begin the next branch at ``#elif`` or ``#else``.

        ``value`` is the value of the branch's condition, None if the condition depends on the build.
        """
        self._close()
        self.live = value is not False and not self.complete
        self.complete |= value is True

    def end(self) -> set[str]:
        """End the conditional at its ``#endif``, and return the folders from which all of its branches include headers."""
        self._close()
        return self.common if self.common and self.complete else set()

    def _close(self) -> None:
        if self.live:
            self.common = self.folders if self.common is None else self.common & self.folders
        self.folders = set()


def _conditional(text: str, directives: list[re.Match[str]]) -> tuple[Set[int], Set[int]]:
    """Return the offsets of include directives in two sets: directives that no build reads, and that only some builds read."""
    skipped: set[int] = set()
    optional: set[int] = set()
    stack: list[_Conditional] = []

    def end() -> None:
        ended = stack.pop()
        always_included = ended.end()
        optional.update(start for start, folder in ended.includes if folder not in always_included)
        if stack:
            stack[-1].includes += ended.includes
            stack[-1].folders |= always_included

    for match in directives:
        if match.lastindex != _CONDITIONAL:
            start = match.start()
            if not all(conditional.live for conditional in stack):
                skipped.add(start)
            elif stack:
                folder = (match[_NAMED] or "").partition("/")[0]
                stack[-1].includes.append((start, folder))
                stack[-1].folders.add(folder)
        elif match[5].startswith("if"):
            stack.append(_Conditional(_value(text, match, first=match is directives[0])))
        elif stack and match[5] == "endif":
            end()
        elif stack:
            stack[-1].branch(True if match[5] == "else" else _value(text, match, first=False))
    while stack:
        end()
    return skipped, optional


def branches(text: str, directives: list[re.Match[str]]) -> list[range]:
    """Return the offset ranges of the branches of ``#if`` that are compiled in some builds only, or in none."""
    result = []
    stack: list[tuple[bool, int]] = []  # whether the branch is always taken, and where it begins
    for match in directives:
        if match.lastindex != _CONDITIONAL:
            continue
        if match[5].startswith("if"):
            stack.append((_value(text, match, first=match is directives[0]) is True, match.end()))
        elif stack:
            always, begin = stack.pop()
            if not always:
                result.append(range(begin, match.start()))
            if match[5] != "endif":
                stack.append((False, match.end()))
    return [*result, *(range(begin, len(text)) for always, begin in stack if not always)]


def _value(text: str, match: re.Match[str], *, first: bool) -> bool | None:
    """Return the value of the condition of an ``#if`` or ``#elif`` directive, or None if it depends on the build.

    ``first`` is True if no directive precedes this directive in the file.
    """
    word, condition = match[5], _without_comments(match[6])
    if word in ("if", "elif"):
        bare = condition.strip("() ")
        if bare in ("0", "false"):
            return False
        if bare.isdigit() or bare == "true":
            return True
        tested = _DEFINED.fullmatch(condition)
        if tested is None:
            return None
        negated, macro = bool(tested[1]), tested[2]
    else:
        negated, macro = "ndef" in word, condition
    if macro in _ALWAYS_DEFINED:
        return not negated
    if macro in _NEVER_DEFINED:
        return negated
    # An include guard: its content is compiled once in every build, even if the two names differ by mistake.
    defined = _DEFINE.search(text, match.end(), match.end() + 400) if negated else None
    return True if defined and (first or defined[1] == macro) else None
