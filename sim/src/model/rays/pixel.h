// The colour of one pixel with every feature of the shader, in integers. docs/shading.md defines them.
#pragma once

#include "lod.h"

#include <voxrt/octree/words/verify.h>

#include <array>
#include <cstdint>
#include <optional>

namespace voxrt::sim {

struct Light {
    int32_t position[3]; // 1/16 voxel
    uint8_t ambient;     // 1/256: the brightness of shadows; by the angle, also the least brightness
};

constexpr int kFaceUnit = 255;

// Everything between a hit and its colour.
struct Shading {
    const uint8_t* materials; // 256 sRGB triples, entry 0 the background
    const uint8_t* mirrors;   // 256 flags
    int bounces = 0;          // 0: mirrors are shaded like other materials
    bool flat = false;
    // The brightness of the faces that look along -x, +x, -y, +y, -z, +z, in 1/kFaceUnit. Without it the angle decides.
    // It must be absent where `flat` is set.
    std::optional<std::array<uint8_t, 6>> faces;
    std::optional<Light> light;
};

struct Pixel {
    uint8_t colour[3];
    uint8_t material;
    uint8_t face;
    uint32_t words_read;
};

// Traces the ray from `origin` (1/16 voxel). Components of `direction` are below kDirectionLimit. Not with lod.on()
// where there is a light or bounces are not 0.
Pixel trace_pixel(const octree::VerifiedMemory& memory, const Shading& shading, const Lod& lod, const int32_t origin[3],
                  const int32_t direction[3]);

} // namespace voxrt::sim
