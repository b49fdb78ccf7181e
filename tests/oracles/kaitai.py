"""A reader that knows no format: it follows a Kaitai Struct description.

Only what the project's descriptions use: block YAML of mappings, lists of mappings and plain scalars; integers, floats,
strings and byte arrays; repeat expr and eos; instances at a position; a switch over types; expressions that Python
reads alike.
"""

import struct

NUMBERS = {"u1": "B", "u2": "H", "u4": "I", "s4": "i", "f8": "d"}


def yaml(text):
    lines = [line for line in text.splitlines() if line.strip() and not line.lstrip().startswith("#")]
    value, rest = block(lines, 0)
    assert not rest
    return value


def indent(line):
    return len(line) - len(line.lstrip())


def block(lines, depth):
    if lines[0].lstrip().startswith("- "):
        items = []
        while lines and indent(lines[0]) == depth and lines[0].lstrip().startswith("- "):
            inner = [" " * (depth + 2) + lines[0].lstrip()[2:], *lines[1:]]
            item, lines = block(inner, depth + 2)
            items.append(item)
        return items, lines
    mapping = {}
    while lines and indent(lines[0]) == depth:
        key, _, value = lines[0].strip().removesuffix(":").partition(": ")
        lines = lines[1:]
        if value:
            mapping[key] = value
        else:
            mapping[key], lines = block(lines, indent(lines[0]))
    return mapping, lines


class Description:
    def __init__(self, text):
        self.root = yaml(text)

    def read(self, data):
        return self._structure(self.root, data, data)[0]

    def _structure(self, description, data, whole):
        fields = {}
        for field in description["seq"]:
            fields[field["id"]], data = self._field(field, data, fields, whole)
        for name, instance in description.get("instances", {}).items():
            start, size = (self._value(instance[key], fields) for key in ("pos", "size"))
            fields[name], rest = self._field(instance, whole[start : start + size], fields, whole)
            assert not rest.strip(b"\0")
        return fields, data

    def _field(self, field, data, fields, whole):
        if field.get("repeat") == "eos":
            values = []
            while data:
                value, data = self._one(field, data, fields, whole)
                values.append(value)
            return values, data
        if field.get("repeat") == "expr":
            values = []
            for _ in range(self._value(field["repeat-expr"], fields)):
                value, data = self._one(field, data, fields, whole)
                values.append(value)
            return values, data
        return self._one(field, data, fields, whole)

    def _one(self, field, data, fields, whole):
        kind = field.get("type")
        if "contents" in field:
            size = len(field["contents"])
            assert data[:size] == field["contents"].encode()
            return data[:size], data[size:]
        if isinstance(kind, dict):
            kind = kind["cases"].get(f"'\"{fields[kind['switch-on']]}\"'")
        if kind in NUMBERS:
            (value,) = struct.unpack_from("<" + NUMBERS[kind], data)
            return value, data[struct.calcsize(NUMBERS[kind]) :]
        if kind in self.root["types"]:
            return self._structure(self.root["types"][kind], data, whole)
        size = len(data) if "size-eos" in field else self._value(field["size"], fields)
        assert len(data) >= size
        return (data[:size].decode() if kind == "str" else data[:size]), data[size:]

    @staticmethod
    def _value(expression, fields):
        return eval(expression, {}, fields)
