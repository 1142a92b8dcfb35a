"""Tetrahedral meshes: the skeleton complex through TetWild, exact again, with a name on everything."""
