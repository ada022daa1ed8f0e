"""The packages and files that a launch file refers to, determined from its actions."""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from operator import attrgetter
from posixpath import normpath
from types import MappingProxyType

from ros_lint.base.text import Span
from ros_lint.collectors import symbolic_text
from ros_lint.collectors.launch.default_configurations import default_configurations
from ros_lint.collectors.launch.expressions import evaluate
from ros_lint.collectors.launch.path_values import FilePart, values_of
from ros_lint.collectors.launch.presence_checks import EVERYWHERE, distributions_under, is_guarded_by_presence
from ros_lint.collectors.symbolic_text import (
    UNKNOWN,
    InstallPlace,
    configurations,
    configurations_with_places,
    files_beside,
    fill,
    installed,
    is_plain,
    is_settled,
    may_contain_place,
    runs_xacro,
    share,
)
from ros_lint.facts.launch import BESIDE, LaunchAction, LaunchCondition, LaunchReference, LaunchValue, ReferenceKind
from ros_lint.facts.visibility import Facet, Opaque, Problem

_COMMANDS: Mapping[tuple[str, ...], str] = {
    ("ros2", "bag"): "ros2bag",
    ("ros2", "control"): "ros2controlcli",
    ("ros2", "trace"): "ros2trace",
}
"""By the first words of a ros2 command: its package, for commands that are not in ros2cli_common_extensions."""


_PREFIXES = frozenset({"gnome-terminal", "konsole", "screen", "terminator", "tmux", "valgrind", "xterm"})
"""System programs, such as xterm, that can wrap the command of a node (``prefix``). Each name is also a rosdep key."""


class References:
    """The references of a launch file to packages and files, with problems and places that cannot be evaluated.

    All are in the order of the file.
    """

    def __init__(self, actions: Iterable[LaunchAction], places: Mapping[str, Span] = MappingProxyType({})) -> None:
        """Collect the references in actions.

        ``places`` are the spans of package look-ups, by the name of the package. In a name, special characters stand for
        parts that are known only at launch.
        """
        self.references: dict[LaunchReference, None] = {}
        self.opaque: dict[Opaque, None] = {}
        self.problems: dict[Problem, None] = {}
        self._places = {package: span for package, span in places.items() if is_settled(package)}
        actions = tuple(actions)
        self._defaults = default_configurations(actions)
        self._path_configurations = configurations_with_places(self._defaults.values)
        self._filled_texts: dict[str, tuple[str, ...]] = {}
        self._narrowed: Mapping[str, tuple[str, ...]] = {}
        self._presence_checked = self._builtin_model = False
        self._distros = EVERYWHERE
        self._named_in: dict[tuple[str, Span], frozenset[str]] = {}
        self._named: set[str] = set()
        computed = [(text, span) for text, span in places.items() if not is_settled(text)]
        self._computed = {package: span for text, span in computed for package in self._fill(text)}
        for action in actions:
            self._note_action(action, conditional=False)

    def _note_action(self, action: LaunchAction, conditional: bool) -> None:
        if not action.conditions and not action.builtin_model:
            self._add_action(action, conditional)
            return
        with self._under(action.conditions, builtin_model=action.builtin_model) as applies:
            if applies:
                self._add_action(action, conditional or bool(action.conditions))

    @contextmanager
    def _under(self, conditions: Sequence[LaunchCondition], *, builtin_model: bool = False) -> Iterator[bool]:
        """Apply conditions to the references that a ``with`` block adds.

        The context manager yields whether the conditions can hold in any ROS distribution. ``builtin_model`` is True for the
        references of an action that a launch helper of a released package creates.
        """
        previous = self._presence_checked, self._distros, self._narrowed, self._filled_texts, self._builtin_model
        self._builtin_model = builtin_model
        self._presence_checked = self._presence_checked or is_guarded_by_presence(conditions)
        self._distros &= distributions_under(conditions)
        self._narrow(conditions)
        try:
            yield bool(self._distros)
        finally:
            self._presence_checked, self._distros, self._narrowed, self._filled_texts, self._builtin_model = previous

    def _add_action(self, action: LaunchAction, conditional: bool) -> None:
        match action.kind:
            case "read":
                return  # the callers note the files that are opened
            case "node" | "component":
                self._note_program(action, conditional)
            case "include":
                self._note_include(action, conditional)
            case "process":
                self._note_process(action, conditional)
        for name, value in action.arguments:
            if name == "prefix":
                self._note_prefix(value, conditional)
        for value, reads in values_of(action):
            if _has_no_place(value.texts, self._path_configurations):
                continue
            if not value.conditions:
                self._note_paths(value, action.package_span, conditional, reads)
                continue
            with self._under(value.conditions, builtin_model=self._builtin_model) as applies:
                if applies:
                    self._note_paths(value, action.package_span, conditional=True, reads=reads)
        for child in action.children:
            self._note_action(child, conditional)

    def _note_program(self, action: LaunchAction, conditional: bool) -> None:
        kind: ReferenceKind = "node" if action.kind == "node" else "component"
        if action.package is None:
            if action.target is not None:
                self._note_paths(action.target, action.package_span, conditional)
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

    def _note_include(self, action: LaunchAction, conditional: bool) -> None:
        target = action.target
        if target is None:
            return
        texts, default = self._filled(target)
        for text in texts:
            places = [place for place in installed(text) if place.known]
            self._note_missing_slash(places, target)
            conditional = conditional or len(texts) > 1
            for place in places:
                span = self._place(place.package, target, action.package_span)
                package = LaunchValue((place.package,), span)
                path = place.share
                is_computed = default and self._is_computed(place.package, target)
                if path and normpath(text) == f"{share(place.package)}/{path}":
                    self._add("include", place.package, path, target, package, conditional, default, is_computed)
                else:
                    self._add("package", place.package, "", package, package, conditional, default, is_computed)
            if not places and not is_settled(text):
                self.hide("the included launch file is computed", target.span)
            for path in files_beside(text) if not places else ():
                self._add("include", BESIDE, path, target, target, conditional, default)

    def _note_process(self, action: LaunchAction, conditional: bool) -> None:
        """Add references to the packages that a command line uses.

        The commands are ``ros2 run a b``, ``ros2 launch a b``, ``xacro`` and those in ``_COMMANDS``.
        """
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
        parameters = [argument for argument in words[2:] if not argument[0].startswith("-")][:2]
        if not parameters or not is_plain(parameters[0][0]):
            self.hide(f"the target of 'ros2 {words[1][0]}' is computed", action.span)
            return
        package, value, default = parameters[0]
        if words[1][0] == "run" and len(parameters) == 2 and is_plain(parameters[1][0]):
            self._add("node", package, parameters[1][0], parameters[1][1], value, conditional, default or parameters[1][2])
        elif "/" not in package and not package.endswith((".py", ".xml", ".yaml", ".launch")):
            self._add("package", package, "", value, value, conditional, default)

    def _note_prefix(self, value: LaunchValue, conditional: bool) -> None:
        """Add a reference to the program of a command prefix, such as ``xterm`` for ``xterm -e``, if it is in ``_PREFIXES``."""
        texts, default = self._filled(value)
        for program in sorted(_PREFIXES.intersection([text.strip().partition(" ")[0] for text in texts])):
            self._add("program", program, program, value, value, conditional or len(texts) > 1, default)

    def _note_paths(
        self, value: LaunchValue, package_span: Span | None, conditional: bool, reads: FilePart | None = None
    ) -> None:
        """Add references to the installed files and packages whose paths a value contains.

        ``reads`` extracts the path of a file that the started program reads from a text: ``-d a.rviz`` -> ``a.rviz``.
        """
        texts, default = self._filled(value)
        # A literal path in a command does not depend on defaults in other words of the command.
        fixed = {place for text in value.texts for place in installed(text) if place.share is not None} if default else set()
        for text in texts:
            if text.isascii() and not runs_xacro(text):
                continue
            read_part = reads(text) if reads is not None else ""
            read_places = set(installed(read_part))
            for beside in files_beside(text) if not default or "//" not in text else ():
                is_read = beside in files_beside(read_part)
                self._add("file", BESIDE, beside, value, value, conditional or len(texts) > 1, default, is_read=is_read)
            for place in installed(text):
                if not place.known:
                    self.hide("the package that is looked up is computed", value.span)
                    continue
                self._note_missing_slash([place], value)
                package = LaunchValue((place.package,), self._place(place.package, value, package_span))
                is_conditional = conditional or len(texts) > 1
                path = place.share
                from_default = default and place not in fixed
                is_computed = from_default and self._is_computed(place.package, value)
                # An empty default as the name of a folder, as in ``robots//a.yaml``, is meant to be replaced.
                if path and not (from_default and "//" in text):
                    self._add(
                        "file",
                        place.package,
                        path,
                        value,
                        package,
                        is_conditional,
                        from_default,
                        is_computed,
                        place in read_places,
                    )
                elif place.executable:
                    self._add("node", place.package, place.executable, value, package, is_conditional, from_default, is_computed)
                else:
                    self._add("package", place.package, "", package, package, is_conditional, from_default, is_computed)
            if runs_xacro(text):
                self._note_command("xacro", value, conditional)

    def _note_missing_slash(self, places: Iterable[InstallPlace], value: LaunchValue) -> None:
        """Add a problem for each path that is appended without a slash to the share folder of a package."""
        for package, path in places:
            remainder = path.removeprefix(f"share/{package}")
            if remainder != path and is_plain(path) and remainder[:1].isalpha() and ("." in remainder or "/" in remainder):
                message = (
                    f"there is no slash between the share folder of '{package}' and '{remainder}'; add a slash, or join the paths"
                )
                self.problems[Problem("no-slash", message, value.span)] = None

    def _place(self, package: str, value: LaunchValue, package_span: Span | None) -> Span:
        """Return the span of the package name in a path.

        It is the span of the package look-up, else ``package_span`` if that is inside of ``value``, else the span of
        ``value``.
        """
        if package in self._places:
            return self._places[package]
        if package in self._computed:
            return self._computed[package]
        path, line, _, last, _ = value.span
        is_inside = package_span is not None and package_span.path == path and line <= package_span.line <= last
        return package_span if package_span is not None and is_inside else value.span

    def _is_computed(self, package: str, value: LaunchValue) -> bool:
        """Return whether a package name is composed of parts, for example of launch configurations.

        It is composed if neither ``value`` nor the default of a launch configuration contains the name as a whole.
        """
        prefix = f"{symbolic_text.prefix(package)}/"
        texts = [value.texts, *self._defaults.values.values()]
        return not any(prefix in f"{text}/" for alternatives in texts for text in alternatives)

    def _note_command(self, command: str, value: LaunchValue, conditional: bool) -> None:
        place = LaunchValue((command,), self._places[command]) if command in self._places else value
        self._add("command", command, command, place, place, conditional, by_default=False)

    def _filled(self, value: LaunchValue) -> tuple[tuple[str, ...], bool]:
        """Return the possible texts of a value with the defaults of launch arguments, and whether a caller can change these."""
        if all(is_settled(text) for text in value.texts):
            return value.texts, False
        by_default = not all(map(self._defaults.is_own, value.texts))
        if len(value.texts) == 1:
            return self._fill(value.texts[0]), by_default
        texts = dict.fromkeys(text for alternative in value.texts for text in self._fill(alternative))
        return tuple(texts), by_default

    def _narrow(self, conditions: Iterable[LaunchCondition]) -> None:
        """Restrict the values of launch configurations to those that ``conditions`` allow, such as "configuration equals x"."""
        for (text, *further_texts), equals, wanted in conditions:
            name = next((name for name, _, symbolic in configurations(text) if symbolic == text), "")
            if name and equals is not None and not further_texts and is_plain(equals):
                remaining = [value for value in self._value(name) or () if value != equals]
                self._narrowed, self._filled_texts = {**self._narrowed, name: (equals,) if wanted else tuple(remaining)}, {}

    def _value(self, name: str) -> tuple[str, ...] | None:
        return self._narrowed[name] or None if name in self._narrowed else self._defaults.values.get(name)

    def _fill(self, text: str) -> tuple[str, ...]:
        texts = self._filled_texts.get(text)
        if texts is None:
            texts = self._filled_texts[text] = fill(text, self._value, evaluate, rejoin=False)
        return texts

    def note_look_up(self, package: str, value: LaunchValue, conditions: Sequence[LaunchCondition]) -> None:
        """Add a reference to a package that the launch file looks up while it is loaded, before any action runs."""
        if not is_plain(package):
            self.hide("the package that is looked up is computed", value.span)
            return
        with self._under(conditions) as applies:
            if applies and not any(
                reference.package == package and reference.conditional <= bool(conditions) and not reference.from_default
                for reference in self.references
            ):
                self._add("package", package, "", value, value, bool(conditions), by_default=False)

    def note_passed(self, package: str, value: LaunchValue, conditions: Sequence[LaunchCondition]) -> None:
        """Add a reference to a package that launch looks up for a substitution, unless the file refers to the package elsewhere.

        The substitution is passed to a function that is not interpreted.
        """
        if all(reference.package != package for reference in self.references):
            self.note_look_up(package, value, conditions)

    def note_opened(self, value: LaunchValue, conditions: Sequence[LaunchCondition]) -> None:
        """Add a reference to a file that the launch file opens while it is loaded, before any action runs."""
        with self._under(conditions) as applies:
            if applies:
                self._note_paths(value, None, bool(conditions))

    def _add(
        self,
        kind: ReferenceKind,
        package: str,
        name: str,
        value: LaunchValue,
        owner: LaunchValue,
        conditional: bool,
        by_default: bool,
        package_by_default: bool = False,
        is_read: bool = False,
    ) -> None:
        exact, package_exact = value.exact and value.texts == (name,), owner.exact and owner.texts == (package,)
        if kind == "package":
            exact = package_exact
        reference = LaunchReference(
            kind,
            package,
            name,
            value.span,
            owner.span,
            conditional,
            exact,
            package_exact,
            self._presence_checked
            or self._distros != EVERYWHERE
            or (self._builtin_model and (conditional or package not in self._places)),
            by_default,
            package_by_default and package not in self._places,
            is_read,
            distros=tuple(sorted(self._distros)) if self._distros != EVERYWHERE else (),
        )
        if not self._presence_checked:
            place = package, owner.span
            self._named_in[place] = self._named_in.get(place, frozenset()) | self._distros
        self.references[reference] = None

    def mark_optional(self, packages: Container[str]) -> None:
        """Mark the references to ``packages`` as optional, except for packages whose nodes or components the file starts."""
        self.references = {
            reference._replace(optional=True)
            if reference.package in packages and reference.package not in self._named
            else reference: None
            for reference in self.references
        }

    def mark_guarded(self, paths: Iterable[str]) -> None:
        """Mark the references to files among ``paths`` as checked, because the launch file tests whether these files exist."""
        checked = set(self._named_files(paths))
        if checked:
            self.references = {
                reference._replace(existence_checked=True)
                if reference.kind in ("file", "include") and (reference.package, reference.name) in checked
                else reference: None
                for reference in self.references
            }

    def mark_fallbacks(self, fallbacks: Iterable[tuple[str, Sequence[str]]]) -> None:
        """Record, for each fallback file, the missing file that it replaces.

        ``fallbacks`` are pairs: the path of the fallback file, and the possible paths of the missing file.
        """
        replaced: dict[tuple[str, str], tuple[tuple[str, str], ...]] = {}
        for path, tested in fallbacks:
            for file in self._named_files([path]):
                replaced[file] = self._named_files(tested)
        if replaced:
            self.references = {
                reference._replace(fallback_for=replaced.get((reference.package, reference.name), ())): None
                for reference in self.references
            }

    def _named_files(self, paths: Iterable[str]) -> tuple[tuple[str, str], ...]:
        """Return the files at paths, each as its package and its path below the package's share directory.

        For a file beside the launch file, they are BESIDE and its path relative to the launch file.
        """
        texts = {text for path in paths for text in self._fill(path)}
        files = {(place.package, place.share) for text in texts for place in installed(text) if place.share}
        return tuple(sorted(files | {(BESIDE, path) for text in texts for path in files_beside(text)}))

    def all(self) -> tuple[LaunchReference, ...]:
        """Return the references, sorted by span.

        A reference under conditions is not optional if the place refers to the package in every ROS distribution, for example
        in both branches of a test of ROS_DISTRO.
        """
        references = list(self.references)
        for number, reference in enumerate(references):
            if reference.distros and self._named_in.get((reference.package, reference.package_span)) == EVERYWHERE:
                references[number] = reference._replace(optional=False)
        return tuple(sorted(references, key=attrgetter("span")))

    def hide(self, reason: str, span: Span) -> None:
        """Record a place that cannot be evaluated: it is unknown which packages the launch file uses there."""
        self.opaque[Opaque(Facet.USES, reason, span)] = None


def _has_no_place(texts: Iterable[str], configurations: Container[str]) -> bool:
    """Return whether none of the texts may contain a path in an install space or a command of xacro.

    ``configurations`` are the launch configurations whose values may contain such a path.
    """
    for text in texts:
        if text.isascii():
            if runs_xacro(text):
                return False
        elif may_contain_place(text, configurations):
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
