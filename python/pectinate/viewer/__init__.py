"""Interactive pages: surfaces with streamlines in one HTML file that any browser shows, without the network."""

from pectinate.viewer.page import Page
from pectinate.viewer.parts import Lines, Marker, Part

__all__ = ["Lines", "Marker", "Page", "Part"]
