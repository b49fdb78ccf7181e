// The colour of one pixel with every feature of the shader, in integers. docs/shading.md defines them.
#pragma once

#include "lod.h"
#include "ray.h"

#include <voxrt/octree/words/verify.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

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

// The brightness of a surface: part / whole.
struct Brightness {
    WideKey part = 1, whole = 1;
};

// A surface that a ray met.
struct Surface {
    uint8_t material, face; // kFaceNone: the camera stands in the solid
    bool is_upper;          // the face looks along the positive axis
    int32_t cell[3];
};

enum class LightOnSurface : uint8_t { none, lit, turned_away, shadowed };

// How a pixel came by its colour.
struct PixelAccount {
    std::vector<Surface> mirrors;   // in order
    std::optional<Surface> surface; // what ended the ray; none: it left the world, or its bounces were used up
    LightOnSurface light = LightOnSurface::none;
    Brightness brightness;
    bool is_mean = false; // the bounces were used up: the colour is the mean of the mirrors
};

// Traces the ray from `origin` (1/16 voxel). Components of `direction` are below kDirectionLimit. Not with lod.on()
// where there is a light or bounces are not 0. An account that is given is filled.
Pixel trace_pixel(const octree::VerifiedMemory& memory, const Shading& shading, const Lod& lod, const int32_t origin[3],
                  const int32_t direction[3], PixelAccount* account = nullptr);

} // namespace voxrt::sim
