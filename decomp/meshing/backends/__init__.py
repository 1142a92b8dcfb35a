"""The meshers that fill a complex with tetrahedra: `base.py` says how, `table.py` has them."""
