"""Maximal balls, equidistant points, and the seams and junctions that are traced from them."""
