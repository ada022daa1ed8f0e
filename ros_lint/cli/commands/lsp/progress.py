"""The progress of the first check of a folder, which the editor shows."""

from __future__ import annotations

import asyncio
import time
import uuid
from types import TracebackType
from typing import TYPE_CHECKING

from lsprotocol import types
from pygls.exceptions import JsonRpcException

if TYPE_CHECKING:
    from pygls.lsp.server import LanguageServer

_PAUSE = 0.1
"""Seconds between two messages to the editor."""


class LoadingProgress:
    """Shows in the editor what a check is doing, inside of ``async with``. An editor without this feature gets nothing."""

    def __init__(self, server: LanguageServer, title: str) -> None:
        window = server.client_capabilities.window
        self._server = server if window is not None and window.work_done_progress else None
        self._title = title
        self._token = str(uuid.uuid4())
        self._loop = asyncio.get_running_loop()
        self._next = 0.0
        self._open = False

    async def __aenter__(self) -> LoadingProgress:
        if self._server is not None:
            try:
                await self._server.work_done_progress.create_async(self._token)
            except JsonRpcException:  # the editor refuses to show it
                self._server = None
            else:
                self._server.work_done_progress.begin(self._token, types.WorkDoneProgressBegin(self._title))
                self._open = True
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        if self._server is not None:
            self._open = False
            self._server.work_done_progress.end(self._token, types.WorkDoneProgressEnd())

    def update(self, step: str, finished: int, total: int) -> None:
        """Show the current step and, if ``total`` is not 0, the number of finished items. It may be called in any thread."""
        now = time.monotonic()
        if self._server is not None and self._open and now >= self._next:
            self._next = now + _PAUSE
            message = f"{step} {finished}/{total}" if total else step
            self._loop.call_soon_threadsafe(self._report, message)

    def _report(self, message: str) -> None:
        if self._server is not None and self._open:
            self._server.work_done_progress.report(self._token, types.WorkDoneProgressReport(message=message))
