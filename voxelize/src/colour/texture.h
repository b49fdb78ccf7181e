// Textures: images that colour surfaces, looked up in linear light.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace voxrt::voxelize {

/// Linear red, green and blue, and alpha.
using Light = std::array<double, 4>;

/// How texture coordinates outside 0 … 1 are treated.
enum class Wrap : uint8_t { repeat, mirror, clamp };

/// Pixels of sRGB colour and linear alpha, row by row. Row 0 is at v = 0, column 0 at u = 0. Borrowed.
struct Image {
    const uint8_t* pixels = nullptr;
    int64_t width = 0, height = 0;
};

struct Texture {
    Image image;
    Wrap wrap_u = Wrap::repeat, wrap_v = Wrap::repeat;
    bool nearest = false; // a sample takes the nearest pixel instead of mixing four
};

/// The colour at (u, v). Coordinates that are not finite read the corner.
Light look_up(const Texture& texture, double u, double v);

/// An image with half as many pixels per side, rounded up: each is the mean of 2 by 2, rounded to 8 bits, in linear
/// light and weighted by alpha, so that transparent pixels do not change the colour.
std::vector<uint8_t> halved(const Image& image, int threads);

} // namespace voxrt::voxelize
