# SPDX-License-Identifier: Apache-2.0
"""The graph of includes between folders: it has no cycle, and can be drawn.

A folder stands above all that it includes, directly or not. `tidy.py ROOT --graph FILE` writes it
as .dot or .svg. Arrows that follow from others are left out of the picture.
"""

import html
import os

from layering import COMPOSITION, INCLUDE, LAYERS, owner, resolve
from tree import Finding

KINDS = (("server/core", "#d7e8f7"), ("server", "#fbe3c0"), ("client", "#d9efd3"),
         ("shaders", "#e8ddf3"))
BOX_WIDTH, BOX_HEIGHT, GAP, ROW = 190, 26, 12, 84  # px


# The service, and what it asks of its engine room.
SERVICE = ("server/service", "server/engine_room")


def room(path):
    """The folder of the graph that a file belongs to, or None. The files that join the stages are
    folders by themselves: what they include is below them, what includes them above."""
    if path.startswith(SERVICE):
        return "server/service"
    for part in COMPOSITION:
        if path.startswith(part):
            return os.path.splitext(part)[0]
    return owner(path, LAYERS)


def arrows(tree):
    """{(including folder, included folder): (file, line) of the first such include}."""
    found = {}
    for path in tree.text_files(".h", ".cpp", ".glsl", ".comp", ".vert", ".frag"):
        above = room(path)
        if above is None:
            continue
        for number, line in enumerate(tree.lines(path), 1):
            match = INCLUDE.match(line)
            included = resolve(tree, path, match.group(2)) if match else None
            below = room(included) if included else None
            if below not in (None, above):
                found.setdefault((above, below), (path, number))
    return found


def _below(graph):
    folders = {folder for arrow in graph for folder in arrow}
    return {folder: {low for high, low in graph if high == folder} for folder in folders}


def cycle(graph):
    """Folders each of which includes the next, and the last the first; empty: there is none."""
    below, done = _below(graph), set()

    def walk(folder, way):
        if folder in way:
            return way[way.index(folder):]
        if folder not in done:
            for low in sorted(below[folder]):
                if (found := walk(low, way + [folder])):
                    return found
            done.add(folder)
        return []

    for start in sorted(below):
        if (found := walk(start, [])):
            return found
    return []


def rows(graph):
    """Folders by how many stand below them in the longest chain: row 0 includes nothing."""
    below, height = _below(graph), {}

    def height_of(folder):
        if folder not in height:
            height[folder] = 1 + max(map(height_of, below[folder]), default=-1)
        return height[folder]

    by_row = [[] for _ in range(1 + max(map(height_of, below), default=-1))]
    for folder in sorted(below):
        by_row[height[folder]].append(folder)
    return by_row


def drawn(graph):
    """The arrows that do not follow from others."""
    below = _below(graph)

    def reaches(high, low):
        return low in below[high] or any(reaches(between, low) for between in below[high])

    return sorted((high, low) for high, low in graph
                  if not any(reaches(between, low) for between in below[high] - {low}))


def dot(graph):
    lines = ["digraph includes {", "  rankdir=TB; node [shape=box, fontname=sans];"]
    for row in rows(graph):
        lines.append("  {rank=same; " + " ".join(f'"{folder}";' for folder in row) + "}")
    lines += [f'  "{high}" -> "{low}";' for high, low in drawn(graph)]
    return "\n".join(lines + ["}", ""])


def _colour(folder):
    return next((colour for kind, colour in KINDS if folder.startswith(kind)), "#eeeeee")


def svg(graph):
    by_row = rows(graph)
    width = max(map(len, by_row)) * (BOX_WIDTH + GAP) + GAP
    height = len(by_row) * ROW
    places = {}
    for level, row in enumerate(by_row):
        left = (width - len(row) * (BOX_WIDTH + GAP) + GAP) / 2
        for index, folder in enumerate(row):
            places[folder] = (left + index * (BOX_WIDTH + GAP), height - (level + 1) * ROW + GAP)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:.0f} {height}" '
             'font-family="sans-serif" font-size="12" text-anchor="middle">',
             '<rect width="100%" height="100%" fill="white"/>']
    for high, low in drawn(graph):
        (x1, y1), (x2, y2) = places[high], places[low]
        parts.append(f'<line x1="{x1 + BOX_WIDTH / 2:.0f}" y1="{y1 + BOX_HEIGHT:.0f}" '
                     f'x2="{x2 + BOX_WIDTH / 2:.0f}" y2="{y2:.0f}" stroke="#8899aa"/>')
    for folder, (x, y) in places.items():
        parts.append(f'<rect x="{x:.0f}" y="{y:.0f}" width="{BOX_WIDTH}" height="{BOX_HEIGHT}" '
                     f'rx="4" fill="{_colour(folder)}" stroke="#556677"/>'
                     f'<text x="{x + BOX_WIDTH / 2:.0f}" y="{y + 17:.0f}">'
                     f'{html.escape(folder)}</text>')
    return "\n".join(parts + ["</svg>", ""])


def write(tree, path):
    graph = arrows(tree)
    text = svg(graph) if path.endswith(".svg") else dot(graph)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    print(f"{path}: {sum(map(len, rows(graph)))} folders in {len(rows(graph))} rows, "
          f"{len(graph)} arrows, {len(drawn(graph))} of them drawn")


def check(tree):
    graph = arrows(tree)
    found = cycle(graph)
    if found:
        path, line = graph[(found[0], found[1 % len(found)])]
        yield Finding(path, line, "cycle", " includes ".join(found + found[:1]))
