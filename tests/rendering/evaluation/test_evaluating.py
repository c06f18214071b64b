"""A set evaluated by two tiny methods, and its report read back."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from evaluation_sets import small_set
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.command import main
from physanimator.rendering.evaluation import figures, running
from physanimator.rendering.evaluation.clip_files import EXACT, SHOWN, kept_clip
from physanimator.rendering.evaluation.columns import COLUMNS, Summary
from physanimator.rendering.evaluation.planning import planned
from physanimator.rendering.evaluation.report_folder import REPORT_FILES
from physanimator.rendering.evaluation.results import MethodResult, Results
from physanimator.rendering.evaluation.running import run
from physanimator.rendering.evaluation.set_document import read_set
from physanimator.rendering.pictures import load_image, load_mask, read_clip, save_image, write_animation
from physanimator.rendering.pipeline import animate

ROOT = Path(__file__).resolve().parents[3]


def evaluate(*arguments: object) -> int:
    return main(["evaluate", *map(str, arguments), "--quiet"])


@pytest.fixture(scope="module")
def evaluated(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """A set, and its report."""
    folder = tmp_path_factory.mktemp("evaluated")
    file = small_set(folder / "set", more='title = "Two & <two>"')
    assert evaluate(file, "-o", folder / "report") == 0
    return file, folder / "report"


class Page(HTMLParser):
    """What a page shows."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.videos: list[str] = []
        self.text = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "video":
            self.videos.append(str(dict(attrs)["data-src"]))

    def handle_data(self, data: str) -> None:
        self.text += data


def test_the_report_read_back(evaluated: tuple[Path, Path]) -> None:
    _, report = evaluated
    told = json.loads((report / "report.json").read_text())
    assert [each["name"] for each in told["methods"]] == ["composite", "warp-inpaint"]
    assert told["pictures"] == ["flag", "bush"]
    for method in told["methods"]:
        drift = method["values"]["static_drift"]
        assert drift["pictures"] == 2
        assert drift["mean"] == pytest.approx(np.mean([each["static_drift"] for each in method["pictures"].values()]))
        assert drift["low"] <= drift["mean"] <= drift["high"]
        assert method["values"]["dynamic_degree"]["mean"] > 0
        assert "missing" in method["values"]["fid"]
    rows = list(csv.DictReader((report / "report.csv").read_text().splitlines()))
    written = {(each["method"], each["column"]): each for each in rows}
    composite = told["methods"][0]["values"]["hole_ratio"]
    assert float(written["composite", "hole_ratio"]["mean"]) == composite["mean"]
    assert written["composite", "fid"]["mean"] == ""
    assert written["composite", "fid"]["missing"] == told["methods"][0]["values"]["fid"]["missing"]
    clips = list(csv.DictReader((report / "clips.csv").read_text().splitlines()))
    assert [(each["method"], each["picture"]) for each in clips] == [
        (method, picture) for method in ("composite", "warp-inpaint") for picture in ("flag", "bush")
    ]


def test_the_page_shows_every_clip(evaluated: tuple[Path, Path]) -> None:
    _, report = evaluated
    page = Page((report / "report.html").read_text())
    assert len(page.videos) == 4
    assert all((report / each).is_file() for each in page.videos)
    assert "Two & <two>" in page.text
    assert "DynamiCrafter" in page.text
    assert "do not compare directly" in page.text


def test_the_latex_table_has_a_cell_for_every_column(evaluated: tuple[Path, Path]) -> None:
    _, report = evaluated
    text = (report / "report.tex").read_text()
    table = text.split("\\end{tabular}")[0]
    head, *rows = re.findall(r"^(.*) \\\\$", table, flags=re.MULTILINE)
    assert len(rows) == 2
    assert {each.count("&") for each in (head, *rows)} == {head.count("&")}
    assert head.index("FID") < head.index("Static drift")


def test_frames_are_what_animate_draws(evaluated: tuple[Path, Path]) -> None:
    file, report = evaluated
    picture = load_image(file.parent / "flag" / "picture.png")
    height, width = picture.shape[:2]
    mask = load_mask(file.parent / "flag" / "mask.png", width=width, height=height)
    scene = json.loads((file.parent / "flag" / "scene.json").read_text())
    from physanimator.rendering.options import Timing

    drawn = list(animate(picture, [mask], scene=scene, timing=Timing(frames=4)).frames())
    kept = list(read_clip(report / "clips" / "composite" / "flag" / "sample_0" / EXACT))
    assert len(kept) == 4
    assert all((one == other).all() for one, other in zip(drawn, kept, strict=True))
    assert (kept[0] != kept[3]).any()


def test_what_is_there_is_kept_and_only_what_changed_is_drawn(
    evaluated: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file, report = evaluated
    clips = sorted((report / "clips").rglob(EXACT))
    before = {each: each.stat().st_mtime_ns for each in clips}
    assert evaluate(file, "-o", report) == 0
    assert {each: each.stat().st_mtime_ns for each in clips} == before
    mask = file.parent / "bush" / "mask.png"
    content = mask.read_bytes()
    try:
        changed = np.zeros((64, 64), np.uint8)
        changed[14:50, 16:40] = 255
        save_image(mask, changed)
        assert evaluate(file, "-o", report, "--dry-run") == 0
        listed = capsys.readouterr().out.splitlines()
        assert [each.split()[0] for each in listed[:4]] == ["kept", "kept", "draw", "draw"]
        assert "2 of 4 clips are kept" in listed
        assert {each: each.stat().st_mtime_ns for each in clips} == before
    finally:
        mask.write_bytes(content)


def test_a_method_without_weights_is_left_out_with_the_name_of_the_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = small_set(tmp_path / "set", methods='"composite", "sketch-guided", "composite-no-contact"')
    assert evaluate(file, "-o", tmp_path / "report", "--dry-run") == 0
    said = capsys.readouterr().out
    assert "left out sketch-guided: not at hand: weights.svd: svd.safetensors" in said
    assert "left out composite-no-contact for flag, bush: its scene has no contact" in said
    assert not (tmp_path / "report").exists()


def test_clips_of_anyone(tmp_path: Path) -> None:
    file = small_set(tmp_path / "set", methods='{name = "still", clips = "still"}')
    (tmp_path / "set" / "still").mkdir()
    for name in ("flag", "bush_0"):
        picture = load_image(tmp_path / "set" / name.split("_")[0] / "picture.png")
        target = tmp_path / "set" / "still" / name
        write_animation([picture] * 3, f"{target}/" if name == "flag" else f"{target}.apng", 24)
    assert evaluate(file, "-o", tmp_path / "report") == 0
    told = json.loads((tmp_path / "report" / "report.json").read_text())["methods"][0]["values"]
    assert told["static_drift"]["mean"] == 0
    assert told["dynamic_degree"]["mean"] == 0
    assert told["simulated_flow_error"] is None
    (tmp_path / "set" / "still" / "bush_0.apng").unlink()
    assert evaluate(file, "-o", tmp_path / "report") == 2


def test_samples_differ_and_are_the_same_for_all_methods(tmp_path: Path) -> None:
    file = small_set(tmp_path / "set", more="samples = 2")
    assert evaluate(file, "-o", tmp_path / "report", "--picture", "flag") == 0
    clips = tmp_path / "report" / "clips"
    first, second = (list(read_clip(clips / "composite" / "flag" / f"sample_{n}" / EXACT))[3] for n in (0, 1))
    assert (first != second).any()
    other = list(read_clip(clips / "warp-inpaint" / "flag" / "sample_1" / EXACT))[3]
    inner = slice(20, 44), slice(22, 32)
    assert (
        np.abs(second[inner].astype(int) - other[inner]).mean() < np.abs(first[inner].astype(int) - other[inner]).mean()
    )


def test_nothing_of_others_is_replaced(evaluated: tuple[Path, Path], tmp_path: Path) -> None:
    file, _ = evaluated
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "novel.txt").write_text("mine")
    assert evaluate(file, "-o", tmp_path / "mine") == 2
    assert [each.name for each in (tmp_path / "mine").iterdir()] == ["novel.txt"]
    assert evaluate(file, "-o", file.parent) == 2


@pytest.mark.parametrize("name", REPORT_FILES)
def test_a_report_that_somebody_edited_stays(tmp_path: Path, name: str) -> None:
    file = small_set(tmp_path / "set", methods='{name = "none", clips = "none"}')
    report = tmp_path / "report"
    report.mkdir()
    (report / "evaluation.json").write_text('{"format": "physanimator-evaluation", "version": 1}')
    (report / name).write_text("mine")
    assert evaluate(file, "-o", report) == 2
    assert (report / name).read_text() == "mine"


def test_a_clip_that_somebody_changed_stays(tmp_path: Path) -> None:
    file = small_set(tmp_path / "set", methods='"composite"')
    report = tmp_path / "report"
    assert evaluate(file, "-o", report) == 0
    clip = report / "clips" / "composite" / "flag" / "sample_0" / SHOWN
    clip.write_bytes(b"mine")
    assert evaluate(file, "-o", report) == 2
    assert clip.read_bytes() == b"mine"


def test_a_damaged_measure_is_measured_again(tmp_path: Path) -> None:
    file = small_set(tmp_path / "set", methods='"composite"')
    plan = planned(read_set(file), tmp_path / "report")
    run(plan)
    measures = plan.folder.measures("composite", "flag", 0)
    told = json.loads(measures.read_text())
    measures.write_text(json.dumps(told | {"key": "another"}))
    again = planned(read_set(file), tmp_path / "report")
    assert [(each.picture.name, each.kept, each.measured) for each in again.todo] == [("flag", True, False)]
    measures.write_text("{}")
    with pytest.raises(InvalidInputError, match="must be what physanimator evaluate wrote"):
        planned(read_set(file), tmp_path / "report")


@pytest.mark.skipif(os.name == "nt", reason="SIGKILL is of POSIX")
def test_it_goes_on_after_being_killed(tmp_path: Path) -> None:
    file = small_set(tmp_path / "set", more="samples = 3")
    report = tmp_path / "report"
    package = tmp_path / "package"
    package.mkdir()
    (package / "physanimator").symlink_to(ROOT, target_is_directory=True)
    command = [sys.executable, "-m", "physanimator", "evaluate", str(file), "-o", str(report), "--processes", "2"]
    environment = os.environ | {"PYTHONPATH": str(package), "OMP_NUM_THREADS": "1"}
    process = subprocess.Popen([*command, "--quiet"], env=environment, start_new_session=True)
    end = time.monotonic() + 120
    while not list(report.glob("measures/*/*.json")) and process.poll() is None and time.monotonic() < end:
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    plan = planned(read_set(file), report)
    done = [each for each in plan.cells if each.kept]
    assert 0 < len(done) < len(plan.cells)
    times = {each: (_folder(report, each) / EXACT).stat().st_mtime_ns for each in done}
    assert evaluate(file, "-o", report) == 0
    assert {each: (_folder(report, each) / EXACT).stat().st_mtime_ns for each in done} == times
    assert all(kept_clip(_folder(report, each), each.key) for each in plan.cells)
    assert len(Page((report / "report.html").read_text()).videos) == len(plan.cells)


def _folder(report: Path, cell) -> Path:  # type: ignore[no-untyped-def]
    return report / "clips" / cell.method.name / cell.picture.name / f"sample_{cell.sample}"


@pytest.mark.parametrize("name", ["masks", "blur", "warp-weight"])
def test_an_ablation_is_a_figure(tmp_path: Path, name: str) -> None:
    file = small_set(tmp_path / "set", methods='"composite"')
    assert evaluate(file, "-o", tmp_path / "report", "--figure", name, "--picture", "flag") == 0
    assert load_image(tmp_path / "report" / "figures" / f"{name}.png").std() > 5
    assert f"figures/{name}.png" in (tmp_path / "report" / "report.html").read_text()


def test_values_beside_a_figure_are_of_the_pictures_that_it_shows(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    drawn: list[list[str]] = []
    sheet = figures.contact_sheet
    monkeypatch.setattr(figures, "contact_sheet", lambda *a, **k: drawn.append(k["row_names"]) or sheet(*a, **k))
    file, report = small_set(tmp_path / "set", methods='"composite", "warp-inpaint"'), tmp_path / "report"
    assert evaluate(file, "-o", report) == 0
    assert evaluate(file, "-o", report, "--figure", "inpainting", "--picture", "flag") == 0
    values: dict[tuple[str, str], list[float]] = {}
    for clip in csv.DictReader((report / "clips.csv").read_text().splitlines()):
        values.setdefault((clip["method"], clip["picture"]), []).append(float(clip["simulated_flow_error"]))
    assert len({picture for _, picture in values}) > 1
    (rows,) = drawn
    for row in rows[1:]:
        name, line = row.split("\n")[:2]
        assert float(line.split()[-1]) == pytest.approx(np.mean(values[name, "flag"]), rel=0.01)


def test_a_figure_compares_pictures_with_pictures_and_sketches_with_sketches() -> None:
    dark = np.full((3, 100, 100, 3), 20, np.uint8)
    white = np.full_like(dark, 255)
    white[:, :, 60:] = 100
    for one, row in ((dark, 0), (white, 60)):
        other = one.copy()
        other[2, row : row + 40, :40] += 60
        clips = [dark, other, white, white] if one is dark else [dark, dark, white, other]
        place = figures._where_they_differ(clips, dark[0], pictures=2, moved=False)[1:]
        assert place == ((row, 0, 42), 2) or place == ((58, 0, 42), 2)


def test_values_that_are_written_alike_are_best_together() -> None:
    column = next(each for each in COLUMNS if each.key == "simulated_flow_error")
    rows = [
        MethodResult(name, {column.key: Summary(value, None, None, 1)}, [])
        for name, value in (("one", 0.0068817), ("two", 0.0068811), ("three", 0.00689))
    ]
    assert Results("", [column], ["flag"], 1, rows, []).best(column) == {"one", "two"}


def test_a_figure_that_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = small_set(tmp_path / "set")
    assert evaluate(file, "-o", tmp_path / "report", "--figure", "mask") == 2
    assert "did you mean masks?" in capsys.readouterr().err
    assert evaluate(file, "-o", tmp_path / "report", "--method", "composit") == 2
    assert "did you mean composite?" in capsys.readouterr().err
    assert not (tmp_path / "report").exists()


def test_a_spoiled_mask_of_which_nothing_is_left_is_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    gone = '"composite", {name = "gone", draws = "composite", mask_error = "shrunk", mask_error_px = 180}'
    file = small_set(tmp_path / "set", methods=gone)
    assert main(["evaluate", str(file), "-o", str(tmp_path / "report"), "--picture", "flag"]) == 0
    assert "left out gone for flag: its masks, shrunk by 180 px, cannot be animated" in capsys.readouterr().out
    assert evaluate(file, "-o", tmp_path / "report", "--picture", "flag", "--dry-run") == 0
    assert "1 of 1 clips are kept" in capsys.readouterr().out


def test_a_scene_of_other_bodies_is_refused_before_the_work(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = small_set(tmp_path / "set", methods='"composite"')
    scene = file.parent / "flag" / "scene.json"
    told = json.loads(scene.read_text())
    scene.write_text(json.dumps(told | {"bodies": told["bodies"] * 3}))
    assert evaluate(file, "-o", tmp_path / "report") == 2
    assert "picture 'flag': " in capsys.readouterr().err
    assert not (tmp_path / "report").exists()


def test_columns_that_one_process_alone_may_measure_are_added_later(tmp_path: Path) -> None:
    plan = planned(read_set(small_set(tmp_path / "set", methods='"composite"')), tmp_path / "report")
    plan.folder.open()
    later = [each for each in COLUMNS if each.key in ("dynamic_degree", "static_drift")]
    cell = plan.cells[0]
    running._make(cell, plan, None, later=later)
    again = planned(plan.which, plan.folder.place).cells[0]
    assert again.kept
    assert not again.measured
    running._complete(cell, plan, later, None)
    assert planned(plan.which, plan.folder.place).cells[0].measured
    file = plan.folder.measures("composite", "flag", 0)
    added = json.loads(file.read_text())["values"]
    file.unlink()
    running._make(cell, plan, None)
    assert json.loads(file.read_text())["values"] == added


def test_a_file_that_changes_while_it_is_drawn_stops_the_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    plan = planned(read_set(small_set(tmp_path / "set", methods='"composite"')), tmp_path / "report")
    drawn = running.drawn_frames

    def changing(*facts: object, **more: object) -> object:
        yield from drawn(*facts, **more)
        (tmp_path / "set" / "flag" / "scene.json").write_text("{}")

    monkeypatch.setattr(running, "drawn_frames", changing)
    with pytest.raises(InvalidInputError, match="must stay as they are"):
        run(plan)
    assert not list((tmp_path / "report").rglob(EXACT))
