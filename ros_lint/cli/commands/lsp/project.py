"""A folder that is open in an editor, and its check with the unsaved texts of the editor."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from ros_lint.base import garbage
from ros_lint.base.paths import is_below
from ros_lint.base.text import Text, read
from ros_lint.base.tree import text_of
from ros_lint.cli.checking import check_workspaces, selection_of
from ros_lint.cli.session import open_session, parse_request
from ros_lint.cli.settings import CONFIGURATION_FILES, find
from ros_lint.engine import registry
from ros_lint.engine.fix_trials import FixTrials
from ros_lint.engine.fixing import fix

if TYPE_CHECKING:
    from ros_lint.cli.session import Request, Session
    from ros_lint.engine.report import Report
    from ros_lint.workspace.model import Workspace

Progress = Callable[[str, int, int], None]


class Snapshot(NamedTuple):
    """A checked workspace and its report. Unsaved texts of the editor replace the contents of files on disk."""

    base: str
    """Absolute folder to which all paths are relative."""
    workspace: Workspace
    """The workspace, loaded for the first distribution of the run."""
    report: Report
    text: Callable[[str], Text | None]
    """A function that returns the checked text of a file by path; None if the file cannot be read."""


class Project:
    """A folder that is open in the editor. Its files are read once, and again only after :meth:`refresh`.

    ``options`` are those of the command line. The constructor reads the settings and raises UserError.
    """

    def __init__(self, folder: str, options: Mapping[str, Any], environment: Mapping[str, str], progress: Progress) -> None:
        self.folder = os.path.realpath(folder)
        self._options = {**options, "paths": [folder]}
        self._environment = environment
        self._progress = progress
        self.reopen()

    def reopen(self) -> None:
        """Read the settings and the changed files again. Raises UserError."""
        garbage.release_objects()
        self._is_checked = False
        self._request: Request = parse_request(self._options, self._environment)
        self._session: Session = open_session(self._request, self._progress, again=True)

    @property
    def base(self) -> str:
        """Absolute folder to which the paths of findings are relative: the root of the git repository, or else the workspace."""
        return self._request.base

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings about the settings."""
        return (*self._request.settings.warnings, *self._session.warnings)

    def contains(self, path: str) -> bool:
        """Return whether an absolute path is in the folder of this project."""
        return is_below(path, self.folder)

    def check(self, unsaved: Mapping[str, bytes]) -> Snapshot:
        """Return a snapshot of the workspace. ``unsaved`` has the unsaved texts of the editor by path, relative to ``base``.

        Raises KnowledgeError if the data about released packages cannot be read.
        """
        loader = self._session.loader
        with garbage.paused():
            workspaces = loader.load_all(unsaved)
            report = check_workspaces(self._session, workspaces, self._session.roots)
        if not self._is_checked:
            self._is_checked = True
            garbage.keep_objects()  # the next checks keep most of the model

        def text(path: str) -> Text | None:
            return read(path, unsaved[path]) if path in unsaved else text_of(loader.tree, path)

        return Snapshot(self.base, workspaces[0], report, text)

    def fixes(self, unsaved: Mapping[str, bytes], rule: str = "") -> Mapping[str, bytes]:
        """Return the new contents of files, by path, after all safe fixes, or after those of ``rule`` if it is not "".

        Each fix has passed a trial: it causes no other finding. No file is written.
        """
        session = self._session
        selection = selection_of(session.settings)
        if rule:
            selection = selection._replace(rules=tuple([other for other in selection.rules if other.name == rule]))
        trials = FixTrials(session.loader, session.roots, selection, registry.load(session.settings["plugins"]))
        changed = fix(trials, unsaved).changed
        session.loader.unpin()
        session.loader.load_all(unsaved)  # the last snapshot shows the state of the last load
        return {path: data for path, data in changed.items() if unsaved.get(path) != data}

    def variable_values(self, package: str, path: str, line: int, name: str, *, assigned: bool) -> tuple[str | None, ...]:
        """Return the values of a CMake variable in the last check, see :meth:`Loader.variable_values`."""
        return self._session.loader.variable_values(package, path, line, name, assigned=assigned)

    def refresh(self, paths: Mapping[str, object]) -> None:
        """Record that files changed on disk. ``paths`` are absolute. Raises UserError if the settings are now invalid."""
        relative = {os.path.relpath(path, self.base).replace(os.sep, "/") for path in paths}
        self._session.loader.forget(relative)
        if find(self.folder)[0] in paths or any(os.path.basename(path) in CONFIGURATION_FILES for path in paths):
            self.reopen()
