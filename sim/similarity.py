"""The similarity of two pictures: PSNR and SSIM."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

_LUMA = np.array([0.299, 0.587, 0.114])  # ITU-R BT.601
_RADIUS = 5
_SIGMA = 1.5


def peak_signal_to_noise(picture: NDArray[np.uint8], other: NDArray[np.uint8]) -> float:
    """Compute the peak signal-to-noise ratio of two pictures.

    Parameters
    ----------
    picture, other
        uint8, shape (H, W, 3).

    Returns
    -------
    float
        Decibel; infinite for equal pictures.

    Raises
    ------
    ValueError
        The pictures differ in shape.

    Examples
    --------
    >>> import numpy as np
    >>> black = np.zeros((8, 8, 3), np.uint8)
    >>> round(peak_signal_to_noise(black, black + 16), 2)
    24.05
    """
    _refuse_other_shape(picture, other)
    error = float(np.mean((picture.astype(np.float64) - other.astype(np.float64)) ** 2))
    return math.inf if error == 0 else 10 * math.log10(255**2 / error)


def structural_similarity(picture: NDArray[np.uint8], other: NDArray[np.uint8]) -> float:
    """Compute the mean structural similarity (SSIM) of the luma of two pictures.

    Parameters
    ----------
    picture, other
        uint8, shape (H, W, 3), sRGB.

    Returns
    -------
    float
        1 for equal pictures.

    Raises
    ------
    ValueError
        The pictures differ in shape.

    Notes
    -----
    Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image Quality Assessment: From Error Visibility to Structural
    Similarity", IEEE Transactions on Image Processing 13 (4), 2004: a Gaussian window of 11 x 11 pixels with sigma 1.5,
    K1 = 0.01, K2 = 0.03. Beyond the border, pictures are continued by their mirror image.

    Examples
    --------
    >>> import numpy as np
    >>> ramp = np.arange(16 * 16 * 3).reshape(16, 16, 3).astype(np.uint8)
    >>> structural_similarity(ramp, ramp)
    1.0
    """
    _refuse_other_shape(picture, other)
    x, y = picture @ _LUMA, other @ _LUMA
    mean_x, mean_y = _blurred(x), _blurred(y)
    variance_x = _blurred(x * x) - mean_x**2
    variance_y = _blurred(y * y) - mean_y**2
    covariance = _blurred(x * y) - mean_x * mean_y
    c1, c2 = (0.01 * 255) ** 2, (0.03 * 255) ** 2
    similarity = ((2 * mean_x * mean_y + c1) * (2 * covariance + c2)) / (
        (mean_x**2 + mean_y**2 + c1) * (variance_x + variance_y + c2)
    )
    return float(similarity.mean())


def _refuse_other_shape(picture: NDArray[np.uint8], other: NDArray[np.uint8]) -> None:
    if picture.shape != other.shape:
        raise ValueError(f"pictures of shape {picture.shape} and {other.shape} cannot be compared")


def _blurred(values: NDArray[np.float64]) -> NDArray[np.float64]:
    weights = np.exp(-(np.arange(-_RADIUS, _RADIUS + 1) ** 2) / (2 * _SIGMA**2))
    weights /= weights.sum()
    for axis in (0, 1):
        margin = [(0, 0), (0, 0)]
        margin[axis] = (_RADIUS, _RADIUS)
        windows = np.lib.stride_tricks.sliding_window_view(np.pad(values, margin, "symmetric"), len(weights), axis)
        values = windows @ weights
    return values
