"""Workflows to open in ComfyUI, and the bundled example illustration. Data only; a package so that it can be found."""
