"""Interactive pages: surfaces with streamlines in one HTML file that any browser shows, without the network."""

from pectinate.figure.parts import Marker, Part
from pectinate.figure.polylines import Lines
from pectinate.viewer.page import Page

__all__ = ["Lines", "Marker", "Page", "Part"]
