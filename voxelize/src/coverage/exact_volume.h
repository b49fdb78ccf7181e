// How much of a voxel a closed surface encloses, as a fraction: what is inside where its winding number is not zero.
//
// Volumes in floating point (volume_pieces.h) decide almost everywhere. This decides where they leave a doubt, and
// where a surface cuts itself. Cost: some microseconds where all planes in the voxel face one axis, or where the only
// plane passes the centre; otherwise about a tenth of a millisecond per triangle.
#pragma once

#include "../grid/big_integer.h"

#include <array>
#include <span>

namespace voxrt::voxelize {

using SolidTriangle = std::array<Vertex, 3>;

/// A sum of fractions, whose common denominator is left as it comes.
class ExactSum {
public:
    /// Adds numerator / denominator; denominator > 0.
    void add(const BigInteger& numerator, const BigInteger& denominator) {
        if (denominator == denominator_) {
            numerator_ = numerator_ + numerator;
            return;
        }
        numerator_ = numerator_ * denominator + numerator * denominator_;
        denominator_ = denominator_ * denominator;
    }
    bool at_least_half() const { return (numerator_ + numerator_ - denominator_).sign() >= 0; }

private:
    BigInteger numerator_, denominator_ = 1;
};

/// Adds the part of voxel (x, y, z) that a closed surface encloses, 0 … 1. `column`: the surface's triangles that reach
/// the column of voxels at (x, y), each once.
void add_exact_volume(std::span<const SolidTriangle> column, int x, int y, int z, ExactSum& sum);

} // namespace voxrt::voxelize
