// frame_tile.h's render_tile for the instruction set of the including file, which defines VOXRT_RENDER_TILE as its
// name.
#include "frame_tile.h"
#include "tile.h"
#include "tile_walk.h"

#include <cstring>

namespace voxrt::sim {
namespace {

constexpr int kGroupsAcross = kTileSide / kLanes;

// The first pixel of a group; the others are to its right.
struct GroupPixel {
    int32_t column, row;
};
inline GroupPixel first_pixel(int32_t left, int32_t top, int group) {
    return {left + group % kGroupsAcross * kLanes, top + group / kGroupsAcross};
}

// The directions of a group's rays: whole numbers, exact.
struct Directions {
    Lanes d[3];
};
inline Directions directions_of(const FrameJob& job, GroupPixel first) {
    Directions out;
    for (int axis = 0; axis < 3; ++axis) {
        const double right = job.camera.right[axis];
        const double start = job.camera.look[axis] + right * (first.column - job.frame.width / 2) +
                             static_cast<double>(job.camera.up[axis]) * (job.frame.height / 2 - first.row);
        out.d[axis] = ramp(start, right);
    }
    return out;
}

// Bit i: pixel i of the group lies in the frame.
inline Mask in_frame(const FrameJob& job, GroupPixel first) {
    const int32_t columns = first.row < job.frame.height ? job.frame.width - first.column : 0;
    return static_cast<Mask>(columns >= kLanes ? 0xFF : columns > 0 ? (1 << columns) - 1 : 0);
}

inline Lanes reach_of(const FrameJob& job, GroupPixel first) {
    double reach[kLanes];
    for (int lane = 0; lane < kLanes; ++lane) {
        int64_t direction[3];
        for (int axis = 0; axis < 3; ++axis)
            direction[axis] = job.camera.look[axis] +
                              int64_t{job.camera.right[axis]} * (first.column + lane - job.frame.width / 2) +
                              int64_t{job.camera.up[axis]} * (job.frame.height / 2 - first.row);
        reach[lane] = static_cast<double>(lod_reach(job.lod, direction));
    }
    Lanes out;
    std::memcpy(&out, reach, sizeof out);
    return out;
}

inline void set_up(Tile& tile, const FrameJob& job, int32_t left, int32_t top) {
    const double world = 16.0 * (1 << job.memory.depth());
    const Lanes zero = all(0);
    for (int group = 0; group < kGroups; ++group) {
        const GroupPixel first = first_pixel(left, top, group);
        const Directions rays = directions_of(job, first);
        Lanes size[3];
        Mask still = 0xFF;
        for (int axis = 0; axis < 3; ++axis) {
            const Lanes d = rays.d[axis];
            tile.mirrored[group][axis] = less(d, zero);
            still &= equal(d, zero);
            size[axis] = larger(larger(d, zero - d), all(1));
            tile.face[group][axis] = 0;
        }
        for (int axis = 0; axis < 3; ++axis) {
            const double origin = job.camera.position[axis];
            const Lanes weight = all(4) * size[(axis + 1) % 3] * size[(axis + 2) % 3];
            const Lanes start = choose(tile.mirrored[group][axis], all(world - origin), all(origin));
            tile.scale[group][axis] = all(16) * weight;
            tile.offset[group][axis] = all(axis) - start * weight;
            if (const Mask dead = equal(rays.d[axis], zero)) {
                const double rest = (job.camera.position[axis] >> 4) + 0.5; // in the middle of a cell, so on no plane
                tile.scale[group][axis] = choose(dead, all(kNeverKey), tile.scale[group][axis]);
                tile.offset[group][axis] = choose(dead, all(-rest * kNeverKey), tile.offset[group][axis]);
            }
        }
        if (job.lod.on())
            tile.reach[group] = reach_of(job, first);
        tile.alive[group] = in_frame(job, first) & ~still;
        tile.material[group] = bytes_of(still) * job.material_at_camera;
    }
}

// What the colours of hits on faces are multiplied by: docs/shading.md.
struct Brightness {
    Lanes part, whole;
};
inline Brightness brightness_of(const Tile& tile, const Shading& shading, int group, const Directions& rays) {
    const Mask x = tile.face[group][0], y = tile.face[group][1];
    Lanes of_axis[3];
    if (shading.flat)
        return {all(1), all(1)};
    if (shading.faces) {
        for (int axis = 0; axis < 3; ++axis)
            of_axis[axis] = choose(tile.mirrored[group][axis], all((*shading.faces)[2 * axis + 1]),
                                   all((*shading.faces)[2 * axis]));
        return {choose(x, of_axis[0], choose(y, of_axis[1], of_axis[2])), all(kFaceUnit)};
    }
    for (int axis = 0; axis < 3; ++axis)
        of_axis[axis] = rays.d[axis] * rays.d[axis];
    return {choose(x, of_axis[0], choose(y, of_axis[1], of_axis[2])), of_axis[0] + of_axis[1] + of_axis[2]};
}

// The pixels of a group: a byte each, three for colours.
struct Pixels {
    uint64_t material;
    uint64_t face;
    uint8_t colour[3 * kLanes + 1];
};
inline Pixels shade(const Tile& tile, const FrameJob& job, int group, const Directions& rays) {
    const Mask x = tile.face[group][0], y = tile.face[group][1], z = tile.face[group][2];
    const Mask none = static_cast<Mask>(~(x | y | z));
    Pixels out;
    out.material = tile.material[group];
    out.face = bytes_of(y | none) | bytes_of(z | none) << 1;

    uint8_t material[kLanes];
    std::memcpy(material, &out.material, kLanes);
    double colours[3][kLanes];
    for (int channel = 0; channel < 3; ++channel)
        for (int lane = 0; lane < kLanes; ++lane)
            colours[channel][lane] = job.shading.materials[3 * material[lane] + channel];
    Lanes surface[3];
    std::memcpy(surface, colours, sizeof surface);

    // round(c part / whole), half up; c itself where no face was crossed. The quotient in doubles has the exact one's
    // floor: a quotient n / m with m < 2^43 stays 1 / m below the next whole number k <= 255, more than half an ulp of
    // k.
    const Brightness brightness = brightness_of(tile, job.shading, group, rays);
    const Lanes part = choose(none, all(1), brightness.part), whole = choose(none, all(1), brightness.whole);
    int32_t channels[3][kLanes];
    const Lanes two = all(2);
    for (int channel = 0; channel < 3; ++channel)
        store_as_int(channels[channel], (two * surface[channel] * part + whole) / (two * whole));
    for (int lane = 0; lane < kLanes; ++lane) {
        const int32_t pixel = channels[0][lane] | channels[1][lane] << 8 | channels[2][lane] << 16;
        std::memcpy(out.colour + 3 * lane, &pixel, 4); // the next pixel overwrites the fourth byte
    }
    return out;
}

} // namespace

uint64_t VOXRT_RENDER_TILE(const FrameJob& job, int32_t left, int32_t top) {
    Tile tile;
    set_up(tile, job, left, top);
    const uint64_t words_read = trace_tile(job, tile);
    for (int group = 0; group < kGroups; ++group) {
        const GroupPixel first = first_pixel(left, top, group);
        if (first.row >= job.frame.height || first.column >= job.frame.width)
            continue;
        const Pixels pixels = shade(tile, job, group, directions_of(job, first));
        const size_t pixel = static_cast<size_t>(first.row) * job.frame.width + first.column;
        const size_t count = job.frame.width - first.column < kLanes ? job.frame.width - first.column : kLanes;
        std::memcpy(job.frame.colour + 3 * pixel, pixels.colour, 3 * count);
        std::memcpy(job.frame.face + pixel, &pixels.face, count);
        std::memcpy(job.frame.material + pixel, &pixels.material, count);
    }
    return words_read;
}

} // namespace voxrt::sim
