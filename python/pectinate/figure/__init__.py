"""Drawings of surfaces with tubes and values on them, offscreen, and of the disk that a surface is mapped to."""

from pectinate.figure.cells import Cell, figure_sheet
from pectinate.figure.contours import Contour, contour_lines
from pectinate.figure.disk import draw_disk
from pectinate.figure.lines import line_tubes
from pectinate.figure.parts import Marker, Part
from pectinate.figure.patient_axes import PatientAxes
from pectinate.figure.picture import render_view
from pectinate.figure.plots import draw_lengths, draw_spacing
from pectinate.figure.polylines import Lines
from pectinate.figure.shading import Style
from pectinate.figure.shape import Layer
from pectinate.figure.sheet import draw_sheet
from pectinate.figure.values import SurfaceValues
from pectinate.figure.views import STANDARD_VIEWS, View, principal_views, standard_view

__all__ = [
    "STANDARD_VIEWS",
    "Cell",
    "Contour",
    "Layer",
    "Lines",
    "Marker",
    "Part",
    "PatientAxes",
    "Style",
    "SurfaceValues",
    "View",
    "contour_lines",
    "draw_disk",
    "draw_lengths",
    "draw_sheet",
    "draw_spacing",
    "figure_sheet",
    "line_tubes",
    "principal_views",
    "render_view",
    "standard_view",
]
