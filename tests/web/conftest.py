from __future__ import annotations

import pytest
from fakes.browser import Browser, chromium
from fakes.site_server import QuietHandler, serving_site


@pytest.fixture(scope="session")
def address():
    with serving_site() as served:
        yield served


@pytest.fixture
def paths():
    """The paths that the page asks for, from the start of the test."""
    QuietHandler.paths.clear()
    return QuietHandler.paths


@pytest.fixture(scope="module")
def opened_browser(address: str):
    with chromium() as one:
        one.address = address
        yield one


@pytest.fixture
def browser(opened_browser: Browser):
    """The browser of the module; the page must say nothing severe on its console."""
    yield opened_browser
    assert opened_browser.faults() == []
