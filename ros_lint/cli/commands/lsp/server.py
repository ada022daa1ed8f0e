"""The language server: answers requests of the editor from the last checked state (snapshot) of each open folder."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Any, TypeVar

from lsprotocol import types
from pygls.lsp.server import LanguageServer
from pygls.uris import to_fs_path

from ros_lint import __version__
from ros_lint.base.text import Span, to_bytes
from ros_lint.cli.commands.lsp import cmake_variables, findings, navigation
from ros_lint.cli.commands.lsp.positions import ENCODINGS, Place, Positions
from ros_lint.cli.commands.lsp.progress import LoadingProgress
from ros_lint.cli.commands.lsp.project import Project, Snapshot
from ros_lint.collectors.cmake.variable_values import Variable, variable_at
from ros_lint.errors import UserError

T = TypeVar("T")

_DELAY = 0.15
"""Seconds without a change after which the workspace is checked again."""

_WATCHED = "**/*"
"""Pattern of the files whose changes on disk the editor reports: all, because any file can be installed or looked up."""


class OpenProject:
    """A folder that is open in the editor, with its last checked state (snapshot).

    All work on such folders is done in one thread. If a text changes during a check, the diagnostics of that check are
    not published, and the folder is checked again.
    """

    def __init__(self, project: Project) -> None:
        self.project = project
        self.lock = asyncio.Lock()
        self.version = 0
        """Number of changes of the project so far."""
        self.checked = -1
        """Value of ``version`` at the time of ``snapshot``; -1 before the first check."""
        self.snapshot: Snapshot | None = None
        self.changed_on_disk: dict[str, None] = {}
        self.timer: asyncio.Task[None] | None = None
        self.published: set[str] = set()
        """URIs of the files with diagnostics in the editor."""


class RosLintServer(LanguageServer):
    """The language server for the folders of one editor. ``options`` are those of the command line."""

    def __init__(self, options: Mapping[str, Any], environment: Mapping[str, str]) -> None:
        super().__init__("ros-lint", f"v{__version__}", max_workers=1)
        self._options = options
        self._environment = environment
        self._pool = ThreadPoolExecutor(1)
        self._projects: list[OpenProject] = []
        self.watches = False
        """True if the editor reports changes on disk. If False, all files are read again for each check."""
        self.ready = asyncio.Event()
        """Set when the folders of the editor have been opened."""

    async def open_folders(self) -> None:
        """Open and check the folders of the editor."""
        folders = [to_fs_path(folder.uri) for folder in self.workspace.folders.values()]
        if not folders and self.workspace.root_path:
            folders = [self.workspace.root_path]
        for folder in folders:
            if folder and os.path.isdir(folder):
                await self.open(folder)
        self.ready.set()

    async def open(self, folder: str) -> None:
        """Open and check a folder, and show the progress. An invalid configuration is reported to the user."""
        async with LoadingProgress(self, f"ros-lint: {os.path.basename(folder)}") as progress:
            try:
                project = await self._work(lambda: Project(folder, self._options, self._environment, progress.update))
            except UserError as error:
                self._show(str(error))
                return
            for warning in project.warnings:
                self.window_log_message(types.LogMessageParams(types.MessageType.Warning, f"ros-lint: {warning}"))
            opened = OpenProject(project)
            self._projects.append(opened)
            await self.current(opened)

    async def close_folders(self, uris: list[str]) -> None:
        """Close the projects of folders and clear their diagnostics."""
        folders = {os.path.realpath(path) for uri in uris if (path := to_fs_path(uri))}
        for opened in [opened for opened in self._projects if opened.project.folder in folders]:
            self._projects.remove(opened)
            self._publish(opened, {})

    def project_of(self, uri: str) -> tuple[OpenProject, str] | None:
        """Return the innermost project that contains a file, and the file's path relative to the project's base.

        Return None if no project contains the file.
        """
        path = os.path.realpath(to_fs_path(uri) or "")
        inside = [opened for opened in self._projects if opened.project.contains(path)]
        if not inside:
            return None
        opened = max(inside, key=lambda opened: len(opened.project.folder))
        return opened, os.path.relpath(path, opened.project.base).replace(os.sep, "/")

    def change(self, uri: str, *, on_disk: bool = False) -> None:
        """Record that a file changed in the editor or on disk, and check its project soon."""
        if (place := self.project_of(uri)) is None:
            return
        opened = place[0]
        opened.version += 1
        if on_disk:
            opened.changed_on_disk[os.path.realpath(to_fs_path(uri) or "")] = None
        if opened.timer is not None:
            opened.timer.cancel()
        opened.timer = asyncio.ensure_future(self._check_later(opened))

    async def _check_later(self, opened: OpenProject) -> None:
        await asyncio.sleep(_DELAY)
        opened.timer = None
        await self.current(opened)

    async def current(self, opened: OpenProject) -> Snapshot | None:
        """Return a snapshot of the current texts and publish its diagnostics; None if the workspace cannot be checked."""
        async with opened.lock:
            while opened.checked != opened.version:
                version = opened.version
                opened.snapshot = await self._check(opened)
                opened.checked = version
                if version == opened.version:
                    self._publish_snapshot(opened)
            return opened.snapshot

    async def _check(self, opened: OpenProject) -> Snapshot | None:
        unsaved, changed_on_disk = self.unsaved(opened.project), opened.changed_on_disk
        opened.changed_on_disk = {}
        try:
            return await self._work(lambda: _check(opened.project, changed_on_disk if self.watches else None, unsaved))
        except UserError as error:
            self._show(str(error))
            return None

    async def fixes(self, opened: OpenProject, rule: str) -> types.WorkspaceEdit | None:
        """Return the edits of all safe fixes of a project, or of those of ``rule`` if not ""; None if it cannot be checked."""
        snapshot = await self.current(opened)
        if snapshot is None:
            return None
        async with opened.lock:
            changed = await self._work(lambda: opened.project.fixes(self.unsaved(opened.project), rule))
        return findings.workspace_edit(snapshot, self.positions(snapshot), changed)

    async def variable_values(self, opened: OpenProject, package: str, variable: Variable) -> tuple[str | None, ...]:
        """Return the values of a CMake variable at its place, which is in the package at the path ``package``."""
        name, span, assigned = variable
        async with opened.lock:
            return await self._work(
                lambda: opened.project.variable_values(package, span.path, span.line, name, assigned=assigned)
            )

    def positions(self, snapshot: Snapshot) -> Positions:
        """Return a converter of places to positions in the encoding that the editor and the server agreed on."""
        return Positions(ENCODINGS[types.PositionEncodingKind(self.workspace.position_encoding or "utf-16")], snapshot.text)

    def unsaved(self, project: Project) -> dict[str, bytes]:
        """Return the texts of a project's files that are open in the editor, by path relative to the base of the project."""
        texts = {}
        for document in list(self.workspace.text_documents.values()):
            path = os.path.realpath(document.path)
            if project.contains(path):
                texts[os.path.relpath(path, project.base).replace(os.sep, "/")] = to_bytes(document.source)
        return texts

    async def _work(self, task: Callable[[], T]) -> T:
        return await asyncio.get_running_loop().run_in_executor(self._pool, task)

    def _publish_snapshot(self, opened: OpenProject) -> None:
        snapshot = opened.snapshot
        self._publish(opened, findings.diagnostics(snapshot, self.positions(snapshot)) if snapshot else {})

    def _publish(self, opened: OpenProject, diagnostics: Mapping[str, list[types.Diagnostic]]) -> None:
        for uri in sorted({*diagnostics, *opened.published}):
            self.text_document_publish_diagnostics(types.PublishDiagnosticsParams(uri, diagnostics.get(uri, [])))
        opened.published = set(diagnostics)

    def _show(self, message: str) -> None:
        self.window_show_message(types.ShowMessageParams(types.MessageType.Error, f"ros-lint: {message}"))


def _check(project: Project, changed_on_disk: Mapping[str, None] | None, unsaved: Mapping[str, bytes]) -> Snapshot:
    """Return a new snapshot of a project.

    ``changed_on_disk`` has the absolute paths of the files to read again; None if any file may have changed.
    """
    if changed_on_disk is None:
        project.reopen()
    elif changed_on_disk:
        project.refresh(changed_on_disk)
    return project.check(unsaved)


def create(options: Mapping[str, Any], environment: Mapping[str, str]) -> RosLintServer:
    """Return a language server with all its features. The server is not started."""
    server = RosLintServer(options, environment)
    _add_synchronisation(server)
    _add_navigation(server)
    _add_actions(server)
    return server


def _add_synchronisation(server: RosLintServer) -> None:
    @server.feature(types.INITIALIZED)
    async def initialized(_: types.InitializedParams) -> None:
        workspace = server.client_capabilities.workspace
        watching = workspace.did_change_watched_files if workspace else None
        if watching and watching.dynamic_registration:
            server.watches = True
            watchers = types.DidChangeWatchedFilesRegistrationOptions([types.FileSystemWatcher(_WATCHED)])
            registration = types.Registration("watch", types.WORKSPACE_DID_CHANGE_WATCHED_FILES, watchers)
            server.client_register_capability(types.RegistrationParams([registration]))
        await server.open_folders()

    @server.feature(types.TEXT_DOCUMENT_DID_OPEN)
    def opened(params: types.DidOpenTextDocumentParams) -> None:
        server.change(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_CHANGE)
    def changed(params: types.DidChangeTextDocumentParams) -> None:
        server.change(params.text_document.uri)

    @server.feature(types.TEXT_DOCUMENT_DID_SAVE)
    def saved(params: types.DidSaveTextDocumentParams) -> None:
        server.change(params.text_document.uri, on_disk=True)

    @server.feature(types.TEXT_DOCUMENT_DID_CLOSE)
    def closed(params: types.DidCloseTextDocumentParams) -> None:
        server.change(params.text_document.uri, on_disk=True)

    @server.feature(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def changed_on_disk(params: types.DidChangeWatchedFilesParams) -> None:
        for event in params.changes:
            if "/.git/" not in event.uri:
                server.change(event.uri, on_disk=True)

    @server.feature(types.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    async def changed_folders(params: types.DidChangeWorkspaceFoldersParams) -> None:
        await server.close_folders([folder.uri for folder in params.event.removed])
        for folder in params.event.added:
            if path := to_fs_path(folder.uri):
                await server.open(path)


class _Request:
    """A request of the editor about a place in a file, with the snapshot from which it is answered."""

    def __init__(self, server: RosLintServer, opened: OpenProject, snapshot: Snapshot, path: str, place: Place) -> None:
        self.opened = opened
        self.snapshot = snapshot
        self.path = path
        self.place = place
        self.positions = server.positions(snapshot)
        self.target = navigation.target_at(snapshot.workspace, path, place)

    def location(self, span: Span) -> types.Location:
        """Return a span as a location of the protocol: URI and range."""
        return types.Location(findings.uri_of(self.snapshot.base, span.path), self.positions.range(span))


async def _request(server: RosLintServer, uri: str, position: types.Position) -> _Request | None:
    """Return the request with a snapshot of the current texts; None if the file is in no project or cannot be read."""
    await server.ready.wait()
    if (place := server.project_of(uri)) is None:
        return None
    opened, path = place
    snapshot = await server.current(opened)
    text = snapshot.text(path) if snapshot else None
    if snapshot is None or text is None:
        return None
    return _Request(server, opened, snapshot, path, server.positions(snapshot).place(text, position))


def _add_navigation(server: RosLintServer) -> None:
    @server.feature(types.TEXT_DOCUMENT_HOVER)
    async def hover(params: types.HoverParams) -> types.Hover | None:
        request = await _request(server, params.text_document.uri, params.position)
        if request is None:
            return None
        owner = request.snapshot.workspace.owner(request.path)
        source = request.snapshot.text(request.path)
        if request.target is not None:
            text, span = navigation.describe(request.snapshot, request.target, owner), request.target.span
        elif owner and source and (variable := variable_at(source, *request.place)):
            values = await server.variable_values(request.opened, owner.path, variable)
            text, span = cmake_variables.describe(variable, values), variable.span
        else:
            return None
        return types.Hover(types.MarkupContent(types.MarkupKind.Markdown, text), request.positions.range(span))

    @server.feature(types.TEXT_DOCUMENT_DEFINITION)
    async def definition(params: types.DefinitionParams) -> list[types.Location]:
        request = await _request(server, params.text_document.uri, params.position)
        if request is None or request.target is None:
            return []
        return [request.location(span) for span in navigation.definitions(request.snapshot.workspace, request.target)]

    @server.feature(types.TEXT_DOCUMENT_REFERENCES)
    async def references(params: types.ReferenceParams) -> list[types.Location]:
        request = await _request(server, params.text_document.uri, params.position)
        if request is None or request.target is None:
            return []
        return [request.location(span) for span in navigation.references(request.snapshot.workspace, request.target.package)]

    @server.feature(types.TEXT_DOCUMENT_DOCUMENT_LINK)
    async def links(params: types.DocumentLinkParams) -> list[types.DocumentLink]:
        request = await _request(server, params.text_document.uri, types.Position(0, 0))
        if request is None:
            return []
        return [
            types.DocumentLink(request.positions.range(span), target=request.location(file).uri)
            for span, file in navigation.links(request.snapshot.workspace, request.path)
        ]

    @server.feature(types.TEXT_DOCUMENT_COMPLETION, types.CompletionOptions(trigger_characters=[">", "'", '"', "="]))
    async def completion(params: types.CompletionParams) -> types.CompletionList | None:
        request = await _request(server, params.text_document.uri, params.position)
        text = request.snapshot.text(request.path) if request else None
        if request is None or text is None:
            return None
        word, names = navigation.completions(request.snapshot.workspace, text, request.place)
        line, column = request.place
        span = Span(request.path, line, column - len(word), line, column)
        edits = [(name, types.TextEdit(request.positions.range(span), name)) for name in names]
        return types.CompletionList(
            is_incomplete=len(names) >= navigation.MOST_COMPLETIONS,
            items=[types.CompletionItem(name, kind=types.CompletionItemKind.Module, text_edit=edit) for name, edit in edits],
        )


def _add_actions(server: RosLintServer) -> None:
    kinds = [types.CodeActionKind.QuickFix, types.CodeActionKind.SourceFixAll]

    @server.feature(types.TEXT_DOCUMENT_CODE_ACTION, types.CodeActionOptions(kinds, resolve_provider=True))
    async def code_actions(params: types.CodeActionParams) -> list[types.CodeAction]:
        request = await _request(server, params.text_document.uri, params.range.start)
        if request is None:
            return []
        first, last, only = params.range.start.line + 1, params.range.end.line + 1, params.context.only or ()
        actions = findings.code_actions(request.snapshot, request.positions, request.path, first, last, only)
        return [_with_uri(action, params.text_document.uri) for action in actions]

    @server.feature(types.CODE_ACTION_RESOLVE)
    async def resolve(action: types.CodeAction) -> types.CodeAction:
        data = action.data if isinstance(action.data, dict) else {}
        if action.edit is None and (place := server.project_of(str(data.get("uri", "")))):
            action.edit = await server.fixes(place[0], str(data.get("rule", "")))
        return action


def _with_uri(action: types.CodeAction, uri: str) -> types.CodeAction:
    """Return a code action with ``uri``, the URI of the file, added to its data. An action without data is unchanged."""
    if action.data is not None:
        action.data = {**action.data, "uri": uri}
    return action
