// Runs what fits a memory to a budget and to a board without Python, for the sanitizers: `make sanitize` builds it with
// each of them.
//
// Random worlds get smaller memories, of which one is chosen by pictures from all around; orbits must see all of a
// scene, searches for a board's pictures must end, and rows of a board's memory be as many as its blocks have. What
// may run on several threads runs on one and on three; the results must be equal. Prints a line and exits with 1 where
// anything is wrong.
#include "world.h"

#include <voxrt/octree/budget/fit_candidates.h>
#include <voxrt/octree/budget/sight_costs.h>
#include <voxrt/octree/build/coarsen.h>
#include <voxrt/octree/words/encoded_rows.h>
#include <voxrt/sim/views/beam.h>
#include <voxrt/sim/views/fit_views.h>
#include <voxrt/sim/views/framing.h>
#include <voxrt/sim/views/similarity.h>

#include <array>
#include <cmath>

using namespace voxrt;
using namespace exercise;

namespace {

constexpr int kMaterials = 6;
using octree::Words;

octree::VerifiedMemory verified(const Words& words, unsigned depth) {
    return octree::VerifiedMemory({words.data(), words.size(), depth});
}

void exercise_fits(Random& random, unsigned depth) {
    const Words whole = world(random, depth, kMaterials);
    const Words shared = octree::coarsened({whole.data(), whole.size(), depth}, 0);
    std::array<uint8_t, 768> palette{};
    std::vector<octree::Colour> colours;
    for (int i = 0; i < kMaterials; ++i) {
        for (int channel = 0; channel < 3; ++channel)
            palette[3 * i + channel] = static_cast<uint8_t>(random());
        colours.push_back({palette[3 * i], palette[3 * i + 1], palette[3 * i + 2]});
    }
    const size_t limit = 1 + static_cast<size_t>(upto(random, static_cast<int>(shared.size())));
    if (limit >= shared.size())
        return;
    std::vector<Words> candidates;
    try {
        candidates =
            octree::fit_candidates({shared.data(), shared.size(), depth}, limit, *octree::sight_costs(colours));
    } catch (const octree::DoesNotFit&) {
        // Eight voxels per side are the coarsest world.
        const unsigned level = depth > 3 ? depth - 3 : 0;
        const Words coarsest = octree::coarsened({shared.data(), shared.size(), depth}, level);
        check(coarsest.size() > limit, "a coarse world does not fit");
        return;
    }
    const bool flat = upto(random, 1) == 0;
    const sim::FitViews alone(verified(whole, depth), palette.data(), flat, 1);
    const sim::FitViews three(verified(whole, depth), palette.data(), flat, 3);
    std::vector<sim::FitFigures> figures;
    for (const Words& words : candidates) {
        check(words.size() <= limit, "a smaller memory has too many words");
        const sim::Likeness one = alone.likeness(verified(words, depth)),
                            other = three.likeness(verified(words, depth));
        check(one.psnr == other.psnr && one.ssim == other.ssim, "likeness depends on the number of threads");
        check(one.ssim <= 1 + 1e-9, "pictures are more than equal");
        figures.push_back({static_cast<double>(upto(random, 1000)), one});
    }
    check(sim::choose_fit(figures) < candidates.size(), "a fit is chosen that is none");
}

void exercise_pictures(Random& random) {
    const size_t width = 1 + static_cast<size_t>(upto(random, 40)), height = 1 + static_cast<size_t>(upto(random, 40));
    std::vector<uint8_t> one(3 * width * height), other(one.size());
    for (size_t i = 0; i < one.size(); ++i) {
        one[i] = static_cast<uint8_t>(random());
        other[i] = static_cast<uint8_t>(random());
    }
    check(std::isinf(sim::peak_signal_to_noise(one.data(), one.data(), width * height)), "equal pictures differ");
    check(std::abs(sim::structural_similarity(one.data(), one.data(), width, height) - 1) < 1e-9, "equal ones differ");
    check(sim::structural_similarity(one.data(), other.data(), width, height) <= 1, "other pictures are too equal");
}

/// Whether a camera has a point in its picture, by the directions of the pixels in the corners.
bool sees(const sim::Camera& camera, const sim::Point& point, int width, int height) {
    std::array<double, 3> from, parts{};
    for (int axis = 0; axis < 3; ++axis)
        from[axis] = point[axis] - camera.position[axis] / 16.0;
    const int32_t* rows[3] = {camera.look, camera.right, camera.up};
    for (int row = 0; row < 3; ++row) {
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            parts[row] += from[axis] * rows[row][axis];
            square += double(rows[row][axis]) * rows[row][axis];
        }
        parts[row] /= square;
    }
    return parts[0] > 0 && std::abs(parts[1] / parts[0]) <= width / 2.0 &&
           std::abs(parts[2] / parts[0]) <= height / 2.0;
}

void exercise_boards(Random& random, unsigned depth) {
    const Words words = world(random, depth, kMaterials);
    const std::vector<sim::Point> points = sim::outline_points(verified(words, depth));
    const int count = 1 + upto(random, 20);
    const std::vector<sim::Camera> cameras = sim::orbit(points, 640, 480, count);
    check(cameras.size() == static_cast<size_t>(count), "an orbit lacks cameras");
    for (const sim::Camera& camera : cameras)
        for (const sim::Point& point : points)
            check(sees(camera, point, 640, 480), "a camera of an orbit does not see all of the scene");
    sim::BeamSearch search(cameras, 1e6 * (10 + upto(random, 200)), 1 << (4 + upto(random, 3)));
    int bands = 0;
    for (; !search.ended(); ++bands) {
        const sim::BeamSearch::Band band = search.band();
        check(bands < 11 * 12 && band.rows * 12 == band.width * 3 / 4, "a search goes on and on");
        search.give(band.width * band.rows * (1 + upto(random, 20)));
    }
    check(search.done() == search.total() && search.fit().scale <= 2, "a search has no end");
    unsigned bits = 0;
    while (1 + (size_t{8} << bits) < words.size())
        ++bits;
    check(octree::encoded_rows(words.data(), words.size(), bits).size() == size_t{8} << bits, "rows are missing");
    if (bits > 0)
        try {
            octree::encoded_rows(words.data(), words.size(), bits - 1);
            check(false, "a memory that is too small takes all words");
        } catch (const std::invalid_argument&) {
        }
}

} // namespace

int main() {
    Random random(17);
    for (unsigned depth = 1; depth <= 4; ++depth)
        for (int round = 0; round < 4; ++round) {
            exercise_fits(random, depth);
            exercise_boards(random, depth);
            exercise_pictures(random);
        }
    std::puts("fit: ok");
}
