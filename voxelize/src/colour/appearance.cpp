#include "appearance.h"

#include "../work/workers.h"

#include <algorithm>

namespace voxrt::voxelize {
namespace {

constexpr int kFinest = 32;
constexpr int64_t kMostSamples = 1 << 21;
constexpr size_t kTrianglesOfAJob = 1 << 12;

/// The texture of an appearance for the question whether any surface is left: nearest pixels suffice.
std::optional<Texture> nearest_of(const Appearance& appearance) {
    std::optional<Texture> texture = appearance.texture;
    if (texture)
        texture->nearest = true;
    return texture;
}

double least_alpha(const Texture& texture) {
    const auto& [pixels, width, height] = texture.image;
    uint8_t least = 255;
    for (int64_t at = 0; at < width * height; ++at)
        least = std::min(least, pixels[4 * at + 3]);
    return least / 255.0;
}

/// The number of parts per side to sample: about one per pixel, a power of two.
int parts_of(const Surface& surface, const Texture* texture, size_t triangle) {
    double across = 2;
    if (texture != nullptr)
        for (size_t axis = 0; axis < 2; ++axis) {
            const double a = surface.uv[6 * triangle + axis], b = surface.uv[6 * triangle + 2 + axis],
                         c = surface.uv[6 * triangle + 4 + axis];
            const double length = std::max({a, b, c}) - std::min({a, b, c});
            across = std::max(across, length * double(axis == 0 ? texture->image.width : texture->image.height));
        }
    int parts = 1;
    while (parts < kFinest && parts < across)
        parts *= 2;
    return parts;
}

} // namespace

TrianglePaint::TrianglePaint(const Surface& surface, size_t triangle, const Appearance& appearance,
                             const Texture* texture)
    : texture_(texture), factor_(appearance.factor) {
    for (size_t corner = 0; corner < 3; ++corner) {
        for (size_t axis = 0; axis < 2; ++axis)
            uv_[corner][axis] = surface.uv[6 * triangle + 2 * corner + axis];
        for (size_t channel = 0; channel < 4; ++channel)
            colours_[corner][channel] = surface.colours[12 * triangle + 4 * corner + channel];
    }
}

Light TrianglePaint::at(const Barycentric& shares) const {
    const auto mixed = [&](const auto& of, size_t at) {
        return shares[0] * of[0][at] + shares[1] * of[1][at] + shares[2] * of[2][at];
    };
    Light own;
    for (size_t channel = 0; channel < 4; ++channel)
        own[channel] = mixed(colours_, channel) * factor_[channel];
    if (texture_ == nullptr)
        return own;
    Light found = look_up(*texture_, mixed(uv_, 0), mixed(uv_, 1));
    for (size_t channel = 0; channel < 4; ++channel)
        found[channel] *= own[channel];
    return found;
}

Light sample(const Surface& surface, size_t triangle, const Barycentric& shares) {
    const Appearance& appearance = surface.entries[static_cast<size_t>(surface.rows[triangle])];
    return TrianglePaint(surface, triangle, appearance, appearance.texture ? &*appearance.texture : nullptr).at(shares);
}

std::vector<uint8_t> visible_triangles(const Surface& surface, int threads) {
    std::vector<uint8_t> solid(surface.size());
    for (size_t row = 0; row < surface.entries.size(); ++row) {
        const Appearance& appearance = surface.entries[row];
        const std::optional<Texture> own = nearest_of(appearance);
        const Texture* texture = own ? &*own : nullptr;
        const double least = texture != nullptr && appearance.cutoff > 0 ? least_alpha(*texture) : 1;
        std::vector<size_t> undecided;
        for (size_t t = 0; t < surface.size(); ++t) {
            if (surface.rows[t] != static_cast<int32_t>(row))
                continue;
            const double alpha =
                std::min({surface.colours[12 * t + 3], surface.colours[12 * t + 7], surface.colours[12 * t + 11]});
            solid[t] = alpha * appearance.factor[3] * least >= appearance.cutoff;
            if (!solid[t])
                undecided.push_back(t);
        }
        if (undecided.empty())
            continue;
        std::vector<int> parts(undecided.size());
        std::array<int64_t, kFinest + 1> number{};
        for (size_t i = 0; i < undecided.size(); ++i)
            ++number[static_cast<size_t>(parts[i] = parts_of(surface, texture, undecided[i]))];
        int finest = kFinest;
        for (const auto samples =
                 [&] {
                     int64_t sum = 0;
                     for (int n = 1; n <= kFinest; n *= 2)
                         sum += number[static_cast<size_t>(n)] * std::min(n, finest) * std::min(n, finest);
                     return sum;
                 };
             finest > 1 && samples() > kMostSamples;)
            finest /= 2;
        std::array<std::vector<Barycentric>, kFinest + 1> points;
        for (int n = 1; n <= finest; n *= 2)
            points[static_cast<size_t>(n)] = centroids(n);
        const size_t jobs = (undecided.size() + kTrianglesOfAJob - 1) / kTrianglesOfAJob;
        Workers(threads).run(jobs, [&](size_t job, int) {
            WorkCounter& counter = WorkCounter::current();
            const size_t end = std::min(undecided.size(), (job + 1) * kTrianglesOfAJob);
            for (size_t i = job * kTrianglesOfAJob; i < end; ++i) {
                const TrianglePaint paint(surface, undecided[i], appearance, texture);
                const auto& places = points[static_cast<size_t>(std::min(parts[i], finest))];
                counter.count(static_cast<uint32_t>(8 * places.size()));
                solid[undecided[i]] = std::any_of(places.begin(), places.end(), [&](const Barycentric& shares) {
                    return paint.at(shares)[3] >= appearance.cutoff;
                });
            }
        });
    }
    return solid;
}

std::vector<Barycentric> centroids(int n) {
    std::vector<Barycentric> found;
    found.reserve(static_cast<size_t>(n) * static_cast<size_t>(n));
    const auto add = [&](int i, int j, double beyond) {
        const double one = (i + beyond) / n, other = (j + beyond) / n;
        found.push_back({one, other, 1 - (one + other)});
    };
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n; ++j)
            add(i, j, 1 / 3.0);
    for (int i = 0; i < n; ++i)
        for (int j = 0; i + j < n - 1; ++j)
            add(i, j, 2 / 3.0);
    return found;
}

} // namespace voxrt::voxelize
