"""Sheets and page of the built-in atria: their numbers and parts."""

from functools import cache

import numpy as np
import pytest

import pectinate
from pectinate import datasets
from pectinate.datasets.sheets import AtrialFibres, atria_page, fibre_sheet, tract_sheet
from pectinate.errors import RenderingUnavailable


@cache
def layers():
    def fibres(made):
        return AtrialFibres(made, pectinate.place_streamlines(made.model, separation_distance=4))

    return {
        layer: {name: fibres(made) for name, made in datasets.atria(layer=layer, edge_length=2).items()}
        for layer in ("epicardium", "endocardium")
    }


def test_every_row_has_a_marker_on_a_tract_of_its_own():
    rows = set()
    for layer, chambers in layers().items():
        for shown in chambers.values():
            labels = [tract.label for tract in shown.made.tracts.tracts]
            for marker in shown.markers():
                own = [curve for curve, label in zip(shown.curves, labels, strict=True) if label == marker.text]
                for place in (marker.position, *marker.alternatives):
                    assert min(np.linalg.norm(curve - place, axis=1).min() for curve in own) == 0
                rows.add((layer, int(marker.text)))
    assert {row for layer, row in rows if layer == "epicardium"} >= set(range(1, 15))
    assert {row for layer, row in rows if layer == "endocardium"} >= set(range(15, 20))
    assert {row for _, row in rows} == set(datasets.FIBRE_RULES)


def test_the_page_holds_all_surfaces_and_rules():
    page = atria_page(layers()).html
    assert all(f"{name.replace('_', ' ')}, {layer}" in page for layer in layers() for name in layers()[layer])
    assert all(rule in page for rule in datasets.FIBRE_RULES.values() if "'" not in rule)


def test_sheets_have_a_row_for_every_view_and_a_column_for_every_layer(tmp_path):
    try:
        fibres = fibre_sheet(layers(), tmp_path / "fibres.png", size=(120, 100), supersampling=1)
        tracts = tract_sheet(layers(), size=(120, 100), supersampling=1)
    except RenderingUnavailable as reason:
        pytest.skip(str(reason))
    assert (tmp_path / "fibres.png").stat().st_size > 0
    for sheet, rows in ((fibres, 3), (tracts, 2)):
        assert 2 * 120 <= sheet.width < 3 * 120
        assert rows * 100 <= sheet.height < (rows + 1) * 100
        dark = np.asarray(sheet.convert("L")) < 60
        assert 0.01 < dark.mean() < 0.4
