"""The page of an export opens in a browser, shows its figures, and needs nothing else."""

import json
import re
import subprocess
from html.parser import HTMLParser

import pytest
from plantc.codegen.package import export
from plantc.codegen.report import report_html
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
                "stack": {"step": {"painted": 200, "bound": 260}}, "instructions": {"step": {"most": 900, "bound": 1000}},
            },
            "rv32": "not measured: install qemu",
        },
        "symbols": ["sqrtf", "memcpy"],
        "gates": {"no heap": True},
        "conditioning": [{"form": "ud", "steps": 100}],
        "something new": {"a": [1, 2], "b": {"c": 1.5}},
    }  # fmt: skip
    page = report_html(pendulum_ekf, manifest, rich, exported.check.calls, audit={"misra": {"findings": 0}})
    assert broken(page) == []
    for text in (
        "figure-instructions",
        "figure-stack",
        "sqrtf",
        "no heap",
        "ud",
        "something new",
        "misra",
        "install qemu",
    ):
        assert text in page


def test_a_failed_check_is_the_first_thing_seen(exported):
    manifest = json.loads(exported.files["manifest.json"])
    checks = [dict(item) for item in exported.evidence["checks"]]
    checks[2] |= {"passed": False, "mismatch": "step 3, <theta>: 1 against 2"}
    page = report_html(pendulum_ekf, manifest, {**exported.evidence, "checks": checks}, exported.check.calls)
    assert f"1 of {len(checks)} checks failed" in page
    assert "step 3, &lt;theta&gt;: 1 against 2" in page
