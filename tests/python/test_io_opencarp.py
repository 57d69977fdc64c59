"""openCARP files: every variant that is in use is read, every malformed one is refused with its line."""

from __future__ import annotations

from pathlib import Path

import hypothesis.extra.numpy as hnp
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from meshes import grid
from pectinate.errors import Error, InvalidFile
from pectinate.io.opencarp import read_dat, read_lon, read_opencarp, read_vtx, write_opencarp

PTS = "4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"
ELEM = "2\nTr 0 1 2 5\nTr 0 2 3 6\n"
LON = "1 0 0\n0 1 0\n"


def write(folder: Path, *, pts: str = PTS, elem: str = ELEM, lon: str | None = LON) -> Path:
    (folder / "m.pts").write_text(pts)
    (folder / "m.elem").write_text(elem)
    if lon is not None:
        (folder / "m.lon").write_text(lon)
    return folder / "m"


@pytest.mark.parametrize("suffix", ["", ".pts", ".elem", ".lon"])
def test_any_path_of_the_triple_names_the_surface(tmp_path: Path, suffix: str) -> None:
    data = read_opencarp(f"{write(tmp_path)}{suffix}")
    assert data.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    assert data.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert data.vectors is not None
    assert data.vectors.tolist() == [[1, 0, 0], [0, 1, 0]]
    assert data.tags is not None
    assert data.tags.tolist() == [5, 6]
    assert (data.second_vectors, data.element_rows, data.notes) == (None, None, ())


@pytest.mark.parametrize(("written", "tag"), [("11", 11), ("4.0", 4), ("-1", -1)])
def test_tags_may_be_written_as_integers_or_floats(tmp_path: Path, written: str, tag: int) -> None:
    data = read_opencarp(write(tmp_path, elem=f"2\nTr 0 1 2 {written}\nTr 0 2 3 {written}\n"))
    assert data.tags is not None
    assert data.tags.tolist() == [tag, tag]


def test_tags_may_be_absent(tmp_path: Path) -> None:
    assert read_opencarp(write(tmp_path, elem="2\nTr 0 1 2\nTr 0 2 3\n")).tags is None


@pytest.mark.parametrize("header", ["", "1\n", "2\n"])
def test_one_vector_with_each_header(tmp_path: Path, header: str) -> None:
    data = read_opencarp(write(tmp_path, lon=header + LON))  # "2" is the number of rows here
    assert data.vectors is not None
    assert data.vectors.tolist() == [[1, 0, 0], [0, 1, 0]]
    assert data.second_vectors is None


@pytest.mark.parametrize("header", ["", "2\n", "3\n"])
def test_two_vectors_with_each_header(tmp_path: Path, header: str) -> None:
    path = tmp_path / "m.lon"
    path.write_text(header + "1 0 0 0 1 0\n0 1 0 0 0 1\n1 0 0 0 nan 1\n")
    vectors, second = read_lon(path, 3)
    assert vectors.tolist() == [[1, 0, 0], [0, 1, 0], [1, 0, 0]]
    assert second is not None
    assert second[:2].tolist() == [[0, 1, 0], [0, 0, 1]]
    assert np.isnan(second[2, 1])


def test_vectors_are_paired_with_elements_before_triangles_are_selected(tmp_path: Path) -> None:
    elem = "6\nLn 0 1 9\nTr 0 1 2 5\nTt 0 1 2 3 8\nQd 0 1 2 3 7\nTr 0 2 3 6\nLn 1 2 9\n"
    lon = "".join(f"{row} 0 1\n" for row in range(6))
    data = read_opencarp(write(tmp_path, elem=elem, lon=lon))
    assert data.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert data.element_rows is not None
    assert data.element_rows.tolist() == [1, 4]
    assert data.element_count == 6
    assert data.vectors is not None
    assert data.vectors[:, 0].tolist() == [1, 4]
    assert data.tags is not None
    assert data.tags.tolist() == [5, 6]
    assert data.notes == ("elements that are no triangles were left out: 2 Ln, 1 Qd, 1 Tt",)


def test_every_type_of_element_may_stand_between(tmp_path: Path) -> None:
    pts = "8\n" + "".join(f"{k} {k * k} 0\n" for k in range(8))
    sizes = {"Ln": 2, "Cx": 2, "cH": 2, "Qd": 4, "Tt": 4, "Py": 5, "Oc": 6, "Pr": 6, "Hx": 8}
    others = "".join(f"{kind} {' '.join(map(str, range(size)))} 1\n" for kind, size in sizes.items())
    data = read_opencarp(write(tmp_path, pts=pts, elem=f"10\n{others}Tr 5 6 7\n", lon=None))
    assert data.triangles.tolist() == [[5, 6, 7]]
    assert data.tags is None


def test_blank_lines_tabs_and_foreign_line_ends_are_harmless(tmp_path: Path) -> None:
    stem = write(tmp_path, lon=None)
    (tmp_path / "m.elem").write_bytes(b"\xef\xbb\xbf2\r\n\r\nTr\t0\t1 2  5\r\n  Tr 0 2 3 6 \r\n\r\n")
    data = read_opencarp(stem)
    assert data.triangles.tolist() == [[0, 1, 2], [0, 2, 3]]
    assert data.notes == ("there is no m.lon beside the .elem file: no field",)


@pytest.mark.parametrize(
    ("files", "place"),
    [
        (
            {"pts": "5\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n"},
            "m.pts, line 1: the first line announces 5 points, the file holds 4",
        ),
        ({"pts": "0 0 0\n1 0 0\n"}, "m.pts, line 1: '0 0 0' is not a count"),
        ({"pts": "4\n0 0 0\n1 0 0\n1 zero 0\n0 1 0\n"}, "m.pts, line 4: 'zero' is not a number"),
        ({"pts": "4\n0 0 0\n\n1 0\n1 1 0\n0 1 0\n"}, "m.pts, line 4: 2 columns where line 2 has 3"),
        ({"pts": "4\n0 0\n1 0\n1 1\n0 1\n"}, "m.pts, line 2: 2 columns"),
        ({"pts": "4\n0 0 0\n1 0 0\n1_0 1 0\n0 1 0\n"}, "m.pts, line 4: '1_0' is not a number"),
        ({"pts": " \n"}, "m.pts: is empty"),
        ({"pts": "4\n"}, "m.pts, line 1: the first line announces 4 points, the file holds 0"),
        ({"elem": ""}, "m.elem: is empty"),
        ({"elem": "0\n"}, "m.elem: no element is a triangle"),
        ({"elem": "1\nTt 0 1 2 3 1\n"}, "m.elem: no element is a triangle"),
        (
            {"elem": "2\nTr 0 1 2 5\nTr 0 2 4 6\n"},
            "m.elem, line 3: 4 is not the index of a vertex; use integers from 0 to 3",
        ),
        ({"elem": "2\nTr 0 1 -2 5\nTr 0 2 3 6\n"}, "m.elem, line 2: -2 is not the index"),
        ({"elem": "2\nTr 0 1 1.5 5\nTr 0 2 3 6\n"}, "m.elem, line 2: 1.5 is not the index"),
        ({"elem": "2\nTr 0 1 nan 5\nTr 0 2 3 6\n"}, "m.elem, line 2: nan is not the index"),
        ({"elem": "2\nTr 0 1 4294967296 5\nTr 0 2 3 6\n"}, "m.elem, line 2: 4294967296 is not the index"),
        ({"elem": "2\nTr 0 1 2 5\nTr 0 2 3 6.5\n"}, "m.elem, line 3: 6.5 is not a region tag"),
        ({"elem": "2\nTr 0 1 2 5\nTr 0 2 3\n"}, "m.elem, line 3: 3 columns where line 2 has 4"),
        ({"elem": "2\nTr 0 1 2 5\nTr\n"}, "m.elem, line 3: 0 columns where line 2 has 4"),
        ({"elem": "2\nTr 0 1 2 5\nTri 0 2 3 6\n"}, "m.elem, line 3: 'Tri' is no type of element"),
        ({"elem": "2\nTr 0 1 2 5\nLn 0 7 6\n"}, "m.elem, line 3: 7 is not the index"),
        ({"elem": "2\nTr 0 1 2 5 7\nTr 0 2 3 6 7\n"}, "m.elem, line 2: 5 columns"),
        ({"lon": "1 0 0\n"}, "m.lon: 1 rows for 2 elements"),
        ({"lon": "1 0 0\n0 1 0\n0 1 0\n"}, "m.lon: 3 rows for 2 elements"),
        ({"lon": "2\n1 0 0\n0 1 0\n0 1 0\n"}, "m.lon, line 1: the first line says 2, 3 rows of 3 numbers follow"),
        ({"lon": "1\n1 0 0\n0 q 0\n"}, "m.lon, line 3: 'q' is not a number"),
        ({"lon": "1 0 0\n0 1 0 0 0 1\n"}, "m.lon, line 2: 6 columns where line 1 has 3"),
        ({"lon": "1 0\n0 1\n"}, "m.lon, line 1: 2 columns"),
        ({"lon": ""}, "m.lon: is empty"),
    ],
)
def test_malformed_files_are_refused_at_their_line(tmp_path: Path, files: dict[str, str], place: str) -> None:
    with pytest.raises(InvalidFile) as caught:
        read_opencarp(write(tmp_path, **files))
    assert str(caught.value).startswith(f"{tmp_path}/{place}")
    assert "; " in str(caught.value)  # the remedy


@pytest.mark.parametrize("missing", [".pts", ".elem"])
def test_a_missing_companion_is_named(tmp_path: Path, missing: str) -> None:
    stem = write(tmp_path)
    stem.with_suffix(missing).unlink()
    with pytest.raises(InvalidFile, match=f"m{missing}: there is no such file"):
        read_opencarp(stem)


def test_a_fibre_file_that_was_named_must_be_there(tmp_path: Path) -> None:
    with pytest.raises(InvalidFile, match=r"m\.lon: there is no such file"):
        read_opencarp(tmp_path / write(tmp_path, lon=None).with_suffix(".lon"))


def test_bytes_that_are_no_text_are_refused(tmp_path: Path) -> None:
    stem = write(tmp_path)
    (tmp_path / "m.pts").write_bytes(bytes(range(256)))
    with pytest.raises(InvalidFile, match="is not a text file"):
        read_opencarp(stem)


numbers = st.floats(width=64, allow_subnormal=True)
finite = st.floats(allow_nan=False, allow_infinity=False)


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data(), has_tags=st.booleans(), vector_count=st.integers(0, 2))
def test_writing_and_reading_gives_the_very_same_numbers(
    tmp_path: Path, data: st.DataObject, has_tags: bool, vector_count: int
) -> None:
    vertices = data.draw(hnp.arrays(np.float64, (data.draw(st.integers(1, 6)), 3), elements=finite))
    count = data.draw(st.integers(1, 6))
    triangles = data.draw(hnp.arrays(np.int64, (count, 3), elements=st.integers(0, len(vertices) - 1)))
    tags = data.draw(hnp.arrays(np.int64, count, elements=st.integers(-(2**53), 2**53))) if has_tags else None
    drawn = [data.draw(hnp.arrays(np.float64, (count, 3), elements=numbers)) for _ in range(vector_count)]
    vectors, second = [*drawn, None, None][:2]
    (tmp_path / "m.lon").unlink(missing_ok=True)

    write_opencarp(tmp_path / "m", vertices, triangles, vectors=vectors, second_vectors=second, tags=tags)
    read = read_opencarp(tmp_path / "m", units="mm")

    assert read.vertices.tobytes() == vertices.tobytes()
    for found, written in ((read.triangles, triangles), (read.tags, tags)):
        assert (found is None) == (written is None)
        assert found is None or written is None or found.tolist() == written.tolist()
    for values, expected in ((read.vectors, vectors), (read.second_vectors, second)):
        assert (values is None) == (expected is None)
        if values is not None:
            np.testing.assert_array_equal(values, expected)
            assert (np.signbit(values) == np.signbit(expected))[~np.isnan(values)].all()


def test_what_is_written_is_by_the_book(tmp_path: Path) -> None:
    vertices, triangles = grid(1, 1)
    vectors = np.array([[1.0, 0, 0], [0.1, 0, 0]])
    files = write_opencarp(tmp_path / "a.b", vertices, triangles, vectors=vectors, tags=np.array([3, 4]))
    assert [file.name for file in files] == ["a.b.pts", "a.b.elem", "a.b.lon"]
    assert files[0].read_text().startswith("4\n0.0 0.0 0.0\n")
    assert files[1].read_text() == "2\nTr 0 1 3 3\nTr 0 3 2 4\n"
    assert files[2].read_text() == "1\n1.0 0.0 0.0\n0.1 0.0 0.0\n"


def test_no_foreign_fibre_file_stays_beside_a_surface_without_vectors(tmp_path: Path) -> None:
    vertices, triangles = grid(1, 1)
    write_opencarp(tmp_path / "m", vertices, triangles, vectors=np.ones((2, 3)))
    with pytest.raises(InvalidFile, match="would stay beside"):
        write_opencarp(tmp_path / "m", vertices, triangles)


def test_a_folder_that_is_not_there_cannot_be_written_to(tmp_path: Path) -> None:
    with pytest.raises(InvalidFile, match="cannot be written"):
        write_opencarp(tmp_path / "no" / "m", *grid(1, 1))


@pytest.mark.parametrize("domain", ["intra", "extra", None])
def test_vertex_sets(tmp_path: Path, domain: str | None) -> None:
    path = tmp_path / "s.vtx"
    path.write_text(f"3\n{domain}\n7\n0\n7\n" if domain else "3\n7\n0\n7\n")
    found = read_vtx(path, vertex_count=8)
    assert (found.indices.tolist(), found.domain) == ([7, 0, 7], domain)


@pytest.mark.parametrize(
    ("text", "place"),
    [
        ("2\nextra\n1\n8\n", "line 4: 8 is not the index"),
        ("2\nouter\n1\n2\n", "line 1: the first line announces 2 vertices, the file holds 3"),
        ("3\nintra\n1\n2\n", "line 1: the first line announces 3 vertices, the file holds 2"),
        ("2\nintra\n1\nx\n", "line 4: 'x' is not a number"),
        ("intra\n1\n", "line 1: 'intra' is not a count"),
    ],
)
def test_malformed_vertex_sets_are_refused(tmp_path: Path, text: str, place: str) -> None:
    path = tmp_path / "s.vtx"
    path.write_text(text)
    with pytest.raises(InvalidFile, match=place):
        read_vtx(path, vertex_count=8)


def test_numbers_per_vertex(tmp_path: Path) -> None:
    path = tmp_path / "v.dat"
    path.write_text("0.5\n-1e3\nnan\n")
    np.testing.assert_array_equal(read_dat(path, 3), [0.5, -1000, np.nan])
    with pytest.raises(InvalidFile, match="3 numbers for 4 vertices"):
        read_dat(path, 4)


def test_file_errors_are_errors_of_the_library_and_value_errors(tmp_path: Path) -> None:
    with pytest.raises(Error):
        read_dat(tmp_path / "none.dat")
    with pytest.raises(ValueError, match="there is no such file"):
        read_dat(tmp_path / "none.dat")
