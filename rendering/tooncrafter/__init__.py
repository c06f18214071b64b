"""Cartoon interpolation between two keyframes with sketch control (ToonCrafter, Xing et al. 2024)."""
