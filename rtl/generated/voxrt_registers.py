"""Registers of the ray tracer, made of rtl/registers.rdl: name, byte address, fields as (low, width)."""

REGISTERS = {
    "identity": (
        0x000,
        {
            "value": (0, 32),
        },
    ),
    "version": (
        0x004,
        {
            "minor": (0, 8),
            "major": (8, 8),
        },
    ),
    "configuration": (
        0x008,
        {
            "lanes": (0, 8),
            "max_depth": (8, 5),
            "ray_clocks": (13, 3),
            "position_bits": (16, 6),
            "block_bits": (24, 5),
            "cached": (30, 1),
            "banked": (31, 1),
        },
    ),
    "control": (
        0x00C,
        {
            "start": (0, 1),
            "continuous": (1, 1),
            "hold": (2, 1),
            "soft_reset": (3, 1),
            "flush": (4, 1),
        },
    ),
    "status": (
        0x010,
        {
            "busy": (0, 1),
            "frame_done": (1, 1),
            "direction_overflow": (8, 1),
            "bad_pointer": (9, 1),
            "step_limit": (10, 1),
            "bus_error": (11, 1),
            "bus_timeout": (12, 1),
        },
    ),
    "size": (
        0x014,
        {
            "width": (0, 12),
            "height": (16, 12),
        },
    ),
    "depth": (
        0x018,
        {
            "depth": (0, 5),
        },
    ),
    "features": (
        0x01C,
        {
            "flat": (0, 1),
            "light": (1, 1),
            "mirrors": (2, 1),
            "faces": (3, 1),
            "lod": (4, 1),
        },
    ),
    "position[0]": (
        0x020,
        {
            "value": (0, 32),
        },
    ),
    "position[1]": (
        0x024,
        {
            "value": (0, 32),
        },
    ),
    "position[2]": (
        0x028,
        {
            "value": (0, 32),
        },
    ),
    "look[0]": (
        0x030,
        {
            "value": (0, 16),
        },
    ),
    "look[1]": (
        0x034,
        {
            "value": (0, 16),
        },
    ),
    "look[2]": (
        0x038,
        {
            "value": (0, 16),
        },
    ),
    "right[0]": (
        0x040,
        {
            "value": (0, 16),
        },
    ),
    "right[1]": (
        0x044,
        {
            "value": (0, 16),
        },
    ),
    "right[2]": (
        0x048,
        {
            "value": (0, 16),
        },
    ),
    "up[0]": (
        0x050,
        {
            "value": (0, 16),
        },
    ),
    "up[1]": (
        0x054,
        {
            "value": (0, 16),
        },
    ),
    "up[2]": (
        0x058,
        {
            "value": (0, 16),
        },
    ),
    "cycles": (
        0x060,
        {
            "value": (0, 32),
        },
    ),
    "rays": (
        0x064,
        {
            "value": (0, 32),
        },
    ),
    "words_read": (
        0x068,
        {
            "value": (0, 32),
        },
    ),
    "hits": (
        0x06C,
        {
            "value": (0, 32),
        },
    ),
    "stalls": (
        0x070,
        {
            "value": (0, 32),
        },
    ),
    "shading": (
        0x074,
        {
            "flat": (0, 1),
            "light": (1, 1),
            "faces": (2, 1),
            "ambient": (8, 8),
            "bounces": (16, 4),
        },
    ),
    "root": (
        0x078,
        {
            "address": (0, 32),
        },
    ),
    "lod": (
        0x07C,
        {
            "scale": (0, 20),
            "words": (31, 1),
        },
    ),
    "light[0]": (
        0x080,
        {
            "value": (0, 32),
        },
    ),
    "light[1]": (
        0x084,
        {
            "value": (0, 32),
        },
    ),
    "light[2]": (
        0x088,
        {
            "value": (0, 32),
        },
    ),
    "lower_faces": (
        0x090,
        {
            "x": (0, 8),
            "y": (8, 8),
            "z": (16, 8),
        },
    ),
    "upper_faces": (
        0x094,
        {
            "x": (0, 8),
            "y": (8, 8),
            "z": (16, 8),
        },
    ),
    "memory_base": (
        0x0C0,
        {
            "address": (5, 27),
        },
    ),
    "word_requests": (
        0x0C4,
        {
            "value": (0, 32),
        },
    ),
    "line_requests": (
        0x0C8,
        {
            "value": (0, 32),
        },
    ),
    "lines_read": (
        0x0CC,
        {
            "value": (0, 32),
        },
    ),
}
MATERIALS = 0x400
