// Which closed components of a surface lie around another component.
//
// A component lies around another where it does not cross the other's surface, and its winding number is the same and
// not zero all over that surface. Corners and edges may touch. A surface crosses a triangle where it meets the
// triangle's interior from both sides, or lies along it. Where nothing crosses a triangle, one place that the surface
// does not touch, a corner or the middle, decides for all of it.
//
// All is decided exactly, in integers, but for the room around a middle, which is rounded.
//
// Cost: a bounding volume hierarchy of all components that may lie around another, a query per component, and one per
// 16 triangles of a component that others lie around.
#pragma once

#include "../faces/mesh_edges.h"
#include "triangle_bvh.h"

#include <optional>
#include <vector>

namespace voxrt::voxelize {

struct ClosedComponent {
    std::vector<uint32_t> triangles, vertices;
    TriangleBox box;
    int128 volume6 = 0;  // six times its volume; negative where it faces inwards
    bool capped = false; // part of it are caps
};

/// A component that lies around another, and its winding number there.
struct Enclosing {
    uint32_t component;
    int winding;
    bool touched; // then the winding number is not known
};

class EnclosingComponents {
public:
    /// `corners`: of each triangle; only those of components are read. The vertices and components stay the caller's.
    EnclosingComponents(const std::vector<Vertex>& vertices, std::vector<Corners> corners,
                        const std::vector<ClosedComponent>& components);

    /// All components, each after those that may lie around it.
    const std::vector<uint32_t>& order() const { return order_; }

    /// Those that lie around a component, in that order.
    std::vector<Enclosing> find(uint32_t own) const;

private:
    TriangleBox box_of(uint32_t t) const;
    bool may_enclose(uint32_t component) const;
    std::vector<Enclosing> winding_at(uint32_t own, const Vertex& q, int room) const;
    Vertex middle_of(uint32_t t) const;
    void keep_enclosing(uint32_t own, uint32_t t, const std::vector<uint32_t>& near,
                        std::vector<Enclosing>& enclosing) const;
    bool crosses(uint32_t component, uint32_t t, const std::vector<uint32_t>& near) const;

    const std::vector<Vertex>& vertices_;
    const std::vector<Corners> corners_;
    const std::vector<ClosedComponent>& components_;
    std::vector<uint32_t> component_of_; // by triangle
    std::vector<uint32_t> order_;
    std::vector<uint32_t> rank_; // by component: its place in the order
    std::optional<TriangleBvh> bvh_;
};

} // namespace voxrt::voxelize
