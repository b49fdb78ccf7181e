// Pictures of a scene from all around, by which one of several smaller memories is chosen.
#pragma once

#include "framing.h"

#include <cstdint>
#include <span>
#include <vector>

namespace voxrt::sim {

struct Likeness {
    double psnr, ssim; // means over the views; decibel, infinite where all are equal
};

// A smaller memory, and how it differs: surface voxels changed, and its likeness.
struct FitFigures {
    double changed;
    Likeness likeness;
};

// The fit whose worst figure is the best, each held against that of the first fit, the plain coarser world: the surface
// voxels changed, the error that the PSNR stands for, and what the SSIM lacks to 1.
std::size_t choose_fit(std::span<const FitFigures> fits);

// The default view of 320x240 pixels, turned about the vertical in six steps of 60 degrees.
class FitViews {
public:
    static constexpr int32_t width = 320, height = 240;

    // `materials`: 256 sRGB triples, which must stay. `flat`: else faces have the brightness of their angle. `threads`:
    // 0 takes as many as the machine has.
    FitViews(const octree::VerifiedMemory& memory, const uint8_t* materials, bool flat, int threads);

    const std::vector<Camera>& cameras() const { return cameras_; }
    Likeness likeness(const octree::VerifiedMemory& fitted) const;

private:
    std::vector<uint8_t> render_view(const octree::VerifiedMemory& memory, const Camera& camera) const;

    const uint8_t* materials_;
    bool flat_;
    int threads_;
    std::vector<Camera> cameras_;
    std::vector<std::vector<uint8_t>> pictures_;
};

} // namespace voxrt::sim
