"""Arrays of plans, files and exports."""

import csv
import gc
import xml.etree.ElementTree as ElementTree

import numpy as np
import possibility
import pytest
from conftest import one_line


def test_arrays_have_a_row_for_every_knot(plan):
    knots = sum(len(phase) for segment in plan.segments for phase in segment.phases)
    assert plan.t.shape == (knots,)
    assert plan.q.shape == (knots, 7 + len(plan.joints))
    assert plan.v.shape == plan.a.shape == (knots, 6 + len(plan.joints))
    assert plan.tau.shape == (knots, len(plan.joints))
    assert np.all(np.diff(plan.t) >= 0) and plan.t[-1] == plan.duration


def test_arrays_of_segments_and_phases_are_views(plan):
    for segment in plan.segments:
        for name in ("t", "q", "v", "a", "tau"):
            whole = getattr(plan, name)
            assert np.shares_memory(getattr(segment, name), whole)
            assert np.shares_memory(getattr(segment.phases[0], name), whole)
    assert np.array_equal(np.concatenate([segment.q for segment in plan.segments]), plan.q)


def test_stacked_arrays_are_made_once(plan):
    first, second = plan.tau, plan.tau
    assert first is not second and np.shares_memory(first, second)


def test_knots_are_views_of_the_plans_memory(plan):
    knot = plan.segments[0].phases[0].knots[1]
    assert not knot.q.flags.owndata
    first, second = knot.q, knot.q  # two views of the same numbers
    assert first is not second and np.shares_memory(first, second)
    assert np.array_equal(knot.q, plan.segments[0].q[1])
    assert np.array_equal(knot.tau, plan.segments[0].tau[1])
    assert knot.t == plan.segments[0].t[1]


def test_arrays_are_read_only(plan):
    knot = plan.segments[0].phases[0].knots[0]
    for array in (plan.q, plan.segments[0].tau, knot.q, knot.forces):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_views_keep_the_plan_alive(plan, tmp_path):
    plan.save(tmp_path)
    loaded = possibility.load_plan(tmp_path)
    view = loaded.segments[0].phases[0].knots[0].q
    expected = view.copy()
    del loaded
    gc.collect()
    assert np.array_equal(view, expected)


def test_forces_carry_the_robot(plan):
    phase = plan.segments[0].phases[0]
    assert phase.contacts == ["left_sole", "right_sole"]
    assert phase.forces.shape == (len(phase), 8, 3)
    assert np.array_equal(phase.forces[0], phase.knots[0].forces)
    assert phase.forces[0, :, 2].sum() == pytest.approx(plan.robot.mass * 9.80665, rel=1e-3)
    assert [f.shape for f in plan.segments[0].forces] == [p.forces.shape
                                                          for p in plan.segments[0].phases]


def test_walking_has_no_impacts(plan):
    assert all(phase.impulses.shape == (0, 3)
               for segment in plan.segments for phase in segment.phases)


def test_a_plan_reads_back_to_the_same_bits(plan, tmp_path):
    file = plan.save(tmp_path / "plan")
    assert file == tmp_path / "plan/plan.json"
    for path in (file, file.parent):
        loaded = possibility.load_plan(path)
        assert loaded.is_current
        for name in ("t", "q", "v", "a", "tau"):
            assert np.array_equal(getattr(loaded, name), getattr(plan, name))


def test_saving_twice_gives_the_same_bytes(plan, tmp_path):
    first = plan.save(tmp_path / "a").read_bytes()
    assert first == plan.save(tmp_path / "a/again.json").read_bytes()


def test_format_2_is_small_and_read_like_format_1(plan, tmp_path):
    plain, packed = plan.save(tmp_path / "plan.json"), plan.save(tmp_path / "packed/plan.zip")
    assert packed.stat().st_size < plain.stat().st_size / 5
    loaded = possibility.load_plan(packed.parent)
    assert [segment.action for segment in loaded.segments] == [
        segment.action for segment in plan.segments]
    assert np.abs(loaded.q[:, 4:] - plan.q[:, 4:]).max() < 1e-9
    assert np.abs(loaded.tau - plan.tau).max() < 1
    assert packed.read_bytes() == loaded.save(tmp_path / "packed/again.zip").read_bytes()


def test_a_truncated_plan_is_refused_in_one_line(plan, tmp_path):
    file = plan.save(tmp_path)
    file.write_text(file.read_text()[:1000])
    with pytest.raises(possibility.InputError) as error:
        possibility.load_plan(file)
    assert str(file) in one_line(error)


def test_a_missing_plan_is_refused():
    with pytest.raises(possibility.InputError) as error:
        possibility.load_plan("nowhere")
    assert "nowhere" in one_line(error)


def test_npz_opens_in_numpy(plan, tmp_path):
    plan.export(npz=tmp_path / "walk.npz")
    arrays = np.load(tmp_path / "walk.npz")
    assert np.array_equal(arrays["q"], plan.q)
    assert list(arrays["tau_names"]) == plan.joints


def test_csv_holds_the_same_numbers(plan, tmp_path):
    plan.export(csv=tmp_path / "tables")
    with open(tmp_path / "tables/trajectory.csv") as file:
        rows = list(csv.reader(file))
    assert len(rows) == 1 + len(plan)
    times = np.array([float(row[0]) for row in rows[1:]])
    assert np.allclose(times, plan.t, atol=1e-9)


def test_period_sets_the_samples(plan, tmp_path):
    plan.export(npz=tmp_path / "walk.npz", period=0.05, margins=True)
    times = np.load(tmp_path / "walk.npz")["t"]
    assert np.median(np.diff(times)) == pytest.approx(0.05)


def test_mujoco_sto_and_mcap_are_written(plan, tmp_path):
    plan.export(mujoco=tmp_path / "a.xml", sto=tmp_path / "a.sto", mcap=tmp_path / "a.mcap",
                period=0.05)
    assert ElementTree.parse(tmp_path / "a.xml").getroot().tag == "mujoco"
    assert "endheader" in (tmp_path / "a.sto").read_text()
    magic = b"\x89MCAP0\r\n"
    content = (tmp_path / "a.mcap").read_bytes()
    assert content.startswith(magic) and content.endswith(magic)


@pytest.mark.parametrize("options", [{}, {"npz": "a.npz", "period": 0},
                                     {"npz": "a.npz", "period": float("nan")},
                                     {"npz": "/nowhere/a.npz"}, {"csv": "/proc/a"}])
def test_bad_exports_are_refused_in_one_line(plan, options, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(possibility.InputError) as error:
        plan.export(**options)
    one_line(error)


def test_the_page_is_written(plan, tmp_path):
    page = plan.view(tmp_path / "walk.html")
    text = page.read_text()
    assert text == plan.page()
    assert text.startswith("<!DOCTYPE html>") and "short_walk" in text


def test_a_notebook_shows_the_page_in_a_frame(plan):
    frame = plan._repr_html_()
    assert frame.startswith("<iframe") and frame.endswith("</iframe>")
    from html.parser import HTMLParser

    class Frames(HTMLParser):
        found = []

        def handle_starttag(self, tag, attributes):
            self.found.append((tag, dict(attributes)))

    Frames().feed(frame)
    (tag, attributes), = Frames.found
    assert tag == "iframe" and attributes["srcdoc"] == plan.page()


def test_plans_describe_themselves(plan, result):
    assert "walk" in repr(plan) and "found" in repr(result)
    assert "left_sole" in repr(plan.segments[0].phases[0])
