"""Kinds of latents, by name alone."""


class SD15:
    def __init__(self, scale_factor=0.18215):
        self.scale_factor = scale_factor
