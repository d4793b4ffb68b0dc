"""The report as a file: what stands in it, what cannot get into it, and how large it is."""

from __future__ import annotations

import base64
import dataclasses
import json
import re
from html.parser import HTMLParser

import numpy as np
import pytest

import armik_sym as ak
from armik_sym.arm.product_of_transforms import hand_pose
from armik_sym.errors import MotionFileError, OptionError, ShapeError
from armik_sym.motion import HandPath
from armik_sym.motion.joint_motion import JointMotion
from armik_sym.report.html import chapter_of, write_report
from armik_sym.report.html.chart import MOST_SAMPLES, shown_samples, styles_of
from armik_sym.report.html.sentences import asked, verdict
from armik_sym.report.html.tables import joint_table, method_table
from armik_sym.report.words import without_exponents
from armik_sym.solution import Requirements, Solution
from armik_sym.symbolic import Orientation

EVIL = "<script>alert(1)</script><img src=x onerror=alert(2)>\"'&"


def made(arm, n=40, orientation=Orientation.FULL, drift=0.0, note=""):
    """A solution without any solver: a smooth motion and the path it makes."""
    time = np.linspace(0.0, 2.0, n)
    q = arm.rom.middle + 0.2 * arm.rom.width * np.sin(time[:, None] + np.arange(arm.dof)) / 2
    position, rotation = hand_pose(arm.chain, q, arm.lengths)
    path = HandPath(time, position, None if orientation is Orientation.NONE else rotation, note)
    free = np.full(arm.dof, np.inf)
    return Solution(
        arm, path, q + drift * time[:, None], "trajectory", orientation, Requirements(1e-9, 1e-9, free, free)
    )


class Reader(HTMLParser):
    """Elements, and text outside of scripts."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.words, self.inside = [], [], [], []
        self.scripts = []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.attributes += attributes
        if tag in ("script", "style"):
            self.inside.append(tag)

    def handle_endtag(self, tag):
        if self.inside and self.inside[-1] == tag:
            self.inside.pop()

    def handle_data(self, text):
        (self.scripts if self.inside else self.words).append(text)


def data_of(text):
    return json.loads(re.search(r'id="report-data">(.*?)</script>', text, re.DOTALL).group(1))


def numbers(packed):
    return np.frombuffer(base64.b64decode(packed["bdata"]), dtype=packed["dtype"])


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    solution = made(ak.catalog.ehmcs())
    other = made(ak.catalog.ehmcs(), drift=0.01)
    measured = JointMotion(solution.time, solution.q + 0.02, solution.arm.joint_names)
    file = tmp_path_factory.mktemp("page") / "page.html"
    chapter = chapter_of(solution, measured=measured, others={"worse": other}, title="Reaching")
    return solution, write_report(file, [chapter], kinematics="frames").read_text(encoding="utf-8")


def test_it_says_what_was_asked_and_what_came_out(page):
    solution, text = page
    words = " ".join(Reader(text).words)
    assert "The arm can make this motion" in words
    assert "A hand path of 40 instants over 2 s" in words
    assert "Reaching" in words
    for name in solution.arm.joint_names:
        assert name.replace("_", " ").capitalize() in words
    assert "worse" in words
    assert f"armik_sym {ak.__version__}" in words
    assert "not a medical device" in words


def test_nothing_is_loaded_from_anywhere(page):
    reader = Reader(page[1])
    addresses = [value for name, value in reader.attributes if name in ("src", "href", "action", "data")]
    assert addresses
    assert all(address.startswith(("data:", "#")) for address in addresses)
    (policy,) = [value for name, value in reader.attributes if value and value.startswith("default-src")]
    assert policy.startswith("default-src 'none'")
    assert "unsafe-inline" not in policy.split("style-src")[0]


def test_the_charts_hold_the_angles_of_the_solution_with_units(page):
    solution, text = page
    charts = data_of(text)["chapters"][0]["charts"]
    for j in range(solution.arm.dof):
        chart = charts[f"chart-0-joints-{j}"]
        traces = {trace["name"]: trace for trace in chart["data"]}
        assert set(traces) == {"measured", "worse", "solved"}
        np.testing.assert_allclose(numbers(traces["solved"]["y"]), np.rad2deg(solution.q[:, j]), rtol=1e-6)
        assert chart["layout"]["yaxis"]["title"]["text"] == "angle [deg]"
    for name, chart in charts.items():
        assert re.search(r"\[(s|deg|mm|%)\]", chart["layout"]["xaxis"]["title"]["text"]), name
        if chart["timed"]:
            assert re.search(r"\[(deg|mm|deg/s|deg/s²)\]", chart["layout"]["yaxis"]["title"]["text"]), name


def test_the_map_has_the_exact_edges_and_the_solved_line(page):
    solution, text = page
    map_ = ak.swivel_map(solution.arm, solution.path)
    chart = data_of(text)["chapters"][0]["charts"]["chart-0-map-0"]
    line = numbers(chart["data"][-1]["y"])
    psi = np.rad2deg(map_.swivel_of(solution).psi)
    assert np.abs(np.mod(line - psi + 180, 360) - 180).max() < 1e-3
    edges = np.concatenate([numbers(t["y"]) for t in chart["data"] if "limit" in (t.get("name") or "")])
    ends = np.rad2deg(np.concatenate([map_.intervals.start, map_.intervals.end]))
    for edge in edges[np.isfinite(edges)][::7]:
        assert np.abs(np.mod(edge - ends + 180, 360) - 180).min() < 1e-3
    heat = chart["data"][0]
    shape = tuple(int(n) for n in heat["z"]["shape"].split(","))
    classes = numbers(heat["z"]).reshape(shape)
    time, angle = numbers(heat["x"]), numbers(heat["y"])
    branch = map_.swivel_of(solution).branch
    for i, k in ((10, 3), (60, 20), (90, 35)):
        sample = int(np.abs(solution.time - time[k]).argmin())
        margin = np.rad2deg(
            map_.clearance([np.deg2rad(angle[i])], int(branch[sample]), [sample]).margin[0, 0]
        )
        assert classes[i, k] == np.digitize(margin, [0, 5, 10, 20, 30]) - 1


def test_texts_of_users_cannot_become_elements(tmp_path):
    evil = {place: f"{place}{EVIL}" for place in ("title", "note", "others", "path", "page", "remark")}
    arm = ak.catalog.ehmcs()
    chapters = [
        chapter_of(made(arm), title=evil["title"], note=evil["note"], others={evil["others"]: made(arm)}),
        chapter_of(made(arm, note=evil["path"])),
    ]
    top = {"title": evil["page"], "note": evil["remark"]}
    text = write_report(tmp_path / "page.html", chapters, kinematics="frames", **top).read_text("utf-8")
    reader = Reader(text)
    words = " ".join(reader.words)
    for each in evil.values():
        assert each in words
    assert reader.tags.count("script") == 4
    assert not [name for name, _ in reader.attributes if name.startswith("on")]
    assert "alert(1)</script>" not in text
    drawn = json.dumps(data_of(text)["chapters"][0]["charts"])
    assert "others" in drawn
    assert "<img" not in drawn


def test_a_verdict_that_is_not_ok_names_the_joint_in_words():
    arm = ak.catalog.ehmcs()
    solution = made(arm, drift=0.4)
    assert not solution.ok
    said = verdict(chapter_of(solution))
    assert "not what was asked for" in said
    assert not any(name in said for name in arm.joint_names)
    assert "not ok" in method_table(chapter_of(made(arm), others={"worse": solution})).rows[1]


def test_what_was_asked_depends_on_what_was_asked():
    said = " ".join(asked(chapter_of(made(ak.catalog.ehmcs(), orientation=Orientation.NONE))))
    assert "how it is turned is free" in said
    unknown = chapter_of(made(ak.catalog.ehmcs()), path_known=False)
    assert "is not known" in " ".join(asked(unknown))


def test_the_joint_table_states_used_and_allowed():
    solution = made(ak.catalog.ehmcs())
    table = joint_table(solution)
    assert len(table.rows) == 7
    low, high = np.rad2deg([solution.q[:, 3].min(), solution.q[:, 3].max()])
    assert table.rows[3][2] == f"{low:.0f} to {high:.0f}°"
    assert table.rows[3][3] == "0 to 145°"


@pytest.mark.parametrize(
    ("arm", "orientation"),
    [
        (ak.catalog.ehmcs(4), Orientation.NONE),
        (ak.catalog.human(), Orientation.FULL),
        (ak.catalog.human(), Orientation.NONE),
        (ak.catalog.alfaiz(), Orientation.FULL),
    ],
    ids=["ehmcs_4dof", "human", "human, turned freely", "alfaiz"],
)
def test_every_arm_of_the_catalogue_has_a_report(tmp_path, arm, orientation):
    solution = made(arm, orientation=orientation)
    text = write_report(tmp_path / "a.html", [chapter_of(solution)], kinematics="frames").read_text("utf-8")
    scene = data_of(text)["chapters"][0]["scene"]
    q = np.frombuffer(base64.b64decode(scene["motions"][0]["q"]))
    np.testing.assert_array_equal(q.reshape(solution.q.shape), solution.q)
    view = np.array(scene["view"]).reshape(3, 3)
    np.testing.assert_allclose(view @ view.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(view) == pytest.approx(1.0)


def test_long_motions_and_five_chapters_stay_below_eight_megabytes(tmp_path):
    arm = ak.catalog.ehmcs()
    chapters = [chapter_of(made(arm, 600), others={"other": made(arm, 600)}, title=f"{i}") for i in range(5)]
    # Frames take more room than a module of WebAssembly.
    file = write_report(tmp_path / "five.html", chapters, title="five", kinematics="frames")
    assert file.stat().st_size < 8_000_000
    long = write_report(tmp_path / "long.html", [chapter_of(made(arm, 8000))], kinematics="frames")
    assert long.stat().st_size < 8_000_000


def test_the_servo_result_is_in_it(tmp_path):
    solution = made(ak.catalog.ehmcs(), n=60)
    solution.report(tmp_path / "servo.html", servo=ak.servo.check(solution))
    words = " ".join(Reader((tmp_path / "servo.html").read_text("utf-8")).words)
    assert "drives of the exoskeleton" in words
    assert "Drives: what is asked of what they can do" in words


def test_wrong_arguments_are_refused(tmp_path):
    solution = made(ak.catalog.ehmcs())
    with pytest.raises(MotionFileError, match=r"\.html"):
        solution.report(tmp_path / "report.pdf")
    with pytest.raises(MotionFileError, match="cannot be written"):
        solution.report(tmp_path / "missing" / "report.html")
    with pytest.raises(OptionError, match="expected a JointMotion"):
        solution.report(tmp_path / "a.html", measured=solution.q)
    with pytest.raises(OptionError, match="expected a Solution"):
        chapter_of(solution.q)
    with pytest.raises(ShapeError, match="30"):
        chapter_of(solution, others={"b": made(ak.catalog.ehmcs(), n=30)})
    with pytest.raises(ShapeError, match="joints"):
        chapter_of(solution, others={"b": made(ak.catalog.alfaiz())})
    with pytest.raises(OptionError, match="expected a ServoCheck"):
        chapter_of(solution, servo="yes")
    with pytest.raises(OptionError, match="at least one"):
        write_report(tmp_path / "a.html", [])


def test_measured_and_others_look_the_same_everywhere():
    first, second = styles_of(["measured", "a", "b"]), styles_of(["a", "b"])
    assert (first["a"], first["b"]) == (second["a"], second["b"])
    looks = [(style["color"], style["dash"]) for style in first.values()]
    assert len(set(looks)) == 3


def test_charts_of_long_motions_keep_their_peaks():
    values = np.zeros(5000)
    values[[1234, 4321]] = [7.0, -3.0]
    rows = shown_samples(values)
    assert len(rows) <= MOST_SAMPLES + 2
    assert {0, 1234, 4321, 4999} <= set(rows.tolist())
    assert list(shown_samples(values[:50])) == list(range(50))


def test_alternatives_come_by_themselves():
    arm = ak.catalog.ehmcs()
    solution = dataclasses.replace(made(arm), alternatives=(made(arm, drift=0.01),))
    assert list(chapter_of(solution).others) == ["choice 2"]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("moves at 3.274e+04°/s (allowed 573°/s)", "moves at 32740°/s (allowed 573°/s)"),
        ("1.6e+02° at 0.5 s", "160° at 0.5 s"),
        ("1.46e-05 mm", "0.000015 mm"),
        ("1.63e-12°", "0.000001°"),
        ("ehmcs, 12 samples", "ehmcs, 12 samples"),
    ],
)
def test_numbers_are_written_out_for_readers(text, expected):
    assert without_exponents(text) == expected
