// The traversal that tile.h describes, for the instruction set of the including file.
#pragma once

#include "frame_tile.h"
#include "tile.h"

#include <algorithm>
#include <bit>

namespace voxrt::sim {
namespace {

constexpr uint32_t kUncountedWork = 1 << 13; // in the units of interrupt.h: about 0.1 ms

struct Rays {
    uint8_t group;
    Mask lanes;
};

struct Walk {
    const uint32_t* words;
    Tile& tile;
    uint32_t mirror;
    const Lod& lod;
    int64_t origin[3]; // of all rays, rounded up to voxels, mirrored frame
    uint64_t words_read = 0;
    uint32_t uncounted_work = 0;

    Lanes key(int group, int axis, double plane) const {
        return all(plane) * tile.scale[group][axis] + tile.offset[group][axis];
    }

    // A node of `size` voxels with its lowest corner at (x, y, z), mirrored frame, and the rays that visit it.
    void node(uint32_t word, double x, double y, double z, double size, const Rays* rays, int count) {
        if (octree::is_leaf(word)) {
            hit(octree::material(word), x, y, z, rays, count);
            return;
        }
        if (lod.on())
            stop(word, x, y, z, size, rays, count);
        block(word, x, y, z, size, rays, count);
    }

    // Ends the rays that do not go into a block, as its mean material.
    void stop(uint32_t pointer, double x, double y, double z, double size, const Rays* rays, int count) {
        const uint8_t mean = lod.mean(pointer);
        const double distance = std::max({x - static_cast<double>(origin[0]), y - static_cast<double>(origin[1]),
                                          z - static_cast<double>(origin[2])});
        if (mean == 0 || distance < size)
            return;
        Rays stopped[kGroups];
        for (int i = 0; i < count; ++i) {
            const Mask beyond = less(all(size) * tile.reach[rays[i].group], all(distance + 0.5));
            stopped[i] = {rays[i].group, static_cast<Mask>(rays[i].lanes & beyond)};
        }
        hit(mean, x, y, z, stopped, count);
    }

    void hit(uint8_t material, double x, double y, double z, const Rays* rays, int count) {
        for (int i = 0; i < count; ++i) {
            const int group = rays[i].group;
            const Mask lanes = rays[i].lanes & tile.alive[group];
            if (!lanes)
                continue;
            tile.alive[group] &= ~lanes;
            const uint64_t bytes = bytes_of(lanes) * 0xFF;
            tile.material[group] = (tile.material[group] & ~bytes) | (material * 0x0101010101010101u & bytes);
            const Lanes near[3] = {key(group, 0, x), key(group, 1, y), key(group, 2, z)};
            const Lanes entry = larger(larger(near[0], near[1]), near[2]);
            const Mask crossing = lanes & less(all(kStartKey), entry);
            for (int axis = 0; axis < 3; ++axis)
                tile.face[group][axis] |= crossing & equal(entry, near[axis]);
        }
    }

    void block(uint32_t address, double x, double y, double z, double size, const Rays* rays, int count) {
        const double half = size / 2;
        uint32_t octants[8]; // in the order that the rays meet them
        uint64_t filled = 0; // byte i: 0xFF where octant i is more than empty space
        for (uint32_t i = 0; i < 8; ++i) {
            octants[i] = words[address + (i ^ mirror)];
            const bool empty = octree::is_leaf(octants[i]) && octree::material(octants[i]) == 0;
            filled |= (empty ? uint64_t{0} : uint64_t{0xFF}) << 8 * i;
        }
        words_read += 8;
        uncounted_work += 8 + 4 * static_cast<uint32_t>(count);
        if (uncounted_work > kUncountedWork) {
            count_tile_work(uncounted_work);
            uncounted_work = 0;
        }

        Rays visitors[8][kGroups];
        int visits[8] = {};
        for (int i = 0; i < count; ++i) {
            const uint8_t group = rays[i].group;
            const Mask lanes = rays[i].lanes & tile.alive[group];
            if (!lanes)
                continue;
            // The keys of the low, middle and high planes of each axis.
            const Lanes x0 = key(group, 0, x), x1 = key(group, 0, x + half), x2 = key(group, 0, x + size);
            const Lanes y0 = key(group, 1, y), y1 = key(group, 1, y + half), y2 = key(group, 1, y + size);
            const Lanes z0 = key(group, 2, z), z1 = key(group, 2, z + half), z2 = key(group, 2, z + size);
            const Lanes start = all(kStartKey), near_z0 = larger(z0, start), near_z1 = larger(z1, start);
            const Lanes entry[4] = {larger(x0, y0), larger(x1, y0), larger(x0, y1), larger(x1, y1)};
            const Lanes exit[4] = {smaller(x1, y1), smaller(x2, y1), smaller(x1, y2), smaller(x2, y2)};
            uint64_t visiting = 0; // byte i: the rays that visit octant i
            for (int i = 0; i < 4; ++i) {
                visiting |= uint64_t{less(larger(entry[i], near_z0), smaller(exit[i], z1))} << 8 * i;
                visiting |= uint64_t{less(larger(entry[i], near_z1), smaller(exit[i], z2))} << (8 * i + 32);
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

    // No ray stops at the root.
    void start(uint32_t word, double side, const Rays* rays, int count) {
        if (octree::is_leaf(word))
            hit(octree::material(word), 0, 0, 0, rays, count);
        else
            block(word, 0, 0, 0, side, rays, count);
    }

    // Traces the rays that are mirrored as `mirror` says; `word` is the root.
    void root(uint32_t word, double side) {
        words_read += 1;
        if (octree::is_leaf(word) && octree::material(word) == 0)
            return;
        Rays rays[kGroups];
        int count = 0;
        for (int group = 0; group < kGroups; ++group) {
            Mask lanes = tile.alive[group];
            Lanes entry = all(kStartKey), exit = all(1e300);
            for (int axis = 0; axis < 3; ++axis) {
                const Mask mirrored = tile.mirrored[group][axis];
                lanes &= mirror >> axis & 1 ? mirrored : ~mirrored;
                entry = larger(entry, key(group, axis, 0));
                exit = smaller(exit, key(group, axis, side));
            }
            lanes &= less(entry, exit);
            if (lanes)
                rays[count++] = {static_cast<uint8_t>(group), lanes};
        }
        if (count)
            start(word, side, rays, count);
    }
};

// Traces the rays of `tile` that are alive through the job's memory. Returns how many octree words were read. A ray
// without any direction must not be alive.
inline uint64_t trace_tile(const FrameJob& job, Tile& tile) {
    const int64_t side = int64_t{1} << job.memory.depth();
    uint64_t words_read = 0;
    Mask some[3] = {0, 0, 0}, every[3] = {0xFF, 0xFF, 0xFF}; // mirrored on each axis
    for (int group = 0; group < kGroups; ++group)
        for (int axis = 0; axis < 3; ++axis) {
            some[axis] |= tile.mirrored[group][axis];
            every[axis] &= tile.mirrored[group][axis];
        }
    const auto occurs = [&](uint32_t mirror) {
        for (int axis = 0; axis < 3; ++axis)
            if (mirror >> axis & 1 ? some[axis] == 0 : every[axis] == 0xFF)
                return false;
        return true;
    };
    for (uint32_t mirror = 0; mirror < 8; ++mirror)
        if (occurs(mirror)) {
            Walk walk{job.memory.words(), tile, mirror, job.lod, {}};
            for (int axis = 0; axis < 3; ++axis) {
                const int64_t position = job.camera.position[axis];
                walk.origin[axis] = ((mirror >> axis & 1 ? 16 * side - position : position) + 15) >> 4;
            }
            walk.root(job.memory.root(), static_cast<double>(side));
            words_read += walk.words_read;
        }
    return words_read;
}

} // namespace
} // namespace voxrt::sim
