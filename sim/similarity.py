"""The similarity of two pictures: PSNR and SSIM."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from voxrt.sim import _model

if TYPE_CHECKING:
    from numpy.typing import NDArray


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
    return _model.peak_signal_to_noise(np.ascontiguousarray(picture), np.ascontiguousarray(other))


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
    return _model.structural_similarity(np.ascontiguousarray(picture), np.ascontiguousarray(other))


def _refuse_other_shape(picture: NDArray[np.uint8], other: NDArray[np.uint8]) -> None:
    if picture.shape != other.shape:
        raise ValueError(f"pictures of shape {picture.shape} and {other.shape} cannot be compared")
