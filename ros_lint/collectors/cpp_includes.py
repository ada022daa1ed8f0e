"""The include directives of C and C++, and which of them depend on how the source is compiled.

Exact with respect to comments, raw strings, line continuations and ``#if 0`` without lexing every file: a scan for
directives is trusted as long as none of them lies where a comment or a raw string might be. Otherwise comments and
raw strings are blanked out first, and the same scan is run again.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Set

# "#" first: the regular expression engine looks for a literal much faster than for the start of a line.
# Groups: 1 quote and 2 name of an include, 3 the macro that gives the name; 4 word and 5 condition of a conditional.
_DIRECTIVE = re.compile(
    r"""\#[ \t]*(?:(?:include(?:_next)?|import)\b[ \t]*(?:([<"])([^>"\n]+)[>"]|([A-Za-z_][^\n]*))
    |(if(?:n?def)?|el(?:if(?:n?def)?|se)|endif)\b([^\n]*))""",
    re.VERBOSE,
)
_NAMED, _COMPUTED, _CONDITIONAL = 2, 3, 5  # the last group that takes part

_HIDING = re.compile(
    r"""//(?:[^\\\n]|\\\r?\n|\\.)*
    |/\*.*?(?:\*/|\Z)
    |(?P<raw>\b(?:u8|[uUL])?R"(?P<mark>[^()\\\s]{0,16})\(.*?\)(?P=mark)")
    |"(?:[^"\\\n]|\\\r?\n|\\.)*"
    |(?<![0-9a-fA-F])'(?:[^'\\\n]|\\\r?\n|\\.)*'
    |^[ \t]*\#[ \t]*(?:include(?:_next)?|import)[ \t]*<[^>\n]+>
    |\\\r?\n""",
    re.VERBOSE | re.DOTALL | re.MULTILINE,
)
_DEFINE = re.compile(r"#[ \t]*define[ \t]+(\w+)")
_DEFINED = re.compile(r"(!?)\s*defined\s*\(?\s*(\w+)\s*\)?")

# What every C++ compiler takes the same way, whatever the build defines. Only Qt's moc, no compiler, has Q_MOC_RUN.
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
"""Headers of the C and C++ standard libraries: they belong to no package, and half of all includes name them."""


_NONE: frozenset[int] = frozenset()


class Include(NamedTuple):
    """An include directive that the preprocessor can meet."""

    start: int
    """Offset of the name."""
    name: str
    """As written, without quotes or brackets; the macro when that gives it."""
    quote: str
    """``"`` or ``<``, "" when a macro gives the name."""
    optional: bool


def includes(text: str) -> list[Include]:
    """Return the includes of a C or C++ text in order, without those of standard headers and those in ``#if 0``.

    Optional are those in a conditional, unless each of its branches includes the same folder; conditions that hold
    in every build, include guards above all, are none. Reference, section E3.9.
    """
    directives = _directives(text)
    simple = directives is not None and _is_simple(text, directives)
    if directives is None or _may_hide(text, directives, simple):
        text = blanked(text)
        directives = [match for match in _DIRECTIVE.finditer(text) if not _before(text, match.start()).strip()]
        simple = _is_simple(text, directives)
    skipped, optional = (_NONE, _NONE) if simple else _conditional(text, directives)
    found = []
    for match in directives:
        kind = match.lastindex
        if kind == _NAMED:
            name = match[2]
            if name not in STANDARD and (simple or match.start() not in skipped):
                found.append(Include(match.start(2), name, match[1], match.start() in optional))
        elif kind == _COMPUTED and match.start() not in skipped:
            found.append(Include(match.start(3), _bare(match[3]), "", match.start() in optional))
    return found


def blanked(text: str) -> str:
    """Return the text with blanks for comments and raw strings, and with continued lines joined. Offsets stay."""
    return _HIDING.sub(_blank, text)


def in_doubt(text: str, at: int) -> bool:
    """Return whether a comment or a raw string may hide an offset."""
    line = text.rfind("\n", 0, at) + 1
    return text.find("//", line, at) >= 0 or text.find('R"', 0, at) >= 0 or text.rfind("/*", 0, at) > text.rfind("*/", 0, at)


def _blank(match: re.Match[str]) -> str:
    token = match[0]
    if match["raw"]:
        return '"' * len(token)
    # A block comment is one space to the preprocessor, its line ends included.
    return " " * len(token) if token[0] in "/\\" else token.replace("\n", " ")


def _before(text: str, at: int) -> str:
    """Return what stands before an offset in its line."""
    return text[text.rfind("\n", 0, at) + 1 : at]


def _bare(line: str) -> str:
    """Return the rest of a directive's line without comments."""
    return line.partition("//")[0].partition("/*")[0].strip()


def _directives(text: str) -> list[re.Match[str]] | None:
    """Return what looks like directives, or None when a comment before one or a continued line is in the way."""
    found = []
    for match in _DIRECTIVE.finditer(text):
        line = match.start()
        if line and text[line - 1] != "\n":
            before = _before(text, line)
            if not before.isspace():
                if before.rstrip().endswith("*/"):
                    return None
                continue
            line -= len(before)
        if line > 1 and text[line - 2] in "\\\r" and text[line - 3 : line - 1].endswith(("\\", "\\\r")):
            return None
        found.append(match)
    return found


def _is_simple(text: str, directives: list[re.Match[str]]) -> bool:
    """Return whether there are no conditionals but an include guard."""
    words = [match for match in directives if match.lastindex == _CONDITIONAL]
    return not words or (len(words) == 2 and words[1][4] == "endif" and _value(text, words[0], first=True) is True)


def _may_hide(text: str, directives: list[re.Match[str]], simple: bool) -> bool:
    """Return whether a comment or a raw string may hide one of the directives that matter."""
    if simple:  # the guard does not
        directives = [match for match in directives if match.lastindex != _CONDITIONAL]
    if not directives:
        return False
    last = directives[-1].start()
    if text.find('R"', 0, last) >= 0:
        return True
    starts = iter(directives)
    start = next(starts).start()
    opened = text.find("/*", 0, last)
    while opened >= 0:
        closed = text.find("*/", opened + 2)
        while start < opened:
            start = next(starts).start()
        if start < closed or closed < 0:
            return True
        # Not past the end: what looks like one comment may be none, and then "*/*" opens the next.
        opened = text.find("/*", closed + 1, last)
    return False


class _Conditional:
    """A conditional that is open, and what its branches include so far."""

    __slots__ = ("common", "complete", "folders", "includes", "live")

    def __init__(self, value: bool | None) -> None:
        self.includes: list[tuple[int, str]] = []  # start and folder
        self.folders: set[str] = set()  # that the present branch includes whenever it is taken
        self.common: set[str] | None = None  # that every branch before does
        self.live = value is not False  # whether the present branch can be taken
        self.complete = value is True  # whether some branch is always taken

    def branch(self, value: bool | None) -> None:
        """Go to the next branch. The value of its condition is None when it depends on the build."""
        self._close()
        self.live = value is not False and not self.complete
        self.complete |= value is True

    def end(self) -> set[str]:
        """Return the folders that are included whatever the build."""
        self._close()
        return self.common if self.common and self.complete else set()

    def _close(self) -> None:
        if self.live:
            self.common = self.folders if self.common is None else self.common & self.folders
        self.folders = set()


def _conditional(text: str, directives: list[re.Match[str]]) -> tuple[Set[int], Set[int]]:
    """Return the starts of those include directives that are never reached, and of those that depend on the build."""
    skipped: set[int] = set()
    optional: set[int] = set()
    stack: list[_Conditional] = []

    def end() -> None:
        ended = stack.pop()
        sure = ended.end()
        optional.update(start for start, folder in ended.includes if folder not in sure)
        if stack:
            stack[-1].includes += ended.includes
            stack[-1].folders |= sure

    for match in directives:
        if match.lastindex != _CONDITIONAL:
            if not all(conditional.live for conditional in stack):
                skipped.add(match.start())
            elif stack:
                folder = (match[2] or "").partition("/")[0]
                stack[-1].includes.append((match.start(), folder))
                stack[-1].folders.add(folder)
        elif match[4].startswith("if"):
            stack.append(_Conditional(_value(text, match, first=match is directives[0])))
        elif stack and match[4] == "endif":
            end()
        elif stack:
            stack[-1].branch(True if match[4] == "else" else _value(text, match, first=False))
    while stack:
        end()
    return skipped, optional


def _value(text: str, match: re.Match[str], *, first: bool) -> bool | None:
    """Return whether a condition is true, None when that depends on the build. ``first``: no directive before it."""
    word, condition = match[4], _bare(match[5])
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
    # An include guard: what it holds is compiled once whatever the build, also when the two names differ by a slip.
    defined = _DEFINE.search(text, match.end(), match.end() + 400) if negated else None
    return True if defined and (first or defined[1] == macro) else None
