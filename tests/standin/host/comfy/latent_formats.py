"""Kinds of latents, by name alone."""


class SD15: ...
