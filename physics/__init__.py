"""Image-space physics: masks to meshes, strokes, rig, simulation, optical flow. Knows neither torch nor a host."""
