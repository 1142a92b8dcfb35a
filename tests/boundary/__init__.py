"""The exact boundary: faces, edges, vertices, volumes."""
