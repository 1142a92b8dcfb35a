"""Curves, sheets and reflexive loci of the skeleton, from exact elements to one complex."""
