"""Reasons to skip tests."""

from __future__ import annotations

import pytest

from pectinate import _core

#: Of tests that map a surface onto the disk.
needs_map = pytest.mark.skipif(
    not _core.has_parameterization(), reason="pectinate was built without CGAL (-DPECTINATE_WITH_CGAL=OFF)"
)
