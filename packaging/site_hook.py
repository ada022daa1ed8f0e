"""Correct the pages of the theme for HTML validators and screen readers.

Corrected are roles that elements have anyway, landmarks, and blocks that scroll but cannot have the focus.
"""

from __future__ import annotations

import re

_REPLACEMENTS = (
    (re.compile(r"(<nav\b[^>]*?) role=\"navigation\""), r"\1"),
    (re.compile(r"(<body\b[^>]*?) role=\"document\""), r"\1"),
    (re.compile(r"<footer>"), '<section aria-label="Footer">'),
    (re.compile(r"</footer>"), "</section>"),
    (re.compile(r'<div role="contentinfo">'), "<div>"),
    (re.compile(r'role="note" aria-label="Versions"'), 'role="region" aria-label="Pages"'),
    (re.compile(r"<(pre><code|table)\b"), r'<\1 tabindex="0"'),
    (re.compile(r"<((?:br|hr|img|input|link|meta)\b[^<>]*?)\s*/>"), r"<\1>"),
)


def on_post_page(output: str, **_: object) -> str:
    """Return the HTML of a page with the corrections; called by MkDocs."""
    for pattern, replacement in _REPLACEMENTS:
        output = pattern.sub(replacement, output)
    return output


def on_post_template(output_content: str, **_: object) -> str:
    """Return the HTML of the search page or the error page with the corrections; called by MkDocs."""
    return on_post_page(output_content)
