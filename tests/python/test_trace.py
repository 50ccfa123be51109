"""Traces, pictures, pages, scenarios."""

import html
import json

import numpy as np
import pytest

import lrbscope
from lrbscope import InputError, Scenario, Trace, trace
from shapes import shifted

CLOSE = shifted(1.5, 0.4, 0.3)


def test_events_are_records_without_a_copy(ball):
    t = trace(ball, ball, [shifted(5, 0, 0), CLOSE])
    events = t.events
    assert events.dtype.itemsize == 24 and len(events) == len(t) and not events.flags.writeable
    assert np.shares_memory(events, t.events)
    contacts = events[events["kind"] == Trace.kinds.index("contact")]
    wanted = lrbscope.collide(ball, ball, CLOSE)
    assert sorted(zip(contacts["a"], contacts["b"])) == [tuple(pair) for pair in wanted.pairs]
    assert t.steps["relation"].tolist() == ["separate", "crossing"]
    assert t.steps["pairs"].tolist() == [0, len(wanted.pairs)]
    assert events["kind"][t.steps["first_event"]].tolist() == [Trace.kinds.index("step")] * 2
    assert t.results[1].fingerprint == wanted.fingerprint and len(t.results[1].regions) > 0


def test_levels_of_events_and_the_cap(ball):
    sizes = [len(trace(ball, ball, CLOSE, events=level)) for level in ("faces", "nodes", "all")]
    assert sizes[0] < sizes[1] <= sizes[2]
    short = trace(ball, ball, CLOSE, max_events=10)
    assert len(short) == 10 and short.steps["events"][0] == sizes[0]


def test_json_and_files(ball, tmp_path):
    t = trace(ball, ball, CLOSE)
    data = json.loads(t.json())
    assert data["metadata"]["format"] == "lrbscope trace"
    t.save(tmp_path / "trace.json")
    same = (tmp_path / "trace.json").read_text() == t.json()
    assert same
    t.save(tmp_path / "trace.json.gz")
    assert (tmp_path / "trace.json.gz").read_bytes()[:2] == b"\x1f\x8b"
    assert t.summary()["steps"][0]["relation"] == "crossing"


def test_pages(ball):
    t = trace(ball, ball, CLOSE)
    page = t.html()
    assert page.startswith("<!DOCTYPE html>") and "crossing" in page
    framed = t._repr_html_()
    start, end = framed.index('srcdoc="') + 8, framed.rindex('"></iframe>')
    same = html.unescape(framed[start:end]) == page
    assert same and '"' not in framed[start:end]


def test_pictures(ball, cube, tmp_path):
    picture = lrbscope.render(ball, cube, shifted(0.5, 0.2, 0.1), size=(320, 240))
    assert picture.shape == (240, 320, 3) and picture.dtype == np.uint8
    assert isinstance(picture, np.ndarray) and "crossing" in picture.caption.lower()
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 100
    png = picture._repr_png_()
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    picture.save(tmp_path / "picture.png")
    assert (tmp_path / "picture.png").read_bytes() == png
    assert picture[:, :, 0]._repr_png_() is None and picture[:100]._repr_png_()
    assert np.array_equal(picture, lrbscope.render(ball, cube, shifted(0.5, 0.2, 0.1), size=(320, 240)))


def test_options_of_pictures(ball):
    plain = lrbscope.render(ball, size=(400, 300))
    for options in (
        {"wrappers": True},
        {"view_from": (0, 0, 1), "up": (0, 1, 0)},
        {"zoom": 2},
        {"look_at": (1, 0, 0)},
        {"orthographic": True},
    ):
        assert not np.array_equal(plain, lrbscope.render(ball, size=(400, 300), **options)), options
    assert lrbscope.render(ball, size=(400, 300), transparent=True).shape == (300, 400, 4)
    t = trace(ball, ball, [shifted(5, 0, 0), CLOSE])
    assert not np.array_equal(t.picture(0, size=(400, 300)), t.picture(1, size=(400, 300)))
    assert not np.array_equal(t.picture(size=(400, 300)), t.picture(size=(400, 300), close_up=True))


def test_scenarios(tmp_path):
    assert "collision" in lrbscope.scenarios()
    s = Scenario("islands")
    reports = []
    t = s.record(progress=lambda what, done, total: reports.append((what, done, total)))
    assert reports and len(t.steps) > 0 and len(t) > 0
    file = tmp_path / "mine.scenario.json"
    file.write_text(
        json.dumps(
            {
                "name": "mine",
                "purpose": "A test.",
                "bodies": {"a": {"generator": "island"}, "b": {"generator": "cog2d"}},
                "motion": {"kind": "sweep", "from": [0, 0, 0], "to": [0.5, 0, 0], "steps": 2},
                "frames": {"size": [400, 300]},
            }
        )
    )
    outcome = Scenario(file).run(tmp_path / "out")
    page = tmp_path / "out" / "index.html"
    assert page.is_file() and outcome.page == str(page)
    assert outcome.frames == 2 and outcome.mismatches == [] and len(outcome.summary["steps"]) == 2
    with pytest.raises(InputError):
        Scenario("nothing_of_this_name")
    with pytest.raises(ZeroDivisionError):
        s.record(progress=lambda *_: 1 // 0)
