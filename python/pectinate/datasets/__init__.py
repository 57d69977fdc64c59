"""Surfaces and fibres that pectinate makes itself."""

from pectinate.datasets.atria import FIBRE_RULES, atria, atrial_tracts
from pectinate.datasets.surfaces import atrial_surface, demo_atrium

__all__ = ["FIBRE_RULES", "atria", "atrial_surface", "atrial_tracts", "demo_atrium"]
