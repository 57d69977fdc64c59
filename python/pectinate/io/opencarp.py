"""The text files of openCARP: `.pts`, `.elem`, `.lon`, `.vtx` and per-vertex `.dat`."""

from __future__ import annotations

import os
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from pectinate.errors import InvalidFile
from pectinate.io.text import (
    TextRows,
    check_indices,
    check_integers,
    format_rows,
    parse_counted,
    parse_table,
    read_rows,
    write_lines,
)
from pectinate.io.units import decide_unit, to_millimetres
from pectinate.model import SurfaceData

SUFFIXES = (".pts", ".elem", ".lon")

#: Vertices of each type of element.
_ELEMENT_SIZES = {"Ln": 2, "Cx": 2, "cH": 2, "Tr": 3, "Qd": 4, "Tt": 4, "Py": 5, "Oc": 6, "Pr": 6, "Hx": 8}

_VECTOR_WIDTH = 3


@dataclass(frozen=True, eq=False)
class VertexSet:
    """A `.vtx` file: (n,) int64 vertex indices and the domain, "intra" or "extra", None where it is not said."""

    indices: NDArray[np.int64]
    domain: Literal["intra", "extra"] | None


@dataclass(frozen=True, eq=False)
class _Elements:
    """The triangles among the elements of a file."""

    count: int  # elements of all types
    triangles: NDArray[np.int64]
    rows: NDArray[np.int64]  # of the triangles among all elements
    tags: NDArray[np.int64] | None
    others: Counter[str]


def stem_of(path: str | os.PathLike[str]) -> Path:
    """Return the common part of the three paths, given it or any of the three."""
    path = Path(path)
    return path.with_suffix("") if path.suffix in SUFFIXES else path


def read_opencarp(
    path: str | os.PathLike[str], *, units: str = "auto", lon: str | os.PathLike[str] | None = "auto"
) -> SurfaceData:
    """Read a surface from `.pts`, `.elem` and, where there is one, `.lon`.

    Rows of the `.lon` are paired with the elements of all types before the triangles are selected; a second vector
    per row becomes `second_vectors`.

    Parameters
    ----------
    path
        The stem that the three paths share, or any of them.
    units
        "auto", "mm", "um", "cm" or "m".
    lon
        Another fibre file, "auto" for the one beside the `.elem`, None for no field.

    Raises
    ------
    InvalidFile
        A file is missing or malformed, or there is no triangle.
    """
    stem = stem_of(path)
    points = _read_points(_with_suffix(stem, ".pts"))
    elements = _read_elements(_with_suffix(stem, ".elem"), len(points))
    notes = [_others_note(elements.others)] if elements.others else []
    lon_path = _lon_path(path, lon)
    if lon_path is None and lon is not None:
        notes.append(f"there is no {stem.name}.lon beside the .elem file: no field")
    vectors = second = None
    if lon_path is not None:
        vectors, second = read_lon(lon_path, elements.count, elements.rows)
    decision = decide_unit(points, units)
    return SurfaceData(
        vertices=to_millimetres(points, decision),
        triangles=elements.triangles,
        units=decision,
        source=str(stem),
        vectors=vectors,
        second_vectors=second,
        tags=elements.tags,
        element_rows=elements.rows if elements.others else None,
        element_count=elements.count if elements.others else None,
        notes=tuple(notes),
    )


def read_lon(
    path: str | os.PathLike[str], element_count: int, rows: NDArray[np.int64] | None = None
) -> tuple[NDArray[np.float64], NDArray[np.float64] | None]:
    """Read a fibre file: 3 or 6 numbers for each element, below a line with 1, 2, the number of rows, or no such line.

    Parameters
    ----------
    path
        The `.lon` file.
    element_count
        Number of elements of all types.
    rows
        (T,), the elements to select; None for all.

    Returns
    -------
    vectors, second_vectors
        (T, 3) each; the second is None where the file has three columns.

    Raises
    ------
    InvalidFile
        The file is missing or malformed, or has another number of rows.
    """
    lines = read_rows(Path(path))
    header = lines if len(lines.lines[0].split()) == 1 else None
    body = lines if header is None else lines.tail()
    table = parse_table(body, (_VECTOR_WIDTH, 2 * _VECTOR_WIDTH), "3 or 6 numbers (one or two vectors)")
    if header is not None and header.lines[0].strip() not in {str(table.shape[1] // _VECTOR_WIDTH), str(len(table))}:
        rule = f"the first line says {header.lines[0].strip()}, {len(table)} rows of {table.shape[1]} numbers follow"
        raise header.error(0, rule, "it must hold the number of vectors in a row (1 or 2) or the number of rows")
    if len(table) != element_count:
        rule = f"{len(table)} rows for {element_count} elements"
        raise InvalidFile.at(path, rule, "give one row for every element of any type, in the order of the .elem file")
    selected = table if rows is None else table[rows]
    second = selected[:, _VECTOR_WIDTH:].copy() if table.shape[1] > _VECTOR_WIDTH else None
    return selected[:, :_VECTOR_WIDTH].copy(), second


def read_vtx(path: str | os.PathLike[str], vertex_count: int | None = None) -> VertexSet:
    """Read a set of vertices: the count, `intra` or `extra` (or nothing), one index a line.

    Raises
    ------
    InvalidFile
        The file is missing or malformed, or an index is not below `vertex_count`.
    """
    rows = read_rows(Path(path))
    word = rows.lines[1].strip() if len(rows) > 1 else ""
    domain: Literal["intra", "extra"] | None = "intra" if word == "intra" else "extra" if word == "extra" else None
    if domain is not None:
        rows = TextRows(rows.path, [rows.lines[0], *rows.lines[2:]], [rows.numbers[0], *rows.numbers[2:]])
    body = parse_counted(rows, "vertices")
    indices = parse_table(body, (1,), "one index of a vertex")
    return VertexSet(check_indices(body, indices[:, 0], vertex_count), domain)


def read_dat(path: str | os.PathLike[str], vertex_count: int | None = None) -> NDArray[np.float64]:
    """Read one number per vertex, (V,) float64, without a header.

    Raises
    ------
    InvalidFile
        The file is missing or malformed, or does not hold `vertex_count` numbers.
    """
    values = parse_table(read_rows(Path(path)), (1,), "one number")[:, 0]
    if vertex_count is not None and len(values) != vertex_count:
        raise InvalidFile.at(path, f"{len(values)} numbers for {vertex_count} vertices", "give one number per vertex")
    return values


def write_opencarp(  # noqa: PLR0913
    path: str | os.PathLike[str],
    vertices: NDArray[np.float64],
    triangles: NDArray[np.int64],
    *,
    vectors: NDArray[np.float64] | None = None,
    second_vectors: NDArray[np.float64] | None = None,
    tags: NDArray[np.int64] | None = None,
) -> list[Path]:
    """Write `.pts`, `.elem` and, with vectors, `.lon`; reading them back gives the very same numbers.

    Parameters
    ----------
    path
        The stem, or any of the three paths.
    vertices
        (V, 3), written as they are: by the book in micrometres.
    triangles
        (T, 3) indices of vertices.
    vectors, second_vectors
        (T, 3) each; a second vector needs a first.
    tags
        (T,), region of each triangle; None for none.

    Returns
    -------
    The files written.

    Raises
    ------
    InvalidFile
        A file cannot be written, or a `.lon` of another surface would stay beside it.
    """
    stem = stem_of(path)
    lon = _with_suffix(stem, ".lon")
    if vectors is None and lon.exists():
        raise InvalidFile.at(lon, "would stay beside a surface without vectors", "remove it or write elsewhere")
    corners = [f"Tr {row}" for row in format_rows(triangles)]
    elements = corners if tags is None else [f"{row} {tag}" for row, tag in zip(corners, tags.tolist(), strict=True)]
    pts, elem = _with_suffix(stem, ".pts"), _with_suffix(stem, ".elem")
    write_lines(pts, [str(len(vertices)), *format_rows(vertices)])
    write_lines(elem, [str(len(elements)), *elements])
    if vectors is None:
        return [pts, elem]
    table = vectors if second_vectors is None else np.hstack([vectors, second_vectors])
    write_lines(lon, ["1" if second_vectors is None else "2", *format_rows(table)])
    return [pts, elem, lon]


def _with_suffix(stem: Path, suffix: str) -> Path:
    return stem.with_name(stem.name + suffix)


def _lon_path(path: str | os.PathLike[str], lon: str | os.PathLike[str] | None) -> Path | None:
    """Choose the fibre file; None where none is wanted, or none is there and none was named."""
    if lon is None or lon != "auto":
        return None if lon is None else Path(lon)
    beside = _with_suffix(stem_of(path), ".lon")
    return beside if beside.exists() or Path(path).suffix == ".lon" else None


def _read_points(path: Path) -> NDArray[np.float64]:
    return parse_table(parse_counted(read_rows(path), "points"), (3,), "x y z")


def _read_elements(path: Path, vertex_count: int) -> _Elements:
    rows = parse_counted(read_rows(path), "elements")
    split = [line.split(None, 1) for line in rows.lines]
    kinds = [parts[0] for parts in split]
    counts = Counter(kinds)
    for kind in counts:
        if kind not in _ELEMENT_SIZES:
            rule = f"{kind[:30]!r} is no type of element"
            raise rows.error(kinds.index(kind), rule, f"use one of {', '.join(_ELEMENT_SIZES)}")
    if "Tr" not in counts:
        raise InvalidFile.at(path, "no element is a triangle (Tr)", "extract the surface first")
    names = np.array(kinds)
    indices = {kind: np.flatnonzero(names == kind) for kind in counts}
    parsed = {kind: _parse_elements(rows, split, kind, indices[kind], vertex_count) for kind in counts}
    triangles, tags = parsed["Tr"]
    del counts["Tr"]
    return _Elements(len(rows), triangles, indices["Tr"].astype(np.int64), tags, counts)


def _parse_elements(
    rows: TextRows, split: list[list[str]], kind: str, indices: NDArray[np.intp], vertex_count: int
) -> tuple[NDArray[np.int64], NDArray[np.int64] | None]:
    """Corners and tags of the elements of one type."""
    size = _ELEMENT_SIZES[kind]
    bodies = [split[index][1] if len(split[index]) > 1 else "" for index in indices]
    body = TextRows(rows.path, bodies, [rows.numbers[index] for index in indices])
    table = parse_table(body, (size, size + 1), f"{kind}, {size} indices of vertices and perhaps a tag")
    corners = check_indices(body, table[:, :size], vertex_count)
    return corners, check_integers(body, table[:, size], "region tag") if table.shape[1] > size else None


def _others_note(others: Counter[str]) -> str:
    listed = ", ".join(f"{count} {kind}" for kind, count in sorted(others.items()))
    return f"elements that are no triangles were left out: {listed}"
