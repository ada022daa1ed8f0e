"""The base class of the errors that end a run with a message for the user."""

from __future__ import annotations


class UserError(Exception):
    """A request of the user cannot be fulfilled. The message states the reason and a remedy."""
