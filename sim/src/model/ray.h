// One ray through the octree, exactly: the first solid cell on the real ray and the plane crossed into it.
//
// The ray is mirrored so that no direction component is negative. Multiplying the ray's parameter by the product of
// the direction's components (a zero one counts as 1) makes the crossing of every plane p an integer,
//     T = (p - origin) * w,   w_x = |d_y| |d_z| and so on,
// so planes are ordered by the pair (T, axis) without division, rounding or ties. `Key` is int64_t where all T fit
// (key_fits_64) and __int128 otherwise; both give the same hit.
#pragma once

#include "memory.h"

#include <bit>
#include <cstdint>

namespace voxrt::model {

inline constexpr int32_t kDirectionLimit = 1 << 20;
inline constexpr int32_t kPositionUnit = 16; // camera positions count 1/16 voxel

using WideKey = __int128;

// A straight line: positions and directions in 1/unit voxel, grid frame.
struct Line {
    int64_t origin[3];
    int64_t direction[3];
    int32_t unit = kPositionUnit;
};

// What a ray met. Miss: material 0, face kFaceNone, cell (-1, -1, -1). Origin in a solid: face kFaceNone.
template <class Key> struct Hit {
    uint8_t material = 0;
    uint8_t face = kFaceNone;
    int32_t cell[3] = {-1, -1, -1};
    Key time = 0;            // T of the plane crossed into the cell
    uint32_t words_read = 0; // of blocks, as the hardware reads them: it keeps word 0 between rays
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

// A word that a ray read, and where the ray stood then: behind plane `face` (kFaceNone: of none), crossed at T = time.
// Where the ray enters the word's octant, that plane is the last of those it crosses on entering.
template <class Key> struct Reading {
    uint32_t address;
    uint32_t word;
    int level;         // the word's octant is 2^level voxels a side
    int32_t corner[3]; // its lowest cell, grid frame
    uint8_t face;
    Key time;
};

template <class Key> class Ray {
public:
    Ray(const Memory& memory, const Line& line) : memory_(&memory), unit_(line.unit), side_(1 << memory.depth) {
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

    // Puts the ray behind the crossing of a plane of `axis` at T = time: it goes on from there.
    void pass(Key time, int axis) {
        for (int other = 0; other < 3; ++other)
            passed_[other] = time + (other <= axis ? 1 : 0);
        time_ = time;
        face_ = static_cast<uint8_t>(axis);
    }

    // The first solid cell at or behind the place where the ray stands.
    Hit<Key> trace() {
        return trace([](const Reading<Key>&) {});
    }

    // The same; calls read(Reading<Key>) for each of the hit's words_read words, in the order that they are read.
    template <class Read> Hit<Key> trace(Read&& read);

    // The 1/unit voxel, on `axis`, in which the ray stood when it crossed into the hit that trace() gave.
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
    // Takes the half of the node, of 2 * half voxels and lowest cell corner, in which the ray stands. Its octant.
    uint32_t descend(int32_t corner[3], int32_t half) const {
        uint32_t octant = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const bool upper = is_behind(axis, corner[axis] + half);
            corner[axis] += upper ? half : 0;
            octant |= static_cast<uint32_t>(upper) << axis;
        }
        return octant;
    }

    const Memory* memory_;
    int32_t unit_;
    int32_t side_;
    uint32_t mirror_ = 0; // bit a: axis a is mirrored; turns an octant's index between the frames
    bool alive_[3];
    Key start_[3], weight_[3];
    // Where the ray stands: planes of axis a with T < passed[a] are behind it; first those through its origin.
    Key passed_[3] = {1, 1, 1};
    Key time_ = 0;
    uint8_t face_ = kFaceNone;
};

template <class Key> template <class Read> Hit<Key> Ray<Key>::trace(Read&& read) {
    // From outside the world the ray enters across the last of its near sides.
    for (int axis = 0; axis < 3; ++axis)
        if (alive_[axis]) {
            if (const Key time = crossing(axis, 0); time >= passed_[axis])
                pass(time, axis);
        } else if (!is_behind(axis, 0)) {
            return {};
        }
    for (int axis = 0; axis < 3; ++axis)
        if (is_behind(axis, side_))
            return {};

    int32_t corner[3] = {0, 0, 0};    // lowest cell of the node at hand, mirrored frame
    int level = memory_->depth;       // the node is 2^level voxels a side
    uint32_t block_at[kMaxDepth + 1]; // block whose octants are 2^level a side
    uint32_t word = memory_->words[0];
    uint32_t words_read = 0;
    const auto read_octant = [&](uint32_t octant) {
        const uint32_t address = block_at[level] + (octant ^ mirror_);
        word = memory_->words[address];
        ++words_read;
        Reading<Key> reading{address, word, level, {}, face_, time_};
        for (int axis = 0; axis < 3; ++axis)
            reading.corner[axis] = mirror_ >> axis & 1 ? side_ - corner[axis] - (1 << level) : corner[axis];
        read(reading);
    };
    for (;;) {
        while (!is_leaf(word)) {
            block_at[--level] = word;
            read_octant(descend(corner, 1 << level));
        }
        if (material_of(word) != 0) {
            while (level > 0) // the cell of a larger leaf in which the ray stands
                descend(corner, 1 << --level);
            Hit<Key> hit{material_of(word), face_, {}, time_, words_read};
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
        pass(first, out);
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

} // namespace voxrt::model
