"""README.md's picture of a browser: ``python -m docs.pictures.make_browser``, with Chromium and selenium."""

from __future__ import annotations

import base64
import io
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.wait import WebDriverWait

from tests.browser import started

FILE = Path(__file__).resolve().parent / "browser.jpg"
SIZE, QUALITY = (1280, 820), 84
#: What is compared, from where the pull starts in px from the picture's middle, and the pull.
LINK, START, PULL = "#basketball?launch.angle=45&launch.speed=7.3", (-250, 60), (-109, 141)
IDLE = "player && state.stage && Object.values(ask).every((each) => !each.awaited && !each.next)"


def picture(driver: webdriver.Chrome, url: str) -> Image.Image:
    """The page while a free throw is pulled: an earlier one compared, similar shots around it."""

    def until(expression: str) -> None:
        WebDriverWait(driver, 60).until(lambda _: driver.execute_script(f"return Boolean({expression})"))

    screen = {"width": SIZE[0], "height": SIZE[1], "deviceScaleFactor": 1, "mobile": False}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", screen)
    driver.get(url + LINK)
    until(IDLE)
    driver.find_element(By.ID, "keep").click()
    driver.find_element(By.ID, "fan").click()
    canvas = driver.find_element(By.ID, "picture")
    pull = ActionChains(driver, duration=50).move_to_element_with_offset(canvas, *START).click_and_hold()
    pull.move_by_offset(*PULL).perform()
    until("player.fan && !player.fan.late")
    until(IDLE)
    driver.execute_script("document.querySelector('.side').scrollTop = 0")
    shot = driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png"})
    return Image.open(io.BytesIO(base64.b64decode(shot["data"]))).convert("RGB")


def main() -> None:
    command = [sys.executable, "-m", "sandbox", "serve", "basketball", "--port", "0", "--json"]
    server = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert server.stdout is not None
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = started(Path(profile))
        try:
            image = picture(driver, json.loads(server.stdout.readline())["url"])
            image.save(FILE, quality=QUALITY, subsampling=0, optimize=True, progressive=True)
        finally:
            driver.quit()
            server.terminate()
            server.wait()


if __name__ == "__main__":
    main()
