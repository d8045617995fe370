# SPDX-License-Identifier: Apache-2.0
"""Watches one view of a stream with asyncio, and says how near what it shows is.

    PYTHONPATH=build/release/client/python \
        /usr/bin/python3 client/python/examples/watch_asyncio.py --stream demo --view 24
"""

import argparse
import asyncio
import sys

import viewloom


async def watch(options: argparse.Namespace) -> None:
    async with viewloom.aio.connect(options.server) as server, \
            server.watch(options.stream, options.preset, wait_for_stream=True,
                         encoding=viewloom.encoding(depth=True)) as watcher:
        left = options.count
        async for atlas in watcher:
            print(f"frame {atlas.header.frame_number}: the nearest px of view {options.view} "
                  f"is {1 / atlas.view_inv_z(options.view).max():.2f} m away, "
                  f"{atlas.skipped} atlases were skipped")
            left -= 1
            if left == 0:
                return


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--server", default="127.0.0.1:50051")
    parser.add_argument("--stream", default="demo")
    parser.add_argument("--preset", default="portrait")
    parser.add_argument("--view", type=int, default=24)
    parser.add_argument("--count", type=int, default=0, help="atlases; 0 = until Ctrl-C")
    try:
        asyncio.run(watch(parser.parse_args()))
    except viewloom.ViewloomError as error:
        sys.exit(f"watch_asyncio: {error}")


if __name__ == "__main__":
    main()
