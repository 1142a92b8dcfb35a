"""Primitives, solids and regions."""
