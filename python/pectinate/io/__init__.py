"""Files and objects that hold surfaces: openCARP, VTK, PLY, OBJ, OFF, STL, GLB, arrays, trimesh, PyVista."""

from pectinate.io.dispatch import load, save_surface
from pectinate.io.opencarp import VertexSet, read_dat, read_vtx
from pectinate.io.units import UnitDecision
from pectinate.io.vtk import write_streamlines_vtp

__all__ = ["UnitDecision", "VertexSet", "load", "read_dat", "read_vtx", "save_surface", "write_streamlines_vtp"]
