"""Self-contained pages: surfaces and streamlines that turn under the mouse, in one HTML file."""

from __future__ import annotations

import functools
import html
import json
import os
import sys
import tempfile
import webbrowser
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any

from pectinate.errors import InvalidFile, InvalidOption, MissingDependency
from pectinate.figure.parts import Marker, Part
from pectinate.figure.patient_axes import PatientAxes
from pectinate.figure.shading import Style
from pectinate.figure.views import STANDARD_VIEWS, View
from pectinate.viewer.scene import describe_scene
from pectinate.viewer.three import three_js

SUFFIXES = (".html", ".htm")

_SCRIPTS = ("decode", "shaders", "surface", "tubes", "view", "pointer", "picture", "overlay", "panel", "main")
_FRAME_HEIGHT = 600  # CSS pixels, in a notebook


class Page:
    """An interactive page of one or several surfaces; `Placement.show` and `Model.show` make one.

    The page is one HTML file that holds its data and three.js, and asks nothing of the network. It needs a browser of
    2023 or later with WebGL 2. In Jupyter a page displays itself.

    Parameters
    ----------
    parts : Part or sequence of Part
        What to show, each with a switch of its own if there are several.
    markers : sequence of Marker
        Labels on the surfaces.
    title : str
        Above the switches.
    notes : sequence of str
        Lines below the controls; more than three are folded.
    views : sequence of str or View
        A button for each; the page begins with the first.
    axes : str or PatientAxes
        Where +x, +y and +z point in the patient, for the standard views.
    shown_values : str, optional
        Name of the values that are shown at first; by default the first ones.
    style : Style
        Colours and light.

    Raises
    ------
    InvalidOption
        There is nothing to show, or views, axes or values do not fit.
    MissingDependency
        There are values to show, but Matplotlib is not installed; or trimesh lacks three.js.
    """

    def __init__(  # noqa: PLR0913
        self,
        parts: Part | Sequence[Part],
        *,
        markers: Sequence[Marker] = (),
        title: str = "",
        notes: Sequence[str] = (),
        views: Sequence[str | View] = STANDARD_VIEWS,
        axes: str | PatientAxes = "LPS",
        shown_values: str | None = None,
        style: Style = Style(),  # noqa: B008  (immutable)
    ) -> None:
        given = [parts] if isinstance(parts, Part) else list(parts)
        scene, arrays = describe_scene(given, markers, views, axes, style)
        scene |= {"title": title, "notes": list(notes), "shown_values": _index(scene["scales"], shown_values)}
        self._html = Template(_static("page.html")).substitute(
            title=html.escape(title or "pectinate"),
            css=_static("page.css"),
            three=three_js(),
            description=_json(scene),
            arrays=arrays.base64(),
            code="\n".join(_static(f"{name}.js") for name in _SCRIPTS),
        )

    @property
    def html(self) -> str:
        """The whole page."""
        return self._html

    def __repr__(self) -> str:
        """Say how large it is."""
        return f"<Page of {len(self._html) / 1e6:.1f} MB>"

    def _repr_html_(self) -> str:
        """The page in a frame, for Jupyter."""
        return (
            f'<iframe srcdoc="{html.escape(self._html)}" sandbox="allow-scripts allow-downloads" '
            f'style="width: 100%; height: {_FRAME_HEIGHT}px; border: 0"></iframe>'
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the page.

        Raises
        ------
        InvalidOption
            The suffix is not `.html`.
        InvalidFile
            The file cannot be written.
        """
        if Path(path).suffix.lower() not in SUFFIXES:
            raise InvalidOption(f"{path}: a page needs the suffix .html")
        try:
            Path(path).write_text(self._html, encoding="utf-8")
        except OSError as error:
            raise InvalidFile.at(path, f"cannot be written ({error.strerror})", "check the folder") from error

    def show(self) -> Page:
        """Open the page in the browser, from a temporary file; in a notebook only return it, to be displayed there.

        Raises
        ------
        MissingDependency
            There is no browser.
        """
        if not _in_notebook():
            with tempfile.NamedTemporaryFile("w", suffix=".html", prefix="pectinate-", delete=False) as file:
                path = Path(file.name)
            self.save(path)
            if not webbrowser.open(path.as_uri()):
                path.unlink()
                raise MissingDependency("no browser could be opened: save the page as a file, and open that")
        return self


def _index(scales: list[dict[str, Any]], name: str | None) -> int:
    """Index of the values that are shown at first."""
    if name is None:
        return 0
    names = [scale["name"] for scale in scales]
    if name not in names:
        raise InvalidOption(f"shown_values is {name!r}, but must be one of: {', '.join(names) or '(there are none)'}")
    return names.index(name)


def _json(scene: dict[str, Any]) -> str:
    """JSON that ends no script element, whatever it holds."""
    return json.dumps(scene, allow_nan=False, separators=(",", ":")).replace("<", "\\u003c")


@functools.cache
def _static(name: str) -> str:
    return resources.files("pectinate.viewer").joinpath("static", name).read_text(encoding="utf-8")


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    return ipython is not None and hasattr(ipython.get_ipython(), "kernel")
