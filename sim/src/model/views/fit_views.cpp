#include "fit_views.h"

#include "../frames/frame_tile.h"
#include "similarity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace voxrt::sim {

namespace {

constexpr int kViews = 6;
constexpr Point kLook = {-620, -680, -1000}; // of the default view
constexpr std::size_t kPixels = std::size_t{FitViews::width} * FitViews::height;

} // namespace

std::size_t choose_fit(std::span<const FitFigures> fits) {
    const auto errors = [](const FitFigures& fit) {
        return std::array<double, 3>{fit.changed, std::pow(10.0, -fit.likeness.psnr / 10), 1 - fit.likeness.ssim};
    };
    const std::array<double, 3> first = errors(fits[0]);
    std::size_t best = 0;
    std::pair<double, double> least{HUGE_VAL, HUGE_VAL};
    for (std::size_t i = 0; i < fits.size(); ++i) {
        std::array<double, 3> shares = errors(fits[i]);
        for (std::size_t k = 0; k < 3; ++k) // rounded: the same choice on every machine
            shares[k] = std::nearbyint(shares[k] / std::max(first[k], 1e-9) * 1e6) / 1e6;
        const std::pair<double, double> key{*std::max_element(shares.begin(), shares.end()),
                                            shares[0] + shares[1] + shares[2]};
        if (key < least) {
            least = key;
            best = i;
        }
    }
    return best;
}

FitViews::FitViews(const octree::VerifiedMemory& memory, const uint8_t* materials, bool flat, int threads)
    : materials_(materials), flat_(flat), threads_(threads) {
    const std::vector<Point> points = outline_points(memory);
    for (int view = 0; view < kViews; ++view) {
        const double angle = view * std::numbers::pi / 3, c = std::cos(angle), s = std::sin(angle);
        const auto& [x, y, z] = kLook;
        const Point look{std::nearbyint(x * c + z * s), y, std::nearbyint(z * c - x * s)};
        cameras_.push_back(frame_along(look, points, width, height));
        pictures_.push_back(render_view(memory, cameras_.back()));
    }
}

Likeness FitViews::likeness(const octree::VerifiedMemory& fitted) const {
    Likeness sum{0, 0};
    for (std::size_t view = 0; view < cameras_.size(); ++view) {
        const std::vector<uint8_t> picture = render_view(fitted, cameras_[view]);
        sum.psnr += peak_signal_to_noise(pictures_[view].data(), picture.data(), kPixels);
        sum.ssim += structural_similarity(pictures_[view].data(), picture.data(), width, height);
    }
    return {sum.psnr / kViews, sum.ssim / kViews};
}

std::vector<uint8_t> FitViews::render_view(const octree::VerifiedMemory& memory, const Camera& camera) const {
    static constexpr uint8_t kNoMirrors[256] = {};
    std::vector<uint8_t> colour(3 * kPixels), material(kPixels), face(kPixels);
    render(memory, {materials_, kNoMirrors, 0, flat_, {}, {}}, Lod{}, camera,
           {width, height, colour.data(), material.data(), face.data()}, threads_, tile_engines()[0].render_tile);
    return colour;
}

} // namespace voxrt::sim
