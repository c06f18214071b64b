"""Masks by the Segment Anything family, with weights that the user has."""
