"""Constructive solid geometry: primitives, the Boolean tree, regions, half-space form."""
