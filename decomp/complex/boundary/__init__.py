"""The exact boundary of all regions as one complex of triangles."""
