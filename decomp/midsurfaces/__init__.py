"""Mid-surfaces: the sheets between two faces that face each other."""
