"""From a complex to tetrahedra that follow it: sizes, TetWild, names, exact places again.

Notation: h is a length of edges, epsilon how far TetWild may leave the triangles that it is given.
"""
