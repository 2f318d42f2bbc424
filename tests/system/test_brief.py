"""The briefing page in a real browser: time, search, keys, colours, print, access, and no outside request.

Needs the extra `browser`, and Debian's chromium and chromium-driver; skipped without them.
"""

from __future__ import annotations

import base64
import importlib.util
import random
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest
import small_stations
from firetwin.data import sample

webdriver = pytest.importorskip(
    "selenium.webdriver", reason="selenium is missing: pip install 'firetwin[browser]'"
)

from selenium.webdriver.chrome.options import Options  # noqa: E402
from selenium.webdriver.chrome.service import Service  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402
from selenium.webdriver.support.ui import Select  # noqa: E402

CHROMIUM, DRIVER = (shutil.which(name) for name in ("chromium", "chromedriver"))
pytestmark = pytest.mark.skipif(
    not (CHROMIUM and DRIVER), reason="no browser: apt-get install chromium chromium-driver"
)
HOSTILE = "Zulu </script><script>document.title='a'</script><img src=x onerror=\"document.title='b'\"> \"q\""
NAMES = ["Alfa", "Bravo", "Charlie", "Delta", "Echo", "Foxtrot", "Golf", "Hotel", "India", "Juliett", "Kilo"]
COUNT = len(NAMES) + 1


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Page of the sample run with an observed perimeter, stations, and a name that is an attack."""
    folder = tmp_path_factory.mktemp("brief")
    sample.write(folder / "sample", 37)
    (folder / "sample/observations").mkdir()
    (folder / "sample/observations/seen.geojson").write_text(
        '{"type": "FeatureCollection", "features": [{"type": "Feature", '
        '"properties": {"date": "2014-09-17T20:00:00Z"}, "geometry": {"type": "Polygon", "coordinates": '
        "[[[-120.66, 38.74], [-120.5, 38.74], [-120.5, 38.88], [-120.66, 38.88], [-120.66, 38.74]]]}}]}"
    )
    rng = random.Random(7)
    spots = [(f"Station {name}", 38.73 + 0.4 * rng.random(), -120.78 + 0.5 * rng.random()) for name in NAMES]
    spots[0] = (spots[0][0], 39.00699, -120.48458)  # burns late
    gpkg = small_stations.briefed(folder / "stations.gpkg", [*spots, (HOSTILE, 38.80, -120.58)])
    out = folder / "brief.html"
    command = [sys.executable, "-m", "firetwin", "brief", folder / "sample", "--stations", gpkg, "--out", out]
    subprocess.run(command, check=True)
    return out


@pytest.fixture(scope="module")
def browser():
    """Chromium without a display and without a network."""
    options = Options()
    options.binary_location = CHROMIUM
    for option in (
        "--headless=new",
        "--no-sandbox",
        "--disable-gpu",
        "--host-resolver-rules=MAP * ~NOTFOUND",
        "--window-size=1400,1000",
    ):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(DRIVER))
    yield driver
    driver.quit()


@pytest.fixture
def opened(browser, page):
    """The page as it opens, in light colours; at the end no error may be in the console."""
    colours(browser, "light")
    browser.get_log("browser")
    browser.get_log("performance")
    browser.get(page.as_uri())
    yield browser
    assert browser.get_log("browser") == []
    assert browser.title.endswith(": briefing")


def colours(browser, scheme, media="", **more):
    """Emulate colours of the system, a medium, and more features such as ``forced_colors="active"``."""
    features = [{"name": "prefers-color-scheme", "value": scheme}]
    features += [{"name": name.replace("_", "-"), "value": value} for name, value in more.items()]
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": media, "features": features})


def wait(true, seconds=20.0):
    """Wait until something is so."""
    deadline = time.monotonic() + seconds
    while not true() and time.monotonic() < deadline:
        time.sleep(0.05)
    assert true()


def press(browser, *keys):
    browser.switch_to.active_element.send_keys(*keys)


def at(browser):
    return int(browser.find_element(By.ID, "slider").get_property("value"))


def front(browser):
    return browser.find_element(By.CSS_SELECTOR, "path.front").get_attribute("d")


def shown(browser):
    """Identifiers of the places that the lists show."""
    every = "[...document.querySelectorAll('[data-id]')]"
    return browser.execute_script(f"return {every}.filter(e => e.offsetParent).map(e => e.dataset.id)")


def test_the_slider_moves_the_front(opened):
    last = int(opened.find_element(By.ID, "slider").get_attribute("max"))
    assert at(opened) == last
    whole, clock = front(opened), opened.find_element(By.ID, "clock").text
    assert "18 Sep 2014 04:42 PDT = 18 Sep 11:42 UTC; burned 71,498 acres" in clock
    opened.find_element(By.ID, "slider").send_keys(Keys.HOME)
    assert at(opened) == 0
    assert (
        "16 Sep 2014 21:45 PDT = 17 Sep 04:45 UTC; burned 11,539 acres"
        in opened.find_element(By.ID, "clock").text
    )
    assert len(front(opened)) < 0.6 * len(whole)
    assert len(opened.find_elements(By.CSS_SELECTOR, "path.front")) == 1
    assert (
        opened.find_element(By.ID, "slider")
        .get_attribute("aria-valuetext")
        .startswith("16 Sep 2014 21:45 PDT")
    )


def test_the_front_lies_on_the_layers_pictures(opened):
    """The last front, as Leaflet draws it, holds the pixels that the arrival layer shows burned."""
    script = """
      const image = document.querySelector(".leaflet-overlay-pane img.crisp");
      const path = document.querySelector("path.front"), back = path.getScreenCTM().inverse();
      const picture = image.getBoundingClientRect(), scale = picture.width / image.naturalWidth;
      const canvas = new OffscreenCanvas(image.naturalWidth, image.naturalHeight);
      const brush = canvas.getContext("2d");
      brush.drawImage(image, 0, 0);
      const bytes = brush.getImageData(0, 0, canvas.width, canvas.height).data;
      const counts = [0, 0, 0, 0];
      for (let k = 0; k < canvas.width * canvas.height; k += 23) {
        const row = Math.floor(k / canvas.width), column = k % canvas.width;
        const burned = bytes[4 * (row * canvas.width + column) + 3] > 0;
        const at = new DOMPoint(picture.left + (column + 0.5) * scale, picture.top + (row + 0.5) * scale);
        counts[2 * burned + path.isPointInFill(at.matrixTransform(back))] += 1;
      }
      return counts;
    """
    neither, front_alone, picture_alone, both = opened.execute_script(script)
    assert both > 1000
    assert front_alone + picture_alone < 0.08 * both  # lines are simplified by half a cell
    assert neither > both


def test_play_goes_through_the_times_and_stops(opened):
    play = opened.find_element(By.ID, "play")
    play.click()
    assert play.get_attribute("aria-pressed") == "true"
    wait(lambda: 3 <= at(opened) < 10)  # from the last time it begins again
    press(opened, Keys.ESCAPE)
    assert play.get_attribute("aria-pressed") == "false"
    assert "Play" in play.text


def test_keys_move_the_time_search_and_clear(opened):
    body = opened.find_element(By.TAG_NAME, "body")
    last = at(opened)
    body.send_keys(Keys.ARROW_LEFT, Keys.ARROW_LEFT)
    assert at(opened) == last - 2
    body.send_keys(Keys.ARROW_RIGHT)
    assert at(opened) == last - 1
    body.send_keys("/")
    search = opened.switch_to.active_element
    assert search.get_attribute("id") == "search"
    search.send_keys("zulu", Keys.ARROW_LEFT)
    assert at(opened) == last - 1  # arrows in the search are the text's
    assert len(shown(opened)) == 1
    search.send_keys(Keys.ESCAPE)
    assert search.get_property("value") == ""
    assert len(shown(opened)) > COUNT
    search.send_keys(Keys.ESCAPE)
    assert opened.switch_to.active_element == body
    body.send_keys(Keys.SPACE)
    assert opened.find_element(By.ID, "play").get_attribute("aria-pressed") == "true"
    body.send_keys(Keys.ESCAPE)
    assert opened.find_element(By.ID, "play").get_attribute("aria-pressed") == "false"


def test_tab_reaches_everything_in_order(opened):
    seen = []
    for _ in range(24):
        press(opened, Keys.TAB)
        element = opened.switch_to.active_element
        seen.append(element.get_attribute("id") or element.get_attribute("class") or element.tag_name)
    assert seen[:6] == ["skip", "theme", "print", "play", "slider", "map"]
    order = [seen.index(name) for name in ("map", "search", "list", "name")]
    assert order == sorted(order)


def test_search_and_filters_find_stations(opened):
    every = len(shown(opened))
    search, count = (opened.find_element(By.ID, name) for name in ("search", "count"))
    assert count.text == f"{every} of {every} shown"
    search.send_keys("STATION charl")
    assert count.text == f"1 of {every} shown"
    assert len(opened.find_elements(By.CSS_SELECTOR, ".leaflet-towns-pane path")) == 1
    search.clear()
    search.send_keys("crew e-31-3")
    assert count.text == f"1 of {every} shown"  # by its resources
    search.clear()
    search.send_keys(Keys.SPACE)
    selects = {
        each.get_attribute("name"): Select(each) for each in opened.find_elements(By.TAG_NAME, "select")
    }
    selects["kind"].select_by_value("named place")
    assert len(shown(opened)) == every - COUNT
    selects["kind"].select_by_value("")
    selects["fire"].select_by_value("now")
    late = shown(opened)
    opened.find_element(By.ID, "slider").send_keys(Keys.HOME)
    early = shown(opened)
    assert set(early) < set(late)
    selects["fire"].select_by_value("not_reached")
    assert not set(shown(opened)) & set(late)


def test_a_station_of_the_list_is_shown_on_the_map(opened):
    opened.find_element(By.ID, "search").send_keys("zulu")
    opened.find_element(By.CSS_SELECTOR, "tbody:not([hidden]) button.name").click()
    wait(lambda: opened.find_elements(By.CSS_SELECTOR, ".leaflet-tooltip:not(.town)"))
    tip = opened.find_element(By.CSS_SELECTOR, ".leaflet-tooltip:not(.town)")
    assert HOSTILE in tip.text
    assert "exercise" in tip.text
    assert not opened.find_elements(By.CSS_SELECTOR, ".leaflet-tooltip img")
    press(opened, Keys.ESCAPE)
    wait(lambda: not opened.find_elements(By.CSS_SELECTOR, ".leaflet-tooltip:not(.town)"))


def test_layers_are_switched_and_made_transparent(opened):
    pictures = lambda: opened.find_elements(By.CSS_SELECTOR, ".leaflet-overlay-pane img")  # noqa: E731
    assert len(pictures()) == 2  # terrain and arrival
    opened.find_element(By.CSS_SELECTOR, '[data-layer="fuel"] input[type=checkbox]').click()
    assert len(pictures()) == 3
    opened.find_element(By.CSS_SELECTOR, '[data-layer="fuel"] input[type=range]').send_keys(Keys.HOME)
    assert [each.value_of_css_property("opacity") for each in pictures()].count("0") == 1
    opened.find_element(By.CSS_SELECTOR, '[data-layer="front"] input').click()
    assert not opened.find_elements(By.CSS_SELECTOR, "path.front")


def test_an_observed_perimeter_appears_at_its_time(opened):
    dashed = lambda: opened.find_elements(By.CSS_SELECTOR, 'path[stroke-dasharray="6 4"]')  # noqa: E731
    assert len(dashed()) == 1
    opened.find_element(By.ID, "slider").send_keys(Keys.HOME)
    assert not dashed()


def ground(browser):
    return browser.execute_script("return getComputedStyle(document.body).backgroundColor")


def brightness(browser):
    return sum(map(int, re.findall(r"\d+", ground(browser))[:3])) / 3


def test_dark_and_light_follow_the_system_and_the_button(opened):
    assert brightness(opened) > 230
    colours(opened, "dark")
    assert brightness(opened) < 40
    button = opened.find_element(By.ID, "theme")
    wait(lambda: button.text == "Light")
    button.click()
    assert brightness(opened) > 230
    button.click()
    assert brightness(opened) < 40


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_printed_document_has_every_row_and_the_map(opened, tmp_path, theme):
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext is missing: apt-get install poppler-utils")
    colours(opened, theme)
    opened.find_element(By.ID, "search").send_keys("station charl")  # a search hides no row of the print
    assert len(shown(opened)) == 1
    printed = opened.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
    path = tmp_path / "page.pdf"
    path.write_bytes(base64.b64decode(printed["data"]))
    text = " ".join(
        subprocess.run(["pdftotext", path, "-"], capture_output=True, text=True, check=True).stdout.split()
    )
    assert all(f"Station {name}" in text for name in NAMES)
    plain = text.replace(" ", "")
    assert plain.count("exercise") >= COUNT + 2 * COUNT // 2  # each station and each resource
    for words in (
        "Exercise: not operational advice",
        "This run is synthetic",
        "Simulated fire edge",
        "Datum WGS 84",
        "Scores against observations",
    ):
        assert words in text
    colours(opened, theme, "print")
    assert not opened.find_element(By.ID, "map").is_displayed()
    assert opened.find_element(By.CSS_SELECTOR, ".map-sheet").is_displayed()
    assert ground(opened) == "rgb(255, 255, 255)"
    colours(opened, "light")


def test_a_narrow_page_is_no_wider_than_a_phone(opened):
    size = {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True}
    opened.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        assert opened.execute_script("return document.documentElement.scrollWidth") <= 390
        assert opened.find_element(By.ID, "map").size["height"] > 300
    finally:
        opened.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


ARRIVALS = (
    '<div class="wide"><table class="arrivals"><thead><tr><th class="text">place</th>'
    "<th>2 of 20<br>burn it by</th><th>10 of 20<br>burn it by</th><th>18 of 20<br>burn it by</th>"
    "<th>do not reach it by<br>18 Sep 04:42, when the<br>forecast ends</th>"
    '<th class="text">each member,<br>16 Sep 21:45 to 18 Sep 04:42</th></tr></thead>'
    '<tbody><tr><td class="text">Robbs Peak</td><td>18 Sep 00:07</td><td>later or never</td>'
    '<td>later or never</td><td>17 of 20</td><td class="text"><svg viewBox="0 0 276 26" class="dots"></svg>'
    "</td></tr></tbody></table></div>"
)
"""A table of a forecast (see `firetwin.forecasts.brief_section`)."""


def test_no_table_is_cut_in_half_a_screen(opened):
    size = {"width": 925, "height": 844, "deviceScaleFactor": 1, "mobile": False}
    opened.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
    try:
        opened.execute_script(
            "document.querySelector('main section').insertAdjacentHTML('beforeend', arguments[0])", ARRIVALS
        )
        cut = "[...document.querySelectorAll('.wide, .list')].filter(e => e.scrollWidth > e.clientWidth)"
        assert opened.execute_script(f"return {cut}.map(e => e.textContent)") == []
    finally:
        opened.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})


def requested(browser):
    """Addresses of all requests that the browser's own log has, other than the page's and data in it."""
    log = [entry["message"] for entry in browser.get_log("performance")]
    urls = [
        url
        for text in log
        if "Network.requestWillBeSent" in text
        for url in re.findall(r'"url":"([^"]+)"', text)
    ]
    return [url for url in urls if not url.startswith(("data:", "file:"))]


def test_no_request_leaves_the_page(opened, page):
    for script in (
        "fetch('https://example.org/a').catch(() => {})",
        "new Image().src = 'https://example.org/b.png'",
        "navigator.sendBeacon('https://example.org/c', 'x')",
    ):
        opened.execute_script(script)
    time.sleep(0.3)
    errors = [entry["message"] for entry in opened.get_log("browser")]
    assert (
        len([text for text in errors if "Content Security Policy" in text]) >= 2
    )  # refused by the page itself
    opened.get_log("performance")
    opened.get(page.as_uri())
    opened.find_element(By.TAG_NAME, "body").send_keys(Keys.ARROW_LEFT, " ", Keys.ESCAPE)
    entries = (
        "return performance.getEntriesByType('resource').map(e => e.name).filter(n => !n.startsWith('data:'))"
    )
    assert opened.execute_script(entries) == []
    assert requested(opened) == []


def test_without_scripts_the_page_is_whole(browser, page):
    browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
    try:
        browser.get(page.as_uri())
        assert browser.find_element(By.CSS_SELECTOR, ".map-sheet").is_displayed()
        assert not browser.find_element(By.ID, "map").is_displayed()
        assert "Scripts are disabled" in browser.find_element(By.TAG_NAME, "noscript").text
        assert browser.find_element(By.CSS_SELECTOR, "tbody[data-id]").is_displayed()
    finally:
        browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})


PHONE = {"width": 390, "height": 844, "deviceScaleFactor": 2, "mobile": True}
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]


@pytest.fixture(scope="module")
def axe():
    """Source of axe-core; the package around it is not imported, as the tests do not use Playwright."""
    found = importlib.util.find_spec("axe_playwright_python")
    if found is None:
        pytest.skip("axe-playwright-python is missing: pip install 'firetwin[browser]'")
    return Path(found.origin).with_name("axe.min.js").read_text(encoding="utf-8")


@pytest.mark.parametrize("phone", [False, True])
@pytest.mark.parametrize(
    ("scheme", "media", "more"),
    [
        ("light", "", {}),
        ("dark", "", {}),
        ("light", "print", {}),
        ("dark", "", {"forced_colors": "active"}),
    ],
)
def test_axe_finds_no_violation(opened, page, axe, scheme, media, more, phone):
    if phone:
        opened.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", PHONE)
    try:
        colours(opened, scheme, media, **more)
        opened.get(page.as_uri())
        opened.execute_script(axe)
        script = "axe.run({runOnly: arguments[0]}).then(arguments[1])"
        found = opened.execute_async_script(script, RULES)
    finally:
        opened.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        colours(opened, "light")
    assert [(each["id"], [node["html"] for node in each["nodes"]]) for each in found["violations"]] == []
    assert len(found["passes"]) > 15


def test_targets_are_at_least_24_pixels(opened):
    script = """
      const all = [...document.querySelectorAll("a, button, input, select, summary, video, [tabindex]")];
      const seen = all.filter((e) => e.tabIndex >= 0 && e.checkVisibility() && !e.matches(".skip"));
      const small = ({ width, height }) => width < 24 || height < 24;
      return [seen.length, seen.filter((e) => small(e.getBoundingClientRect())).map((e) => e.outerHTML)];
    """
    opened.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", PHONE)
    try:
        count, small = opened.execute_script(script)
    finally:
        opened.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert count > 20
    assert small == []


def test_reduced_motion_stops_animations(opened, page):
    fading = "return document.getElementById('map').classList.contains('leaflet-fade-anim')"
    assert opened.execute_script(fading)
    colours(opened, "light", prefers_reduced_motion="reduce")
    opened.get(page.as_uri())
    assert not opened.execute_script(fading)
    colours(opened, "light")


def test_wide_tables_scroll_with_the_keyboard(opened):
    opened.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", PHONE)
    try:
        wait(lambda: opened.find_elements(By.CSS_SELECTOR, ".wide[tabindex]"), 5.0)
        table = opened.find_element(By.CSS_SELECTOR, ".wide[tabindex]")
        opened.execute_script("arguments[0].focus()", table)
        before = at(opened)
        press(opened, Keys.ARROW_LEFT)
        assert at(opened) == before  # the arrows are the table's
    finally:
        opened.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
