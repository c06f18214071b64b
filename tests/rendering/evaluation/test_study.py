"""Studies without a browser: which pairs are shown, what the page gives away, and what answers say."""

from __future__ import annotations

import json
import os
import re
from pathlib import Path
from typing import Any

import av
import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.command import main
from physanimator.rendering.evaluation.study import MethodClips, StudyKey, making, method_clips, read_files, results_of
from physanimator.rendering.evaluation.study.agreement import krippendorff_alpha
from physanimator.rendering.evaluation.study.answers import AnswerFile
from physanimator.rendering.evaluation.study.clip_folders import BROKEN
from physanimator.rendering.evaluation.study.trials import Trial, trials_of
from physanimator.rendering.evaluation.study.words import WORDS
from physanimator.rendering.pictures import write_animation

PICTURES = [f"picture{k}" for k in range(10)]


def methods(*names: str) -> list[MethodClips]:
    return [MethodClips(name, {each: Path(name, each) for each in PICTURES}) for name in names]


def test_each_pair_is_shown_once_and_each_method_is_left_half_of_the_time() -> None:
    trials = trials_of(methods("ours", "a", "b"), against="ours", seed=1)
    pairs = [each for each in trials if each.kind == "pair"]
    assert sorted((t.picture, *sorted((t.left, t.right))) for t in pairs) == sorted(
        (p, *sorted(("ours", other))) for p in PICTURES for other in ("a", "b")
    )
    for other in ("a", "b"):
        assert sum(t.left == "ours" for t in pairs if other in (t.left, t.right)) == 5
    assert trials[0].kind == "practice"
    assert sum(t.kind == "catch" for t in trials) == 2
    assert all(BROKEN in (t.left, t.right) for t in trials if t.kind != "pair")
    assert trials == trials_of(methods("ours", "a", "b"), against="ours", seed=1)
    assert trials != trials_of(methods("ours", "a", "b"), against="ours", seed=2)
    assert len({t.id for t in trials}) == len(trials)


def test_fewer_pairs_are_shared_evenly() -> None:
    pairs = [t for t in trials_of(methods("ours", "a", "b", "c"), most=12) if t.kind == "pair"]
    counts = {tuple(sorted((t.left, t.right))): 0 for t in pairs}
    for t in pairs:
        counts[tuple(sorted((t.left, t.right)))] += 1
    assert sorted(counts.values()) == [2] * 6


def clip(path: Path, level: int, frames: int = 4) -> None:
    write_animation([np.full((32, 48, 3), level + 8 * k, np.uint8) for k in range(frames)], path, 12)


@pytest.fixture
def folders(tmp_path: Path) -> list[str]:
    for number, method in enumerate(("secretive", "hidden")):
        (tmp_path / method / "kite").mkdir(parents=True)
        clip(tmp_path / method / "lamp.mp4", 40 + 60 * number)
        clip(tmp_path / method / "kite" / "clip.mp4", 60 + 60 * number)
    return [str(tmp_path / method) for method in ("secretive", "hidden")]


def test_the_page_gives_no_method_away_and_fetches_nothing(folders: list[str], tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    main(["study", "make", *folders, "-o", str(page), "--quiet", "--question", "</script><b>Own?"])
    text = page.read_text(encoding="utf-8")
    assert not [word for word in ("secretive", "hidden/", "kite", "lamp", "(broken)", '"catch') if word in text]
    assert not re.search(r"https?://|<script src|<link|@import|url\(|fetch\(|XMLHttp|WebSocket|sendBeacon", text)
    assert text.count("</script>") == 2
    key = json.loads((tmp_path / "page.key.json").read_text(encoding="utf-8"))
    assert {t["kind"] for t in key["trials"]} == {"pair", "catch", "practice"}
    assert [q["key"] for q in key["questions"]] == ["vq", "tc", "mp", "overall", "own1"]


def test_clips_beside_the_page_are_h264_that_browsers_play(folders: list[str], tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    main(["study", "make", *folders, "-o", str(page), "--quiet", "--beside", "--catch", "0", "--no-practice"])
    videos = sorted((tmp_path / "page_clips").glob("*.mp4"))
    assert len(videos) == 4
    for video in videos:
        with av.open(str(video)) as container:
            stream = container.streams.video[0]
            assert (stream.codec_context.name, stream.pix_fmt, stream.average_rate) == ("h264", "yuv420p", 12)
            assert "secretive" not in str(container.metadata)
    (tmp_path / "page_clips" / "clip_0000.mp4").write_bytes(b"mine")
    assert main(["study", "make", *folders, "-o", str(page), "--quiet", "--beside"]) == 2
    assert (tmp_path / "page_clips" / "clip_0000.mp4").read_bytes() == b"mine"


def test_the_key_of_another_study_is_never_replaced(folders: list[str], tmp_path: Path) -> None:
    page, key = tmp_path / "page.html", tmp_path / "page.key.json"
    make = ["study", "make", *folders, "-o", str(page), "--quiet", "--catch", "0"]
    assert main(make) == 0
    first, text = key.read_bytes(), page.read_bytes()
    assert main(make) == 0
    assert (key.read_bytes(), page.read_bytes()) == (first, text)
    assert main([*make, "--seed", "5"]) == 2
    clip(Path(folders[0], "lamp.mp4"), 200)
    assert main(make) == 2
    key.write_text("mine")
    assert main(make) == 2
    assert key.read_text() == "mine"
    assert page.read_bytes() == text


def test_no_key_is_left_where_its_page_cannot_be_written(
    folders: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(path: Path, text: str) -> None:
        if path.suffix == ".html":
            raise OSError(28, "No space left on device", str(path))
        path.write_text(text, encoding="utf-8")

    monkeypatch.setattr(making, "write_text", full)
    before = sorted(tmp_path.iterdir())
    assert main(["study", "make", *folders, "-o", str(tmp_path / "page.html"), "--quiet"]) == 1
    assert sorted(tmp_path.iterdir()) == before


def refused(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    assert main(arguments) == 2
    said = capsys.readouterr().err.strip().splitlines()[-1]
    assert "Got: " in said
    return said


@pytest.mark.parametrize(
    ("more", "expected"),
    [
        (["--questions", "vq,beauty"], "--questions must be some of"),
        (["--questions", "", "--question", " "], "--question must be a text"),
        (["--language", "xx"], "--language must be one of en, ja, zh, ko"),
        (["--against", "nobody"], "--against must be one of"),
        (["--pairs", "0"], "--pairs must be at least 1"),
        (["-o", "page.htm"], "--output must end in .html"),
        (["--limit", "nan"], "--limit must be"),
        (["--fps", "0"], "--fps must be"),
    ],
)
def test_bad_options_are_refused(
    more: list[str], expected: str, folders: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert expected in refused(["study", "make", *folders, "-o", str(tmp_path / "p.html"), *more], capsys)
    assert not (tmp_path / "p.html").exists()


def test_a_page_beyond_its_limit_is_refused(
    folders: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for folder in folders:
        noise = np.random.default_rng(0).integers(0, 255, (30, 256, 256, 3), dtype=np.uint8)
        write_animation(list(noise), Path(folder, "noise.mp4"), 12)
    said = refused(["study", "make", *folders, "-o", str(tmp_path / "p.html"), "--limit", "0.1"], capsys)
    assert "at most 0.1 MB" in said
    assert not (tmp_path / "p.key.json").exists()


@pytest.mark.parametrize(
    "given", [["only"], ["a", "nowhere"], ["a", "empty"], ["a", "a"], ["a", "=only"], ["a", "(broken)=only"]]
)
def test_folders_that_cannot_be_compared_are_refused(given: list[str], tmp_path: Path) -> None:
    for name in ("only", "a", "empty"):
        (tmp_path / name).mkdir()
    clip(tmp_path / "a" / "x.mp4", 30)
    clip(tmp_path / "only" / "x.mp4", 30)
    with pytest.raises(InvalidInputError, match="CLIPS must"):
        method_clips(
            [
                f"{name}={tmp_path / path}" if "=" in each else str(tmp_path / each)
                for each in given
                for name, _, path in [each.partition("=")]
            ]
        )


def key_of(count: int = 10) -> StudyKey:
    trials = [Trial(f"t{k}", "pair", f"p{k}", *(("ours", "base") if k % 2 else ("base", "ours"))) for k in range(count)]
    trials += [Trial(f"c{k}", "catch", "p0", "ours", BROKEN) for k in range(5)]
    return StudyKey("study", {"vq": "?"}, {each.id: each for each in trials})


def rater(name: str, wins: int, *, caught: int = 5, saved: str = "2026-01-01", count: int = 10) -> AnswerFile:
    """One who prefers ours in the first so many pairs."""
    ours = {
        f"t{k}": ("left" if k % 2 else "right") if k < wins else ("right" if k % 2 else "left") for k in range(count)
    }
    catch = {f"c{k}": "left" if k < caught else "right" for k in range(5)}
    return AnswerFile(name, saved, {(trial, "vq"): side for trial, side in (ours | catch).items()})


def test_shares_and_intervals_are_those_of_the_binomial() -> None:
    found = results_of(key_of(), [rater("a", 9), rater("b", 8)], against="ours")
    (only,) = found.preferences
    assert (only.method, only.other, only.preferred, only.answers) == ("ours", "base", 17, 20)
    # Clopper and Pearson's interval of 17 of 20, as published tables give it.
    assert (only.low, only.high) == pytest.approx((0.6211, 0.9679), abs=2e-4)
    assert only.p_value == pytest.approx(0.002577, abs=1e-5)


def test_careless_raters_are_dropped_and_files_of_one_rater_are_one() -> None:
    files = [rater("good", 10), rater("careless", 0, caught=3), rater("good", 4, saved="2026-02-01")]
    found = results_of(key_of(), files, against="ours")
    assert [(each.rater, each.files, each.dropped) for each in found.raters] == [
        ("careless", 1, True),
        ("good", 2, False),
    ]
    assert (found.preferences[0].preferred, found.preferences[0].answers) == (4, 10)
    assert results_of(key_of(), files, against="base", least_caught=0).preferences[0].answers == 20


def test_agreement_is_krippendorffs() -> None:
    # The worked example, with gaps, of Wikipedia's article on Krippendorff's alpha: 0.691 for nominal data.
    a = list("*****34121133*3")
    b = list("1*213343*******")
    c = list("**21344*21133*4")
    units = [[value for value in each if value != "*"] for each in zip(a, b, c, strict=True)]
    assert krippendorff_alpha(units) == pytest.approx(0.691, abs=1e-3)
    assert krippendorff_alpha([["x"], []]) is None
    chance = np.random.default_rng(0)
    assert abs(krippendorff_alpha(chance.integers(0, 2, (4000, 3)).tolist()) or 1) < 0.03


def test_raters_who_agree_have_alpha_one() -> None:
    assert results_of(key_of(), [rater("a", 10), rater("b", 10)]).agreement["vq"] == 1.0
    assert results_of(key_of(), [rater("a", 10), rater("b", 5)]).agreement["vq"] < 0.2


def written(folder: Path, **changed: Any) -> list[Path]:
    key = {
        "format": "physanimator study key",
        "version": 1,
        "study": "s",
        "questions": [{"key": "vq", "text": "?"}],
        "trials": [{"id": "t", "kind": "pair", "picture": "p", "left": "a", "right": "b"}],
    }
    (folder / "page.key.json").write_text(json.dumps(key), encoding="utf-8")
    answers = {
        "format": "physanimator study answers",
        "version": 1,
        "study": "s",
        "rater": "r",
        "saved": "2026",
        "answers": [{"trial": "t", "question": "vq", "choice": "left", "seconds": 1}],
    }
    (folder / "answers").mkdir(exist_ok=True)
    path = folder / "answers" / "one.json"
    path.write_text(json.dumps(answers | changed), encoding="utf-8")
    return [path]


def test_the_key_is_found_beside_the_answers_or_among_them(tmp_path: Path) -> None:
    (path,) = written(tmp_path)
    key, files = read_files([path])
    assert key.trials["t"].left == "a"
    assert files[0].choices == {("t", "vq"): "left"}
    assert read_files([path, tmp_path / "page.key.json"])[0] == key


@pytest.mark.parametrize(
    "changed",
    [
        {"format": "other"},
        {"version": 2},
        {"study": "another"},
        {"study": ["s"]},
        {"rater": ""},
        {"rater": "x" * 500},
        {"saved": None},
        {"answers": {}},
        {"answers": [3]},
        {"answers": [{"trial": "z", "question": "vq", "choice": "left"}]},
        {"answers": [{"trial": ["t"], "question": "vq", "choice": "left"}]},
        {"answers": [{"trial": "t", "question": "mp", "choice": "left"}]},
        {"answers": [{"trial": "t", "question": "vq", "choice": "both"}]},
        {"answers": [{"trial": "t", "question": "vq", "choice": "left"}] * 2},
        {"answers": [{"trial": "t", "question": "vq", "choice": "left"}] * 200_000},
    ],
)
def test_answers_that_no_page_saved_are_refused(changed: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match="Got: "):
        read_files(written(tmp_path, **changed))


@pytest.mark.parametrize("text", ["", "[1]", "{", "\x00", "[" * 100_000, '{"format": "physanimator study key"}'])
def test_files_that_hold_something_else_are_refused(text: str, tmp_path: Path) -> None:
    path = tmp_path / "x.json"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(InvalidInputError, match="Got: "):
        read_files([path])


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no named pipes")
def test_a_pipe_is_refused_and_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "x.json")
    for path in (tmp_path / "x.json", Path("/dev/zero")):
        with pytest.raises(InvalidInputError, match=r"ANSWERS must be a file\. Got: "):
            read_files([path])


def test_a_table_does_not_replace_answers_or_the_key(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (path,) = written(tmp_path)
    answers = path.rename(tmp_path / "answers.csv")
    before = answers.read_bytes()
    assert main(["study", "results", str(answers), "--csv", str(answers)]) == 2
    assert "--csv must not be a file that is read" in capsys.readouterr().err
    assert answers.read_bytes() == before


def test_results_are_printed_and_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (path,) = written(tmp_path)
    main(["study", "results", str(path), "--csv", str(tmp_path / "r.csv")])
    assert "a to b" in capsys.readouterr().out
    assert (tmp_path / "r.csv").read_text(encoding="utf-8").splitlines()[1].startswith("vq,a,b,1,1,1,")
    main(["study", "results", str(path), "--json"])
    assert json.loads(capsys.readouterr().out)["preferences"][0]["preferred"] == 1


def test_every_language_has_every_word() -> None:
    places = {key: set(re.findall(r"\{\w+\}", text)) for key, text in WORDS["en"].items()}
    for words in WORDS.values():
        assert {key: set(re.findall(r"\{\w+\}", text)) for key, text in words.items()} == places
