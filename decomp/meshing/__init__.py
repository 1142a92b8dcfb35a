"""From a complex to tetrahedra that follow it: sizes, a mesher, names, exact places again.

Notation: h is a length of edges, the tolerance how far a mesher may leave the triangles that it is
given.
"""
