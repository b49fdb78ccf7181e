// Octants of sparse voxels, joined where they make up larger ones.
#pragma once

#include "sparse_voxels.h"

namespace voxrt::voxelize {

/// Adds an octant to sparse voxels, after all that lie before it. Eight equal octants in a row that share a parent
/// become the parent.
inline void push_octant(SparseVoxels& out, uint64_t code, uint8_t level, uint8_t material) {
    auto& codes = out.octant_codes;
    auto& levels = out.octant_levels;
    auto& materials = out.octant_materials;
    codes.push_back(code);
    levels.push_back(level);
    materials.push_back(material);
    while (codes.size() >= 8 && (codes.back() & 7) == 7) {
        const size_t first = codes.size() - 8;
        for (size_t i = first; i < codes.size(); ++i)
            if (levels[i] != levels.back() || materials[i] != materials.back() || codes[i] >> 3 != codes.back() >> 3)
                return;
        codes.resize(first + 1);
        levels.resize(first + 1);
        materials.resize(first + 1);
        codes[first] >>= 3;
        ++levels[first];
    }
}

} // namespace voxrt::voxelize
