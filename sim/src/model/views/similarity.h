// The similarity of two pictures, sRGB, 3 bytes per pixel, row by row.
#pragma once

#include <cstddef>
#include <cstdint>

namespace voxrt::sim {

/// Peak signal-to-noise ratio, decibel; infinite for equal pictures.
double peak_signal_to_noise(const std::uint8_t* picture, const std::uint8_t* other, std::size_t pixels);

/// The mean structural similarity (SSIM) of the luma; 1 for equal pictures. Z. Wang, A. C. Bovik, H. R. Sheikh, E. P.
/// Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity", IEEE Transactions on Image
/// Processing 13 (4), 2004: a Gaussian window of 11 x 11 pixels with sigma 1.5, K1 = 0.01, K2 = 0.03. Beyond the
/// border, pictures are continued by their mirror image.
double structural_similarity(const std::uint8_t* picture, const std::uint8_t* other, std::size_t width,
                             std::size_t height);

} // namespace voxrt::sim
