"""Write the pictures of the docs: ``python packaging/screenshots.py``.

They show the pages of ``ros-lint graph`` and ``ros-lint launch`` for workspaces of ``fixtures/``, in the light colours.
It needs the package playwright and the program chromium.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from playwright.sync_api import Page, sync_playwright

ROOT = Path(__file__).parent.parent


class Picture(NamedTuple):
    """A picture of a page: the command that prints the page, and the size in pixels."""

    name: str
    arguments: tuple[str, ...]
    height: int
    width: int = 1000


PICTURES = (
    Picture("graph-page", ("graph", "fixtures/workspaces/demo", "--external"), 520),
    Picture("launch-page", ("launch", "fixtures/workspaces/launch/src/arm_bringup/launch/arm.launch.py", "side:=left"), 430),
)


def main() -> None:
    """Write all pictures."""
    with sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        for picture in PICTURES:
            tab = browser.new_page(color_scheme="light", viewport={"width": picture.width, "height": picture.height})
            file = Path(folder, f"{picture.name}.html")
            file.write_bytes(_page(picture.arguments))
            tab.goto(file.as_uri())
            _prepare(tab, picture.name)
            tab.screenshot(path=ROOT / "docs" / "images" / f"{picture.name}.png")
        browser.close()


def _page(arguments: tuple[str, ...]) -> bytes:
    """Return the page that a command prints."""
    command = [sys.executable, "-m", "ros_lint", *arguments, "--distro", "jazzy", "--format", "html"]
    return subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout  # noqa: S603  (our own command)


def _prepare(tab: Page, name: str) -> None:
    """Bring a page into the state that its picture shows."""
    if name == "launch-page":
        tab.locator(".item.node summary").first.click()
    else:
        tab.fill("#search", "rover_driver")
        tab.wait_for_timeout(300)


if __name__ == "__main__":
    main()
