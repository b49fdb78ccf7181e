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
    "--host-resolver-rules=MAP voxrt.example 127.0.0.1, MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
)
_MOUSE = "--blink-settings=primaryPointerType=4,availablePointerTypes=4,primaryHoverType=2,availableHoverTypes=2"
"""A mouse is there, which pages can lock."""

RESTS = "document.querySelector('#stage').getAttribute('aria-busy') === 'false'"
"""The picture is as fine as it will be."""

SCREENS = {"desktop": (1280, 800, False), "phone": (390, 844, True), "lying phone": (844, 390, True)}
"""Width, height, and whether it is for fingers."""

_OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))


class Browser:
    def __init__(self, driver: str, size: tuple[int, int], dark: bool = True, mouse: bool = False) -> None:
        self._driver = driver
        arguments = [*_ARGUMENTS, f"--window-size={size[0]},{size[1]}"]
        if dark:
            arguments.append("--force-dark-mode")
        if mouse:
            arguments.append(_MOUSE)
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

    def run_async(self, script: str, *arguments: object) -> object:
        """The same for a function whose last argument is called with its value."""
        return self._call("POST", f"{self._session}/execute/async", {"script": script, "args": list(arguments)})

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
        return self.run_async(script)

    def draws(self) -> None:
        """Wait until the page has drawn twice: by then it knows every event that was sent before."""
        script = "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done(null)));"
        self.run_async(script)

    def click(self, selector: str) -> None:
        """Click an element, wherever it is."""
        self.run("document.querySelector(arguments[0]).click()", selector)

    def enter(self, selector: str, value: object, event: str = "input") -> None:
        """Give a field a value, as a user does."""
        script = "const field = document.querySelector(arguments[0]); field.value = arguments[1];"
        self.run(f"{script} field.dispatchEvent(new Event(arguments[2], {{ bubbles: true }}))", selector, value, event)

    def keys(self, down: list[str], seconds: float) -> None:
        """Press keys together for some seconds."""
        press = [{"type": "keyDown", "value": key} for key in down]
        lift = [{"type": "keyUp", "value": key} for key in down]
        actions = [*press, {"type": "pause", "duration": int(seconds * 1000)}, *lift]
        self._call("POST", f"{self._session}/actions", {"actions": [{"type": "key", "id": "keys", "actions": actions}]})

    def cdp(self, command: str, **parameters: object) -> dict:
        """Send a command of the Chrome DevTools Protocol."""
        return self._call("POST", f"{self._session}/goog/cdp/execute", {"cmd": command, "params": parameters})

    def screen(self, width: int, height: int, *, touch: bool = False, ratio: float = 1) -> None:
        """Make the page this large, pixels of the page; `touch` makes the screen one for fingers."""
        self.cdp(
            "Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=ratio, mobile=touch
        )
        self.cdp("Emulation.setTouchEmulationEnabled", enabled=touch, maxTouchPoints=5 if touch else 1)

    def theme(self, *, dark: bool) -> None:
        features = [
            {"name": "prefers-color-scheme", "value": "dark" if dark else "light"},
            {"name": "prefers-reduced-motion", "value": "reduce"},  # colours change at once
        ]
        self.cdp("Emulation.setEmulatedMedia", features=features)

    def mouse(
        self, path: list[tuple[float, float]], button: str = "left", *, clicks: int = 1, modifiers: int = 0
    ) -> None:
        """Press a button at the first place, move through the others, and let it go at the last.

        Shift is modifier 8.
        """
        held = {"left": 1, "right": 2, "middle": 4}[button]
        (x, y), (end_x, end_y) = path[0], path[-1]
        common = {"button": button, "modifiers": modifiers}
        self.cdp("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        for click in range(1, clicks + 1):
            self.cdp(
                "Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, buttons=held, clickCount=click, **common
            )
            for to_x, to_y in path[1:]:
                self.cdp("Input.dispatchMouseEvent", type="mouseMoved", x=to_x, y=to_y, buttons=held, **common)
            self.cdp("Input.dispatchMouseEvent", type="mouseReleased", x=end_x, y=end_y, clickCount=click, **common)

    def wheel(self, x: float, y: float, pixels: float) -> None:
        self.cdp("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=pixels)

    def touch(self, *paths: list[tuple[float, float]]) -> None:
        """Put down a finger per path, move all of them, and lift them; paths have the same number of places."""
        for number, places in enumerate(zip(*paths, strict=True)):
            points = [{"x": x, "y": y, "id": finger} for finger, (x, y) in enumerate(places)]
            self.cdp("Input.dispatchTouchEvent", type="touchMove" if number else "touchStart", touchPoints=points)
        self.cdp("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def drop(self, x: float, y: float, files: list[str]) -> None:
        """Drag files from the desktop to a place and drop them."""
        data = {"items": [], "files": files, "dragOperationsMask": 1}
        for kind in ("dragEnter", "dragOver", "drop"):
            self.cdp("Input.dispatchDragEvent", type=kind, x=x, y=y, data=data)

    def middle(self, selector: str) -> tuple[float, float]:
        """Where the middle of an element is on the page."""
        x, y = self.run(
            "const b = document.querySelector(arguments[0]).getBoundingClientRect();"
            "return [b.x + b.width / 2, b.y + b.height / 2]",
            selector,
        )
        return x, y

    @contextmanager
    def held(self, key: str, code: str = ""):
        """Hold a key as long as the context lasts."""
        text = {"text": key} if len(key) == 1 else {"text": "\r"} if key == "Enter" else {}
        number = {"Tab": 9, "Enter": 13, "Escape": 27, "ArrowRight": 39, "ArrowLeft": 37}.get(key, ord(key[0].upper()))
        known = {"key": key, "code": code or key, "windowsVirtualKeyCode": number}
        self.cdp("Input.dispatchKeyEvent", type="keyDown", **known, **text)
        yield
        self.cdp("Input.dispatchKeyEvent", type="keyUp", **known)

    def key(self, key: str, code: str = "") -> None:
        """Press a key and let it go."""
        with self.held(key, code):
            pass

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
def chromium(size: tuple[int, int] = (1280, 800), dark: bool = True, mouse: bool = False):
    if shutil.which("chromedriver") is None or not (shutil.which("chromium") or shutil.which("chromium-browser")):
        pytest.skip("no chromium and chromedriver here; apt install chromium chromium-driver")
    with subprocess.Popen(["chromedriver", "--port=0"], stdout=subprocess.PIPE, text=True) as driver:
        try:
            port = next(
                line.split("port ")[1].split(".")[0].strip() for line in driver.stdout if "started successfully" in line
            )
            browser = Browser(f"http://127.0.0.1:{port}", size, dark, mouse)
            try:
                yield browser
            finally:
                browser.close()
        finally:
            driver.terminate()
