"""Domains in the plane over which boundary faces and sheets are triangulated."""
