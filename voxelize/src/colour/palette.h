// Colour quantization: a palette for the textures and vertex colours of a scene.
//
// The colours are divided into groups in sRGB, which is nearly uniform to the eye, in whole numbers: the group whose
// division lessens the sum of squared distances most is divided again and again, across the channel that varies most
// (Wu, "Color quantization by dynamic programming and principal analysis", 1992); then k-means moves colours to the
// group whose mean is nearest (Lloyd, "Least squares quantization in PCM", 1982). Each entry is the mean, in linear
// light, of the colours of its group.
#pragma once

#include "numbers.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::voxelize {

using Srgb = std::array<uint8_t, 3>;

struct Palette {
    std::vector<Srgb> entries; // ascending
    std::vector<uint8_t> rows; // each colour's entry
};

/// Chooses at most `count` (1 … 255) colours that represent `colours`, of which each covers its weight. Where there are
/// no more distinct colours than that, each is its own entry. The result does not depend on the platform.
Palette quantize(std::span<const Srgb> colours, const Numbers& weights, int count);

} // namespace voxrt::voxelize
