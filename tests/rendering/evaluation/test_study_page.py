"""The raters' page in a real browser, by keyboard and by touch; skipped where there is none."""

from __future__ import annotations

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.rendering.evaluation.study import (
    StudyOptions,
    make_study,
    method_clips,
    questions_of,
    read_files,
    results_of,
)
from physanimator.rendering.evaluation.study.trials import trials_of
from physanimator.rendering.pictures import write_animation

playwright = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser: pip install playwright")
CHROMIUM = Path(os.environ.get("CHROMIUM", "/usr/bin/chromium"))
if not CHROMIUM.exists():
    pytest.skip(f"no browser at {CHROMIUM}; CHROMIUM names another", allow_module_level=True)


def clips(folder: Path, methods: tuple[str, ...] = ("secretive", "hidden")) -> list[str]:
    x = np.arange(96)
    for shift, method in enumerate(methods):
        (folder / method).mkdir()
        for number, name in enumerate(("cat", "tree")):
            frames = [
                np.repeat(np.uint8(128 + 100 * np.sin((x + (2 + shift) * t) / 6 + number))[None, :, None], 64, 0)
                for t in range(12)
            ]
            write_animation([np.repeat(f, 3, 2) for f in frames], folder / method / f"{name}.mp4", 12)
    return [str(folder / method) for method in methods]


def study(folder: Path, **more: Any) -> tuple[Path, dict[str, Any]]:
    methods = method_clips(clips(folder))
    options = StudyOptions(questions_of("vq,overall"), **more)
    page = folder / "study.html"
    make_study(page, methods, trials_of(methods, catch=1, seed=3), options)
    return page, json.loads((folder / "study.key.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    with playwright.sync_playwright() as running:
        browser = running.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox", "--disable-gpu"])
        yield browser
        browser.close()


def opened(chromium: Any, page: Path, **context: Any) -> tuple[Any, list[str]]:
    """A tab with the page, and what went wrong or was asked of a network in it."""
    tab = chromium.new_context(accept_downloads=True, **context).new_page()
    wrong: list[str] = []
    tab.on("pageerror", lambda error: wrong.append(str(error)))
    tab.on("console", lambda message: wrong.append(message.text) if message.type == "error" else None)
    tab.on("request", lambda request: wrong.append(request.url) if request.url.startswith(("http", "ws")) else None)
    tab.goto(page.as_uri())
    return tab, wrong


def played(tab: Any, seconds: float) -> None:
    """Wait until the left clip has come so far; the page's policy forbids what Playwright's own waiting does."""
    for _ in range(200):
        if tab.evaluate("document.getElementById('left').currentTime") > seconds:
            return
        tab.wait_for_timeout(25)
    pytest.fail("the clip does not play")


def practise(tab: Any, key: dict[str, Any], press: Any) -> None:
    (trial,) = (each for each in key["trials"] if each["kind"] == "practice")
    good = "2" if trial["left"] == "(broken)" else "1"
    press("1" if good == "2" else "2")
    assert tab.locator("#note").is_visible()
    assert tab.locator("#next").is_disabled()
    press(good)
    assert tab.locator("#note").is_hidden()
    press("Enter")


def test_a_rater_answers_by_keyboard_and_the_answers_are_read_back(chromium: Any, tmp_path: Path) -> None:
    page, key = study(tmp_path)
    text = page.read_text(encoding="utf-8")
    assert not [word for word in ("secretive", "hidden/", "cat.", "tree", str(tmp_path)) if word in text]
    tab, wrong = opened(chromium, page)
    tab.locator("#start").click()
    practise(tab, key, tab.keyboard.press)
    shown = [each for each in key["trials"] if each["kind"] != "practice"]
    for number, trial in enumerate(shown):
        assert f"{number + 1} of {len(shown)}" in tab.locator("#where").inner_text()
        side = "1" if trial["left"] in ("secretive",) or trial["right"] == "(broken)" else "2"
        tab.keyboard.press(side)
        assert tab.locator("fieldset.current legend").inner_text() == key["questions"][1]["text"]
        if number == 1:
            tab.reload()  # what was answered is still there
            tab.locator("#start").click()
            assert tab.locator('button[aria-checked="true"]').count() == 1
        tab.keyboard.press("ArrowLeft" if side == "1" else "ArrowRight")
        tab.keyboard.press("Enter")
    with tab.expect_download() as download:
        tab.locator("#save").click()
    saved = tmp_path / "answers" / "one.json"
    download.value.save_as(saved)
    assert wrong == []
    found = results_of(*read_files([saved]), against="secretive")
    assert [(p.question, p.method, p.other, p.preferred, p.answers) for p in found.preferences] == [
        (question, "secretive", "hidden", 2, 2) for question in ("vq", "overall")
    ]
    assert found.raters[0].caught == found.raters[0].catch_answers == 2


def test_both_clips_play_in_step(chromium: Any, tmp_path: Path) -> None:
    page, _ = study(tmp_path)
    tab, wrong = opened(chromium, page)
    tab.locator("#start").click()
    played(tab, 0.2)
    times = "['left', 'right'].map((id) => document.getElementById(id).currentTime)"
    for _ in range(8):
        left, right = tab.evaluate(times)
        assert abs(left - right) < 0.15
        tab.wait_for_timeout(100)
    before = tab.evaluate(times)
    tab.evaluate("document.activeElement.blur()")
    tab.keyboard.press(" ")
    tab.wait_for_timeout(100)
    stopped = tab.evaluate(times)
    tab.wait_for_timeout(300)
    assert tab.evaluate(times) == stopped
    assert before != [0, 0]
    tab.locator('button[data-side="left"]').first.focus()
    tab.keyboard.press("Enter")  # on a choice it chooses, as long as not all is answered
    assert tab.locator("#note").is_visible() or tab.locator('button[aria-checked="true"]').count() == 1
    assert wrong == []


@pytest.mark.parametrize("beside", [False, True])
def test_a_rater_answers_by_touch_on_a_telephone(chromium: Any, tmp_path: Path, beside: bool) -> None:
    page, key = study(tmp_path, language="ja", beside=beside)
    tab, wrong = opened(chromium, page, has_touch=True, is_mobile=True, viewport={"width": 390, "height": 844})
    assert tab.locator("html").get_attribute("lang") == "ja"

    def tap(pressed: str) -> None:
        if pressed == "Enter":
            tab.locator("#next").tap()
        else:
            tab.locator(f'button[data-side="{"left" if pressed == "1" else "right"}"]').first.tap()

    tab.locator("#start").tap()
    practise(tab, key, tap)
    for question in range(2):
        button = tab.locator('button[data-side="left"]').nth(question)
        assert button.bounding_box()["height"] >= 44
        button.tap()
    played(tab, 0.1)
    assert tab.evaluate("document.documentElement.scrollWidth <= innerWidth")
    tab.locator("#next").tap()
    assert tab.locator("#back").is_enabled()
    assert wrong == []
