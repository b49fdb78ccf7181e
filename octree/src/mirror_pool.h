// Blocks stored once up to mirroring along axes, as in Jaspe-Villanueva, Marton, Gobbetti, "SSVDAGs: Symmetry-aware
// Sparse Voxel DAGs", 2016.
//
// A mirror is three bits, for x, y and z; it moves octant i to octant i ^ mirror. A reference is a leaf, which every
// mirror leaves as it is, or 8 * number + mirror: the block of that number, mirrored. Of the mirrors that give the same
// cube the least is taken. So two references are equal exactly where their cubes are, and have the same number exactly
// where a mirror makes one of the other.
#pragma once

#include "block_pool.h"

#include <algorithm>
#include <vector>

namespace voxrt::octree {

class MirrorPool {
public:
    /// The reference of the cube whose octants are eight references: their leaf where all are the same leaf.
    Word intern(const Block& octants) {
        if (is_leaf(octants[0]) && std::all_of(octants.begin(), octants.end(), [&](Word w) { return w == octants[0]; }))
            return octants[0];
        Block least = octants;
        unsigned to_least = 0;
        unsigned symmetries = 0; // bit m: mirror m leaves the cube as it is
        for (unsigned mirror = 0; mirror < 8; ++mirror) {
            const Block image = mirrored(octants, mirror);
            if (image == octants)
                symmetries |= 1u << mirror;
            if (image < least) {
                least = image;
                to_least = mirror;
            }
        }
        const Word number = pool_.intern(least);
        if (number == symmetries_.size())
            symmetries_.push_back(static_cast<std::uint8_t>(symmetries)); // mirrors commute: those of the image too
        return 8 * number + least_mirror(number, to_least);
    }

    std::size_t size() const { return pool_.size(); }

private:
    Block mirrored(const Block& octants, unsigned mirror) const {
        Block image;
        for (unsigned octant = 0; octant < 8; ++octant) {
            const Word reference = octants[octant];
            image[octant ^ mirror] = is_leaf(reference)
                                         ? reference
                                         : (reference & ~7u) | least_mirror(reference / 8, (reference & 7) ^ mirror);
        }
        return image;
    }

    unsigned least_mirror(Word number, unsigned mirror) const {
        unsigned least = mirror;
        for (unsigned symmetry = 1; symmetry < 8; ++symmetry)
            if (symmetries_[number] >> symmetry & 1)
                least = std::min(least, mirror ^ symmetry);
        return least;
    }

    BlockPool pool_;
    std::vector<std::uint8_t> symmetries_;
};

} // namespace voxrt::octree
