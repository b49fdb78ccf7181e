"""Headless Chromium by chromedriver's W3C WebDriver protocol; it needs the standard library only."""

from __future__ import annotations

import base64
import json
import shutil
import subprocess
import urllib.request
from contextlib import contextmanager

import pytest

_ARGUMENTS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-sync",
    "--no-first-run",
    "--no-pings",
    "--proxy-server=direct://",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
)
_OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))


class Browser:
    def __init__(self, driver: str, size: tuple[int, int], dark: bool = True) -> None:
        self._driver = driver
        arguments = [*_ARGUMENTS, f"--window-size={size[0]},{size[1]}"]
        if dark:
            arguments.append("--force-dark-mode")
        binary = shutil.which("chromium") or shutil.which("chromium-browser")
        options = {"args": arguments, "binary": binary}
        capabilities = {"goog:chromeOptions": options, "goog:loggingPrefs": {"browser": "ALL"}}
        made = self._call("POST", "/session", {"capabilities": {"alwaysMatch": capabilities}})
        self._session = f"/session/{made['sessionId']}"
        self._call("POST", f"{self._session}/timeouts", {"script": 60000})

    def open(self, url: str) -> None:
        self._call("POST", f"{self._session}/url", {"url": url})

    def run(self, script: str, *arguments: object) -> object:
        """Run the body of a JavaScript function; return its value."""
        return self._call("POST", f"{self._session}/execute/sync", {"script": script, "args": list(arguments)})

    def until(self, condition: str, seconds: float = 30) -> object:
        """Wait in the page until a JavaScript expression is true; return its value."""
        # The condition is part of the script: the security policy of the page forbids eval().
        script = f"""
            const done = arguments[arguments.length - 1];
            const end = performance.now() + {seconds} * 1000;
            const look = () => {{
              let value = null;
              try {{ value = {condition}; }} catch {{ }}
              if (value || performance.now() > end) done(value); else setTimeout(look, 20);
            }};
            look();
        """
        return self._call("POST", f"{self._session}/execute/async", {"script": script, "args": []})

    def keys(self, down: list[str], seconds: float) -> None:
        """Press keys together for some seconds."""
        press = [{"type": "keyDown", "value": key} for key in down]
        lift = [{"type": "keyUp", "value": key} for key in down]
        actions = [*press, {"type": "pause", "duration": int(seconds * 1000)}, *lift]
        self._call("POST", f"{self._session}/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def drag(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        actions = [
            {"type": "pointerMove", "x": start[0], "y": start[1], "duration": 0},
            {"type": "pointerDown", "button": 0},
            {"type": "pointerMove", "x": end[0], "y": end[1], "duration": 100},
            {"type": "pointerUp", "button": 0},
        ]
        self._call(
            "POST", f"{self._session}/actions", {"actions": [{"type": "pointer", "id": "mouse", "actions": actions}]}
        )

    def give_files(self, selector: str, paths: list[str]) -> None:
        found = self._call("POST", f"{self._session}/element", {"using": "css selector", "value": selector})
        element = next(iter(found.values()))
        self._call("POST", f"{self._session}/element/{element}/value", {"text": "\n".join(paths)})

    def screenshot(self) -> bytes:
        return base64.b64decode(self._call("GET", f"{self._session}/screenshot"))

    def faults(self) -> list[str]:
        """The severe messages of the console."""
        log = self._call("POST", f"{self._session}/se/log", {"type": "browser"})
        return [entry["message"] for entry in log if entry["level"] == "SEVERE"]

    def close(self) -> None:
        self._call("DELETE", self._session)

    def _call(self, method: str, path: str, body: object = None) -> dict:
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self._driver + path, data, {"Content-Type": "application/json"}, method=method)
        try:
            with _OPENER.open(request, timeout=120) as response:
                return json.load(response)["value"]
        except urllib.error.HTTPError as error:
            raise AssertionError(error.read().decode()[:2000]) from None


@contextmanager
def chromium(size: tuple[int, int] = (1280, 800), dark: bool = True):
    if shutil.which("chromedriver") is None or not (shutil.which("chromium") or shutil.which("chromium-browser")):
        pytest.skip("no chromium and chromedriver here; apt install chromium chromium-driver")
    with subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True) as driver:
        try:
            port = next(
                line.split("port ")[1].split(".")[0].strip() for line in driver.stdout if "started successfully" in line
            )
            browser = Browser(f"http://127.0.0.1:{port}", size, dark)
            try:
                yield browser
            finally:
                browser.close()
        finally:
            driver.terminate()
