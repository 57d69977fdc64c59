"""The README's Python is run as it stands."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from pectinate.errors import RenderingUnavailable

README = Path(__file__).resolve().parents[2] / "README.md"


def test_the_examples_run_and_make_what_they_say(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pyvista")
    pytest.importorskip("pandas")
    first, *others = re.findall(r"```python\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert len(first.strip().splitlines()) <= 10
    code = first + "".join(others)
    monkeypatch.chdir(tmp_path)
    try:
        exec(compile(code, str(README), "exec"), {})
    except RenderingUnavailable as error:
        pytest.skip(str(error))
    assert {path.name for path in tmp_path.iterdir()} == {
        *("streamlines.npz", "tubes.glb", "posterior.png"),
        *("right_atrium.pts", "right_atrium.elem", "right_atrium.lon"),
        *("atrium.vtp", "made.png"),
        *("atrium.html", "both.html", "lines.vtp"),
        *("values.png", "values.html"),
    }
    assert np.load("streamlines.npz")["offsets"][-1] > 0
    assert Image.open("posterior.png").size == (640, 610)


def test_every_linked_file_is_there() -> None:
    links = re.findall(r"\]\(([^)#]+)\)", README.read_text(encoding="utf-8"))
    assert [link for link in links if "://" not in link and not (README.parent / link).exists()] == []
