"""Drawings of surfaces with tubes on them, offscreen: one view, or several on a sheet."""

from pectinate.figure.picture import render_view
from pectinate.figure.shading import Style
from pectinate.figure.sheet import draw_sheet
from pectinate.figure.views import STANDARD_VIEWS, View, principal_views, standard_view

__all__ = ["STANDARD_VIEWS", "Style", "View", "draw_sheet", "principal_views", "render_view", "standard_view"]
