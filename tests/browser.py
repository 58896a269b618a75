"""One headless Chromium for all tests of pages; README's picture of a page is made with it, too."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

PROGRAMS = {"chromium": "chromium", "chromedriver": "chromium-driver"}
#: For root and for a machine without a network; every page is a local file.
FLAGS = ("headless", "no-sandbox", "disable-gpu", "disable-quic", "no-first-run", "disable-background-networking",
         "disable-component-update", "disable-sync", "disable-dev-shm-usage", "hide-scrollbars")  # fmt: skip
#: So often a browser is tried to be started: on a machine that does much else it may be late.
TRIES = 3


def started(profile: Path) -> Any:
    """A driver of a new Chromium, which keeps what it writes in a folder."""
    from selenium import webdriver
    from selenium.common.exceptions import WebDriverException

    for tries in range(TRIES):
        options = webdriver.ChromeOptions()
        options.binary_location = shutil.which("chromium") or ""
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        for flag in [*FLAGS, f"user-data-dir={profile / str(tries)}"]:
            options.add_argument(f"--{flag}")
        try:
            return webdriver.Chrome(options=options, service=webdriver.ChromeService(shutil.which("chromedriver")))
        except WebDriverException:
            if tries == TRIES - 1:
                raise
    raise AssertionError


class Browser:
    """A driver with what these tests do often."""

    def __init__(self, driver: Any):
        self.driver = driver

    def open(self, page: Path, width: int = 1280, height: int = 1000, dark: bool = False) -> None:
        """Open a file and wait until it is ready."""
        self.resize(width, height, dark)
        self.driver.get(page.as_uri())
        failed = self.driver.execute_async_script(
            "const done = arguments[0]; window.ready.then(() => done(null), (error) => done(String(error.stack)))"
        )
        assert failed is None

    def resize(self, width: int, height: int, dark: bool = False) -> None:
        screen = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 700}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})

    def run(self, script: str, *arguments: Any) -> Any:
        """The value of an expression in the page."""
        return self.driver.execute_script(f"return {script}", *arguments)

    def text(self, selector: str) -> list[str]:
        """What the elements say."""
        return self.run("[...document.querySelectorAll(arguments[0])].map((found) => found.textContent)", selector)

    def complaints(self) -> list[Any]:
        """What the console has, and the addresses that were asked for besides the page's own data."""
        asked = self.run("performance.getEntriesByType('resource').map((entry) => entry.name)")
        return [*self.driver.get_log("browser"), *(name for name in asked if not name.startswith("data:"))]


@pytest.fixture(scope="session")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Browser]:
    missing = [package for program, package in PROGRAMS.items() if shutil.which(program) is None]
    if missing:
        pytest.skip(f"pages are tested in a browser: apt-get install {' '.join(missing)}")
    pytest.importorskip("selenium.webdriver", reason="pages are tested with selenium")
    driver = started(tmp_path_factory.mktemp("chromium"))
    driver.set_script_timeout(120)
    yield Browser(driver)
    driver.quit()
