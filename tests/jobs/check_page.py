#!/usr/bin/env python3
"""Reads a report as a browser does and fails on what a reader would miss.

    check_page.py PAGE [CHARTS]     CHARTS: how many must be drawn; default: as many as there are

In the text: less than 2 MB, tags that close, names that are there once, nothing fetched from elsewhere, numbers that
are JSON. In headless Chromium: every chart drawn and every series of it, the car in
motion where there is one, nothing said on the console, no button that would send the numbers away; nothing
that a screen of 420 px cuts.
Exit 77: Chromium is not there; the text was checked.
"""

import html.parser
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

VOID = {"meta", "br", "hr", "img", "link", "input"}
# What graphics drivers and canvases say of their own speed.
HARMLESS = re.compile(r"willReadFrequently|GL Driver Message|GPU stall")


class Page(html.parser.HTMLParser):
    """The tags of a page: checks them on the way, counts charts and motions."""

    def __init__(self):
        super().__init__()
        self.open = []
        self.names = set()
        self.motions = 0
        self.charts = []
        self.is_chart = self.is_json = False

    def handle_starttag(self, tag, attributes):
        about = dict(attributes)
        for name in ("src", "action", "data"):
            assert name not in about, f"{tag} fetches {about[name]}"
        assert tag not in ("link", "iframe", "img"), tag
        assert not re.match(r"[a-z]+:|//", about.get("href", "")), about["href"]
        if "id" in about:
            assert about["id"] not in self.names, f"id {about['id']} is there twice"
            self.names.add(about["id"])
        if tag == "script":
            self.is_json = about.get("type") == "application/json"
        else:
            self.is_chart = about.get("class") == "chart"
            self.motions += about.get("class") == "motion"
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open and self.open[-1] == tag, (tag, self.open)
        self.open.pop()
        self.is_json = False

    def handle_data(self, text):
        if not self.is_json:
            return
        content = json.loads(text, parse_constant=refuse)
        if self.is_chart:
            self.charts.append(content)


def refuse(constant):
    raise AssertionError(f"{constant} is no JSON")


def count_series(chart):
    """Those that plotly.js must draw: with any place, be it a gap."""
    return sum(bool(trace["x"]) for trace in chart["data"])


def read_text(path):
    page = Page()
    text = path.read_text(encoding="utf-8")
    assert len(text) < 2e6, f"{len(text)} bytes: too large to mail"
    page.feed(text)
    page.close()
    assert not page.open, page.open
    style = re.search(r"<style>(.*?)</style>", text, re.S).group(1)
    assert not re.search(r"@import|url\(", style)
    return page


def find_browser():
    return next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)


# A page as a phone shows it. Says in data-cut what is wider than its place.
PHONE = """<!DOCTYPE html><meta charset="utf-8"><iframe src="{page}" style="width:420px;height:900px"></iframe><script>
const frame = document.querySelector("iframe");
const waiting = setInterval(() => {{
  const page = frame.contentDocument;
  if (!page || !page.body || ({has_charts} && !page.body.dataset.charts)) return;
  clearInterval(waiting);
  const wide = [...page.querySelectorAll(".wide, figure, .keys, header")].filter((e) => e.scrollWidth > e.clientWidth + 1);
  const cut = wide.map((e) => e.textContent.trim().slice(0, 60) + ": " + e.scrollWidth);
  if (page.documentElement.scrollWidth > 421) cut.push("the page: " + page.documentElement.scrollWidth);
  // Paper has no use for what is clicked.
  const printed = [...page.styleSheets[0].cssRules].find((rule) => rule.media?.mediaText === "print");
  for (const name of ["nav", ".modebar-container", ".motion .controls"]) {{
    const hides = (rule) => rule.style?.display === "none" && rule.selectorText.split(", ").includes(name);
    if (![...printed.cssRules].some(hides)) cut.push(name + ": printed");
  }}
  document.body.dataset.cut = cut.join("; ") || "nothing";
}}, 50);
</script>"""


def draw_on_phone(browser, path, has_charts):
    """What a screen of 420 px cuts."""
    with tempfile.TemporaryDirectory() as folder:
        phone = pathlib.Path(folder, "phone.html")
        phone.write_text(PHONE.format(page=path.resolve().as_uri(), has_charts="true" if has_charts else "false"))
        dom, _ = draw(browser, phone, "--allow-file-access-from-files")
    return html.unescape(re.search(r'data-cut="([^"]*)"', dom).group(1))


def draw(browser, path, *options):
    """The page after its scripts have run, and what they said."""
    with tempfile.TemporaryDirectory() as profile:
        done = subprocess.run(
            [browser, "--headless=new", "--no-sandbox", "--enable-unsafe-swiftshader", "--no-first-run",
             f"--user-data-dir={profile}", "--host-resolver-rules=MAP * ~NOTFOUND",
             "--virtual-time-budget=120000", "--enable-logging=stderr", "--log-level=0", "--dump-dom", *options,
             path.resolve().as_uri()],
            capture_output=True, text=True, timeout=240, check=True)
    said = [line for line in done.stderr.splitlines() if "CONSOLE" in line and not HARMLESS.search(line)]
    return done.stdout, said


def main():
    path = pathlib.Path(sys.argv[1])
    page = read_text(path)
    wanted = int(sys.argv[2]) if len(sys.argv) > 2 else len(page.charts)
    assert len(page.charts) == wanted, f"{len(page.charts)} charts instead of {wanted}"
    browser = find_browser()
    if browser is None:
        print("no Chromium: only the text was checked")
        return 77
    dom, said = draw(browser, path)
    assert not said, said
    if wanted or page.motions:
        assert f'data-charts="{wanted}/{wanted}"' in dom, re.findall(r'data-charts="[^"]*"', dom)
    series, shown = sum(map(count_series, page.charts)), len(re.findall('<g class="trace ', dom))
    assert shown == series, f"{shown} of {series} series drawn"
    drawn = dom.count('data-motion="drawn"')
    assert drawn == page.motions, f"{drawn} of {page.motions} motions drawn"
    assert dom.count('data-title="Numbers as CSV"') == wanted
    assert 'data-title="Share' not in dom, "a button sends the chart away"
    cut = draw_on_phone(browser, path, bool(wanted))
    assert cut == "nothing", f"wider than a screen of 420 px, or printed: {cut}"
    print(f"{wanted} charts with {series} flat series, {page.motions} motions")
    return 0


sys.exit(main())
