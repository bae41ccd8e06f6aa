"""Pages in a browser: drawn without a network, without an error, with nobody else's script."""

from __future__ import annotations

import re
import shutil
import subprocess

import pytest

pytest.importorskip("jinja2")
pytest.importorskip("plotly")

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
# Chromium's advice to Plotly on how it measures text.
HARMLESS = "Canvas2D: Multiple readback operations"


@pytest.fixture(scope="module")
def browser() -> str:
    found = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if found is None:
        pytest.skip(f"none of {', '.join(BROWSERS)} is installed: the page is not opened")
    return found


@pytest.mark.slow
def test_a_page_is_drawn_without_network_or_error(browser, text, tmp_path):
    file = tmp_path / "page.html"
    file.write_text(text, encoding="utf-8")
    run = subprocess.run(
        [
            browser, "--headless=new", "--no-sandbox", "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader", "--host-resolver-rules=MAP * ~NOTFOUND",
            f"--user-data-dir={tmp_path / 'profile'}", "--virtual-time-budget=30000",
            "--enable-logging=stderr", "--dump-dom", file.as_uri(),
        ],
        capture_output=True, text=True, timeout=240, check=True,
    )  # fmt: skip
    said = [line for line in run.stderr.splitlines() if "CONSOLE" in line and HARMLESS not in line]
    assert said == []
    head, _, body = run.stdout.partition("<body")
    assert 'data-drawn="true"' in head[:200]
    shown = [plot for plot in re.findall(r'<div class="plot[^>]*>', body) if "data-drawn" in plot]
    assert len(shown) > 12
    assert body.count("gl-container") >= 1 and body.count('class="main-svg"') >= 2 * len(shown)
    assert "Share chart" not in body  # nothing sends what is drawn anywhere
    assert 'id="trouble" class="doubts" role="alert" hidden' in body
    # The script in the blade's name has not run, and is there to be read.
    assert "window.hit=1&lt;/script&gt;" in body
