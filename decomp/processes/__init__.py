"""Processes started by this one: they end with it, and work in directories of their own."""
