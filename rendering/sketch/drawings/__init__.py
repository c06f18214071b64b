"""Line drawing networks: informative drawings and the sketch U-Net, with their public weights."""
