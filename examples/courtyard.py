"""The demo scene: a house with a garden. x to the right, y up, z towards the viewer, metres."""

from __future__ import annotations

from solids import Part, Solid, ball, box, prism, ring, spin

# Bright, for the shade of a face is (n . l)^2: the three faces seen share the light.
COURTYARD_PALETTE = {
    "grass": (170, 240, 110),
    "stone": (236, 222, 190),
    "wall": (255, 244, 214),
    "roof": (240, 104, 70),
    "brick": (206, 112, 92),
    "wood": (168, 104, 60),
    "white": (255, 255, 255),
    "glass": (120, 200, 255),
    "water": (84, 176, 255),
    "leaves": (92, 190, 84),
    "needles": (60, 170, 120),
    "fur": (236, 170, 92),
    "dark": (64, 52, 56),
    "red": (255, 72, 84),
    "sun": (255, 236, 110),
}
EIGHTH = 0.125
GROUND = 0.5


def house() -> list[Part]:
    """Make the house, x 4.5 … 12.5, z 1.25 … 8.75, its front at z = 8."""
    front, right, panes, frames = 8.0, 12.0, [], []
    for left in (5.25, 9.75):
        panes.append(box((left, left + 1.5), (1.75, 3.25), (front - EIGHTH, front)))
        frames += [
            box((left - EIGHTH, left), (1.625, 3.375), (front, front + EIGHTH)),
            box((left + 1.5, left + 1.625), (1.625, 3.375), (front, front + EIGHTH)),
            box((left, left + 1.5), (3.25, 3.375), (front, front + EIGHTH)),
            box((left, left + 1.5), (1.625, 1.75), (front, front + EIGHTH)),
            box((left + 0.625, left + 0.875), (1.75, 3.25), (front, front + EIGHTH)),
        ]
    for low, near, far in ((1.75, 5.5, 7), (1.75, 3, 4.5), (4.75, 4.25, 5.75)):
        panes.append(box((right - EIGHTH, right), (low, low + 1.5), (near, far)))
        frames += [
            box((right, right + EIGHTH), (low - EIGHTH, low + 1.625), (near - EIGHTH, near)),
            box((right, right + EIGHTH), (low - EIGHTH, low + 1.625), (far, far + EIGHTH)),
            box((right, right + EIGHTH), (low + 1.5, low + 1.625), (near, far)),
            box((right, right + EIGHTH), (low - EIGHTH, low), (near, far)),
        ]
    frames += [
        box((7.5, 7.625), (GROUND, 3.125), (front, front + EIGHTH)),
        box((8.875, 9), (GROUND, 3.125), (front, front + EIGHTH)),
        box((7.625, 8.875), (3, 3.125), (front, front + EIGHTH)),
    ]
    troughs = [box((left - EIGHTH, left + 1.625), (1.25, 1.625), (front, front + 0.375)) for left in (5.25, 9.75)]
    flowers = [
        box((left + step, left + step + 0.25), (1.625, 1.875), (front + EIGHTH, front + 0.375))
        for left in (5.25, 9.75)
        for step in (0, 0.5, 1, 1.375)
    ]
    slope = [
        prism("x", [(y, z) for y, z in side], (4.5, 12.5))
        for side in ([(3.25, 8.75), (7, 5), (7.5, 5), (3.75, 8.75)], [(3.25, 1.25), (3.75, 1.25), (7.5, 5), (7, 5)])
    ]
    return [
        Part("knob", "dark", (box((8.625, 8.75), (1.625, 1.75), (front, front + EIGHTH)),)),
        Part("door", "wood", (box((7.625, 8.875), (GROUND, 3), (front - EIGHTH, front)), *troughs)),
        Part("geraniums", "red", tuple(flowers)),
        Part("panes", "glass", tuple(panes)),
        Part("frames", "white", tuple(frames)),
        Part("chimney_top", "dark", (box((9.625, 10.875), (8.5, 8.75), (5.875, 7.125)),)),
        Part("chimney", "brick", (box((9.75, 10.75), (4, 8.5), (6, 7)),)),
        Part("roof", "roof", tuple(slope)),
        Part("plinth", "stone", (box((4.875, 12.125), (GROUND, 0.875), (1.875, 8.125)),)),
        Part("walls", "wall", (prism("x", [(GROUND, 2), (4, 2), (7, 5), (4, 8), (GROUND, 8)], (5, 12)),)),
    ]


def garden() -> list[Part]:
    """Make the ground and what grows and stands on it."""
    stones = [
        box((7.5 + shift, 9 + shift), (GROUND - EIGHTH, GROUND), (near, near + 1))
        for near, shift in ((9.25, 0), (10.5, 0.125), (11.75, -0.125), (13, 0), (14.25, 0.125), (15.25, 0))
        if near < 15
    ]
    steps = [box((7.25, 9.25), (GROUND, 0.75), (8, 9))]
    posts = [x / 2 for x in range(1, 32)]
    pickets = [box((x - EIGHTH, x + EIGHTH), (GROUND, 1.5), (15.375, 15.625)) for x in posts if not 7 <= x <= 9.5]
    pickets += [box((0.375, 0.625), (GROUND, 1.5), (z - EIGHTH, z + EIGHTH)) for z in posts[1:-1]]
    rails = [box((a, b), (1, 1.25), (15.375, 15.625)) for a, b in ((0.5, 6.5), (10, 15.5))]
    rails += [box((0.375, 0.625), (1, 1.25), (0.5, 15.5))]
    crown = ball(1.75).moved(2.25, 4, 6.5)
    apples = [
        box((x, x + 0.25), (y, y + 0.25), (z, z + 0.25))
        for x, y, z in (
            (1.5, 3.5, 7.875),
            (2.75, 4.5, 7.875),
            (3.5, 3.25, 7.25),
            (3.625, 4.5, 6),
            (2.25, 5.125, 7.5),
            (2.125, 3, 7.75),
        )
    ]
    fir = [spin([(r, y), (0.125, y + 2.25)], 12).moved(14, 0, 3.5) for r, y in ((1.75, 1.5), (1.5, 2.75), (1.125, 4))]
    small_fir = [spin([(r, y), (0.125, y + 1.5)], 12).moved(14.5, 0, 7) for r, y in ((1, 1), (0.75, 1.75))]
    bushes = [ball(0.75, 8, 12).moved(x, 0.75, 8.375) for x in (4.25, 12.5)]
    flowers = [
        box((x, x + 0.25), (GROUND, 0.75), (z, z + 0.25))
        for x, z in (
            (1.25, 9.5),
            (2, 14.5),
            (6, 13.75),
            (6.25, 10.5),
            (5.5, 9.25),
            (1, 13),
            (10, 10),
            (13.5, 9.5),
            (14, 12),
            (10.5, 14),
            (13.5, 14.5),
            (14.75, 10.5),
        )
    ]
    mailbox = box((9.875, 10.375), (1.5, 2), (14.625, 15.25))
    return [
        Part("apples", "red", (*apples, mailbox)),
        Part("flowers", "sun", tuple(flowers)),
        Part("crown", "leaves", (crown, *bushes)),
        Part("firs", "needles", (*fir, *small_fir)),
        Part(
            "trunks",
            "wood",
            (
                box((2, 2.5), (GROUND, 3), (6.25, 6.75)),
                box((13.75, 14.25), (GROUND, 1.75), (3.25, 3.75)),
                box((14.375, 14.625), (GROUND, 1.25), (6.875, 7.125)),
                box((10, 10.25), (GROUND, 1.5), (14.875, 15.125)),
            ),
        ),
        Part("fence", "white", (*pickets, *rails)),
        Part("path", "stone", (*stones, *steps, ring(1.75, 2.125, (GROUND - EIGHTH, 0.75)).moved(3.5, 0, 12))),
        Part("pond", "water", (spin([(1.875, 0.25), (1.875, GROUND)], 24).moved(3.5, 0, 12),)),
        Part("lawn", "grass", (box((0, 16), (0, GROUND), (0, 16)),)),
    ]


def dog() -> list[Part]:
    """Make a dog of boxes that looks at the viewer."""

    def at(x: tuple[float, float], y: tuple[float, float], z: tuple[float, float]) -> Solid:
        return box(x, y, z).moved(11.25, GROUND, 11.5)

    eyes = [at((x, x + EIGHTH), (1.5, 1.625), (1.5, 1.625)) for x in (-0.25, 0.125)]
    nose = at((-EIGHTH, EIGHTH), (1.25, 1.375), (1.875, 2))
    ears = [at((x, x + 0.125), (1.25, 1.75), (1, 1.25)) for x in (-0.5, 0.375)]
    legs = [at((x, x + 0.25), (0, 0.5), (z, z + 0.25)) for x in (-0.375, 0.125) for z in (-0.75, 0.75)]
    return [
        Part("dog_dark", "dark", (*eyes, nose, *ears)),
        Part("collar", "red", (at((-0.375, 0.375), (0.875, 1.125), (0.875, 1.0)),)),
        Part(
            "dog",
            "fur",
            (
                *legs,
                at((-0.375, 0.375), (0.5, 1.125), (-0.75, 1)),
                at((-0.375, 0.375), (1.125, 1.75), (0.875, 1.5)),
                at((-0.25, 0.25), (1.125, 1.375), (1.5, 1.875)),
                at((-0.125, 0.125), (1, 1.75), (-1, -0.75)),
            ),
        ),
    ]


COURTYARD = [*house(), *dog(), *garden()]
