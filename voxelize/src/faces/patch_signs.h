// Which way the patches of a body face, as one sees them from outside. A patch is faces joined over edges of two.
//
// Cells know it from the order of the faces about each edge. Where parts cross, or where rounding puts faces that
// nearly lie upon one another in a wrong order, a cell has parts of the inside and of the outside. So lines along the
// axes look at the patches: what a line meets first has the outside before it. Each edge has to be walked as often one
// way as the other, which tells the rest; hidden patches count only where they must. (Facing by visibility: Takayama,
// Jacobson, Kavan and Sorkine-Hornung, "A Simple Method for Correcting Facet Orientations in Polygon Meshes Based on
// Ray Casting", 2014.)
#pragma once

#include "../grid/fixed_point.h"
#include "mesh_edges.h"

namespace voxrt::voxelize {

struct PatchSigns {
    bool are_sure = true;                          // what is seen counts as it is seen, once and from one side
    std::vector<std::pair<uint32_t, int>> by_face; // 1, -1 or 0 where it does not count; empty where nothing changes
};

/// A face of a body: a number for its patch, whether it is wound as its patch is (1) or against it (-1), and how often
/// it counts as authored.
struct PatchFace {
    uint32_t face, patch;
    int direction, counted;
    std::array<Vertex, 3> corners;
};

/// Patches at an edge, each as often as its faces walk it upwards more than downwards.
using PatchBalance = std::vector<std::pair<uint32_t, int>>;

class BodyPatches {
public:
    /// `is_said`: the file winds the faces consistently, and no cells contradict it. Then large bodies are left out.
    explicit BodyPatches(bool is_said) : is_said_(is_said) {}

    /// Faces come in order.
    void add(const PatchFace& face) {
        if (is_said_ && faces_.size() == kFewFaces)
            leave_out();
        if (!is_left_out_)
            faces_.push_back(face);
    }
    /// The faces at an edge of other than two. All faces are there.
    void add_edge(const std::vector<EdgeUse>& uses);
    void leave_out() {
        is_left_out_ = true;
        faces_.clear();
    }
    /// Looks at the patches. Cost: some lines per patch, each past all faces; bodies of many patches are left out.
    PatchSigns look();

private:
    static constexpr size_t kFewFaces = 1 << 13; // times patches, where the file is said to be right

    bool is_said_;
    std::vector<PatchFace> faces_;
    std::vector<PatchBalance> edges_;
    bool is_left_out_ = false;
};

} // namespace voxrt::voxelize
