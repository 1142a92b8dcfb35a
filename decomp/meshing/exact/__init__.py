"""Nodes brought from within epsilon onto the exact surfaces, curves and points."""
