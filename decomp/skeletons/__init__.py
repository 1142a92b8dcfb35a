"""The traced skeleton: from exact elements by balls, seams, curves and sheets to one complex.

Notation, here and below: p is a point of the skeleton, r the radius of its maximal ball, q its feet
on the boundary, g = (p - q) / r the gradient of the distance to a foot; f and g are also the two
sites of a sheet, u a direction, t the parameter of an edge or a curve, n a normal of a face.
"""
