"""The language server, driven by a client over standard input and output."""

from __future__ import annotations

import asyncio
import shutil
import sys
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

pytest.importorskip("pytest_lsp", reason="pytest-lsp is not installed")

from lsprotocol import types
from pytest_lsp import LanguageClient, client_capabilities, make_test_lsp_client

pytestmark = pytest.mark.slow  # each test starts a server

DEMO = Path(__file__).parents[1] / "fixtures" / "workspaces" / "demo"
DRIVER = "src/rover_driver/package.xml"
LAUNCH = "src/rover_bringup/launch/rover.launch.py"
NODE = "src/rover_driver/src/driver_node.cpp"
SCRIPT = "src/rover_driver/CMakeLists.txt"


class Editor:
    """A client with the server that it started, in the folder ``root``."""

    def __init__(self, root: Path, client: LanguageClient) -> None:
        self.root = root
        self.client = client
        self.versions: dict[str, int] = {}

    def uri(self, path: str) -> str:
        return (self.root / path).as_uri()

    def text(self, path: str) -> str:
        return (self.root / path).read_text("utf-8")

    def open(self, path: str, text: str | None = None) -> None:
        document = types.TextDocumentItem(self.uri(path), "", 0, self.text(path) if text is None else text)
        self.client.text_document_did_open(types.DidOpenTextDocumentParams(document))

    def change(self, path: str, text: str) -> None:
        self.versions[path] = self.versions.get(path, 0) + 1
        document = types.VersionedTextDocumentIdentifier(self.versions[path], self.uri(path))
        change = types.TextDocumentContentChangeWholeDocument(text)
        self.client.text_document_did_change(types.DidChangeTextDocumentParams(document, [change]))

    def identifier(self, path: str) -> types.TextDocumentIdentifier:
        return types.TextDocumentIdentifier(self.uri(path))

    def position(self, path: str, word: str, offset: int = 0) -> types.Position:
        """Return the position of the first occurrence of a word in a file on disk, plus ``offset`` columns."""
        line, text = next((number, text) for number, text in enumerate(self.text(path).splitlines()) if word in text)
        return types.Position(line, text.index(word) + offset)

    async def settled(self) -> None:
        """Wait until the server has checked the current texts: it answers a request only then."""
        await self.client.text_document_document_link_async(types.DocumentLinkParams(self.identifier(DRIVER)))

    async def codes(self, path: str) -> list[str]:
        await self.settled()
        return sorted(str(diagnostic.code) for diagnostic in self.client.diagnostics.get(self.uri(path), []))

    async def actions(self, path: str, position: types.Position, *kinds: str) -> list[types.CodeAction]:
        context = types.CodeActionContext([], only=[types.CodeActionKind(kind) for kind in kinds] or None)
        request = types.CodeActionParams(self.identifier(path), types.Range(position, position), context)
        actions = await self.client.text_document_code_action_async(request)
        assert actions is not None
        return [action for action in actions if isinstance(action, types.CodeAction)]

    def apply(self, edit: types.WorkspaceEdit | None) -> None:
        """Write an edit to the disk, as an editor that saves it."""
        assert edit is not None
        assert edit.changes
        for uri, edits in edit.changes.items():
            path = uri.removeprefix(f"{self.root.as_uri()}/")
            lines = self.text(path).splitlines(keepends=True)
            for change in edits:
                start, end = change.range.start, change.range.end
                assert (start.character, end.character) == (0, 0)
                lines[start.line : end.line] = [change.new_text]
            (self.root / path).write_text("".join(lines), "utf-8")

    def changed_on_disk(self, path: str, kind: types.FileChangeType = types.FileChangeType.Changed) -> None:
        event = types.FileEvent(self.uri(path), kind)
        self.client.workspace_did_change_watched_files(types.DidChangeWatchedFilesParams([event]))


def edit(
    tmp_path: Path,
    steps: Callable[[Editor], Awaitable[None]],
    *,
    client: str = "neovim",
    isolated: bool = True,
    watches: bool = True,
) -> None:
    """Copy the demo workspace, start the server in it and run the coroutine function ``steps`` with an Editor."""
    root = (tmp_path / "demo").resolve()
    shutil.copytree(DEMO, root)

    options = ["--distro", "jazzy", "--no-cache", *(["--isolated"] if isolated else [])]

    async def session() -> None:
        connection = make_test_lsp_client()
        await connection.start_io(sys.executable, "-m", "ros_lint", "lsp", *options)
        folder = types.WorkspaceFolder(root.as_uri(), "demo")
        capabilities = client_capabilities(client)
        assert capabilities.workspace is not None
        capabilities.workspace.did_change_watched_files = types.DidChangeWatchedFilesClientCapabilities(
            dynamic_registration=watches
        )
        parameters = types.InitializeParams(capabilities=capabilities, workspace_folders=[folder], root_uri=root.as_uri())
        await connection.initialize_session(parameters)
        await steps(Editor(root, connection))
        await connection.shutdown_session()
        await connection.stop()

    asyncio.run(asyncio.wait_for(session(), 300))


def test_the_findings_are_those_of_the_command_line(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        assert await editor.codes(DRIVER) == ["ROS103", "ROS204"]
        assert await editor.codes(LAUNCH) == ["ROS502", "ROS503"]
        assert await editor.codes(NODE) == ["ROS201"]

    edit(tmp_path, steps)


def test_findings_follow_the_unsaved_text(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        editor.open(LAUNCH)
        assert await editor.codes(LAUNCH) == ["ROS502", "ROS503"]
        text = editor.text(LAUNCH)
        editor.change(LAUNCH, text.replace("executable='driver'", "executable='driver_node'"))
        assert await editor.codes(LAUNCH) == ["ROS503"]
        editor.change(LAUNCH, f"import tf2_ros\n{text}")
        assert await editor.codes(LAUNCH) == ["ROS201", "ROS502", "ROS503"]
        editor.client.text_document_did_close(types.DidCloseTextDocumentParams(editor.identifier(LAUNCH)))
        assert await editor.codes(LAUNCH) == ["ROS502", "ROS503"], "the file on disk counts once its document is closed"

    edit(tmp_path, steps)


def test_a_change_of_one_file_updates_findings_in_others(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        editor.open(DRIVER)
        with_sensor_msgs = editor.text(DRIVER).replace(
            "<depend>rclcpp</depend>", "<depend>rclcpp</depend>\n  <depend>sensor_msgs</depend>"
        )
        assert await editor.codes(NODE) == ["ROS201"]
        editor.change(DRIVER, with_sensor_msgs)
        assert await editor.codes(NODE) == []

    edit(tmp_path, steps)


def test_changes_on_disk_are_read(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        await editor.settled()
        (editor.root / LAUNCH).write_text(editor.text(LAUNCH).replace("executable='driver'", "executable='driver_node'"), "utf-8")
        editor.changed_on_disk(LAUNCH)
        assert await editor.codes(LAUNCH) == ["ROS503"]
        (editor.root / LAUNCH).unlink()
        editor.changed_on_disk(LAUNCH, types.FileChangeType.Deleted)
        assert await editor.codes(LAUNCH) == []

    edit(tmp_path, steps)


def test_without_reports_of_changes_each_check_reads_the_disk(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        editor.open(DRIVER)
        assert await editor.codes(LAUNCH) == ["ROS502", "ROS503"]
        (editor.root / LAUNCH).write_text(editor.text(LAUNCH).replace("executable='driver'", "executable='driver_node'"), "utf-8")
        editor.change(DRIVER, editor.text(DRIVER) + "\n")
        assert await editor.codes(LAUNCH) == ["ROS503"]

    edit(tmp_path, steps, watches=False)


def test_the_configuration_is_read_again_when_it_changes(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        assert await editor.codes(NODE) == ["ROS201"]
        (editor.root / "ros-lint.toml").write_text('ignore = ["undeclared-dependency"]\n', "utf-8")
        editor.changed_on_disk("ros-lint.toml", types.FileChangeType.Created)
        assert await editor.codes(NODE) == []
        (editor.root / "ros-lint.toml").write_text("ignore = 1\n", "utf-8")
        editor.changed_on_disk("ros-lint.toml")
        await editor.settled()
        assert "'ignore' must be a list of strings" in editor.client.messages[-1].message

    edit(tmp_path, steps, isolated=False)


def test_the_progress_of_the_first_check_is_shown(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        await editor.settled()
        [(first, *between, last)] = editor.client.progress_reports.values()
        assert isinstance(first, types.WorkDoneProgressBegin)
        assert first.title == "ros-lint: demo"
        assert isinstance(last, types.WorkDoneProgressEnd)
        messages = [report.message or "" for report in between if isinstance(report, types.WorkDoneProgressReport)]
        assert messages
        assert len(messages) == len(between)

    edit(tmp_path, steps, client="visual-studio-code")


def test_a_quick_fix_resolves_its_finding(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        [action] = await editor.actions(NODE, editor.position(NODE, "sensor_msgs/msg"), "quickfix")
        assert (action.title, action.is_preferred) == ("Declare 'sensor_msgs' as <depend>", True)
        editor.apply(action.edit)
        editor.changed_on_disk(DRIVER)
        assert await editor.codes(NODE) == []
        [unsafe] = await editor.actions(LAUNCH, editor.position(LAUNCH, "executable='driver'"), "quickfix")
        assert unsafe.title == "Start 'driver_node' (may change behaviour)"
        assert not unsafe.is_preferred

    edit(tmp_path, steps)


def test_all_safe_fixes_are_made_at_once(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        editor.open(DRIVER, editor.text(DRIVER).replace("<version>", "<!-- unsaved --><version>"))
        [action] = await editor.actions(DRIVER, types.Position(0, 0), "source.fixAll")
        resolved = await editor.client.code_action_resolve_async(action)
        assert resolved.edit
        (editor.root / DRIVER).write_text(editor.text(DRIVER).replace("<version>", "<!-- unsaved --><version>"), "utf-8")
        editor.apply(resolved.edit)
        assert "<!-- unsaved -->" in editor.text(DRIVER)
        editor.client.text_document_did_close(types.DidCloseTextDocumentParams(editor.identifier(DRIVER)))
        for uri in resolved.edit.changes or {}:
            editor.changed_on_disk(uri.removeprefix(f"{editor.root.as_uri()}/"))
        assert await editor.codes(NODE) == []
        assert await editor.codes(DRIVER) == ["ROS103"]

    edit(tmp_path, steps)


def test_hover_describes_a_dependency_and_a_program(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        request = types.HoverParams(editor.identifier(DRIVER), editor.position(DRIVER, "<depend>rclcpp", 9))
        hover = await editor.client.text_document_hover_async(request)
        assert hover is not None
        assert isinstance(hover.contents, types.MarkupContent)
        first, declared, used, *_ = hover.contents.value.split("\n\n")
        assert first.startswith("**rclcpp**: released in jazzy, version ")
        assert declared == "Declared by 'rover_driver' as `<depend>`."
        assert used == "Used by 'rover_driver':"
        request = types.HoverParams(editor.identifier(LAUNCH), editor.position(LAUNCH, "'mission_server'", 3))
        hover = await editor.client.text_document_hover_async(request)
        assert hover is not None
        assert isinstance(hover.contents, types.MarkupContent)
        place = "src/rover_mission/CMakeLists.txt:9, installed as `lib/rover_mission/mission_server`"
        assert f"`mission_server`: defined in {place}" in hover.contents.value

    edit(tmp_path, steps)


VARIABLES = (
    ("set(NODES a b)\nmessage(${NODES})\n", "{NODES", "**NODES** = `a`; `b`"),
    ("set(NODES a b)\nlist(APPEND NODES c)\n", "NODES c", "**NODES** = `a`; `b`; `c`"),
    ("message(${PROJECT_NAME})\n", "PROJECT_NAME}", "**PROJECT_NAME** = `rover_driver`"),
    ("set(HERE ${CMAKE_CURRENT_SOURCE_DIR}/x)\n", "HERE", "**HERE** = `<workspace>/src/rover_driver/x`"),
    ("find_package(unknown)\nmessage(${unknown_DIR}/x)\n", "unknown_DIR}", "**unknown_DIR** = `...`"),
    ("message(${NONE})\n", "NONE", "**NONE** is not set"),
    ("if(FALSE)\nmessage(${NONE})\nendif()\n", "NONE", "**NONE**: this command does not run"),
    ("foreach(i a b)\nmessage(${i})\nendforeach()\n", "i}", "- `a`\n- `b`"),
    ("macro(show what)\nmessage(${what})\nendmacro()\nshow(c)\n", "what})", "**what** = `c`"),
    ("if(NOT WIN32)\nendif()\n", "WIN32", "**WIN32** is not set"),
)


def test_hover_shows_the_value_of_a_cmake_variable(tmp_path: Path) -> None:
    head = "cmake_minimum_required(VERSION 3.8)\nproject(rover_driver)\n"

    async def steps(editor: Editor) -> None:
        editor.open(SCRIPT)
        for text, word, expected in VARIABLES:
            editor.change(SCRIPT, head + text)
            before = head + text[: text.index(word)]
            position = types.Position(before.count("\n"), len(before.rpartition("\n")[2]) + 1)
            hover = await editor.client.text_document_hover_async(types.HoverParams(editor.identifier(SCRIPT), position))
            assert hover is not None, text
            assert isinstance(hover.contents, types.MarkupContent)
            assert hover.contents.value.endswith(expected)

    edit(tmp_path, steps)


def definitions(editor: Editor, result: object) -> list[tuple[str, int]]:
    """Return the path and the line, from 1, of each location."""
    assert isinstance(result, list | tuple)
    prefix = f"{editor.root.as_uri()}/"
    return [(location.uri.removeprefix(prefix), location.range.start.line + 1) for location in result]


@pytest.mark.parametrize(
    ("path", "word", "offset", "expected"),
    [
        (
            "src/rover_bringup/package.xml",
            "<exec_depend>rover_driver",
            14,
            ("src/rover_driver/package.xml", "<name>rover_driver"),
        ),
        (LAUNCH, "package='rover_driver'", 10, ("src/rover_driver/package.xml", "<name>rover_driver")),
    ],
)
def test_the_definition_of_a_dependency_is_its_manifest(
    tmp_path: Path, path: str, word: str, offset: int, expected: tuple[str, str]
) -> None:
    async def steps(editor: Editor) -> None:
        request = types.DefinitionParams(editor.identifier(path), editor.position(path, word, offset))
        result = definitions(editor, await editor.client.text_document_definition_async(request))
        assert result == [(expected[0], editor.position(*expected).line + 1)]

    edit(tmp_path, steps)


def test_the_definition_of_an_executable_is_its_cmake_target(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        editor.open(LAUNCH, editor.text(LAUNCH).replace("executable='driver'", "executable='driver_node'"))
        request = types.DefinitionParams(editor.identifier(LAUNCH), editor.position(LAUNCH, "executable='driver'", 13))
        result = definitions(editor, await editor.client.text_document_definition_async(request))
        script = "src/rover_driver/CMakeLists.txt"
        assert result == [(script, editor.position(script, "add_executable(driver_node").line + 1)]

    edit(tmp_path, steps)


def test_references_of_a_package(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        position = editor.position(DRIVER, "<name>rover_driver", 8)
        request = types.ReferenceParams(types.ReferenceContext(include_declaration=False), editor.identifier(DRIVER), position)
        result = definitions(editor, await editor.client.text_document_references_async(request))
        assert (
            "src/rover_bringup/package.xml",
            editor.position("src/rover_bringup/package.xml", "rover_driver").line + 1,
        ) in result
        assert (LAUNCH, editor.position(LAUNCH, "package='rover_driver'").line + 1) in result

    edit(tmp_path, steps)


COMPLETIONS = (
    (DRIVER, "<package><depend>rover_i", "rover_interfaces"),
    (DRIVER, "<package><exec_depend>tf2_geometry_m", "tf2_geometry_msgs"),
    (LAUNCH, "Node(package='rover_d", "rover_driver"),
    (LAUNCH, "Node(package='rover_driver', executable='dri", "driver_node"),
    (LAUNCH, "os.path.join(get_package_share_directory('rover_driver'), 'config', 'dr", "driver.yaml"),
    (LAUNCH, "[FindPackageShare('rover_driver'), 'conf", "config/driver.yaml"),
    (LAUNCH, '<include file="$(find-pkg-share rover_bringup)/', "launch/rover.launch.py"),
)


def test_names_are_completed(tmp_path: Path) -> None:
    async def steps(editor: Editor) -> None:
        editor.open(DRIVER)
        editor.open(LAUNCH)
        for path, text, first in COMPLETIONS:
            saved = editor.text(path)
            editor.change(path, text)
            result = await editor.client.text_document_completion_async(
                types.CompletionParams(editor.identifier(path), types.Position(0, len(text)))
            )
            assert isinstance(result, types.CompletionList)
            assert result.items[0].label == first, text
            editor.change(path, saved)

    edit(tmp_path, steps)


@pytest.mark.parametrize("client", ["neovim", "visual-studio-code", "emacs"])
def test_columns_count_the_units_of_the_client(tmp_path: Path, client: str) -> None:
    async def steps(editor: Editor) -> None:
        text = editor.text(LAUNCH)
        line = next(line for line in text.splitlines() if "executable='driver'" in line)
        editor.open(LAUNCH, text.replace(line, line.replace("Node(", "Node(name='\N{ROBOT FACE}', ")))
        await editor.settled()
        [diagnostic] = [found for found in editor.client.diagnostics[editor.uri(LAUNCH)] if found.code == "ROS502"]
        assert diagnostic.range.end.character - diagnostic.range.start.character == len("driver")
        before = line.replace("Node(", "Node(name='\N{ROBOT FACE}', ").partition("'driver'")[0] + "'"
        assert diagnostic.range.start.character in (len(before), len(before) + 1, len(before.encode()))

    edit(tmp_path, steps, client=client)


def test_a_missing_library_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    from ros_lint.cli.main import main

    monkeypatch.delitem(sys.modules, "ros_lint.cli.commands.lsp.server", raising=False)
    monkeypatch.setitem(sys.modules, "pygls", None)
    assert main(["lsp"]) == 2
    assert "pip install 'ros-lint[lsp]'" in capsys.readouterr().err
