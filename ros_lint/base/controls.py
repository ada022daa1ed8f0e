"""Characters that are harmful in a terminal."""

from __future__ import annotations

import re

HARMFUL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
"""Matches controls, except for tabs and line feeds, and characters that change the direction of writing."""

LOG_COMMAND = re.compile(r"##(?=\[|vso\[)")
"""Matches the start of a command for GitHub Actions (``##[error]``) and Azure Pipelines (``##vso[...]``).

They execute it anywhere in a line (actions/runner, src/Runner.Common/ActionCommand.cs, TryParse; microsoft/azure-pipelines-agent,
Command.cs, TryParse), but ``::error::`` only at the start of a line, after blanks (TryParseV2 of the former).
"""
