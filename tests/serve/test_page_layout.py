"""The page on a desktop, a phone, and a phone that lies: what fits, what can be reached, and what can be read."""

from __future__ import annotations

from itertools import pairwise

import pytest
from fakes.browser import RESTS, SCREENS, chromium
from fakes.page_server import scene_of, serving
from oracles import worlds

OPEN_ALL = """
document.querySelector("#advanced").open = true;
document.querySelector("[data-feature=light]").click();
document.querySelector("[data-feature=mirrors]").click();
"""
SMALL_TARGETS = """
return [...document.querySelectorAll("button, input:not([type=file]), select, summary")].filter((element) => {
  const { width, height } = element.getBoundingClientRect();
  return element.checkVisibility() && (width < 24 || height < 24);
}).map((element) => element.outerHTML);
"""
# The script lists visible elements with text of their own: the text, and its contrast with what is behind.
# It ends every transition first, so that no colour is read on its way from one to the other.
CONTRASTS = """
document.getAnimations().forEach((animation) => animation.finish());
const parse = (colour) => { const n = colour.match(/[\\d.]+/g).map(Number); return [...n.slice(0, 3), n[3] ?? 1]; };
const over = ([r, g, b, a], back) => [r, g, b].map((part, i) => part * a + back[i] * (1 - a));
const linear = (part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
const light = (rgb) => rgb.map((part) => linear(part / 255))
  .reduce((sum, part, i) => sum + part * [0.2126, 0.7152, 0.0722][i], 0);
const behind = (element) => {
  if (!element) return [0, 0, 0];
  const colour = parse(getComputedStyle(element).backgroundColor);
  return colour[3] === 1 ? colour.slice(0, 3) : over(colour, behind(element.parentElement));
};
return [...document.querySelectorAll("body *")].filter((element) =>
  element.checkVisibility({ visibilityProperty: true }) && !element.disabled && element.tagName !== "OPTION" &&
  [...element.childNodes].some((node) => node.nodeType === 3 && node.data.trim())).map((element) => {
    const back = behind(element);
    const levels = [light(over(parse(getComputedStyle(element).color), back)), light(back)].sort((a, b) => b - a);
    return [element.innerText, (levels[0] + 0.05) / (levels[1] + 0.05)];
  });
"""


@pytest.fixture(scope="module", params=SCREENS)
def browser(request):
    width, height, touch = SCREENS[request.param]
    with chromium((1280, 900)) as opened, serving(scene_of("ball", worlds.ball(4), 4)) as server:
        opened.screen(width, height, touch=touch)
        opened.open(server.url)
        assert opened.until(RESTS)
        opened.size = (width, height)
        opened.touches = touch
        yield opened
        assert opened.faults() == []


def test_all_fits(browser):
    width, height = browser.size
    assert browser.run("return [document.documentElement.scrollWidth, document.documentElement.scrollHeight]") == [
        width,
        height,
    ]
    stage = browser.run("const s = document.querySelector('#stage'); return [s.clientWidth, s.clientHeight]")
    assert stage[0] * stage[1] > 0.45 * width * height
    for tool in ("orbit", "fly", "frame", "statistics", "save", "toggle-panel"):
        x, y = browser.middle(f"#{tool}")
        found = browser.run("return document.elementFromPoint(arguments[0], arguments[1])?.id", x, y)
        assert found == tool


def test_no_text_is_cut(browser):
    """Not even while somebody else has control."""
    script = """
        const control = document.querySelector("#control");
        const [before, hidden] = [control.textContent, document.querySelector("#take").hidden];
        control.textContent = "viewer 12 has control";
        document.querySelector("#take").hidden = false;
        const texts = [control, ...document.querySelectorAll("header button, .chips button")];
        const cut = texts.filter((one) => one.checkVisibility() && one.scrollWidth > one.clientWidth);
        const outside = texts.filter((one) => one.getBoundingClientRect().right > innerWidth);
        control.textContent = before;
        document.querySelector("#take").hidden = hidden;
        return [...cut, ...outside].map((one) => one.textContent);
    """
    assert browser.run(script) == []


def test_figures_are_hidden_on_a_phone_at_first(browser):
    assert browser.run("return document.querySelector('#figures').hidden") == browser.touches
    browser.mouse([browser.middle("#statistics")])
    assert browser.run("return document.querySelector('#figures').hidden") != browser.touches
    browser.mouse([browser.middle("#statistics")])


def test_the_panel_can_be_hidden(browser):
    before = browser.run("const s = document.querySelector('#stage'); return s.clientWidth * s.clientHeight")
    browser.mouse([browser.middle("#toggle-panel")])
    assert browser.run("const s = document.querySelector('#stage'); return s.clientWidth * s.clientHeight") > before
    browser.mouse([browser.middle("#toggle-panel")])
    assert browser.run("const s = document.querySelector('#stage'); return s.clientWidth * s.clientHeight") == before


def test_few_stops_of_the_tab_key(browser):
    # Tab goes on from where another test clicked last, even after blur(): start before the first stop.
    browser.run("document.body.tabIndex = -1; document.body.focus(); document.body.removeAttribute('tabindex')")
    stops = []
    for _ in range(40):
        browser.key("Tab")
        stop = browser.run("const e = document.activeElement; return e === document.body ? null : e.outerHTML")
        if stop is None or stop in stops:
            break
        stops.append(stop)
    assert 8 <= len(stops) <= 20
    assert any("canvas" in stop for stop in stops)


def test_arrows_go_through_a_toolbar(browser):
    browser.run("document.querySelector('#presets button').focus()")
    seen = []
    for _ in range(8):
        seen.append(browser.run("return document.activeElement.innerText"))
        browser.key("ArrowRight")
    assert seen[:2] == ["Corner", "Front"]
    assert len(set(seen)) == 7
    assert seen[7] == "Corner"


def test_targets_are_large(browser):
    browser.run(OPEN_ALL)
    assert browser.until("!document.querySelector('#light').hidden")
    assert browser.run(SMALL_TARGETS) == []
    browser.run(OPEN_ALL + "document.querySelector('#advanced').open = false;")


def test_every_control_has_a_name(browser):
    browser.run(OPEN_ALL)
    assert browser.until("!document.querySelector('#light').hidden")
    nodes = browser.cdp("Accessibility.getFullAXTree")["nodes"]
    roles = {
        "button",
        "slider",
        "textbox",
        "spinbutton",
        "combobox",
        "ColorWell",
        "application",
        "toolbar",
        "DisclosureTriangle",
    }
    controls = [node for node in nodes if node.get("role", {}).get("value") in roles and not node["ignored"]]
    assert len(controls) > 40
    assert [node for node in controls if not node.get("name", {}).get("value", "").strip()] == []
    levels = browser.run("return [...document.querySelectorAll('h1, h2, h3')].map((head) => Number(head.tagName[1]))")
    assert all(after <= before + 1 for before, after in pairwise(levels))
    browser.run(OPEN_ALL + "document.querySelector('#advanced').open = false;")


@pytest.mark.parametrize("dark", [True, False])
def test_text_can_be_read(browser, dark):
    browser.theme(dark=dark)
    browser.run("document.querySelector('#keys').showModal(); document.querySelector('#advanced').open = true")
    contrasts = browser.run(CONTRASTS)
    browser.run("document.querySelector('#keys').close(); document.querySelector('#advanced').open = false")
    assert len(contrasts) > 40
    assert [(text, contrast) for text, contrast in contrasts if contrast < 4.5] == []
    browser.theme(dark=True)
