"""three.js (MIT), which draws in the browser: the copy that trimesh carries for its own viewer."""

from __future__ import annotations

import functools
import io
import re
import zipfile
from importlib import resources

from pectinate.errors import MissingDependency

# Its notice, which must stay with it, and the one line of code that follows.
_LIBRARY = re.compile(
    r"/\*\*\n \* @license\n(?: \*[^\n]*\n)*? \*[^\n]*Three\.js Authors[^\n]*\n(?: \*[^\n/]*\n)* \*/\n[^\n]+"
)


@functools.cache
def three_js() -> str:
    """Source of three.js, beginning with its notice; defines the global `THREE`.

    Raises
    ------
    MissingDependency
        The installed trimesh does not carry it.
    """
    try:
        packed = resources.files("trimesh.resources").joinpath("templates", "viewer.zip").read_bytes()
        with zipfile.ZipFile(io.BytesIO(packed)) as archive:
            text = archive.read("viewer.html.template").decode("utf-8")
    except (OSError, KeyError, zipfile.BadZipFile, ImportError) as error:
        raise _missing() from error
    found = _LIBRARY.search(text)
    if found is None:
        raise _missing()
    return found.group()


def _missing() -> MissingDependency:
    return MissingDependency("this trimesh carries no three.js; install it with: pip install 'trimesh>=4.12'")
