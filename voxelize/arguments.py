"""Exact conversion of arguments.

Every public function and value type converts its arguments with these functions: a list becomes an array, ``3.0``
becomes ``3``. A conversion that would change a value is refused in one line that names the argument, its value and what
is expected. The wrong kind of value is a :class:`TypeError`, a value out of range a :class:`ValueError`.
"""

from __future__ import annotations

import math
import operator
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

_T = TypeVar("_T")
_Integer = TypeVar("_Integer", bound=np.integer)

_LONGEST = 60


def metres_per_unit(name: str, value: object) -> float:
    """Return a unit of length: 1e-12 to 1e12 metres, so that areas and volumes in the scene stay within float64."""
    return real(name, value, low=1e-12, high=1e12)


def whole(name: str, value: object, low: int, high: int) -> int:
    """Return an integer, or a real number without fraction, of `low` to `high` as an int; `name` is for errors.

    >>> whole("depth", 3.0, 1, 16)
    3
    >>> whole("depth", 17, 1, 16)
    Traceback (most recent call last):
        ...
    ValueError: depth must be an integer 1 … 16, not 17
    """
    expected = f"{name} must be an integer {low} … {high}"
    number = _number(value)
    if number is None:
        raise TypeError(f"{expected}, not {shown(value)}")
    if not (low <= number <= high and number == int(number)):
        raise ValueError(f"{expected}, not {shown(value)}")
    return int(number)


def real(
    name: str,
    value: object,
    *,
    above: float = -math.inf,
    below: float = math.inf,
    low: float = -math.inf,
    high: float = math.inf,
) -> float:
    """Return a real number `low` … `high`, strictly between `above` and `below`, as a finite float.

    >>> real("voxel_size", 1, above=0)
    1.0
    >>> real("voxel_size", -2, above=0)
    Traceback (most recent call last):
        ...
    ValueError: voxel_size must be a finite number above 0, not -2
    """
    limits = [f"above {above:g}"] * math.isfinite(above) + [f"below {below:g}"] * math.isfinite(below)
    limits += [f"from {low:g} to {high:g}"] * (math.isfinite(low) and math.isfinite(high))
    expected = " ".join([f"{name} must be a finite number", " and ".join(limits)]).strip()
    number = _number(value)
    if number is None:
        raise TypeError(f"{expected}, not {shown(value)}")
    if not (math.isfinite(number) and above < number < below and low <= number <= high):
        raise ValueError(f"{expected}, not {shown(value)}")
    return float(number)


def flag(name: str, value: object) -> bool:
    """Return an argument that is True or False as a bool.

    >>> flag("mirror", np.bool_(True))
    True
    """
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    raise TypeError(f"{name} must be True or False, not {shown(value)}")


def text(name: str, value: object) -> str:
    """Return an argument that is a string.

    >>> text("name", 7)
    Traceback (most recent call last):
        ...
    TypeError: name must be a string, not 7
    """
    if isinstance(value, str):
        return value
    raise TypeError(f"{name} must be a string, not {shown(value)}")


def choice(name: str, value: _T, allowed: Sequence[_T]) -> _T:
    """Return an argument that is one of a few values.

    >>> choice("fill", "solid", ("solid", "surface"))
    'solid'
    >>> choice("fill", "x", ("solid", "surface"))
    Traceback (most recent call last):
        ...
    ValueError: fill must be 'solid' or 'surface', not 'x'
    """
    for one in allowed:
        if type(value) is type(one) and value == one:
            return one
    *others, last = (repr(one) for one in allowed)
    expected = f"{', '.join(others)} or {last}" if others else last
    raise ValueError(f"{name} must be {expected}, not {shown(value)}")


def instance(name: str, value: object, kind: type[_T]) -> _T:
    """Return an argument that is a value of `kind`.

    >>> instance("scene", 7, dict)
    Traceback (most recent call last):
        ...
    TypeError: scene must be a dict, not int
    """
    if isinstance(value, kind):
        return value
    raise TypeError(f"{name} must be a {kind.__name__}, not {type(value).__name__}")


def colour(name: str, value: object) -> tuple[int, int, int]:
    """Return an sRGB colour as three ints, 0 … 255 each.

    Floats are refused, whole ones too: 1.0 may mean the darkest or the brightest.

    >>> colour("colour", [255, 128, 0])
    (255, 128, 0)
    >>> colour("colour", (1.0, 0.5, 0.0))
    Traceback (most recent call last):
        ...
    TypeError: colour must be three integers 0 … 255, not (1.0, 0.5, 0.0): multiply by 255 and round
    """
    expected = f"{name} must be three integers 0 … 255, not {shown(value)}"
    try:
        channels = [value[index] for index in range(len(value))]  # type: ignore[arg-type,index]
    except (TypeError, KeyError):
        raise TypeError(expected) from None
    if isinstance(value, (str, bytes)):
        raise TypeError(expected)
    if any(isinstance(one, (float, np.floating)) for one in channels):
        raise TypeError(f"{expected}: multiply by 255 and round")
    numbers = [_number(one) for one in channels]
    if None in numbers:
        raise TypeError(expected)
    found = tuple(int(one) for one in numbers if one is not None)
    if len(found) != 3 or not all(0 <= one <= 255 for one in found):
        raise ValueError(expected)
    return found[0], found[1], found[2]


def vector(name: str, value: object) -> tuple[float, float, float]:
    """Return three finite numbers as floats: a point or a direction.

    >>> vector("origin", np.arange(3))
    (0.0, 1.0, 2.0)
    """
    x, y, z = real_array(name, value, (3,)).tolist()
    return float(x), float(y), float(z)


def real_array(name: str, value: object, shape: Sequence[int | str], *, finite: bool = True) -> NDArray[np.floating]:
    """Return an argument as an array of real numbers: float32 and float64 stay, without a copy; others become float64.

    A letter in `shape` stands for any length. NaN and infinities are refused where `finite`, and integers that float64
    cannot hold always.

    >>> real_array("vertices", [[0, 0, 1], [2, 0, 0]], ("V", 3))
    array([[0., 0., 1.],
           [2., 0., 0.]])
    >>> real_array("vertices", [[0, 1], [2, 0]], ("V", 3))
    Traceback (most recent call last):
        ...
    ValueError: vertices must have shape (V, 3), not (2, 2)
    """
    array = _shaped(name, value, shape, "real numbers")
    if array.dtype.type in (np.float32, np.float64):
        found: NDArray[np.floating] = array if array.dtype.isnative else array.astype(array.dtype.newbyteorder("="))
    else:
        found = array.astype(np.float64)
        if array.dtype.kind != "f" and not (found.astype(object) == array.astype(object)).all():
            raise ValueError(f"{name} holds integers that float64 cannot hold exactly: they are above 2**53")
    if finite and not np.isfinite(found).all():
        place = np.argwhere(~np.isfinite(found))[0]
        raise ValueError(f"{name}[{', '.join(map(str, place))}] must be a finite number, not {found[tuple(place)]}")
    return found


def whole_array(
    name: str, value: object, shape: Sequence[int | str], dtype: type[_Integer], *, low: int, high: int
) -> NDArray[_Integer]:
    """Return an argument as an array of integers of type `dtype`; one that has it already is not copied.

    A letter in `shape` stands for any length. Reals without fraction are taken, booleans are not. Values are `low` to
    `high`, within the range of `dtype`.

    >>> whole_array("materials", [1, 2.0], ("T",), np.uint8, low=1, high=255)
    array([1, 2], dtype=uint8)
    >>> whole_array("materials", [1, 300], ("T",), np.uint8, low=1, high=255)
    Traceback (most recent call last):
        ...
    ValueError: materials[1] must be an integer 1 … 255, not 300
    """
    array = _shaped(name, value, shape, "integers")
    limits = np.iinfo(dtype)
    if array.dtype == dtype and low <= limits.min and high >= limits.max:
        return array
    if not array.size or (array.dtype.kind in "iu" and array.min() >= low and array.max() <= high):
        return array.astype(dtype, copy=False)
    allowed = (array >= low) & (array <= high)  # NaN compares false
    if array.dtype.kind == "f":
        with np.errstate(invalid="ignore"):
            allowed &= np.floor(array) == array
    if not allowed.all():
        place = np.argwhere(~allowed)[0]
        where = f"{name}[{', '.join(map(str, place))}]"
        raise ValueError(f"{where} must be an integer {low} … {high}, not {array[tuple(place)]}")
    return array.astype(dtype)


def shown(value: object) -> str:
    """Return a value for an error message: one line, at most 60 characters.

    >>> shown("a" * 100)
    "'aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa …"
    """
    line = " ".join((str(value) if isinstance(value, (np.generic, np.ndarray)) else repr(value)).split())
    return line if len(line) <= _LONGEST else f"{line[: _LONGEST - 3]} …"


def _number(value: object) -> int | float | None:
    """Return a real number as Python's own; None where it is none, or a boolean."""
    if isinstance(value, (bool, np.bool_)):
        return None
    if isinstance(value, (float, np.floating)):
        number = float(value)
        return number if math.isfinite(number) else math.nan
    try:
        return operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        return None


def _shaped(name: str, value: object, shape: Sequence[int | str], kind: str) -> NDArray[Any]:
    """Return a value as an array of numbers of an expected shape; an empty list fits wherever a length may be 0."""
    try:
        found = np.asarray(value)
    except ValueError:
        raise ValueError(f"{name} must be an array of {kind}: its rows differ in length") from None
    if found.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be an array of {kind}, not of {_kind_of(value, found)}")
    if found.shape == tuple(shape):
        return found
    if found.shape == (0,) and isinstance(shape[0], str):
        found = found.reshape(0, *(side if isinstance(side, int) else 0 for side in shape[1:]))
    wrong = found.ndim != len(shape) or any(
        isinstance(want, int) and want != has for want, has in zip(shape, found.shape, strict=True)
    )
    if wrong:
        expected = f"({', '.join(map(str, shape))}{',' if len(shape) == 1 else ''})"
        raise ValueError(f"{name} must have shape {expected}, not {found.shape}")
    return found


def _kind_of(value: object, found: NDArray[Any]) -> str:
    if found.ndim == 0 and found.dtype.kind == "O":
        return type(value).__name__
    return {"b": "booleans", "c": "complex numbers", "U": "text", "S": "bytes", "O": "objects"}.get(
        found.dtype.kind, found.dtype.name
    )
