"""The viewer page of a glTF scene in a real browser: time, cameras, keys, access, and no outside request.

Needs the extra `browser`, and Debian's chromium and chromium-driver; skipped without them.
"""

from __future__ import annotations

import importlib.util
import shutil
import time
from pathlib import Path

import pytest
import small_gltf

webdriver = pytest.importorskip(
    "selenium.webdriver", reason="selenium is missing: pip install 'firetwin[browser]'"
)

from selenium.webdriver.chrome.options import Options  # noqa: E402
from selenium.webdriver.chrome.service import Service  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402

CHROMIUM, DRIVER = (shutil.which(name) for name in ("chromium", "chromedriver"))
pytestmark = pytest.mark.skipif(
    not (CHROMIUM and DRIVER), reason="no browser: apt-get install chromium chromium-driver"
)
PHONE = {"width": 390, "height": 800, "deviceScaleFactor": 1, "mobile": True}
RULES = ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"]


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """Page of a small run whose name is an attack."""
    return small_gltf.write(tmp_path_factory.mktemp("viewer"))[-1]


@pytest.fixture(scope="module")
def browser():
    """Chromium with WebGL by the processor, without a display and without a network."""
    options = Options()
    options.binary_location = CHROMIUM
    for option in (
        "--headless=new",
        "--no-sandbox",
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--host-resolver-rules=MAP * ~NOTFOUND",
        "--window-size=900,700",
    ):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(DRIVER))
    driver.set_script_timeout(60)
    yield driver
    driver.quit()


@pytest.fixture
def opened(browser, page):
    """The page with its scene; at the end no error may be in the console, and no request left the machine."""
    motion(browser, "no-preference")
    browser.get_log("browser")
    browser.get_log("performance")
    load(browser, page)
    yield browser
    assert [each for each in browser.get_log("browser") if "GPU stall" not in each["message"]] == []
    log = [each["message"] for each in browser.get_log("performance")]
    assert not [each for each in log if '"Network.requestWillBeSent"' in each and '"url":"http' in each]


def motion(browser, value, scheme="light", **more):
    """Emulate preferences of the system."""
    features = [("prefers-reduced-motion", value), ("prefers-color-scheme", scheme)]
    features += [(name.replace("_", "-"), each) for name, each in more.items()]
    named = [{"name": name, "value": each} for name, each in features]
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": named})


def load(browser, page):
    browser.get(page.as_uri())
    wait(lambda: browser.execute_script("return document.documentElement.dataset.state") == "ready")


def wait(true, seconds=60.0):
    """Wait until something is so."""
    deadline = time.monotonic() + seconds
    while not true() and time.monotonic() < deadline:
        time.sleep(0.1)
    assert true()


def brightness(browser):
    """Mean of red, green and blue of the picture, drawn with all trees."""
    return browser.execute_script("""
      viewer.draw(1);
      const gl = viewer.renderer.getContext(), w = gl.drawingBufferWidth, h = gl.drawingBufferHeight;
      const pixels = new Uint8Array(4 * w * h), sum = [0, 0, 0];
      gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
      for (let i = 0; i < pixels.length; i++) if (i % 4 < 3) sum[i % 4] += pixels[i];
      return sum.map((each) => each / (w * h));
    """)


def value(browser):
    return int(browser.find_element(By.ID, "slider").get_property("value"))


def test_three_js_reads_the_whole_scene(opened):
    counts = opened.execute_script("""
      const { world } = viewer, trees = new Set();
      const numbers = world.cells.map(({ mesh }) => mesh.geometry.getAttribute("_ID").array);
      for (const each of numbers) each.forEach((id) => trees.add(id));
      return [trees.size, world.fronts.length, world.cameras.length, Boolean(world.terrain)];
    """)
    assert counts[0] == small_gltf.TREES
    assert counts[1] > 1
    assert counts[2:] == [1, True]
    assert opened.title.endswith(": 3-D view")
    assert not opened.find_elements(By.TAG_NAME, "img")


def test_the_slider_burns_the_ground(opened):
    slider = opened.find_element(By.ID, "slider")
    last, burned = value(opened), brightness(opened)
    slider.send_keys(Keys.HOME)
    assert value(opened) == 0
    before = brightness(opened)
    assert last > 0
    assert max(abs(a - b) for a, b in zip(before, burned, strict=True)) > 0.5
    shown = "return viewer.world.fronts.filter((each) => each.visible).length"
    assert opened.execute_script(shown) <= 1
    assert slider.get_attribute("aria-valuetext") == opened.find_element(By.ID, "clock").text
    slider.send_keys(Keys.END)
    assert opened.execute_script(shown) >= 1


def test_a_camera_plays_the_film_and_a_key_takes_over(opened):
    button = opened.find_elements(By.CSS_SELECTOR, "#views button")[1]
    assert button.text.startswith("Camera: </script>")
    button.send_keys(Keys.ENTER)
    film = opened.execute_script("return viewer.world.about.frame_times_s")
    wait(lambda: opened.find_element(By.ID, "play").get_attribute("aria-pressed") == "false")
    assert opened.execute_script("return viewer.time()") == pytest.approx(film[-1])
    assert button.get_attribute("aria-pressed") == "true"
    where = "return viewer.world.cameras[0].position.toArray()"
    (path,) = opened.execute_script(
        "return viewer.world.gltf.animations.map((each) => [...each.tracks[0].values.slice(-3)])"
    )
    assert opened.execute_script(where) == pytest.approx(path, abs=0.5)
    opened.find_element(By.ID, "view").send_keys(Keys.ARROW_LEFT)
    assert button.get_attribute("aria-pressed") == "false"
    opened.find_element(By.ID, "view").send_keys(Keys.HOME)
    overview = opened.find_element(By.ID, "overview")
    assert overview.get_attribute("aria-pressed") == "true"


def test_reduced_motion_shows_a_still_view(opened, page):
    motion(opened, "reduce")
    load(opened, page)
    opened.find_elements(By.CSS_SELECTOR, "#views button")[1].click()
    assert opened.find_element(By.ID, "play").get_attribute("aria-pressed") == "false"
    assert opened.find_elements(By.CSS_SELECTOR, "#views button")[1].get_attribute("aria-pressed") == "true"


@pytest.mark.parametrize(
    ("phone", "scheme", "more"),
    [(False, "light", {}), (True, "dark", {}), (True, "dark", {"forced_colors": "active"})],
)
def test_axe_finds_no_violation_and_nothing_is_wider_than_the_window(opened, page, phone, scheme, more):
    found = importlib.util.find_spec("axe_playwright_python")
    if found is None:
        pytest.skip("axe-playwright-python is missing: pip install 'firetwin[browser]'")
    axe = Path(found.origin).with_name("axe.min.js").read_text(encoding="utf-8")
    if phone:
        opened.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", PHONE)
    try:
        motion(opened, "reduce", scheme, **more)
        load(opened, page)
        opened.find_element(By.TAG_NAME, "summary").click()
        wide = opened.execute_script("return document.documentElement.scrollWidth - innerWidth")
        opened.execute_script(axe)
        result = opened.execute_async_script("axe.run({runOnly: arguments[0]}).then(arguments[1])", RULES)
    finally:
        opened.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
    assert [(each["id"], [node["html"] for node in each["nodes"]]) for each in result["violations"]] == []
    assert len(result["passes"]) > 15
    assert wide <= 0
