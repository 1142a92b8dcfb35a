"""Triangulations of plane, cylinder and torus between given lines, and whether lines cross."""
