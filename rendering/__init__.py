"""Pictures from motion: masks, line drawings, warping, compositing, interpolation. Knows no host."""
