"""fTetWild in a child process of its own."""
