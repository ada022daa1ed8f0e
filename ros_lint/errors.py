"""Errors that end a run with a message for the user."""

from __future__ import annotations


class UserError(Exception):
    """The tool cannot do what was asked for. The message names the reason, and the way out."""
