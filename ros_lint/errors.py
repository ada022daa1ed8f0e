"""Errors that end a run with a message for the user."""

from __future__ import annotations


class UserError(Exception):
    """A request of the user that cannot be fulfilled. The message names the reason and the remedy."""
