// One ray through an octree, exactly: the first solid voxel on the real line, and the plane crossed into it.
//
//     const octree::VerifiedMemory memory({words.data(), words.size(), depth});
//     const Line line{{0, 0, 0}, {3, 1, 2}};                  // origin in 1/16 voxel, direction
//     const Hit<WideKey> hit = Ray<WideKey>(memory, line).trace();
//
// The ray is mirrored so that no direction component is negative. Its parameter is multiplied by the product of the
// direction's components (a zero one counts as 1). Then the crossing of every plane p is an integer,
//     T = (p - origin) * w,   w_x = |d_y| |d_z| and so on,
// and the pair (T, axis) orders all planes, without division, rounding or ties. Descending into octants by mirrored
// octant index: Revelles, Urena and Lastra, "An Efficient Parametric Algorithm for Octree Traversal", 2000. Leaving a
// leaf, the highest changed bit of the position names the common ancestor: Laine and Karras, "Efficient Sparse Voxel
// Octrees", 2010.
//
// `Key` is int64_t where all T fit (key_fits_64), else WideKey; both give the same hit. Cost: about 10 to 30 words read
// per ray. No errors: the memory is verified, and a line of any origin and direction below kDirectionLimit is valid.
#pragma once

#include "lod.h"

#include <voxrt/octree/words/verify.h>

#include <bit>
#include <cstdint>

namespace voxrt::sim {

inline constexpr uint8_t kFaceNone = 3;             // in place of an axis: no plane was crossed
inline constexpr int32_t kDirectionLimit = 1 << 20; // components of directions are below it
inline constexpr int32_t kPositionUnit = 16;        // camera positions count 1/16 voxel

using WideKey = __int128;

// A straight line: positions and directions in 1/unit voxel, grid frame.
struct Line {
    int64_t origin[3];
    int64_t direction[3];
    int32_t unit = kPositionUnit;
};

// What a ray hit. A miss: material 0, face kFaceNone, cell (-1, -1, -1). An origin inside a solid: face kFaceNone.
template <class Key> struct Hit {
    uint8_t material = 0;
    uint8_t face = kFaceNone;       // axis of the plane crossed into the voxel
    int32_t cell[3] = {-1, -1, -1}; // the voxel, grid frame
    Key time = 0;                   // T of that plane
    uint32_t words_read = 0;        // as the hardware reads them: it keeps word 0 between rays
};

// Whether every T of a ray fits in 63 bits: |p - origin| < 2^23 on either side of the mirror, w < 2^40.
inline bool key_fits_64(const Line& line) {
    for (int axis = 0; axis < 3; ++axis) {
        const int64_t origin = line.origin[axis], direction = line.direction[axis];
        if (origin <= -(1 << 22) || origin >= 1 << 22 || direction <= -kDirectionLimit || direction >= kDirectionLimit)
            return false;
    }
    return true;
}

// A word that a ray read. The last plane that the ray had crossed then is across axis `face` (kFaceNone: none), at
// T = time. Where the ray enters the word's octant, that is the last of the planes crossed on entering.
template <class Key> struct Reading {
    uint32_t address;
    uint32_t word;
    int level;         // the word's octant is 2^level voxels per side
    int32_t corner[3]; // its lowest cell, grid frame
    uint8_t face;
    Key time;
};

template <class Key> class Ray {
public:
    Ray(const octree::VerifiedMemory& memory, const Line& line)
        : words_(memory.words()), root_(memory.root()), depth_(static_cast<int>(memory.depth())), unit_(line.unit),
          side_(1 << depth_) {
        for (int axis = 0; axis < 3; ++axis) {
            const int64_t d = line.direction[axis];
            alive_[axis] = d != 0;
            mirror_ |= static_cast<uint32_t>(d < 0) << axis;
            start_[axis] = d < 0 ? Key{unit_} * side_ - line.origin[axis] : Key{line.origin[axis]};
            weight_[axis] = 1;
            for (int other = 0; other < 3; ++other)
                if (other != axis && line.direction[other] != 0)
                    weight_[axis] *= line.direction[other] < 0 ? -line.direction[other] : line.direction[other];
        }
    }

    // Lets the ray stop at cells that are not wider than a pixel. Its positions count 1/kPositionUnit voxel.
    void use(const Lod& lod, const Line& line) {
        lod_ = lod;
        reach_ = lod_reach(lod, line.direction);
    }

    // Moves the start of the ray to its crossing of a plane across `axis` at T = time.
    void start_behind(Key time, int axis) {
        for (int other = 0; other < 3; ++other)
            passed_[other] = time + (other <= axis ? 1 : 0);
        time_ = time;
        face_ = static_cast<uint8_t>(axis);
    }

    // The first solid voxel from the start of the ray on.
    Hit<Key> trace() {
        return trace([](const Reading<Key>&) {});
    }

    // The same, and calls read(Reading<Key>) for each of the hit's words_read words, in the order in which they are
    // read.
    template <class Read> Hit<Key> trace(Read&& read);

    // The coordinate along `axis`, floor in 1/unit voxel, of the point where the ray crossed into the hit of trace().
    int64_t sub_cell(const Hit<Key>& hit, int axis) const {
        if (!alive_[axis])
            return static_cast<int64_t>(start_[axis]);
        const bool mirrored = mirror_ >> axis & 1;
        const int64_t cell = mirrored ? side_ - 1 - hit.cell[axis] : hit.cell[axis];
        int64_t place = cell * unit_;
        for (int64_t half = unit_ / 2; half > 0; half /= 2)
            if ((Key{place} + half - start_[axis]) * weight_[axis] < passed_[axis])
                place += half;
        return mirrored ? int64_t{side_} * unit_ - 1 - place : place;
    }

private:
    // T of the plane between cells plane - 1 and plane.
    Key crossing(int axis, int32_t plane) const { return (Key{unit_} * plane - start_[axis]) * weight_[axis]; }
    bool is_behind(int axis, int32_t plane) const {
        return alive_[axis] ? crossing(axis, plane) < passed_[axis] : start_[axis] >= Key{unit_} * plane;
    }
    // Whether the ray stops at the octant of 2^level voxels per side with that pointer.
    bool stops(uint32_t pointer, const int32_t corner[3], int level) const {
        if (!lod_.on() || lod_.mean(pointer) == 0)
            return false;
        int64_t distance = 0;
        for (int axis = 0; axis < 3; ++axis)
            distance = std::max(distance, static_cast<int64_t>((Key{unit_} * corner[axis] - start_[axis]) >> 4));
        return distance >= reach_ << level;
    }
    // Moves `corner`, the lowest cell of a node of 2 * half voxels per side, to the child in which the ray is; returns
    // the octant of that child.
    uint32_t descend(int32_t corner[3], int32_t half) const {
        uint32_t octant = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const bool upper = is_behind(axis, corner[axis] + half);
            corner[axis] += upper ? half : 0;
            octant |= static_cast<uint32_t>(upper) << axis;
        }
        return octant;
    }

    const octree::Word* words_;
    octree::Word root_;
    int depth_;
    int32_t unit_;
    int32_t side_;
    uint32_t mirror_ = 0; // bit a: axis a is mirrored; turns an octant's index between the frames
    bool alive_[3];
    Key start_[3], weight_[3];
    // Where the ray is: planes across axis a with T < passed[a] are behind it; at first those up to its origin.
    Key passed_[3] = {1, 1, 1};
    Key time_ = 0;
    uint8_t face_ = kFaceNone;
    Lod lod_;
    int64_t reach_ = 0;
};

template <class Key> template <class Read> Hit<Key> Ray<Key>::trace(Read&& read) {
    // From outside the world the ray enters across the last of its near sides.
    for (int axis = 0; axis < 3; ++axis)
        if (alive_[axis]) {
            if (const Key time = crossing(axis, 0); time >= passed_[axis])
                start_behind(time, axis);
        } else if (!is_behind(axis, 0)) {
            return {};
        }
    for (int axis = 0; axis < 3; ++axis)
        if (is_behind(axis, side_))
            return {};

    int32_t corner[3] = {0, 0, 0};            // lowest cell of the current node, mirrored frame
    int level = depth_;                       // the node is 2^level voxels per side
    uint32_t block_at[octree::kMaxDepth + 1]; // block whose octants are 2^level a side
    uint32_t word = root_;
    uint32_t words_read = 0;
    const auto read_octant = [&](uint32_t octant) {
        const uint32_t address = block_at[level] + (octant ^ mirror_);
        word = words_[address];
        ++words_read;
        Reading<Key> reading{address, word, level, {}, face_, time_};
        for (int axis = 0; axis < 3; ++axis)
            reading.corner[axis] = mirror_ >> axis & 1 ? side_ - corner[axis] - (1 << level) : corner[axis];
        read(reading);
    };
    for (;;) {
        // The root is no octant of a block: no ray stops at it.
        while (!octree::is_leaf(word) && (level == depth_ || !stops(word, corner, level))) {
            block_at[--level] = word;
            read_octant(descend(corner, 1 << level));
        }
        const uint8_t material = octree::is_leaf(word) ? octree::material(word) : lod_.mean(word);
        if (material != 0) {
            while (level > 0) // the cell of a larger octant in which the ray is
                descend(corner, 1 << --level);
            Hit<Key> hit{material, face_, {}, time_, words_read};
            for (int axis = 0; axis < 3; ++axis)
                hit.cell[axis] = mirror_ >> axis & 1 ? side_ - 1 - corner[axis] : corner[axis];
            return hit;
        }
        // Leave the leaf by its first far plane.
        int out = -1;
        Key first = 0;
        for (int axis = 0; axis < 3; ++axis) {
            if (!alive_[axis])
                continue;
            const Key time = crossing(axis, corner[axis] + (1 << level));
            if (out < 0 || time < first) {
                out = axis;
                first = time;
            }
        }
        if (out < 0)
            return {.words_read = words_read};
        start_behind(first, out);
        const int32_t left = corner[out];
        corner[out] += 1 << level;
        if (corner[out] == side_)
            return {.words_read = words_read};
        // The smallest ancestor that holds both cells: the highest bit that the step changed.
        level = std::bit_width(static_cast<uint32_t>(left ^ corner[out])) - 1;
        uint32_t octant = 0;
        for (int axis = 0; axis < 3; ++axis) {
            corner[axis] &= -(1 << level);
            octant |= static_cast<uint32_t>(corner[axis] >> level & 1) << axis;
        }
        read_octant(octant);
    }
}

} // namespace voxrt::sim
