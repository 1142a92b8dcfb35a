"""Nodes brought from within the tolerance onto the exact surfaces, curves and points."""
