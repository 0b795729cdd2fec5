"""The page: escaped, whole by itself, and true to the study."""

import base64
import hashlib
import json
import re
from dataclasses import replace
from html.parser import HTMLParser

import pytest
from holdfast.pipeline.choose.situations import to_situations
from holdfast.pipeline.choose.study import Study, headline, render_page, study_data, tables

from ...choice.synthetic import make_choice_data

EVIL = "<script>alert(1)</script>\"'&"
POLICIES = ("random", "first", "formula:epsilon", "logistic", "linucb")


class Checker(HTMLParser):
    """Collects tags, links and whether every element is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.links: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.links += [value or "" for name, value in attrs if name in ("src", "href", "srcset", "data")]
        assert not [name for name, _ in attrs if name.startswith("on")]
        if tag not in {"meta", "line", "polyline", "circle", "rect"}:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert tag in {"line", "polyline", "circle", "rect"} or self.open.pop() == tag


@pytest.fixture(scope="module")
def study() -> Study:
    data = make_choice_data(groups=40, candidates=5, tasks=("lift", "turn"))
    return study_data(to_situations(data), POLICIES, seeds=2)


def test_the_page_needs_nothing_else(study: Study) -> None:
    html = render_page(study, "grasps")
    checker = Checker()
    checker.feed(html)
    checker.close()
    assert checker.open == [] and checker.links == [] and "script" not in checker.tags
    policy = re.search(r'Content-Security-Policy" content="([^"]*)"', html)
    assert policy is not None and "default-src &#39;none&#39;" in policy[1]
    for style in re.findall(r"<style>(.*?)</style>", html, re.DOTALL):
        digest = base64.b64encode(hashlib.sha256(style.encode()).digest()).decode()
        assert digest in policy[1].replace("&#43;", "+")


def test_names_are_escaped(study: Study) -> None:
    evil = replace(study, hands=(EVIL,), explained=EVIL)
    html = render_page(evil, EVIL)
    assert "<script>" not in html and "&lt;script&gt;" in html


def test_page_tables_and_json_say_the_same(study: Study) -> None:
    html, text, data = render_page(study, "grasps"), tables(study), study.as_json()
    json.dumps(data, allow_nan=False)
    assert {entry["unseen"] for entry in data["comparisons"]} == {"object", "hand", "task"}
    assert len(data["comparisons"]) == 6
    for entry in data["comparisons"]:
        for one in entry["policies"]:
            value, low, high = (100.0 * x for x in one["success"])
            assert f"{value:.0f} [{low:.0f}, {high:.0f}]" in html
            assert f"{value:.1f} [{low:.1f}, {high:.1f}]" in text
    assert headline(study).split(":")[0] in html
    assert study.explained in {"logistic", "linucb"}
    assert data["importance"]["features"][0]["feature"] == "span"
    assert {point["policy"] for point in data["learning_curve"]} == {"logistic", "linucb"}
    assert html.count("by the objects that were trained on") == 2  # a curve for each load
    for point in data["learning_curve"]:
        value, low, high = (100.0 * x for x in point["success"])
        assert f"{value:.1f} [{low:.1f}, {high:.1f}]" in text


def test_a_study_of_one_policy_is_shown(study: Study) -> None:
    s = to_situations(make_choice_data(groups=12, candidates=4, hands=("sa",)))
    lone = study_data(s, ("first",), seeds=1)
    assert [entry.protocol for entry in lone.comparisons] == ["object", "object"]
    html = render_page(lone, "grasps")
    assert "Learning curve" not in html and "first" in html
    assert "the oracle" in headline(lone) and "lots" not in headline(lone)
