// The walk that tile.h describes, for the instruction set of the including file.
#pragma once

#include "lanes.h"
#include "tile.h"

namespace voxrt::model {
namespace {

struct Rays {
    uint8_t group;
    uint8_t lanes; // bit i: lane i
};

struct Walk {
    const uint32_t* words;
    Tile& tile;
    uint32_t mirror;
    uint64_t words_read;

    // A node of `size` voxels with its lowest corner at (x, y, z), mirrored frame, and the rays that visit it.
    void node(uint32_t word, double x, double y, double z, double size, const Rays* rays, int count) {
        if (is_leaf(word))
            hit(material_of(word), x, y, z, rays, count);
        else
            block(word, x, y, z, size, rays, count);
    }

    void hit(uint8_t material, double x, double y, double z, const Rays* rays, int count) {
        for (int i = 0; i < count; ++i) {
            const int group = rays[i].group;
            const uint8_t lanes = rays[i].lanes & tile.alive[group];
            if (!lanes)
                continue;
            tile.alive[group] &= ~lanes;
            const auto& scale = tile.scale[group];
            const auto& offset = tile.offset[group];
            const Lanes near_x = multiply_add(all(x), load(scale[0]), load(offset[0]));
            const Lanes near_y = multiply_add(all(y), load(scale[1]), load(offset[1]));
            const Lanes near_z = multiply_add(all(z), load(scale[2]), load(offset[2]));
            store(tile.entry[group], larger(larger(near_x, near_y), near_z), lanes);
            for (int lane = 0; lane < kLanes; ++lane)
                if (lanes >> lane & 1)
                    tile.material[group][lane] = material;
        }
    }

    void block(uint32_t address, double x, double y, double z, double size, const Rays* rays, int count) {
        const double half = size / 2;
        uint32_t octants[8]; // the words that are not empty space, in the order the rays meet them
        int places[8];
        int filled = 0;
        for (uint32_t place = 0; place < 8; ++place) {
            const uint32_t word = words[address + (place ^ mirror)];
            octants[filled] = word;
            places[filled] = static_cast<int>(place);
            filled += !(is_leaf(word) && material_of(word) == 0);
        }
        words_read += 8;

        Rays visitors[8][kGroups];
        int visits[8] = {};
        for (int i = 0; i < count; ++i) {
            const uint8_t group = rays[i].group;
            const uint8_t lanes = rays[i].lanes & tile.alive[group];
            if (!lanes)
                continue;
            // The keys of the low, middle and high planes of each axis.
            const auto key = [&](int axis, double plane) {
                return multiply_add(all(plane), load(tile.scale[group][axis]), load(tile.offset[group][axis]));
            };
            const Lanes x1 = key(0, x + half), y1 = key(1, y + half), z1 = key(2, z + half);
            const Lanes x0 = larger(key(0, x), all(kStartKey)), y0 = key(1, y), z0 = key(2, z);
            const Lanes x2 = key(0, x + size), y2 = key(1, y + size), z2 = key(2, z + size);
            const Lanes entry[4] = {larger(x0, y0), larger(larger(x1, all(kStartKey)), y0), larger(x0, y1),
                                    larger(larger(x1, all(kStartKey)), y1)};
            const Lanes exit[4] = {smaller(x1, y1), smaller(x2, y1), smaller(x1, y2), smaller(x2, y2)};
            for (int j = 0; j < filled; ++j) {
                const int place = places[j];
                const bool far = place >= 4;
                const uint8_t visiting =
                    lanes & less(larger(entry[place & 3], far ? z1 : z0), smaller(exit[place & 3], far ? z2 : z1));
                visitors[j][visits[j]] = {group, visiting};
                visits[j] += visiting != 0;
            }
        }
        for (int j = 0; j < filled; ++j)
            if (visits[j])
                node(octants[j], x + (places[j] & 1 ? half : 0), y + (places[j] & 2 ? half : 0),
                     z + (places[j] & 4 ? half : 0), half, visitors[j], visits[j]);
    }

    // Traces the rays that are mirrored like this walk.
    void root(double side) {
        const uint32_t word = words[0];
        words_read += 1;
        if (is_leaf(word) && material_of(word) == 0)
            return;
        Rays rays[kGroups];
        int count = 0;
        for (int group = 0; group < kGroups; ++group) {
            uint8_t lanes = 0;
            for (int lane = 0; lane < kLanes; ++lane)
                lanes |= static_cast<uint8_t>((tile.mirror[group][lane] == mirror) << lane);
            lanes &= tile.alive[group];
            Lanes entry = all(kStartKey), exit = all(1e300);
            for (int axis = 0; axis < 3; ++axis) {
                const Lanes scale = load(tile.scale[group][axis]), offset = load(tile.offset[group][axis]);
                entry = larger(entry, offset);
                exit = smaller(exit, multiply_add(all(side), scale, offset));
            }
            lanes &= less(entry, exit);
            if (lanes)
                rays[count++] = {static_cast<uint8_t>(group), lanes};
        }
        if (count)
            node(word, 0, 0, 0, side, rays, count);
    }
};

// Traces the rays of `tile` that are alive through a verified memory. Returns how many octree words were read. A ray
// without any direction must not be alive.
inline uint64_t trace_tile(const Memory& memory, Tile& tile) {
    uint64_t words_read = 0;
    uint32_t mirrors = 0; // bit m: some ray is mirrored as m says
    for (int group = 0; group < kGroups; ++group)
        for (int lane = 0; lane < kLanes; ++lane)
            mirrors |= (tile.alive[group] >> lane & 1u) << tile.mirror[group][lane];
    for (uint32_t mirror = 0; mirror < 8; ++mirror)
        if (mirrors >> mirror & 1) {
            Walk walk{memory.words, tile, mirror, 0};
            walk.root(static_cast<double>(1 << memory.depth));
            words_read += walk.words_read;
        }
    return words_read;
}

} // namespace
} // namespace voxrt::model
