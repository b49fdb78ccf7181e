// The volumes of the voxels of a brick column, summed slice by slice from what a surface's triangles add.
#pragma once

#include "../coverage/tile_surface.h"
#include "column_winding.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxrt::voxelize {

class VolumeSums {
public:
    /// No column is summed any more.
    void clear() { summed_ = 0; }

    /// Sums those columns alone that have surface in the next slice. `winding`: below it.
    void begin(uint64_t surface, const ColumnWinding& winding) {
        // Below its surface a solid fills as many voxels as the winding number says, which has no rounding.
        for (uint64_t begun = surface & ~summed_; begun != 0; begun &= begun - 1)
            below_[size_t(std::countr_zero(begun))] = winding.at(std::countr_zero(begun));
        summed_ = surface;
    }

    /// Finds the volumes of these columns in slice `z` of a brick. `pieces`: the brick's, or null.
    void add(const TileSurface& object, const PiecesOfBrick* pieces, uint64_t surface,
             std::array<double, kBrickVoxels>& volumes, int z) {
        const uint64_t with_pieces = pieces ? pieces->columns : 0;
        for (uint64_t left = surface; left != 0; left &= left - 1) {
            const int bit = std::countr_zero(left);
            double& below = below_[size_t(bit)];
            if (with_pieces >> bit & 1)
                below += object.pieces(*pieces, bit)[size_t(z)];
            volumes[size_t(z * 64 + bit)] = std::min(std::abs(below), 1.0);
        }
    }

    /// Adds what pieces of a brick add to the brick above. Sums, too, where a flat piece lies between both: the surface
    /// begins above.
    void carry(const TileSurface& object, const PiecesOfBrick& pieces, const ColumnWinding& winding) {
        for (uint64_t left = pieces.columns; left != 0; left &= left - 1) {
            const int bit = std::countr_zero(left);
            const double carried = object.pieces(pieces, bit)[kBrickSide];
            if (carried == 0)
                continue;
            double& below = below_[size_t(bit)];
            below = carried + ((summed_ >> bit & 1) == 0 ? winding.at(bit) : below);
            summed_ |= uint64_t{1} << bit;
        }
    }

private:
    uint64_t summed_ = 0;            // columns: the last slice had surface there
    std::array<double, 64> below_{}; // by column: the volume below the slice, per voxel
};

} // namespace voxrt::voxelize
