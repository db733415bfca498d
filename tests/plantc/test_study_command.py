"""`plantc study` as people and scripts meet it; the studies themselves are tested in tests/examples."""

import json
import sys
import types

import pytest
from plantc.simulation import ClusterError, Comparison, StudyResult, StudyTable

from plantc import ModelError, studies


@pytest.fixture
def asked(monkeypatch):
    """A study that records how it was asked for."""
    calls = []

    def study(runs=7, seed=0, *, on=None, progress=None):
        calls.append((runs, seed, on))
        progress("half", 1, 2)
        print("what a study prints")
        if seed == 13:
            raise ModelError("thirteen: give another seed")
        if seed == 14:
            raise KeyboardInterrupt
        if seed == 15:
            raise ClusterError("nobody answers at dask://there:1; start a scheduler")
        made = StudyResult("sample", "Sample", "A paper", "0" * 16, "It holds.", {"Runs": runs})
        made.comparisons = [Comparison("Table 1: 2", "3", "does not reproduce", "rounding")]
        made.tables = [StudyTable("main", "Main", ("a",), ((float("nan"),),))]
        return made

    module = types.ModuleType("sample_study")
    module.study = study
    monkeypatch.setitem(sys.modules, "sample_study", module)
    monkeypatch.setitem(studies.STUDIES, "sample", "sample_study")
    return calls


def test_without_runs_the_study_says_how_many(asked, plantc, tmp_path):
    assert plantc("study", "sample", "--out", tmp_path).status == 0
    assert asked == [(7, 2018, None)]


def test_it_writes_the_folder_and_says_what_came_out(asked, plantc, tmp_path):
    said = plantc("study", "sample", "--runs", 3, "--seed", 5, "--out", tmp_path, "--on", "dask://there:1")
    assert (said.status, said.out) == (0, "")
    assert asked == [(3, 5, "dask://there:1")]
    assert "  does not reproduce: Table 1: 2: 3" in said.err
    assert said.summary == f"done: of 1 printed statements 1 do not reproduce: {tmp_path / 'sample' / 'index.html'}"
    assert (tmp_path / "sample" / "index.html").is_file()


def test_json_is_alone_on_standard_output(asked, plantc, tmp_path):
    said = plantc("study", "sample", "--out", tmp_path, "--json")
    answer = json.loads(said.out)
    assert answer["status"] == 0
    assert answer["summary"] == said.summary
    assert asked == [(7, 2018, None)]
    assert answer["results"]["conditions"] == {"Runs": 7}
    assert answer["results"]["tables"]["main"]["rows"] == [[None]]
    assert answer["verdicts"]["does not reproduce"] == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["study", "meda2081"],
            "there is no study 'meda2081'; give one of meda2018, regulation2023, jump_matrix, fsmc2018, sample",
        ),
        (["study", "sample", "--runs", "0"], "Invalid value for '--runs': 0 is not in the range"),
        (["study", "sample", "--runs", "many"], "Invalid value for '--runs': 'many' is not a valid integer range"),
        (["study", "sample", "--seed", "-1"], "Invalid value for '--seed'"),
        (["study", "sample", "--seed", "13"], "thirteen: give another seed"),
        (["study", "sample", "--seed", "14"], "interrupted"),
        (["study", "sample", "--seed", "15"], "error: nobody answers at dask://there:1; start a scheduler"),
        (["study", "regulation2023", "--on", "dask://there:1"], "this study runs in this process only; leave it out"),
        (["study", "jump_matrix", "--on", "dask://there:1"], "this study runs on this machine only; leave it out"),
        (["study"], "Missing argument 'NAME'"),
    ],
)
def test_what_is_wrong_is_one_sentence_and_nothing_is_written(asked, plantc, tmp_path, monkeypatch, arguments, message):
    monkeypatch.chdir(tmp_path)
    said = plantc(*arguments, "--json")
    assert said.status == 2
    assert message in said.summary
    assert "Traceback" not in said.err
    assert json.loads(said.out)["status"] == 2
    assert list(tmp_path.iterdir()) == []


def test_a_folder_of_someone_else_is_refused_before_the_work(asked, plantc, tmp_path):
    (tmp_path / "sample").mkdir()
    (tmp_path / "sample" / "mine.txt").write_text("mine")
    said = plantc("study", "sample", "--out", tmp_path)
    assert said.status == 2
    assert "it holds files that plantc did not write" in said.summary
    assert asked == []


def test_every_study_that_is_named_is_there():
    for name in studies.STUDIES:
        assert callable(studies.find(name))
