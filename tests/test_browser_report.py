"""The report in a real browser: it plays, swings the elbow, works by keyboard, prints, and asks nobody."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from page_browser import browser as headless
from page_browser import new_page

import armik_sym as ak
from armik_sym.report.html import chapter_of, write_report
from armik_sym.report.wasm.wasm_compiler import find_zig

KEPT = 1e-9


@pytest.fixture(scope="module")
def solution():
    task = ak.load_task("drinking_reach")
    return ak.solve(ak.catalog.ehmcs(), task.path, start=task.measured.q[0])


@pytest.fixture(scope="module")
def chrome():
    with headless() as started:
        yield started


@pytest.fixture(scope="module")
def demo(chrome, tmp_path_factory):
    """What `armik demo` writes, once; where there is no browser it is not written."""
    folder = tmp_path_factory.mktemp("demo")
    # The very first compilation to WebAssembly on a machine takes minutes.
    done = subprocess.run(
        [sys.executable, "-m", "armik_sym", "demo", "--out", folder], capture_output=True, text=True,
        check=False, env={**os.environ, "PYTHONPATH": str(Path(ak.__file__).parents[1])}, timeout=1200,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert str(folder / "report.html") in done.stdout
    return folder / "report.html"


@pytest.fixture(scope="module")
def opened(chrome, demo):
    """One page for many tests: opening it takes longest."""
    return new_page(chrome, demo)


@pytest.fixture
def browser(opened):
    """The page as it was when it was opened."""
    opened.page.set_viewport_size({"width": 1280, "height": 900})
    opened.page.emulate_media(media="screen")
    opened.page.evaluate("armik.show(0)")
    opened.page.evaluate("armik.pause()")
    opened.page.evaluate("armik.setTime(0)")
    opened.complaints.clear()
    return opened


def moved(before, after):
    return np.abs(np.array(before) - np.array(after)).max()


def test_the_report_of_the_demo_in_a_browser(opened, demo):
    assert demo.stat().st_size < 8_000_000
    page = opened.page
    assert page.locator("[role=tab]").count() == len(ak.task_names())
    assert "The arm can make this motion" in page.locator(".verdict:visible").first.inner_text()
    assert "drives of the exoskeleton can follow" in page.locator(".verdict:visible").nth(1).inner_text()
    page.evaluate("armik.setTime(1)")  # before that the hand hardly moves
    start = opened.state()
    page.locator(".play:visible").click()
    opened.until(f"armik.state().then((s) => s.sample > {start['sample']} + 15)")
    page.locator(".play:visible").click()
    now = opened.state()
    assert not now["playing"]
    assert moved(start["joints"], now["joints"]) > 0.01
    swing_by_slider(opened)
    page.locator("[role=tab]").nth(4).click()
    page.evaluate("armik.ready()")
    assert opened.state()["chapter"] == 4
    assert page.locator(".plot:visible .main-svg").count() >= 10
    swing_by_slider(opened)
    assert opened.complaints == []
    assert opened.requests == [demo.as_uri()]


def swing_by_slider(browser):
    """The swivel slider moves the elbow and keeps the hand, by the page's own kinematics."""
    slider = browser.page.locator(".psi:visible")
    wrist, before = np.array(browser.wrist()), browser.state()
    slider.focus()
    elbow = []
    for key in ("Home", "End", "PageUp", "PageDown", "ArrowUp"):
        browser.page.keyboard.press(key)
        after = browser.state()
        assert moved(wrist, browser.wrist()) < KEPT
        assert moved(before["hand"]["position"], after["hand"]["position"]) < KEPT
        assert moved(before["hand"]["rotation"], after["hand"]["rotation"]) < KEPT
        elbow.append(moved(before["joints"][3], after["joints"][3]))
    assert max(elbow) > 0.02
    assert not browser.state()["solved"]


def test_webassembly_agrees_with_the_library_and_says_so(browser, solution):
    if find_zig() is None:
        pytest.skip("no compiler for WebAssembly: pip install ziglang")
    agrees(browser, solution, "wasm", "generated C code")


def test_frames_agree_with_the_library_and_say_so(chrome, solution, tmp_path):
    file = write_report(tmp_path / "frames.html", [chapter_of(solution)], kinematics="frames")
    browser = new_page(chrome, file)
    agrees(browser, solution, "frames", "computed beforehand")
    browser.page.close()


def agrees(browser, solution, kind, words):
    kinematics = ak.compile(solution.arm, backend="vm")
    assert words in browser.page.locator(".player:visible").inner_text()
    for k in (50, 140):
        browser.page.evaluate(f"armik.setTime({solution.time[k]})")
        state = browser.state()
        assert (state["kind"], state["sample"]) == (kind, k)
        np.testing.assert_allclose(state["q"], solution.q[k], atol=1e-15)
        hand = kinematics.position(solution.q[k])
        np.testing.assert_allclose(state["hand"]["position"], hand, atol=1e-12)
        swing_by_slider(browser)
    assert browser.complaints == []


def test_the_keyboard_is_enough(browser):
    page = browser.page
    page.locator(".skip").focus()
    assert page.evaluate("document.activeElement.getBoundingClientRect().left") >= 0
    page.locator(".scene:visible").focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    assert browser.state()["sample"] == 2
    wrist, swivel = browser.wrist(), browser.state()["swivel"]
    for _ in range(5):
        page.keyboard.press("ArrowUp")
    assert abs(browser.state()["swivel"] - swivel) > 0.1
    assert moved(wrist, browser.wrist()) < KEPT
    camera = "document.querySelector('.scene')._fullLayout.scene.camera.eye.x"
    eye = page.evaluate(camera)
    page.keyboard.press("d")
    browser.until(f"{camera} !== {eye}")
    page.keyboard.press("Space")
    browser.until("armik.state().then((s) => s.playing && s.sample > 3)")
    page.keyboard.press("Space")
    assert not browser.state()["playing"]
    page.locator("[role=tab]").first.focus()
    page.keyboard.press("ArrowRight")
    page.evaluate("armik.ready()")
    assert browser.state()["chapter"] == 1
    assert page.locator("#chapter-1").is_visible()
    assert not page.locator("#chapter-0").is_visible()
    assert browser.complaints == []


def test_a_joint_out_of_its_range_is_named_and_red(browser, solution):
    browser.page.evaluate("armik.swing(3.0)")
    (blocked, *_) = browser.state()["blocked"]
    title = blocked["name"].replace("_", " ").capitalize()
    assert title in browser.page.locator(".status:visible").inner_text()
    assert browser.page.locator(".gauge.out:visible").count() >= 1
    arm = "(() => { const all = document.querySelector('.scene').data; return all[all.length - 1]; })()"
    assert browser.page.evaluate(f"{arm}.line.color") == "#A50F15"
    assert title in " ".join(browser.page.evaluate(f"{arm}.text"))
    q, j = browser.state()["q"], blocked["joint"]
    limit = solution.arm.rom.upper[j] if blocked["limit"] == "upper" else solution.arm.rom.lower[j]
    assert abs(abs(q[j] - limit) - blocked["missing"]) < 1e-9
    browser.page.locator(".back:visible").click()
    assert browser.state()["blocked"] == []
    assert browser.page.evaluate(f"{arm}.line.color") == "#0072B2"


def test_a_click_on_the_map_moves_time_and_elbow(browser):
    plot = browser.page.locator(".plot[id*=map]:visible")
    plot.scroll_into_view_if_needed()
    box = plot.bounding_box()
    browser.page.mouse.click(box["x"] + 0.5 * box["width"], box["y"] + 0.4 * box["height"])
    state = browser.state()
    assert state["sample"] > 20
    assert not state["solved"]


def test_motions_beside_it_can_be_shown(browser):
    box = browser.page.locator(".ghosts:visible input").first
    ghost = "document.querySelector('.scene').data.find((trace) => trace.name === 'measured')"
    assert browser.page.evaluate(f"{ghost}.visible") is False
    box.check()
    browser.until(f"{ghost}.visible === true")
    box.uncheck()
    browser.until(f"{ghost}.visible === false")


@pytest.mark.parametrize("width", [360, 800])
def test_a_small_window_needs_no_sideways_scrolling(browser, width):
    browser.page.set_viewport_size({"width": width, "height": 800})
    browser.until(f"document.documentElement.scrollWidth <= {width}")


def test_it_prints(browser, tmp_path):
    browser.page.pdf(path=tmp_path / "report.pdf", format="A4")
    assert (tmp_path / "report.pdf").read_bytes().startswith(b"%PDF")
    assert (tmp_path / "report.pdf").stat().st_size > 50_000
    browser.page.emulate_media(media="print")
    assert not browser.page.locator(".controls").first.is_visible()
    assert browser.page.locator(".paper").first.evaluate("image => image.naturalWidth") > 500
    assert browser.complaints == []


def test_an_arm_without_a_swivel_says_so(chrome, tmp_path):
    arm = ak.catalog.ehmcs(4)
    q = arm.rom.middle + 0.1 * np.sin(np.linspace(0, 2, 30))[:, None]
    kinematics = ak.compile(arm, backend="vm")
    path = ak.HandPath(np.linspace(0, 1, 30), kinematics.position(q))
    file = ak.solve(arm, path, backend="vm").report(tmp_path / "four.html")
    browser = new_page(chrome, file)
    assert "cannot be swung" in browser.page.locator(".no-swivel").inner_text()
    assert not browser.page.locator(".row.swivel").is_visible()
    browser.page.locator(".play").click()
    browser.until("armik.state().then((s) => s.sample > 2)")
    assert browser.complaints == []
    browser.page.close()
