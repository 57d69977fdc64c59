from collections.abc import Callable, Sequence
from enum import Enum, IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int32]
_Longs = NDArray[np.int64]
_Numbers = NDArray[Any]

class Error(Exception): ...
class InvalidMesh(Error, ValueError): ...
class InvalidField(Error, ValueError): ...
class InvalidOption(Error, ValueError): ...
class SolverFailure(Error, RuntimeError): ...

class MeshRepairs:
    degenerate_triangles: _Ints
    duplicate_triangles: _Ints
    non_finite_vertices: _Ints
    non_finite_triangles: _Ints
    unreferenced_vertices: _Ints
    reversed_triangles: _Ints
    non_manifold_edges: _Ints
    split_vertices: _Ints

class BoundaryLoop:
    vertices: _Ints
    length: float
    diameter: float
    centroid: list[float]
    component: int

class SurfaceComponent:
    triangle_count: int
    area: float
    euler_characteristic: int
    boundary_loop_count: int
    orientable: bool
    genus: int

class SurfaceMesh:
    def __init__(self, vertices: _Numbers, triangles: _Numbers) -> None: ...
    vertices: _Floats
    triangles: _Ints
    triangle_count: int
    input_vertex_count: int
    input_triangle_count: int
    input_vertex: _Ints
    input_triangle: _Ints
    repairs: MeshRepairs
    edges: _Ints
    edge_lengths: _Floats
    triangle_areas: _Floats
    triangle_normals: _Floats
    triangle_components: _Ints
    area: float
    bounding_box_diagonal: float
    components: list[SurfaceComponent]
    boundary_loops: list[BoundaryLoop]

class DirectionStatus(IntEnum):
    valid = 0
    zero = 1
    non_finite = 2
    normal = 3
    isotropic = 4

class OrientationField:
    @staticmethod
    def from_triangle_vectors(mesh: SurfaceMesh, vectors: _Numbers) -> OrientationField: ...
    @staticmethod
    def from_vertex_vectors(mesh: SurfaceMesh, vectors: _Numbers) -> OrientationField: ...
    @staticmethod
    def from_triangle_tensors(mesh: SurfaceMesh, tensors: _Numbers) -> OrientationField: ...
    @staticmethod
    def from_vertex_tensors(mesh: SurfaceMesh, tensors: _Numbers) -> OrientationField: ...
    directions: _Floats
    status: NDArray[np.uint8]
    out_of_plane_angles: _Floats
    def count(self, status: DirectionStatus) -> int: ...

class Interpolation:
    field: OrientationField
    confidence: _Floats

class FieldInterpolator:
    def __init__(self, mesh: SurfaceMesh, frame: ReferenceFrame | None = None) -> None: ...
    def interpolate(self, constraints: Constraints) -> Interpolation: ...

class Singularity:
    vertex: int
    half_turns: int
    position: list[float]

class FieldTopology:
    singularities: list[Singularity]
    loop_half_turns: list[int | None]

class BoundaryRule(Enum):
    free = 0
    parallel = 1
    perpendicular = 2

LEAST_WEIGHT: float
GREATEST_WEIGHT: float

class Tract:
    def __init__(self, points: _Numbers, *, name: str = "", weight: float = ..., number: int | None = None) -> None: ...
    name: str
    points: _Floats
    weight: float
    number: int | None

class BoundaryCondition:
    def __init__(self, loop: int, rule: BoundaryRule, *, weight: float = ...) -> None: ...
    loop: int
    rule: BoundaryRule
    weight: float

class ProjectedTract:
    points: _Floats
    triangles: _Ints
    greatest_distance: float
    greatest_detour: float

class Constraints:
    triangles: _Ints
    directions: _Floats
    weights: _Floats
    tract_indices: _Ints
    tracts: list[ProjectedTract]
    conflict_triangles: _Ints
    conflict_tracts: _Ints
    conflict_angles: _Floats

class TractProjector:
    def __init__(self, mesh: SurfaceMesh) -> None: ...
    def nearest_surface_points(self, points: _Numbers) -> tuple[_Ints, _Floats, _Floats]: ...
    def make_constraints(
        self,
        tracts: Sequence[Tract],
        boundary: Sequence[BoundaryCondition] = ...,
        *,
        maximum_distance: float | None = None,
        conflict_angle: float = ...,
    ) -> Constraints: ...

class Parameterization:
    points: _Floats
    outer_loop: int
    loop_ambiguity: float
    loop_centres: _Floats
    flipped_triangles: _Ints
    area_ratio: _Floats
    anisotropy: _Floats

class ReferenceFrame:
    u: _Floats
    longitudinal: _Floats
    transverse: _Floats
    borrowed_triangles: _Ints
    critical_points: _Ints

class Smoothing:
    field: OrientationField
    moved_angles: _Floats
    outliers: NDArray[np.uint8]

class Transfer:
    field: OrientationField
    source_triangles: _Ints
    distances: _Floats

class LandmarkWarp:
    landmarks: _Floats
    weights: _Floats
    linear: list[list[float]]
    offset: list[float]

class PlacementMethod(Enum):
    random = 0
    neighborhood = 1
    distance = 2
    longest = 3

class OccupancyModel(Enum):
    exact = 0
    edge_mask = 1

class PlacementEnd(Enum):
    complete = 0
    cancelled = 1

class StopReason(IntEnum):
    max_steps = 0
    boundary = 1
    near_other = 2
    abrupt_turn = 3
    near_itself = 4
    no_field = 5
    closed = 6
    singularity = 7

class PlacementStatistics:
    streamline_count: int
    total_length: float
    mean_length: float
    length_weighted_mean: float
    surface_area: float
    mean_spacing: float
    mean_spacing_ratio: float
    short_fraction: float
    coverage: float
    stop_counts: list[int]
    polishing_rounds: int

class PlacementOptions:
    separation_distance: float
    method: PlacementMethod
    occupancy: OccupancyModel
    seed_count: int
    seed_distance_factor: float
    seed_clearance: float
    test_distance: float
    minimum_length: float
    close_loops: bool
    singularity_radius: float
    polishing_rounds: int
    polishing_time: float
    abrupt_turn_angle: float
    max_steps: int
    random_seed: int
    thread_count: int

class Placement:
    points: _Floats
    offsets: _Longs
    segment_triangles: _Ints
    point_triangles: _Ints
    barycentric: _Floats
    lengths: _Floats
    stop_reasons: NDArray[np.uint8]
    seed_points: _Longs
    statistics: PlacementStatistics
    options: PlacementOptions
    end: PlacementEnd

class Tubes:
    vertices: _Floats
    triangles: _Ints
    vertex_offsets: _Longs
    triangle_offsets: _Longs
    vertex_points: _Floats

class NamedLoop:
    name: str
    vertices: _Ints

class DemoAtrium:
    vertices: _Floats
    triangles: _Ints
    directions: _Floats
    regions: _Ints
    region_names: list[str]
    loops: list[NamedLoop]

class AtrialSurface(Enum):
    left_atrium = 0
    right_atrium = 1
    bachmann_bundle = 2

class AtrialLayer(Enum):
    epicardium = 0
    endocardium = 1

class GeneratedSurface:
    vertices: _Floats
    triangles: _Ints
    regions: _Ints
    region_names: list[str]
    loops: list[NamedLoop]

def field_topology(mesh: SurfaceMesh, field: OrientationField) -> FieldTopology: ...
def dirichlet_energy(mesh: SurfaceMesh, field: OrientationField) -> float: ...
def nearest_surface_points(mesh: SurfaceMesh, points: _Numbers) -> tuple[_Ints, _Floats, _Floats]: ...
def nearest_boundary_loop(mesh: SurfaceMesh, point: Sequence[float] | _Floats) -> int: ...
def make_constraints(
    mesh: SurfaceMesh,
    tracts: Sequence[Tract],
    boundary: Sequence[BoundaryCondition] = ...,
    *,
    maximum_distance: float | None = None,
    conflict_angle: float = ...,
) -> Constraints: ...
def make_landmark_warp(landmarks: _Numbers, counterparts: _Numbers, *, stiffness: float = ...) -> LandmarkWarp: ...
def warp_points(warp: LandmarkWarp, points: _Numbers) -> _Floats: ...
def has_parameterization() -> bool: ...
def parameterize(mesh: SurfaceMesh, *, outer_loop: int | None = ...) -> Parameterization: ...
def make_reference_frame(
    mesh: SurfaceMesh,
    parameterization: Parameterization,
    *,
    inner_loop: int | None = ...,
    inner_point: Sequence[float] | _Numbers | None = ...,
) -> ReferenceFrame: ...
def field_angles(frame: ReferenceFrame, field: OrientationField) -> _Floats: ...
def field_from_angles(mesh: SurfaceMesh, frame: ReferenceFrame, angles: _Numbers) -> OrientationField: ...
def smooth(
    mesh: SurfaceMesh,
    field: OrientationField,
    *,
    length: float = ...,
    outlier_angle: float = ...,
    fill_missing: bool = ...,
    barriers: Sequence[int] | _Ints | None = None,
) -> Smoothing: ...
def angles_between(first: OrientationField, second: OrientationField) -> _Floats: ...
def add_angular_noise(
    mesh: SurfaceMesh, field: OrientationField, *, standard_deviation: float, random_seed: int = ...
) -> OrientationField: ...
def vertex_directions(mesh: SurfaceMesh, field: OrientationField) -> _Floats: ...
def transfer_by_nearest_point(
    source: SurfaceMesh, field: OrientationField, target: SurfaceMesh, *, maximum_distance: float
) -> Transfer: ...
def transfer_through_disks(
    source: SurfaceMesh,
    source_disk: Parameterization,
    field: OrientationField,
    target: SurfaceMesh,
    target_disk: Parameterization,
    *,
    loop_pairs: Sequence[Sequence[int]] | _Numbers,
) -> Transfer: ...
def place_streamlines(
    mesh: SurfaceMesh,
    field: OrientationField,
    *,
    separation_distance: float = ...,
    separation_distances: _Floats = ...,
    method: PlacementMethod = ...,
    occupancy: OccupancyModel = ...,
    seed_count: int = ...,
    seed_distance_factor: float = ...,
    seed_clearance: float = ...,
    test_distance: float = ...,
    minimum_length: float = ...,
    close_loops: bool = ...,
    singularity_radius: float = ...,
    polishing_rounds: int = ...,
    polishing_time: float = ...,
    abrupt_turn_angle: float = ...,
    max_steps: int = ...,
    random_seed: int = ...,
    thread_count: int = ...,
    progress: Callable[[float], bool | None] | None = None,
) -> Placement: ...

default_taper_length: float

def make_tubes(
    mesh: SurfaceMesh,
    placement: Placement,
    *,
    radius: float = ...,
    taper_length: float = ...,
    side_count: int = ...,
    height: float = ...,
) -> Tubes: ...
def make_demo_atrium(*, edge_length: float = ...) -> DemoAtrium: ...
def make_atrial_surface(
    surface: AtrialSurface, layer: AtrialLayer = ..., *, edge_length: float = ...
) -> GeneratedSurface: ...
def length_histogram(lengths: _Floats, bin_count: int) -> tuple[_Floats, _Longs]: ...
