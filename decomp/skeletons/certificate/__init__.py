"""How good a skeleton is: every figure measured."""
