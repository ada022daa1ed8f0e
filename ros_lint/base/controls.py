"""Characters that are harmful in a terminal."""

from __future__ import annotations

import re

HARMFUL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]")
"""Matches controls, except for tabs and line feeds, and characters that change the direction of writing."""
