"""The page and the files of a study: nothing is missing, nothing is half-written, and what is not finite is said."""

import json
import math
import os
import re
from html.parser import HTMLParser

import pytest
from matplotlib.figure import Figure
from plantc.codegen.folder import FolderError
from plantc.simulation import (
    Comparison,
    Picture,
    StudyResult,
    StudyTable,
    check_study_folder,
    compared,
    each,
    study_page,
    write_study,
)
from plantc.simulation.study import cell_text


def drawing():
    figure = Figure(figsize=(3, 2))
    figure.subplots().plot([0, 1, 2], [1, 3, 2], label="a < b")
    figure.legend()
    return figure


@pytest.fixture
def result():
    made = StudyResult(
        "sample2026", "A sample <of> studies", "A. Author, A Paper, 2026", "0123456789abcdef", "It holds."
    )
    made.conditions = {"Runs": 20, "Step": 0.025}
    made.comparisons = [
        Comparison("Table 1: a < 2", "1.5 +- 0.1", "reproduces"),
        Comparison("eq. 3", "4.2", "does not reproduce", "rounded <twice>"),
        Comparison("Fig. 2: 3 s", "2 ms", "cannot be compared", "another machine", measured=True),
    ]
    made.tables = [
        StudyTable("main", "Main", ("case", "value"), (("x & y", 1.23456789), ("z", float("nan")))),
        StudyTable("times", "Times", ("case", "s"), (("x", 0.5),), "on this machine", measured=True),
    ]
    made.pictures = [Picture("one", "Fig. 1", "what it shows, for <everyone>", drawing())]
    made.seconds = {"runs": 1.23456}
    return made


class Page(HTMLParser):
    """Collects what a page refers to, what it defines, and its cells."""

    def __init__(self, text):
        super().__init__()
        self.used, self.defined, self.cells, self.open = [], [], [], []
        self.feed(text)
        style = "".join(re.findall(r"<style>(.*?)</style>", text, re.DOTALL))
        self.used += re.findall(r"url\([^)]*\)|@import[^;]*", style)

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.defined.append(given.get("id"))
        self.used += [given[name] for name in ("src", "href", "xlink:href", "data") if name in given]
        self.used += re.findall(r"url\(([^)]*)\)", " ".join(value or "" for value in given.values()))
        if tag in ("td", "th"):
            self.cells.append("")
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag in ("td", "th"):
            self.open.pop()

    def handle_data(self, data):
        if self.open:
            self.cells[-1] += data

    def broken(self):
        """What is neither inside the page nor data."""
        return [item for item in self.used if not item.startswith("data:") and item.lstrip("#") not in self.defined]


def test_the_page_shows_everything_and_refers_to_nothing_outside(result):
    text = study_page(result)
    page = Page(text)
    assert page.broken() == []
    for shown in (
        "Table 1: a < 2",
        "1.5 +- 0.1",
        "rounded <twice>",
        "does not reproduce",
        "x & y",
        "1.235",
        "-",
        "0.5",
    ):
        assert shown in page.cells
    assert "A sample &lt;of&gt; studies" in text
    assert text.count("<svg") == 1
    assert "for &lt;everyone&gt;" in text
    assert "Of 3 printed statements 1 reproduce, 1 do not reproduce, 1 cannot be compared." in text
    # planted
    assert Page(text.replace('href="#table-main"', 'href="#tabel-main"')).broken() == ["#tabel-main"]
    assert Page(text.replace("</main>", '<img src="a.png"></main>')).broken() == ["a.png"]


def test_the_page_is_the_same_text_for_the_same_result(result):
    assert study_page(result) == study_page(result)


def test_the_files_part_what_was_found_from_what_was_measured(result, tmp_path):
    files = write_study(result, tmp_path)
    folder = tmp_path / "sample2026"
    assert sorted(path.name for path in folder.iterdir()) == [
        "evidence.json",
        "index.html",
        "manifest.json",
        "results.json",
    ]
    assert files[0] == folder / "index.html"
    found = json.loads((folder / "results.json").read_text())
    assert found["tables"].keys() == {"main"}
    assert found["tables"]["main"]["rows"] == [["x & y", 1.23456789], ["z", None]]
    assert [item["published"] for item in found["comparisons"]] == ["Table 1: a < 2", "eq. 3"]
    assert found["conditions"]["Runs"] == 20
    measured = json.loads((folder / "evidence.json").read_text())
    assert measured["tables"].keys() == {"times"}
    assert measured["seconds"] == {"runs": 1.235}
    assert json.loads((folder / "manifest.json").read_text())["model"] == "0123456789abcdef"


def test_a_later_run_replaces_an_earlier_one_and_nothing_else(result, tmp_path):
    write_study(result, tmp_path)
    page = tmp_path / "sample2026" / "index.html"
    (tmp_path / "sample2026" / "notes.txt").write_text("mine")
    result.summary = "It still holds."
    write_study(result, tmp_path)
    assert "It still holds." in page.read_text()
    assert (tmp_path / "sample2026" / "notes.txt").read_text() == "mine"
    page.write_text("changed")
    with pytest.raises(FolderError, match="it was changed since plantc wrote it"):
        check_study_folder("sample2026", tmp_path)
    with pytest.raises(FolderError, match="it was changed since plantc wrote it"):
        write_study(result, tmp_path)
    assert page.read_text() == "changed"
    write_study(result, tmp_path, force=True)
    assert "It still holds." in page.read_text()


def test_a_folder_of_someone_else_is_refused(result, tmp_path):
    theirs = tmp_path / "sample2026"
    theirs.mkdir()
    (theirs / "index.html").write_text("theirs")
    for attempt in (lambda: check_study_folder("sample2026", tmp_path), lambda: write_study(result, tmp_path)):
        with pytest.raises(FolderError, match="it holds files that plantc did not write"):
            attempt()
    assert [path.name for path in theirs.iterdir()] == ["index.html"]


def test_nothing_is_written_where_the_page_cannot_be_made(result, tmp_path):
    result.pictures = [Picture("one", "Fig. 1", "no figure", None)]
    with pytest.raises(AttributeError):
        write_study(result, tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
def test_items_are_done_in_processes_in_their_order():
    items = [3.0, 1.0, 2.0, 5.0]
    assert list(each(math.sqrt, items, 1)) == list(each(math.sqrt, items, 2)) == [math.sqrt(item) for item in items]
    ask = ["__import__('os').getpid()"] * 6  # a function of a test module is not found by another process
    here, there = (set(each(eval, ask, processes)) for processes in (1, 2))
    assert here == {os.getpid()}
    assert os.getpid() not in there
    with pytest.raises(ValueError, match="math domain error"):
        list(each(math.sqrt, [1.0, -1.0], 2))


def test_a_table_is_asked_for_by_name_and_its_rows_are_as_long_as_its_head(result):
    assert result.table("main")[0] == {"case": "x & y", "value": 1.23456789}
    with pytest.raises(KeyError, match="there is no table 'mian'; there are main, times"):
        result.table("mian")
    with pytest.raises(ValueError, match="a row has 1 cells, there are 2 columns"):
        StudyTable("bad", "Bad", ("a", "b"), ((1,),))


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, "-"), (float("nan"), "-"), (float("inf"), "inf"), (12345, "12,345"), (1.5e7, "1.5e+07"), ("r", "r"), (True, "True")],
)  # fmt: skip
def test_a_cell_is_written_for_people(value, text):
    assert cell_text(value) == text


def test_a_verdict_needs_numbers():
    def verdict(holds, numbers):
        return compared("as printed", "ours", holds, numbers, "a cause", otherwise="shown wrong").verdict

    assert [verdict(True, [1.0]), verdict(False, [1.0])] == ["reproduces", "shown wrong"]
    for holds in (True, False):
        assert verdict(holds, [1.0, float("nan")]) == verdict(holds, []) == "cannot be compared"
