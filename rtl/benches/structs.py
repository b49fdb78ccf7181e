"""Packed structs of voxrt_pkg, which the simulator shows as one number: fields and widths, the highest first."""


def wrapped(value, width):
    """Give a number, negative or not, as so many bits."""
    return value % (1 << width)


def signed(value, width):
    """Give the number that so many bits mean in two's complement."""
    return value - (value >> width - 1 << width)


def packed_array(values, width):
    """Pack elements of one width, the first one lowest."""
    return sum(wrapped(value, width) << width * index for index, value in enumerate(values))


def unpacked_array(number, count, width):
    return [number >> width * index & (1 << width) - 1 for index in range(count)]


class Struct:
    """Fields: a width, or how many elements and their width."""

    def __init__(self, **fields):
        self.fields = {name: spec if isinstance(spec, tuple) else (1, spec) for name, spec in fields.items()}
        self.arrays = {name for name, spec in fields.items() if isinstance(spec, tuple)}

    def pack(self, **values):
        """Give the number; fields that are not named are 0."""
        assert set(values) <= set(self.fields)
        number = 0
        for name, (count, width) in self.fields.items():
            value = values.get(name, [0] * count if name in self.arrays else 0)
            elements = list(value) if name in self.arrays else [int(value)]
            assert len(elements) == count
            number = number << count * width | packed_array(elements, width)
        return number

    def unpack(self, signal):
        """Give the fields of a signal, without sign."""
        number, fields = signal.value.to_unsigned(), {}
        assert len(signal) == sum(count * width for count, width in self.fields.values())
        for name, (count, width) in reversed(self.fields.items()):
            elements = unpacked_array(number, count, width)
            fields[name] = elements if name in self.arrays else elements[0]
            number >>= count * width
        return fields


DISTANCE, KEY, POINT, SHADOW_POINT, SCAN, WEIGHT, REACH = 33, 62, 20, 23, 29, 40, 29
WORLD = Struct(origin=(3, DISTANCE), mirrored_origin=(3, DISTANCE), depth=5, side=17, outside_mask=16)
RASTER = Struct(start=1, corner=1, line_step=(3, SCAN), right=(3, 16), width=12, height=12)
# Brightness: by {looks along +axis, axis}.
SHADING = Struct(flat=1, faces=1, brightness=(6, 8), light=1, ambient=8, bounces=4)
MATERIAL_WRITE = Struct(valid=1, material=8, mirror=1, red=8, green=8, blue=8)
# By mirrored (0, 1) and axis: 3 * mirrored + axis.
LIGHT_PLANES = Struct(occluder=(6, 17), backface=(6, 17))
RAY = Struct(
    resolved=1,
    pixel=10,
    lit=1,
    shadow=1,
    tag=9,
    mirrored=3,
    dead=3,
    octant=3,
    entry_time=KEY,
    entry_face=2,
    origin=(3, DISTANCE),
    reach=REACH,
)
WEIGHTS_WRITE = Struct(valid=1, row=6, weights=(3, WEIGHT), reach=REACH)
ROW_FREE = Struct(valid=1, row=6)
HIT_POINT = Struct(tag=9, face=2, mirrored=3, point=(3, POINT))
SHADOW_RAY = Struct(tag=9, point=(3, SHADOW_POINT), direction=(3, SCAN))
RESULT = Struct(complete=1, store=1, tag=9, lit=1)
SHADED_PIXEL = Struct(colour=24, pixel=10, first=1, line_end=1, last=1)
