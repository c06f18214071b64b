"""Sketch-guided Stable Video Diffusion: the paper's renderer, for the public LVCD weights."""
