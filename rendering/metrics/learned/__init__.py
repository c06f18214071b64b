"""Measures by networks whose weights are on this machine: nothing is fetched."""
