"""Tests of meshing."""
