"""Nodes for ComfyUI: each converts the host's values, calls physics or rendering, and wraps the result."""
