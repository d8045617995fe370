# SPDX-License-Identifier: Apache-2.0
"""A ball before a wall, from numpy, as the quilt of a Looking Glass Portrait: ball.jpg."""

import sys

import numpy as np

import viewloom

y, x = np.mgrid[0:270, 0:480]
is_ball = np.hypot(x - 240, y - 135) < 80
color = np.where(is_ball[..., None], (220, 40, 30), (30, 60, 210)).astype(np.uint8)
depth_m = np.where(is_ball, 1.5, 3.0)

with viewloom.connect(*sys.argv[1:]) as server, server.publish("ball") as publisher:
    publisher.send(viewloom.Source(color, depth_m, fov_y_rad=0.6))
    print("wrote", server.still("ball", "portrait").save("ball.jpg"))
