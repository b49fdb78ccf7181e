// Parts too thin for a rule: the voxels that are filled so that nothing of them gets lost.
//
// A voxel is solid in bulk where it lies in a cube of 2 x 2 x 2 filled voxels. A touched voxel with no such voxel among
// its 26 neighbours belongs to a thin part. The voxels of thin parts and their touched neighbours are candidates: all
// of them are filled at first, and then taken away, one after another, where
//
// - it changes no connection: the filled neighbours stay in one piece, and the empty ones, too (a simple point;
//   Bertrand and Malandain 1994: 26 neighbours for what is filled, 6 for what is empty),
// - each touched voxel among it and its 26 neighbours is filled or keeps a filled neighbour.
//
// They are looked at once, in the order of (x mod 3, y mod 3, z mod 3), z most significant. Voxels of one turn are at
// least three apart, so none bears on another, and the result does not depend on threads. What lies 56 voxels away
// does not matter.
#pragma once

#include "../work/workers.h"
#include "rule_bricks.h"

namespace voxrt::voxelize {

/// How many voxels around a block decide what thin parts keep in it, at most.
inline constexpr int kThinReach = 56;

/// Voxels of a brick.
struct AddedVoxels {
    uint32_t brick;
    Slices voxels;
};

/// Fills voxels of thin parts. `added`, where there are lone rules and it is not null, gets them.
void keep_thin_parts(RuleBricks& bricks, const Workers& workers, std::vector<AddedVoxels>* added);

} // namespace voxrt::voxelize
