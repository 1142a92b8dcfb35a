"""What each tetrahedron and triangle belongs to, asked of the exact geometry."""
