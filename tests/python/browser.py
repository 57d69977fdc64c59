"""A headless Chromium for the tests of pages, driven by Selenium."""

from __future__ import annotations

import base64
import io
import json
import shutil
import socket
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

_NAMES = ("chromium", "chromium-browser", "google-chrome")
# WebGL without a graphics card; nothing is looked up in the network, and no start page is.
_ARGUMENTS = (
    *("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--hide-scrollbars", "--no-first-run"),
    *("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-background-networking", "--disable-component-update", "--host-resolver-rules=MAP * ~NOTFOUND"),
)
_PATIENCE = 60  # s


class Browser:
    """One window of Chromium."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def open(self, path: Path, size: tuple[int, int] = (360, 300), *, dark: bool = False) -> str:
        """Open a page in a window of a size, wait until it is ready or has given up, and return its state."""
        metrics = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})
        self.messages(), self.requests()  # those of the page before
        self.driver.get(path.as_uri())
        return self.wait_for("return document.documentElement.dataset.state")

    def run(self, script: str, *arguments: object) -> Any:
        """Run a script in the page; `viewer` is its viewer."""
        return self.driver.execute_script(f"const viewer = window.pectinate; {script}", *arguments)

    def wait_for(self, script: str) -> Any:
        """Run a script until it returns something."""
        give_up = time.monotonic() + _PATIENCE
        while time.monotonic() < give_up:
            if result := self.run(script):
                return result
            time.sleep(0.02)
        pytest.fail(f"waited {_PATIENCE} s in vain for: {script}")

    def picture(self, *, written: bool = False, ratio: int = 1) -> NDArray[np.float64]:
        """The picture as it is now, (h, w, 3), 0 to 255, at the size of the window; by default as fast as can be.

        With `written`, markers and scales are there too; `ratio` is the number of pixels drawn across each.
        """
        url = self.run(f"return viewer.screenshot({json.dumps(written)}, {ratio})")
        image = Image.open(io.BytesIO(base64.b64decode(url.partition(",")[2])))
        return np.asarray(image.convert("RGB").reduce(ratio), dtype=np.float64)

    def window(self) -> NDArray[np.float64]:
        """The whole window, controls included, (h, w, 3), 0 to 255, with the fine picture that a page at rest has."""
        self.run("if (viewer) { clearTimeout(viewer.finePicture); viewer.draw(2); }")
        return np.asarray(Image.open(io.BytesIO(self.driver.get_screenshot_as_png())).convert("RGB"), dtype=np.float64)

    def messages(self) -> list[str]:
        """What was written to the console since it was last asked for."""
        return [entry["message"] for entry in self.driver.get_log("browser")]

    def requests(self) -> list[str]:
        """What was asked for since it was last asked for: the beginning of each address."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        sent = [message["params"] for message in messages if message["method"] == "Network.requestWillBeSent"]
        return [params["request"]["url"][:100] for params in sent]


def start_browser(*more_arguments: str) -> Browser:
    """Start Chromium; skips the test, with the reason, where it or Selenium is not installed."""
    webdriver = pytest.importorskip("selenium.webdriver", reason="needs Selenium: pip install pectinate[test]")
    browser = next(filter(None, map(shutil.which, _NAMES)), None)
    driver = shutil.which("chromedriver")
    if browser is None or driver is None:
        pytest.skip("needs Chromium and its driver; on Debian: apt-get install chromium chromium-driver")
    try:
        socket.getaddrinfo("localhost", None)
    except OSError:
        pytest.skip("Selenium asks for the name localhost, which this system does not know; see /etc/hosts")
    options = webdriver.ChromeOptions()
    options.binary_location = browser
    for argument in (*_ARGUMENTS, *more_arguments):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return Browser(webdriver.Chrome(options=options, service=webdriver.ChromeService(executable_path=driver)))
