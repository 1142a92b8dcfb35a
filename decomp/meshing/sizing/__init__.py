"""How long edges are to be, where, and why; and edges cut that came out longer."""
