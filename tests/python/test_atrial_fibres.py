"""What the nineteen rows of the paper's tables say, against the fibres of the built-in atria.

Places and statements come from the geometry alone: borders, regions, normals; not from the tracts.
"""

import json
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import pectinate
from pectinate import datasets
from pectinate.errors import InvalidOption

CHAMBERS = {
    "epicardium": ["left_atrium", "right_atrium", "bachmann_bundle"],
    "endocardium": ["left_atrium", "right_atrium"],
}


@cache
def layer_of(layer):
    return datasets.atria(layer=layer)


@cache
class Surface:
    """One surface with its field, and places on it."""

    def __init__(self, chamber, layer="epicardium"):
        made = layer_of(layer)[chamber]
        self.model, self.mesh = made.model, made.model.mesh
        self.directions = made.field.directions
        self.normals = np.asarray(self.mesh.triangle_normals)
        self.centres = self.mesh.vertices[self.mesh.triangles].mean(axis=1)

    def region(self, name):
        tags = [note.split()[1] for note in self.model.data.notes if note.endswith(f"is the {name.replace(' ', '_')}")]
        return self.model.tags == int(tags[0])

    def loop(self, name):
        """Points of a border, closed."""
        vertices = self.mesh.boundary_loops[self.model.loop_names[name]].vertices
        return self.mesh.vertices[np.append(vertices, vertices[0])]

    def centre(self, name):
        return self.loop(name)[:-1].mean(axis=0)

    def axis(self, name):
        """Unit normal of a border's plane."""
        points = self.loop(name)[:-1]
        return np.linalg.svd(points - points.mean(axis=0))[2][2]

    def near(self, point, distance):
        return np.linalg.norm(self.centres - point, axis=1) < distance

    def beside(self, name, least, greatest):
        """Triangles within a range of distances from a border, and the border's direction nearest to each."""
        points = self.loop(name)
        apart = np.linalg.norm(self.centres[:, None] - points[None, :-1], axis=2)
        nearest = apart.argmin(axis=1)
        return (apart.min(axis=1) > least) & (apart.min(axis=1) < greatest), np.diff(points, axis=0)[nearest]

    def across(self, lines):
        """Across the given lines, in the surface."""
        return np.cross(self.normals, np.broadcast_to(lines, self.normals.shape))

    def angles(self, place, lines):
        """Degrees between fibres and lines, the lines projected to the surface, at a place of at least 20 triangles."""
        assert place.sum() >= 20
        lines = np.broadcast_to(lines, self.normals.shape)[place]
        normals = self.normals[place]
        lines = lines - (lines * normals).sum(axis=1, keepdims=True) * normals
        cosines = abs((lines * self.directions[place]).sum(axis=1)) / np.linalg.norm(lines, axis=1)
        return np.degrees(np.arccos(np.clip(cosines, 0, 1)))

    def median(self, place, lines):
        return np.median(self.angles(place, lines))


def test_1_fibres_of_bachmanns_bundle_run_along_it():
    bundle = Surface("bachmann_bundle")
    beside, margin = bundle.beside("bachmann bundle margin", 0, 3)
    ends = np.sort(bundle.centres[:, 0])[[0, -1]] + [8, -8]
    long_sides = beside & (bundle.centres[:, 0] > ends[0]) & (bundle.centres[:, 0] < ends[1])
    assert bundle.median(long_sides, margin) < 15


def test_2_over_the_roof_fibres_run_from_front_to_back():
    atrium = Surface("left_atrium")
    roof = atrium.region("body") & (atrium.normals[:, 2] > 0.9) & (abs(atrium.centres[:, 0] - 10) < 8)
    assert atrium.median(roof, [0, 1, 0]) < 10


@pytest.mark.parametrize("chamber, valve", [("left_atrium", "mitral valve"), ("right_atrium", "tricuspid valve")])
def test_3_round_the_valves_fibres_are_circles(chamber, valve):
    atrium = Surface(chamber)
    place, circle = atrium.beside(valve, 0, 6)
    assert atrium.median(place, circle) < 10


def test_4_outside_the_superior_vena_cava_has_longitudinal_fibres():
    atrium = Surface("right_atrium")
    assert atrium.median(atrium.region("superior vena cava"), atrium.axis("superior vena cava")) < 10


def test_5_from_bachmanns_bundle_to_the_tricuspid_valve_fibres_turn_gradually():
    atrium = Surface("right_atrium")
    front = (atrium.normals[:, 1] < -0.2) & (abs(atrium.centres[:, 0] + 28) < 4)
    bands = [front & (abs(atrium.centres[:, 2] - height) < 2) for height in range(20, -20, -4)]
    turns = [atrium.median(band, [1, 0, 0]) for band in bands]
    assert turns[0] < 25
    assert np.abs(np.diff(turns)).max() < 30  # in 4 mm
    beside, circle = atrium.beside("tricuspid valve", 0, 7)
    assert atrium.median(front & beside, circle) < 15


def test_6_on_the_right_appendage_fibres_run_to_the_tip():
    atrium = Surface("right_atrium")
    appendage = atrium.region("right atrial appendage")
    root = atrium.centres[atrium.region("body")].mean(axis=0)
    tip = max(atrium.centres[appendage], key=lambda point: np.linalg.norm(point - root))
    far = appendage & ~atrium.near(tip, 6)
    assert atrium.median(far, tip - atrium.centres) < 25


VEINS = [f"{side} {height} pulmonary vein" for side in ("left", "right") for height in ("superior", "inferior")]


@pytest.mark.parametrize("vein", VEINS)
def test_7_outside_the_pulmonary_veins_are_wrapped_in_circles(vein):
    atrium = Surface("left_atrium")
    assert atrium.median(atrium.region(vein), atrium.across(atrium.axis(vein))) < 10


@pytest.mark.parametrize("side", ["left", "right"])
def test_8_from_between_the_veins_fibres_run_to_the_posterior_wall(side):
    atrium = Surface("left_atrium")
    veins = [atrium.centre(f"{side} {height} pulmonary vein") for height in ("superior", "inferior")]
    others = np.mean([atrium.centre(vein) for vein in VEINS], axis=0)
    carina = np.mean(veins, axis=0) + 0.45 * (others - np.mean(veins, axis=0))
    between = atrium.region("body") & atrium.near(carina, 9) & (atrium.normals[:, 1] > -0.2)
    assert atrium.median(between, others - np.mean(veins, axis=0) + np.array([0, 8, 0])) < 25


def test_9_below_the_right_inferior_vein_fibres_turn_to_the_right_atrium():
    atrium, right = Surface("left_atrium"), Surface("right_atrium")
    ostium = atrium.centre("right inferior pulmonary vein")
    beneath = ostium + np.array([12, -10, -6])
    below = atrium.region("body") & (atrium.normals[:, 2] < -0.3) & atrium.near(beneath, 9)
    assert atrium.median(below, right.centres[right.region("body")].mean(axis=0) - atrium.centres) < 30


def test_10_on_the_posterior_wall_the_orientation_changes_abruptly():
    atrium = Surface("left_atrium")
    wall = atrium.region("body") & (atrium.normals[:, 1] > 0.8) & (abs(atrium.centres[:, 0] - 10) < 8)
    upright = atrium.angles(wall, [0, 0, 1])
    heights = atrium.centres[wall, 2]
    bands = [np.median(upright[abs(heights - z) < 1]) for z in range(0, 14)]
    assert min(bands) < 15 and max(bands) > 75
    assert max(bands[i] - min(bands[i : i + 5]) for i in range(10)) > 60  # within 4 mm


def longitudinal(atrium):
    return atrium.centre("superior vena cava") - atrium.centre("inferior vena cava")


@pytest.mark.parametrize("layer", CHAMBERS)
def test_11_the_crista_terminalis_runs_lengthwise(layer):
    atrium = Surface("right_atrium", layer)
    crista = [tract for tract in datasets.atrial_tracts("right_atrium", layer=layer).tracts if tract.label == "11"]
    corners = crista[0].points
    points = np.concatenate([np.linspace(a, b, 20) for a, b in pairwise(corners)])
    apart = np.linalg.norm(atrium.centres[:, None] - points, axis=2).min(axis=1)
    assert atrium.median(apart < 2, longitudinal(atrium)) < 20
    assert np.linalg.norm(corners[0] - corners[-1]) > 0.7 * 45  # mm, of the way from vein to vein


@pytest.mark.parametrize("layer", CHAMBERS)
def test_12_on_the_posterior_wall_fibres_run_against_the_crista_terminalis(layer):
    atrium = Surface("right_atrium", layer)
    wall = atrium.region("body") & (atrium.normals[:, 1] > 0.7) & (abs(atrium.centres[:, 2]) < 12)
    assert atrium.median(wall, atrium.across(longitudinal(atrium))) < 15


FREE_WALL = {"least": -14, "greatest": 6}  # mm, heights


def free_wall(atrium):
    heights, front = atrium.centres[:, 2], atrium.centres[:, 1]
    right = atrium.region("body") & (atrium.normals[:, 0] < -0.6) & (front > -20) & (front < -8)
    return right & (heights > FREE_WALL["least"]) & (heights < FREE_WALL["greatest"])


def test_13_outside_the_free_wall_has_fibres_beside_the_crista_terminalis():
    atrium = Surface("right_atrium")
    assert atrium.median(free_wall(atrium), longitudinal(atrium)) < 25


@pytest.mark.parametrize("layer", CHAMBERS)
def test_14_round_the_inferior_vena_cava_fibres_are_circles(layer):
    atrium = Surface("right_atrium", layer)
    place = atrium.region("inferior vena cava")
    assert atrium.median(place, atrium.across(atrium.axis("inferior vena cava"))) < 10


def test_15_the_left_appendage_has_circles_outside_and_lengthwise_fibres_inside():
    medians = {}
    for layer in CHAMBERS:
        atrium = Surface("left_atrium", layer)
        points = atrium.centres[atrium.region("left atrial appendage")]
        tip = points[points[:, 1].argmin()]
        place = atrium.region("left atrial appendage") & atrium.near(tip, 18) & ~atrium.near(tip, 5)
        lengthwise = np.linalg.svd(atrium.centres[place] - atrium.centres[place].mean(axis=0))[2][0]
        medians[layer] = atrium.median(place, lengthwise)
    assert medians["epicardium"] > 65
    assert medians["endocardium"] < 25


def test_16_inside_the_superior_vena_cava_is_wrapped_in_circles():
    atrium = Surface("right_atrium", "endocardium")
    place = atrium.region("superior vena cava")
    assert atrium.median(place, atrium.across(atrium.axis("superior vena cava"))) < 10


@pytest.mark.parametrize("vein", VEINS)
def test_17_inside_the_pulmonary_veins_fibres_are_lengthwise_or_oblique(vein):
    atrium = Surface("left_atrium", "endocardium")
    angle = atrium.median(atrium.region(vein), atrium.axis(vein))
    assert angle < 20 if "superior" in vein else 20 < angle < 70


def test_18_inside_fibres_run_from_the_veins_to_the_mitral_valve():
    atrium = Surface("left_atrium", "endocardium")
    valve = atrium.centre("mitral valve")
    low = atrium.region("body") & (atrium.normals[:, 1] > 0) & (atrium.centres[:, 2] < -2)
    assert atrium.median(low, valve - atrium.centres) < 35
    beside, circle = atrium.beside("mitral valve", 0, 5)
    assert atrium.median(beside, atrium.across(circle)) < 20


def test_19_inside_pectinate_muscles_run_straight_from_the_crista_terminalis():
    atrium = Surface("right_atrium", "endocardium")
    assert atrium.median(free_wall(atrium), atrium.across(longitudinal(atrium))) < 20


@pytest.mark.parametrize("layer", CHAMBERS)
def test_every_row_has_tracts_where_it_belongs_and_none_contradict(layer):
    made = layer_of(layer)
    assert list(made) == CHAMBERS[layer]
    labels = {tract.label for surface in made.values() for tract in surface.tracts.tracts} - {""}
    rows = range(1, 15) if layer == "epicardium" else range(15, 20)
    assert {str(row) for row in rows} <= labels <= {str(row) for row in datasets.FIBRE_RULES}
    for surface in made.values():
        report = surface.report()
        assert report["conflicts"] == []
        assert max(tract["greatest_distance"] for tract in report["tracts"]) < 1
        assert all(tract.name and tract.description for tract in surface.tracts.tracts)
        assert surface.model.field.count(pectinate._core.DirectionStatus.valid) == surface.model.mesh.triangle_count


def test_boundary_conditions_hold_on_every_border_that_has_one():
    for layer, chambers in CHAMBERS.items():
        for chamber in chambers:
            atrium = Surface(chamber, layer)
            for condition in datasets.atrial_tracts(chamber, layer=layer).boundary:
                place, along = atrium.beside(condition.loop, 0, 0.6)
                lines = along if condition.rule == "parallel" else atrium.across(along)
                assert atrium.median(place, lines) < 5


def test_the_same_fields_at_other_edge_lengths():
    coarse, fine = (datasets.atria(edge_length=length)["right_atrium"].model for length in (2, 1))
    compared = pectinate.compare(fine, coarse, how="nearest")
    assert np.degrees(np.nanmedian(compared.angles)) < 4


def test_files_of_tracts_are_plain(tmp_path):
    tracts = datasets.atrial_tracts("left_atrium")
    tracts.save(tmp_path / "tracts.json")
    document = json.loads((tmp_path / "tracts.json").read_text())
    assert [tract["label"] for tract in document["tracts"]] == [tract.label for tract in tracts.tracts]
    assert document["version"] == 1


@pytest.mark.parametrize(
    "chamber, layer", [("ventricle", "epicardium"), ("left_atrium", "midwall"), ("bachmann_bundle", "endocardium")]
)
def test_what_is_not_there_is_refused(chamber, layer):
    with pytest.raises(InvalidOption):
        datasets.atrial_tracts(chamber, layer=layer)
    with pytest.raises(InvalidOption):
        datasets.atrial_surface(chamber, layer=layer)
