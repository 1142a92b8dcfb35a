"""Seams and junctions: where three and more feet are equally far, from seeds to one graph."""
