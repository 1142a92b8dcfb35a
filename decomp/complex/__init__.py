"""One conforming complex of triangles: boundary faces, interfaces, sheets and trim surfaces."""
