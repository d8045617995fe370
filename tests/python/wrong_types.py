# SPDX-License-Identifier: Apache-2.0
"""Uses that a type checker must refuse: mypy says so of each that it would let pass."""

import numpy as np

import viewloom


def wrong(server: viewloom.Server, publisher: viewloom.Publisher, atlas: viewloom.Atlas) -> None:
    picture = np.zeros((4, 6, 3), np.uint8)
    viewloom.Source(picture)  # type: ignore[call-arg]
    viewloom.Source(picture, picture, fov_y_rad="60")  # type: ignore[arg-type]
    publisher.send(picture)  # type: ignore[arg-type]
    server.still("demo", 8)  # type: ignore[arg-type]
    server.still("demo", "portrait", count=2)  # type: ignore[call-arg]
    server.watch("demo", "portrait").recieve()  # type: ignore[attr-defined]
    server.watch("demo", "portrait").send_eye_poses(1, 2)  # type: ignore[arg-type]
    atlas.view("middle")  # type: ignore[arg-type]
    viewloom.encoding(True)  # type: ignore[misc]
    viewloom.conect()  # type: ignore[attr-defined]


async def wrong_too(server: viewloom.aio.Server, publisher: viewloom.aio.Publisher) -> None:
    (await publisher.send([])).outcome  # type: ignore[attr-defined]
    server.still("demo", "portrait").view(0)  # type: ignore[attr-defined]
