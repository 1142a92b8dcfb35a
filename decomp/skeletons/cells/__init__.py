"""Cells: the parts into which a skeleton cuts a region, as closed surfaces."""
