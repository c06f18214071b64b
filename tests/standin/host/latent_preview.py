"""Pictures of unfinished latents, which are off as in the host's own defaults."""


def get_previewer(device, latent_format):
    return None
