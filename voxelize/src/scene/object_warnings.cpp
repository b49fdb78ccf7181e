#include "object_warnings.h"

#include "object_mode.h"

#include <algorithm>

namespace voxrt::voxelize {
namespace {

constexpr size_t kMostNames = 20;

/// Names as a message lists them.
std::string listed(const std::vector<std::string>& names) {
    std::string shown;
    for (size_t i = 0; i < std::min(names.size(), kMostNames); ++i)
        shown += (i > 0 ? ", " : "") + names[i];
    return names.size() > kMostNames ? shown + " and " + std::to_string(names.size() - kMostNames) + " more" : shown;
}

} // namespace

std::vector<ObjectWarning> object_warnings(const VoxelizedObjects& objects) {
    std::vector<std::string> without, mostly_filled;
    int64_t open = 0, flipped = 0, turned = 0, one_sided = 0, inward = 0;
    for (size_t i = 0; i < objects.names.size(); ++i) {
        if (objects.reported[i] && objects.voxels[i] == 0)
            without.push_back(objects.names[i]);
        open += objects.reported[i] && objects.modes[i] == static_cast<uint8_t>(ObjectMode::open);
        const ObjectNotes& notes = objects.notes[i];
        flipped += notes[kFlippedComponents];
        turned += notes[kTurnedFaces];
        one_sided += notes[kOneSidedPieces];
        inward += objects.reported[i] && notes[kInwardParts] != 0;
        if (notes[kMostlyFilled] != 0)
            mostly_filled.push_back(objects.names[i]);
    }

    std::vector<ObjectWarning> warnings;
    if (!without.empty())
        warnings.push_back({"no-voxels", "objects got no voxel: " + listed(without), int64_t(without.size())});
    if (open > 0)
        warnings.push_back(
            {"open-surface",
             "open objects, like a room without a front, were not filled: close them, give them colliders, or take "
             "--fill together where they close one another",
             open});
    if (!mostly_filled.empty()) {
        const size_t others = mostly_filled.size() - 1;
        const std::string more = others > 0 ? " and " + std::to_string(others) + " more" : "";
        warnings.push_back({"mostly-filled",
                            "open objects were filled, and are more inside than shell (" + mostly_filled[0] + more +
                                "): build thin sheets, such as cloth, with --fill surface",
                            int64_t(mostly_filled.size())});
    }
    if (flipped > 0)
        warnings.push_back(
            {"turned-pieces",
             "closed pieces that face inwards, unlike others of their object, were turned: recalculate their normals",
             flipped});
    if (turned > 0)
        warnings.push_back({"turned-faces",
                            "faces were wound against those beside them and were turned, so that what the surface "
                            "encloses is solid: recalculate the normals",
                            turned});
    if (inward > 0)
        warnings.push_back(
            {"inward-parts",
             "objects have parts that face inwards, or are turned in a way that does not show their inside, where they "
             "touch or cross others: such parts may be hollow, or a voxel too large; recalculate the normals",
             inward});
    if (one_sided > 0)
        warnings.push_back({"one-sided",
                            "pieces have one side only, like a Klein bottle, so nothing tells their inside for sure: "
                            "look at the picture, or build them with --fill surface",
                            one_sided});
    return warnings;
}

} // namespace voxrt::voxelize
