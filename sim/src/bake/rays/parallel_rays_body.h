// parallel_rays.h's open_rays for the instruction set of the including file, which defines VOXRT_OPEN_RAYS as its name.
//
// The traversal is that of model/frames/tile.h: crossings of planes have keys, whole numbers held exactly in doubles,
// and a ray visits a node where the largest key of its near planes is below the smallest of its far planes. Here all
// rays have one direction. So plane p has the key p * scale + offset with one scale per axis for all of them, and the
// rays differ in their offsets alone. The least and the largest offset bound them all: large nodes are tested against
// these bounds, and only nodes of kRaySize voxels per side and less ray by ray. Any hit ends a ray.
#include "parallel_rays.h"

#include <voxrt/voxelize/vectors/lanes.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxrt::sim {
namespace {

constexpr double kNeverKey = 0x1p56; // as in model/frames/tile.h
constexpr double kStartKey = 3.5;
constexpr double kRaySize = 8;

struct Rays {
    uint8_t group;
    Mask lanes;
};

struct Packet {
    const uint32_t* words;
    uint32_t mirror = 0;
    double scale[3];
    double least[3], most[3]; // of the offsets
    Lanes offset[kPacketGroups][3];
    Mask alive[kPacketGroups];
    int groups;
    int living; // groups with a ray alive

    void kill(int group, Mask lanes) {
        alive[group] &= static_cast<Mask>(~lanes);
        living -= alive[group] == 0;
    }

    // A node of `size` voxels with its lowest corner at (x, y, z), mirrored frame, that some rays may visit.
    void beam(uint32_t word, double x, double y, double z, double size) {
        if (octree::is_leaf(word) || size <= kRaySize) {
            Rays rays[kPacketGroups];
            int count = 0;
            const Lanes plane[6] = {all(x * scale[0]),          all((x + size) * scale[0]), all(y * scale[1]),
                                    all((y + size) * scale[1]), all(z * scale[2]),          all((z + size) * scale[2])};
            for (int group = 0; group < groups; ++group)
                if (alive[group]) {
                    const Lanes* o = offset[group];
                    const Lanes entry =
                        larger(larger(plane[0] + o[0], plane[2] + o[1]), larger(plane[4] + o[2], all(kStartKey)));
                    const Lanes exit = smaller(smaller(plane[1] + o[0], plane[3] + o[1]), plane[5] + o[2]);
                    if (const Mask here = alive[group] & less(entry, exit))
                        rays[count++] = {static_cast<uint8_t>(group), here};
                }
            if (count)
                node(word, x, y, z, size, rays, count);
            return;
        }
        const double half = size / 2;
        double low[3][2], high[3][2]; // bounds of the keys of the near and far planes of the lower and upper octants
        const double corner[3] = {x, y, z};
        for (int axis = 0; axis < 3; ++axis)
            for (int upper = 0; upper < 2; ++upper) {
                const double plane = corner[axis] + upper * half;
                low[axis][upper] = plane * scale[axis] + least[axis];
                high[axis][upper] = (plane + half) * scale[axis] + most[axis];
            }
        for (uint32_t i = 0; i < 8 && living; ++i) {
            const uint32_t child = words[word + (i ^ mirror)];
            if (octree::is_leaf(child) && octree::material(child) == 0)
                continue;
            const int a = i & 1, b = i >> 1 & 1, c = i >> 2;
            const double entry = std::max(std::max(low[0][a], low[1][b]), std::max(low[2][c], kStartKey));
            const double exit = std::min(std::min(high[0][a], high[1][b]), high[2][c]);
            if (entry < exit)
                beam(child, x + a * half, y + b * half, z + c * half, half);
        }
    }

    // The same with the rays that visit it.
    void node(uint32_t word, double x, double y, double z, double size, const Rays* rays, int count) {
        if (octree::is_leaf(word)) {
            for (int i = 0; i < count; ++i)
                if (const Mask hit = rays[i].lanes & alive[rays[i].group])
                    kill(rays[i].group, hit);
            return;
        }
        const double half = size / 2;
        uint32_t octants[8];
        uint64_t filled = 0; // byte i: 0xFF where octant i is more than empty space
        for (uint32_t i = 0; i < 8; ++i) {
            octants[i] = words[word + (i ^ mirror)];
            const bool empty = octree::is_leaf(octants[i]) && octree::material(octants[i]) == 0;
            filled |= (empty ? uint64_t{0} : uint64_t{0xFF}) << 8 * i;
        }
        Lanes plane[3][3];
        const double corner[3] = {x, y, z};
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < 3; ++i)
                plane[axis][i] = all((corner[axis] + i * half) * scale[axis]);
        const Lanes start = all(kStartKey);
        Rays visitors[8][kPacketGroups];
        int visits[8] = {};
        for (int i = 0; i < count; ++i) {
            const uint8_t group = rays[i].group;
            const Mask lanes = rays[i].lanes & alive[group];
            if (!lanes)
                continue;
            const Lanes* o = offset[group];
            const Lanes x0 = plane[0][0] + o[0], x1 = plane[0][1] + o[0], x2 = plane[0][2] + o[0];
            const Lanes y0 = plane[1][0] + o[1], y1 = plane[1][1] + o[1], y2 = plane[1][2] + o[1];
            const Lanes z0 = plane[2][0] + o[2], z1 = plane[2][1] + o[2], z2 = plane[2][2] + o[2];
            const Lanes near_z0 = larger(z0, start), near_z1 = larger(z1, start);
            const Lanes entry[4] = {larger(x0, y0), larger(x1, y0), larger(x0, y1), larger(x1, y1)};
            const Lanes exit[4] = {smaller(x1, y1), smaller(x2, y1), smaller(x1, y2), smaller(x2, y2)};
            uint64_t visiting = 0; // byte i: the rays that visit octant i
            for (int j = 0; j < 4; ++j) {
                visiting |= uint64_t{less(larger(entry[j], near_z0), smaller(exit[j], z1))} << 8 * j;
                visiting |= uint64_t{less(larger(entry[j], near_z1), smaller(exit[j], z2))} << (8 * j + 32);
            }
            visiting &= filled & lanes * 0x0101010101010101u;
            while (visiting) {
                const int octant = std::countr_zero(visiting) / 8;
                const Mask here = static_cast<Mask>(visiting >> 8 * octant);
                visitors[octant][visits[octant]++] = {group, here};
                visiting ^= uint64_t{here} << 8 * octant;
            }
        }
        for (int i = 0; i < 8; ++i)
            if (visits[i])
                node(octants[i], x + (i & 1 ? half : 0), y + (i & 2 ? half : 0), z + (i & 4 ? half : 0), half,
                     visitors[i], visits[i]);
    }
};

} // namespace

void VOXRT_OPEN_RAYS(const octree::VerifiedMemory& memory, const ParallelRays& rays, uint8_t* open) {
    const double side = static_cast<double>(1 << memory.depth()), world = 16 * side;
    Packet packet;
    packet.words = memory.words();
    packet.groups = (rays.count + kLanes - 1) / kLanes;
    packet.living = 0;
    for (int group = 0; group < packet.groups; ++group) {
        packet.alive[group] = rays.wanted[group];
        packet.living += packet.alive[group] != 0;
    }
    if (!packet.living) {
        std::fill_n(open, packet.groups, uint8_t{0});
        return;
    }
    double size[3];
    for (int axis = 0; axis < 3; ++axis)
        size[axis] = rays.direction[axis] == 0 ? 1 : std::abs(static_cast<double>(rays.direction[axis]));
    alignas(64) double values[kLanes];
    for (int axis = 0; axis < 3; ++axis) {
        const int32_t d = rays.direction[axis];
        const double weight = 4 * size[(axis + 1) % 3] * size[(axis + 2) % 3];
        packet.mirror |= static_cast<uint32_t>(d < 0) << axis;
        packet.scale[axis] = d == 0 ? kNeverKey : 16 * weight;
        packet.least[axis] = HUGE_VAL;
        packet.most[axis] = -HUGE_VAL;
        for (int group = 0; group < packet.groups; ++group) {
            for (int lane = 0; lane < kLanes; ++lane) {
                const int ray = std::min(kLanes * group + lane, rays.count - 1);
                const int32_t place = rays.origins[3 * ray + axis];
                const double origin = place;
                double offset = axis - (d < 0 ? world - origin : origin) * weight;
                if (d == 0)
                    offset = -((place >> 4) + 0.5) * kNeverKey; // in the middle of a cell, so on no plane
                values[lane] = offset;
                packet.least[axis] = std::min(packet.least[axis], offset);
                packet.most[axis] = std::max(packet.most[axis], offset);
            }
            std::memcpy(&packet.offset[group][axis], values, sizeof values);
        }
    }
    const uint32_t root = memory.root();
    if (!octree::is_leaf(root) || octree::material(root) != 0)
        packet.beam(root, 0, 0, 0, side);
    std::copy_n(packet.alive, packet.groups, open);
}

} // namespace voxrt::sim
