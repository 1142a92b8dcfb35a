"""The meshers that fill a complex with tetrahedra."""
