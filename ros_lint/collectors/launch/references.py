"""References to packages and files, computed from the actions of a launch file."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from operator import attrgetter
from posixpath import normpath
from types import MappingProxyType

from ros_lint.base.text import Span
from ros_lint.collectors import symbolic_text as launch_text
from ros_lint.collectors.launch.default_configurations import default_configurations
from ros_lint.collectors.launch.expressions import evaluate
from ros_lint.collectors.launch.path_values import Reads, values_of
from ros_lint.collectors.launch.presence_checks import EVERYWHERE, distributions_under, is_guarded_by_presence
from ros_lint.collectors.symbolic_text import (
    UNKNOWN,
    Installed,
    carriers_of_places,
    configurations,
    fill,
    installed,
    is_plain,
    is_settled,
    names_places,
    runs_xacro,
    share,
)
from ros_lint.facts.launch import LaunchAction, LaunchCondition, LaunchReference, LaunchValue, ReferenceKind
from ros_lint.facts.visibility import Facet, Opaque, Problem

_COMMANDS: Mapping[tuple[str, ...], str] = {
    ("ros2", "bag"): "ros2bag",
    ("ros2", "control"): "ros2controlcli",
    ("ros2", "trace"): "ros2trace",
}
"""The packages that provide the ros2 commands which ros2cli_common_extensions does not include."""


_PREFIXES = frozenset({"gnome-terminal", "konsole", "screen", "terminator", "tmux", "valgrind", "xterm"})
"""System programs that wrap the start of a node. Each name is also a rosdep key."""


class References:
    """The references of the actions of a launch file in the order of the file, and the opaque places."""

    def __init__(self, actions: Iterable[LaunchAction], places: Mapping[str, Span] = MappingProxyType({})) -> None:
        """Read actions. ``places`` are the package look-ups, by package or by the text that computes it."""
        self.found: dict[LaunchReference, None] = {}
        self.opaque: dict[Opaque, None] = {}
        self.problems: dict[Problem, None] = {}
        self._places = {package: span for package, span in places.items() if is_settled(package)}
        actions = tuple(actions)
        self._held = default_configurations(actions)
        self._carriers = carriers_of_places(self._held.values)
        self._known: dict[str, tuple[str, ...]] = {}
        self._narrowed: Mapping[str, tuple[str, ...]] = {}
        self._asks = self._lent = False
        self._distros = EVERYWHERE
        self._named_in: dict[tuple[str, Span], frozenset[str]] = {}
        self._named: set[str] = set()
        asked = [(text, span) for text, span in places.items() if not is_settled(text)]
        self._computed = {package: span for text, span in asked for package in self._fill(text)}
        for action in actions:
            self._action(action, conditional=False)

    def _action(self, action: LaunchAction, conditional: bool) -> None:
        if not action.conditions and not action.builtin_model:
            self._taken(action, conditional)
            return
        with self._under(action.conditions, lent=action.builtin_model) as somewhere:
            if somewhere:
                self._taken(action, conditional or bool(action.conditions))

    @contextmanager
    def _under(self, conditions: Sequence[LaunchCondition], *, lent: bool = False) -> Iterator[bool]:
        """Apply conditions, or mark actions of a model, for a block. Yields whether any distribution remains."""
        before = self._asks, self._distros, self._narrowed, self._known, self._lent
        self._lent = lent
        self._asks = self._asks or is_guarded_by_presence(conditions)
        self._distros &= distributions_under(conditions)
        self._narrow(conditions)
        try:
            yield bool(self._distros)
        finally:
            self._asks, self._distros, self._narrowed, self._known, self._lent = before

    def _taken(self, action: LaunchAction, conditional: bool) -> None:
        match action.kind:
            case "node" | "component":
                self._program(action, conditional)
            case "include":
                self._include(action, conditional)
            case "process":
                self._process(action, conditional)
        for name, value in action.arguments:
            if name == "prefix":
                self._prefix(value, conditional)
        for value, reads in values_of(action):
            if _is_dull(value.texts, self._carriers):
                continue
            if not value.conditions:
                self._paths(value, action.package_span, conditional, reads)
                continue
            with self._under(value.conditions, lent=self._lent) as somewhere:
                if somewhere:
                    self._paths(value, action.package_span, conditional=True, reads=reads)
        for child in action.children:
            self._action(child, conditional)

    def _program(self, action: LaunchAction, conditional: bool) -> None:
        kind: ReferenceKind = "node" if action.kind == "node" else "component"
        if action.package is None:
            if action.target is not None:
                self._paths(action.target, action.package_span, conditional)
            return
        packages, package_default = self._filled(action.package)
        names, name_default = self._filled(action.target) if action.target is not None else ((UNKNOWN,), False)
        conditional = conditional or len(packages) * len(names) > 1
        self._named.update(packages)
        for package in packages:
            if not is_plain(package) or not package:
                self.hide(f"the package of a {kind} is computed", action.package.span)
                continue
            for name in names if len(packages) == 1 or len(names) == 1 else (UNKNOWN,):
                if action.target is not None and is_plain(name) and name:
                    default = package_default or name_default
                    self._add(kind, package, name, action.target, action.package, conditional, default, package_default)
                else:
                    self._add(
                        "package", package, "", action.package, action.package, conditional, package_default, package_default
                    )

    def _include(self, action: LaunchAction, conditional: bool) -> None:
        target = action.target
        if target is None:
            return
        texts, default = self._filled(target)
        for text in texts:
            places = [place for place in installed(text) if place.known]
            self._run_on(places, target)
            conditional = conditional or len(texts) > 1
            for place in places:
                span = self._place(place.package, target, action.package_span)
                package = LaunchValue((place.package,), span)
                path = place.share
                made = default and self._is_made(place.package, target)
                if path and normpath(text) == f"{share(place.package)}/{path}":
                    self._add("include", place.package, path, target, package, conditional, default, made)
                else:
                    self._add("package", place.package, "", package, package, conditional, default, made)
            if not places and not is_settled(text):
                self.hide("which launch file is included is computed", target.span)

    def _process(self, action: LaunchAction, conditional: bool) -> None:
        """Note the packages of ``ros2 run``, ``ros2 launch`` and of the other commands in ``_COMMANDS``."""
        words: list[tuple[str, LaunchValue, bool]] = []
        for name, value in action.arguments:
            if not name:
                texts, default = self._filled(value)
                words += [(word, value, default) for word in _words(texts[0] if len(texts) == 1 else UNKNOWN)]
        command = tuple([word for word, _, _ in words[:2]])
        if command[:1] == ("xacro",):
            self._add("command", "xacro", "xacro", words[0][1], words[0][1], conditional, by_default=False)
        elif command in _COMMANDS:
            self._add("command", _COMMANDS[command], " ".join(command), words[1][1], words[1][1], conditional, by_default=False)
        if command not in (("ros2", "run"), ("ros2", "launch")):
            return
        rest = [argument for argument in words[2:] if not argument[0].startswith("-")][:2]
        if not rest or not is_plain(rest[0][0]):
            self.hide(f"what ros2 {words[1][0]} starts is computed", action.span)
            return
        package, value, default = rest[0]
        if words[1][0] == "run" and len(rest) == 2 and is_plain(rest[1][0]):
            self._add("node", package, rest[1][0], rest[1][1], value, conditional, default or rest[1][2])
        elif "/" not in package and not package.endswith((".py", ".xml", ".yaml", ".launch")):
            self._add("package", package, "", value, value, conditional, default)

    def _prefix(self, value: LaunchValue, conditional: bool) -> None:
        """Note the program that wraps another one, as in ``xterm -e``."""
        texts, default = self._filled(value)
        for program in sorted(_PREFIXES.intersection([text.strip().partition(" ")[0] for text in texts])):
            self._add("program", program, program, value, value, conditional or len(texts) > 1, default)

    def _paths(self, value: LaunchValue, package_span: Span | None, conditional: bool, reads: Reads | None = None) -> None:
        """Note the install places that a value contains."""
        texts, default = self._filled(value)
        # A literal place stays the same whatever the defaults are: a command has more words than the file.
        fixed = {place for text in value.texts for place in installed(text) if place.share is not None} if default else set()
        for text in texts:
            if text.isascii() and not runs_xacro(text):
                continue
            read = set(installed(reads(text))) if reads is not None else ()
            for place in installed(text):
                if not place.known:
                    self.hide("the package that is looked up is computed", value.span)
                    continue
                self._run_on([place], value)
                package = LaunchValue((place.package,), self._place(place.package, value, package_span))
                several = conditional or len(texts) > 1
                path = place.share
                hangs = default and place not in fixed
                made = hangs and self._is_made(place.package, value)
                if path:
                    self._add("file", place.package, path, value, package, several, hangs, made, place in read)
                elif place.executable:
                    self._add("node", place.package, place.executable, value, package, several, hangs, made)
                else:
                    self._add("package", place.package, "", package, package, several, hangs, made)
            if runs_xacro(text):
                self._runs("xacro", value, conditional)

    def _run_on(self, places: Iterable[Installed], value: LaunchValue) -> None:
        """Note paths that are appended to the share folder of a package without a slash."""
        for package, path in places:
            rest = path.removeprefix(f"share/{package}")
            if rest != path and is_plain(path) and rest[:1].isalpha() and ("." in rest or "/" in rest):
                says = f"there is no slash between the share folder of '{package}' and '{rest}'; add one, or join the paths"
                self.problems[Problem("no-slash", says, value.span)] = None

    def _place(self, package: str, value: LaunchValue, package_span: Span | None) -> Span:
        """Return where the package of a path is named: the span of the look-up if there is one."""
        if package in self._places:
            return self._places[package]
        if package in self._computed:
            return self._computed[package]
        path, line, _, last, _ = value.span
        inside = package_span is not None and package_span.path == path and line <= package_span.line <= last
        return package_span if package_span is not None and inside else value.span

    def _is_made(self, package: str, value: LaunchValue) -> bool:
        """Return whether a package name is assembled from configurations and occurs in no text as a whole."""
        prefix = f"{launch_text.prefix(package)}/"
        texts = [value.texts, *self._held.values.values()]
        return not any(prefix in f"{text}/" for one in texts for text in one)

    def _runs(self, command: str, value: LaunchValue, conditional: bool) -> None:
        place = LaunchValue((command,), self._places[command]) if command in self._places else value
        self._add("command", command, command, place, place, conditional, by_default=False)

    def _filled(self, value: LaunchValue) -> tuple[tuple[str, ...], bool]:
        """Return the values of ``value`` with defaults of launch arguments, and whether it needed them."""
        if all(is_settled(text) for text in value.texts):
            return value.texts, False
        by_default = not all(map(self._held.is_own, value.texts))
        if len(value.texts) == 1:
            return self._fill(value.texts[0]), by_default
        texts = dict.fromkeys(text for alternative in value.texts for text in self._fill(alternative))
        return tuple(texts), by_default

    def _narrow(self, conditions: Iterable[LaunchCondition]) -> None:
        """Restrict configurations to the values that conditions of the form "configuration equals x" allow."""
        for (text, *further_texts), equals, wanted in conditions:
            name = next((name for name, _, whole in configurations(text) if whole == text), "")
            if name and equals is not None and not further_texts and is_plain(equals):
                remaining = [value for value in self._value(name) or () if value != equals]
                self._narrowed, self._known = {**self._narrowed, name: (equals,) if wanted else tuple(remaining)}, {}

    def _value(self, name: str) -> tuple[str, ...] | None:
        return self._narrowed[name] or None if name in self._narrowed else self._held.values.get(name)

    def _fill(self, text: str) -> tuple[str, ...]:
        texts = self._known.get(text)
        if texts is None:
            texts = self._known[text] = fill(text, self._value, evaluate)
        return texts

    def look_up(self, package: str, value: LaunchValue, conditions: Sequence[LaunchCondition]) -> None:
        """Note a package that is looked up while the file is read."""
        if not is_plain(package):
            self.hide("the package that is looked up is computed", value.span)
            return
        with self._under(conditions) as somewhere:
            if somewhere and not any(
                reference.package == package and reference.conditional <= bool(conditions) and not reference.from_default
                for reference in self.found
            ):
                self._add("package", package, "", value, value, bool(conditions), by_default=False)

    def opens(self, value: LaunchValue, conditions: Sequence[LaunchCondition]) -> None:
        """Note a file that is opened while the launch file is read."""
        with self._under(conditions) as somewhere:
            if somewhere:
                self._paths(value, None, bool(conditions))

    def _add(
        self,
        kind: ReferenceKind,
        package: str,
        name: str,
        at: LaunchValue,
        owner: LaunchValue,
        conditional: bool,
        by_default: bool,
        package_by_default: bool = False,
        read: bool = False,
    ) -> None:
        exact, package_exact = at.exact and at.texts == (name,), owner.exact and owner.texts == (package,)
        if kind == "package":
            exact = package_exact
        reference = LaunchReference(
            kind,
            package,
            name,
            at.span,
            owner.span,
            conditional,
            exact,
            package_exact,
            self._asks or self._distros != EVERYWHERE or (self._lent and (conditional or package not in self._places)),
            by_default,
            package_by_default and package not in self._places,
            read,
            distros=tuple(sorted(self._distros)) if self._distros != EVERYWHERE else (),
        )
        if not self._asks:
            place = package, owner.span
            self._named_in[place] = self._named_in.get(place, frozenset()) | self._distros
        self.found[reference] = None

    def spare(self, packages: Container[str]) -> None:
        """Mark look-ups of packages as optional, unless a node is started from the package."""
        self.found = {
            found._replace(optional=True) if found.package in packages and found.package not in self._named else found: None
            for found in self.found
        }

    def do_without(self, paths: Iterable[str]) -> None:
        """Mark references to files whose existence the launch file checks first."""
        asked = {(place.package, place.share) for path in paths for text in self._fill(path) for place in installed(text)}
        if asked:
            self.found = {
                reference._replace(existence_checked=True)
                if reference.kind in ("file", "include") and (reference.package, reference.name) in asked
                else reference: None
                for reference in self.found
            }

    def all(self) -> tuple[LaunchReference, ...]:
        """Return the references by place.

        A reference is not optional if the same place names the package in every distribution.
        """
        references = list(self.found)
        for number, reference in enumerate(references):
            if reference.distros and self._named_in.get((reference.package, reference.package_span)) == EVERYWHERE:
                references[number] = reference._replace(optional=False)
        return tuple(sorted(references, key=attrgetter("span")))

    def hide(self, reason: str, span: Span) -> None:
        """Note that an unknown value hides which packages are used."""
        self.opaque[Opaque(Facet.USES, reason, span)] = None


def _is_dull(texts: Iterable[str], carriers: Container[str]) -> bool:
    """Return whether texts name neither an install place nor xacro, directly or by a configuration."""
    for text in texts:
        if text.isascii():
            if runs_xacro(text):
                return False
        elif names_places(text, carriers):
            return False
    return True


def _words(text: str) -> list[str]:
    if not any(quote in text for quote in "'\"\\"):
        return text.split()
    import shlex  # noqa: PLC0415  (few launch files have such command lines)

    try:
        return shlex.split(text)
    except ValueError:
        return text.split()
