// What to tell the author of a scene about its voxels.
#pragma once

#include "../grid/sparse_voxels.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace voxrt::voxelize {

struct ObjectWarning {
    std::string kind;
    std::string message;
    int64_t count;
};

/// By object of a scene: how it was voxelized (sparse_voxels.h), its name, and whether it is reported on.
struct VoxelizedObjects {
    std::span<const int64_t> voxels;
    std::span<const uint8_t> modes;
    std::span<const ObjectNotes> notes;
    std::span<const std::string> names;
    std::span<const uint8_t> reported;
};

std::vector<ObjectWarning> object_warnings(const VoxelizedObjects& objects);

} // namespace voxrt::voxelize
