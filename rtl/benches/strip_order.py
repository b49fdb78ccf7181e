"""The order of pixels in strips: an oracle of voxrt_strip_place, for the benches of what makes and takes it."""


def strip_lines(lanes, width):
    """Give the lines of a strip: its pixels fit where 16 lines (8 for up to 8 lanes) of 1024 do."""
    lines = 16 if lanes > 8 else 8
    room = 1024 * lines
    while width * lines > room:
        lines //= 2
    return lines


def in_strips(lanes, width, height):
    """Give a frame's places, (line, column), in the order in which they are traced."""
    left, right = range(width // 2), range(width // 2, width)
    columns = [column for pair in zip(right, left, strict=False) for column in pair]
    if len(right) > len(left):
        columns.append(right[-1])
    lines = strip_lines(lanes, width)
    places = []
    for strip, top in enumerate(range(0, height, lines)):
        for column in columns if strip % 2 == 0 else reversed(columns):
            places += [(line, column) for line in range(top, min(top + lines, height))]
    return places
