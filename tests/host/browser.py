"""ComfyUI's page in Chromium, driven through the frontend's own objects."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

__all__ = ["EXECUTABLE", "Page", "opened"]

EXECUTABLE = Path(os.environ.get("CHROMIUM", "/usr/bin/chromium"))

# SwiftShader draws WebGL where there is no graphics card.
_ARGUMENTS = [
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--enable-unsafe-swiftshader",
]
# What the frontends complain about by themselves: files that the host lacks, routes that are newer than the host, the
# outside world; a page file that fails, which they name in a second message; subgraphs that are left or unpacked.
_HOST_NOISE = (
    "Failed to load resource",
    "[Jobs API]",
    "Fetch API cannot load",
    "Connecting to",
    "[vite:preloadError]",
    "Attempted to cleanup event listeners",
    "Missing Link ID when unpacking",
)
_READY = "() => window.app?.graph && window.LiteGraph?.registered_node_types?.['PhysAnimator_Render']"


def of_another_pack(told: str) -> bool:
    """Whether an error comes from page files of other packs or of the host's own extensions, and of none of ours."""
    return bool(re.search(r"/extensions/[^/\s]+/", told)) and "physanimator" not in told.lower()


class Page:
    """A page with ComfyUI in it.

    Attributes:
        page: Playwright's page.
        problems: console errors and uncaught exceptions so far, without the host's own.
    """

    def __init__(self, page: Any) -> None:
        self.page = page
        self.problems: list[str] = []
        page.on("console", self._on_console)
        page.on("pageerror", self._on_uncaught)

    def _on_console(self, message: Any) -> None:
        told = f"{message.text} {message.location['url']}"
        noise = message.text.startswith(_HOST_NOISE) and "physanimator" not in told.lower()
        if message.type == "error" and not noise and not of_another_pack(told):
            self.problems.append(message.text)

    def _on_uncaught(self, error: Any) -> None:
        if not of_another_pack(f"{error} {error.stack}"):
            self.problems.append(f"uncaught: {error}")

    def run(self, script: str, argument: Any = None) -> Any:
        """The value of a JavaScript function, awaited."""
        return self.page.evaluate(script, argument)

    def load(self, workflow: dict[str, Any]) -> None:
        """Open a workflow as the user would by dropping its file."""
        self.run("(workflow) => app.loadGraphData(workflow, true, true)", workflow)
        self.page.wait_for_timeout(500)

    def fit(self) -> None:
        """Bring the whole graph into view."""
        self.run("() => app.extensionManager.command.execute('Comfy.Canvas.FitView')")
        self.page.wait_for_timeout(1000)

    def reload(self) -> None:
        """The page anew, as after pressing F5."""
        self.page.reload()
        self.wait_until_ready()

    def wait_until_ready(self) -> None:
        self.page.wait_for_function(_READY, timeout=120_000)
        self.page.wait_for_timeout(1000)

    def screenshot(self, path: str) -> None:
        self.page.screenshot(path=path)


@contextmanager
def opened(url: str) -> Iterator[Page]:
    """The page at a URL, ready for use and without the dialogs that greet a new user."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=EXECUTABLE, args=_ARGUMENTS)
        tab = chromium.new_page(viewport={"width": 1920, "height": 1080})
        page = Page(tab)
        tab.request.post(f"{url}/settings/Comfy.TutorialCompleted", data="true")
        tab.goto(url)
        page.wait_until_ready()
        yield page
        chromium.close()
