"""Interactive pages: surfaces with streamlines in one HTML file that any browser shows, without the network."""

from pectinate.figure.parts import Lines, Marker, Part
from pectinate.viewer.page import Page

__all__ = ["Lines", "Marker", "Page", "Part"]
