"""The page of an export opens in a browser, shows its figures, and needs nothing else."""

import json
import re
import subprocess
from html.parser import HTMLParser

import pytest
from plantc.codegen.costs import Cost, written
from plantc.codegen.findings import CheckResult
from plantc.codegen.package import export
from plantc.codegen.report import report_html, with_audit
from plantc.examples.pendulum import pendulum_ekf

CHROMIUM = [
    "chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--virtual-time-budget=3000", "--dump-dom",
]  # fmt: skip

PROBE = """<pre id="probe"></pre><script>
const failed = [];
addEventListener("error", (event) => failed.push(String(event.message)));
addEventListener("load", () => {
  const figures = [...document.querySelectorAll("svg.figure")].map((svg) => {
    const box = svg.getBoundingClientRect();
    return { name: svg.id, width: box.width, height: box.height, shapes: svg.querySelectorAll("path, use").length };
  });
  const headings = [...document.querySelectorAll("h1, h2")].map((item) => item.textContent);
  document.getElementById("probe").textContent = JSON.stringify({ figures, headings, failed });
});
</script></body>"""


class References(HTMLParser):
    """Collects what a page refers to, and what it defines."""

    def __init__(self):
        super().__init__()
        self.used, self.defined, self.tags, self.problems = [], [], [], []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.tags.append(tag)
        if "id" in given:
            self.defined.append(given["id"])
        for name in ("src", "href", "xlink:href", "data", "poster", "action"):
            if name in given:
                self.used.append(given[name])
        self.used += re.findall(r"url\(([^)]*)\)", " ".join(value or "" for value in given.values()))
        if tag == "img" and not given.get("alt"):
            self.problems.append("an image without alt")
        if tag == "svg" and not given.get("aria-labelledby"):
            self.problems.append("a figure without a label")


def broken(page):
    """Return what the page refers to that is neither inside it nor data."""
    parser = References()
    parser.feed(page)
    known = set(parser.defined)
    outside = [item for item in parser.used if not (item.startswith("data:") or item.lstrip("#") in known)]
    style = "".join(re.findall(r"<style>(.*?)</style>", page, re.DOTALL))
    return outside + re.findall(r"url\([^)]*\)|@import[^;]*", style) + parser.problems


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    return export(pendulum_ekf, tmp_path_factory.mktemp("out"), precision="float", steps=40)


@pytest.fixture(scope="module")
def page(exported):
    return (exported.folder / "report.html").read_text()


def opened(page, folder):
    path = folder / "page.html"
    path.write_text(page.replace("</body>", PROBE))
    done = subprocess.run(
        [*CHROMIUM, f"--user-data-dir={folder / 'profile'}", path.as_uri()],
        capture_output=True, text=True, check=True, timeout=120,
    )  # fmt: skip
    found = re.search(r'<pre id="probe">(.*?)</pre>', done.stdout, re.DOTALL)
    return json.loads(found.group(1))


@pytest.mark.slow
def test_it_opens_in_a_browser_with_all_its_figures(page, needs, tmp_path):
    needs("chromium")
    told = opened(page, tmp_path)
    assert told["failed"] == []
    assert told["headings"][0] == "pendulum_ekf"
    assert {item["name"] for item in told["figures"]} >= {
        "figure-errors", "figure-operations", "figure-trace", "figure-memory", "figure-statuses",
    }  # fmt: skip
    for item in told["figures"]:
        assert item["width"] > 300, item
        assert item["height"] > 50, item
        assert item["shapes"] > 5, item


@pytest.mark.slow
def test_a_figure_that_is_not_shown_and_a_script_error_are_seen(page, needs, tmp_path):
    needs("chromium")
    bad = page.replace("svg.figure {", "svg.figure { display: none !important;")
    bad = bad.replace("</main>", "</main><script>throw new Error('planted')</script>")
    told = opened(bad.replace("<head>", "<head><script>0</script>"), tmp_path)
    assert all(item["height"] == 0 for item in told["figures"])


def test_it_refers_to_nothing_outside_and_a_broken_reference_is_caught(page):
    assert broken(page) == []
    assert "<script" not in page
    assert not re.search(r"https?://(?!www\.w3\.org/)", page)
    assert broken(page.replace('href="#checks"', 'href="#chekcs"')) == ["#chekcs"]
    planted = page.replace("</main>", '<img src="picture.png" alt="a picture"></main>')
    assert broken(planted) == ["picture.png"]
    assert broken(page.replace("</main>", '<link href="https://example.com/a.css"></main>'))
    clip = re.search(r"url\(#([^)]+)\)", page).group(1)
    assert f"#{clip}x" in broken(page.replace(f"url(#{clip})", f"url(#{clip}x)", 1))


def test_it_is_small_readable_and_says_what_the_evidence_says(exported, page):
    assert len(page) < 300_000
    parser = References()
    parser.feed(page)
    assert parser.tags.count("h1") == 1
    assert parser.tags.count("table") == parser.tags.count("caption")
    assert len(parser.defined) == len(set(parser.defined))
    for item in exported.evidence["checks"]:
        assert f">{item['name'].replace('&', '&amp;')}<" in page
    assert f"All {len(exported.evidence['checks'])} checks passed" in page
    assert pendulum_ekf.model_hash() in page
    assert "@media print" in page
    assert "prefers-color-scheme: dark" in page


def test_the_same_evidence_gives_the_same_page(exported, page):
    manifest = json.loads(exported.files["manifest.json"])
    assert report_html(pendulum_ekf, manifest, exported.evidence, exported.check.calls) == page


def test_it_degrades_where_the_evidence_is_poor_and_takes_new_keys(exported):
    manifest = json.loads(exported.files["manifest.json"])
    poor = {key: exported.evidence[key] for key in ("name", "model", "precision", "checks")}
    page = report_html(pendulum_ekf, manifest, poor, [])
    assert broken(page) == []
    assert "Not measured." in page
    rich = {
        **exported.evidence,
        "coverage": "not measured: gcov not found",
        "targets": {
            "cortex-m4": {
                "toolchain": {"version": "some gcc", "flags": ["-O2"]}, "object": {"text": 100, "data": 0, "bss": 0},
                **written("stack", {"step": Cost(200, 260)}), **written("instructions", {"step": Cost(900, 1000)}),
            },
            "rv32": "not measured: install qemu",
        },
        "symbols": ["sqrtf", "memcpy"],
        "gates": {"no heap": True},
        "tables": [{"title": "Lasting <1>", "caption": "How long", "columns": ["form", "steps"],
                    "rows": [["ud", 100000], ["other", "never"]], "note": "Measured so."}],
        "something new": {"a": [1, 2], "b": {"c": 1.5}},
    }  # fmt: skip
    page = report_html(pendulum_ekf, manifest, rich, exported.check.calls)
    assert broken(page) == []
    for text in (
        "figure-instructions",
        "figure-stack",
        "sqrtf",
        "no heap",
        '<a href="#table-1">Lasting &lt;1&gt;</a>',
        "<caption>How long</caption>",
        '<th scope="row">ud</th>\n<td>100,000</td>',
        "Measured so.",
        "something new",
        "install qemu",
    ):
        assert text in page


AUDIT = {
    "machine": "x86_64", "tools": {"gcc": "gcc 12", "clang": ""}, "changed_since_export": [],
    "not_run": {"libfuzzer": "clang is not installed"},
    "audits": {
        "misra": {"checks": [CheckResult("the <library>", True, note="no finding").as_dict()],
                  "deviations": [{"rule": "21.6", "file": "test/test_vectors.c", "count": 3, "reason": "it prints"}]},
        "sanitizers": {"checks": [CheckResult("nothing lost", False, calls=12345, note="1 lost").as_dict()],
                       "random_calls": {"calls": 12345, "lost": 1}},
    },
}  # fmt: skip


def test_an_audit_is_shown_in_its_place_and_a_later_one_takes_it(exported, page):
    assert "Not done. <code>plantc audit pendulum_ekf</code>" in page
    manifest = json.loads(exported.files["manifest.json"])
    shown = with_audit(page, "pendulum_ekf", AUDIT)
    assert report_html(pendulum_ekf, manifest, exported.evidence, exported.check.calls, audit=AUDIT) == shown
    assert "Not done." not in shown
    assert broken(shown) == []
    for text in (
        "the &lt;library&gt;",
        "12,345</strong> calls",
        "1 were not as they have to be",
        "it prints",
        "gcc 12",
    ):
        assert text in shown
    rows = {row[1]: row[2] for row in rows_of(shown, "Every analyser")[1:]}
    assert rows == {"the &lt;library&gt;": "passed", "nothing lost": "failed", "": "not run"}
    later = with_audit(shown, "pendulum_ekf", {**AUDIT, "audits": {}, "changed_since_export": ["src/a.c"]})
    assert "nothing lost" not in later
    assert "not of the C that was exported: src/a.c" in later
    assert later.count('id="audit"') == 1
    assert with_audit("<html>another page</html>", "pendulum_ekf", AUDIT) == "<html>another page</html>"


def rows_of(page, caption):
    """The cells of the table with a caption that begins so."""
    table = re.search(rf"<caption>{caption}.*?</table>", page, re.DOTALL).group()
    return [
        re.findall(r"<t[hd][^>]*>(.*?)</t[hd]>", row, re.DOTALL)
        for row in re.findall(r"<tr>.*?</tr>", table, re.DOTALL)
    ]


def test_the_bounds_of_the_committed_quadrotor_are_in_the_page(exported, checkout):
    """What an export really wrote, so that writer and page cannot differ: table, figure, and its words."""
    stored = json.loads((checkout / "generated_c/quadrotor_ekf/evidence.json").read_text())["targets"]
    evidence = {**exported.evidence, "targets": stored}
    page = report_html(pendulum_ekf, json.loads(exported.files["manifest.json"]), evidence, exported.check.calls)
    facts = stored["cortex-m7"]
    seen, bound = facts["instructions"]["step"], facts["instruction_bound"]["step"]
    assert seen <= bound
    rows = {(row[0], row[1]): row[2:] for row in rows_of(page, "Instructions")}
    told = [f"{number:,}" for number in (seen, bound, facts["stack"]["step"], facts["stack_bound"]["step"])]
    assert rows["cortex-m7", "<code>step</code>"] == told
    assert f"step {seen} (bound {bound})" in page
    assert f"{seen:,}, ≤ {bound:,}" in page
    soft = stored["cortex-m4"]["instruction_bound"]["step"]
    if isinstance(soft, str):
        assert rows["cortex-m4", "<code>step</code>"][1] == soft
    lost = {**facts, "instruction_bound": {}}
    bare = report_html(
        pendulum_ekf, json.loads(exported.files["manifest.json"]), {**evidence, "targets": {"cortex-m7": lost}}, []
    )
    assert f"step {seen} (no bound)" in bare


def test_the_host_shows_its_bounds_and_that_nothing_was_counted(exported, page, needs):
    needs("gcc")
    host = exported.evidence["targets"]["host"]
    row = next(row for row in rows_of(page, "Instructions") if row[:2] == ["host", "<code>step</code>"])
    assert row[2].startswith("not counted: ")
    assert row[3] == f"{host['instruction_bound']['step']:,}"
    assert row[4].startswith("not painted: ")
    assert row[5] == f"{host['stack_bound']['step']:,}"


def test_a_check_that_judged_nothing_does_not_look_like_one_that_passed(exported, page):
    assert 'class="open">not judged<' not in page
    manifest = json.loads(exported.files["manifest.json"])
    checks = [dict(item) for item in exported.evidence["checks"]]
    checks[3] = CheckResult("stack within the bound", True, not_judged="no entry has a bound").as_dict()
    told = report_html(pendulum_ekf, manifest, {**exported.evidence, "checks": checks}, exported.check.calls)
    assert f"{len(checks) - 1} checks passed; 1 could not judge" in told
    assert 'class="open">not judged<' in told
    assert "not judged: no entry has a bound" in told


def test_a_failed_check_is_the_first_thing_seen(exported):
    manifest = json.loads(exported.files["manifest.json"])
    checks = [dict(item) for item in exported.evidence["checks"]]
    checks[2] |= {"verdict": "failed", "passed": False, "mismatch": "step 3, <theta>: 1 against 2"}
    page = report_html(pendulum_ekf, manifest, {**exported.evidence, "checks": checks}, exported.check.calls)
    assert f"1 of {len(checks)} checks failed" in page
    assert "step 3, &lt;theta&gt;: 1 against 2" in page
