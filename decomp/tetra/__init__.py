"""Tetrahedral meshes: from the skeleton complex by TetWild, exact again, named throughout."""
