"""Whether a mesh is a mesh of its model."""
