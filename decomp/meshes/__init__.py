"""Tetrahedral meshes as values: elements, named groups and their parts, quality, report."""
