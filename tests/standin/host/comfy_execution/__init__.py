"""Stands in for the host's package of the same name."""
