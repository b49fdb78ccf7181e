// The C interface of voxrt.wasm: voxels that are given one by one become words.
#include "export.h"
#include "interface_error.h"

#include <voxrt/octree/build/build.h>
#include <voxrt/voxelize/grid/morton.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace {
voxrt::octree::Words words;
}

/// Builds the octree of voxels: x, y, z from 0 up to 2^depth, and a material each. Where a place repeats, the first
/// voxel counts. Returns how many words there are.
EXPORT(vx_points) double vx_points(const int32_t* places, const uint8_t* materials, size_t count, int depth) {
    using namespace voxrt;
    return web::guarded([&] {
        if (depth < 1 || depth > 16)
            throw std::invalid_argument("depth must be 1 … 16");
        std::vector<std::pair<uint64_t, uint8_t>> voxels;
        voxels.reserve(count);
        for (size_t i = 0; i < count; ++i) {
            const int32_t* place = places + 3 * i;
            if (std::any_of(place, place + 3, [&](int32_t at) { return at < 0 || at >> depth != 0; }))
                throw std::invalid_argument("voxel " + std::to_string(i) + " lies beyond the world");
            voxels.emplace_back(voxelize::morton(static_cast<uint32_t>(place[0]), static_cast<uint32_t>(place[1]),
                                                 static_cast<uint32_t>(place[2])),
                                materials[i]);
        }
        std::stable_sort(voxels.begin(), voxels.end(),
                         [](const auto& one, const auto& other) { return one.first < other.first; });
        voxels.erase(std::unique(voxels.begin(), voxels.end(),
                                 [](const auto& one, const auto& other) { return one.first == other.first; }),
                     voxels.end());
        std::vector<uint64_t> codes;
        std::vector<uint8_t> ids;
        for (const auto& [code, id] : voxels) {
            codes.push_back(code);
            ids.push_back(id);
        }
        words = octree::build_points(codes.data(), ids.data(), codes.size(), static_cast<unsigned>(depth));
        return static_cast<double>(words.size());
    });
}
EXPORT(vx_points_words) const voxrt::octree::Word* vx_points_words() { return words.data(); }
