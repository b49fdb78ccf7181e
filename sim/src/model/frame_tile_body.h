// frame_tile.h's render_tile for the instruction set of the including file, which defines VOXRT_RENDER_TILE as its
// name.
#include "frame_tile.h"
#include "tile.h"
#include "tile_walk.h"

#include <cstring>

namespace voxrt::model {
namespace {

constexpr int kGroupsAcross = kTileSide / kLanes;

// The group's first pixel; the others stand to its right.
struct Place {
    int32_t column, row;
};
inline Place place_of(int32_t left, int32_t top, int group) {
    return {left + group % kGroupsAcross * kLanes, top + group / kGroupsAcross};
}

// The directions of a group's rays: whole numbers, exact.
struct Directions {
    alignas(64) double d[3][kLanes];
};
inline Directions directions_of(const FrameJob& job, Place place) {
    Directions out;
    for (int axis = 0; axis < 3; ++axis) {
        const double right = job.camera.right[axis];
        const double first = job.camera.look[axis] + right * (place.column - job.frame.width / 2) +
                             static_cast<double>(job.camera.up[axis]) * (job.frame.height / 2 - place.row);
        for (int lane = 0; lane < kLanes; ++lane)
            out.d[axis][lane] = first + right * lane;
    }
    return out;
}

inline void set_up(Tile& tile, const FrameJob& job, int32_t left, int32_t top) {
    const double world = 16.0 * (1 << job.memory.depth);
    for (int group = 0; group < kGroups; ++group) {
        const Place place = place_of(left, top, group);
        const Directions rays = directions_of(job, place);
        alignas(64) double size[3][kLanes];
        for (int axis = 0; axis < 3; ++axis)
            for (int lane = 0; lane < kLanes; ++lane) {
                const double d = rays.d[axis][lane];
                size[axis][lane] = d < 0 ? -d : d > 0 ? d : 1.0;
            }
        for (int axis = 0; axis < 3; ++axis) {
            const double origin = job.camera.position[axis];
            const double rest = (job.camera.position[axis] >> 4) + 0.5; // in the middle of a cell: on no plane
            const double* other = size[(axis + 1) % 3];
            const double* another = size[(axis + 2) % 3];
            for (int lane = 0; lane < kLanes; ++lane) {
                const double d = rays.d[axis][lane];
                const double weight = 4 * other[lane] * another[lane];
                const double start = d < 0 ? world - origin : origin;
                tile.scale[group][axis][lane] = d == 0 ? kNeverKey : 16 * weight;
                tile.offset[group][axis][lane] = d == 0 ? -rest * kNeverKey : axis - start * weight;
            }
        }
        const Lanes zero = all(0);
        uint32_t mirrored[3], still = 0xFF;
        for (int axis = 0; axis < 3; ++axis) {
            const Lanes d = load(rays.d[axis]);
            mirrored[axis] = less(d, zero);
            still &= ~(mirrored[axis] | less(zero, d));
        }
        for (int lane = 0; lane < kLanes; ++lane)
            tile.mirror[group][lane] = static_cast<uint8_t>((mirrored[0] >> lane & 1) | (mirrored[1] >> lane & 1) << 1 |
                                                            (mirrored[2] >> lane & 1) << 2);
        for (int lane = 0; lane < kLanes; ++lane)
            tile.entry[group][lane] = 0;
        for (int lane = 0; lane < kLanes; ++lane)
            tile.material[group][lane] = still >> lane & 1 ? job.material_at_camera : 0;
        const int32_t across = place.row < job.frame.height ? job.frame.width - place.column : 0;
        const uint32_t seen = across >= kLanes ? 0xFF : across > 0 ? (1u << across) - 1 : 0;
        tile.alive[group] = static_cast<uint8_t>(seen & ~still);
    }
}

// The colours, faces and materials of a group's pixels.
struct Pixels {
    uint8_t colour[kLanes][3];
    uint8_t face[kLanes];
    uint8_t material[kLanes];
};
inline Pixels shade(const Tile& tile, const FrameJob& job, int group, const Directions& rays) {
    Pixels out;
    alignas(64) double surface[3][kLanes], shaded[3][kLanes], length[kLanes], across[kLanes];
    std::memcpy(out.material, tile.material[group], kLanes);
    for (int lane = 0; lane < kLanes; ++lane)
        for (int channel = 0; channel < 3; ++channel)
            surface[channel][lane] = job.materials[3 * out.material[lane] + channel];
    for (int lane = 0; lane < kLanes; ++lane) {
        const double entry = tile.entry[group][lane];
        const int64_t axis = entry < kStartKey ? int64_t{kFaceNone} : static_cast<int64_t>(entry) & 3;
        const double x = rays.d[0][lane] * rays.d[0][lane];
        const double y = rays.d[1][lane] * rays.d[1][lane];
        const double z = rays.d[2][lane] * rays.d[2][lane];
        length[lane] = axis == kFaceNone ? 1.0 : x + y + z;
        across[lane] = axis == 0 ? x : axis == 1 ? y : axis == 2 ? z : 1.0;
        out.face[lane] = static_cast<uint8_t>(axis);
    }
    // round(c d_a^2 / |d|^2), half up. The quotient in doubles has the exact one's floor: a quotient n / m with m <
    // 2^43 stays 1 / m below the next whole number k <= 255, and that is more than half an ulp of k.
    for (int channel = 0; channel < 3; ++channel)
        for (int lane = 0; lane < kLanes; ++lane)
            shaded[channel][lane] = (2 * surface[channel][lane] * across[lane] + length[lane]) / (2 * length[lane]);
    for (int lane = 0; lane < kLanes; ++lane)
        for (int channel = 0; channel < 3; ++channel)
            out.colour[lane][channel] = static_cast<uint8_t>(static_cast<int32_t>(shaded[channel][lane]));
    return out;
}

} // namespace

uint64_t VOXRT_RENDER_TILE(const FrameJob& job, int32_t left, int32_t top) {
    Tile tile;
    set_up(tile, job, left, top);
    const uint64_t words_read = trace_tile(job.memory, tile);
    for (int group = 0; group < kGroups; ++group) {
        const Place place = place_of(left, top, group);
        if (place.row >= job.frame.height || place.column >= job.frame.width)
            continue;
        const Pixels pixels = shade(tile, job, group, directions_of(job, place));
        const size_t pixel = static_cast<size_t>(place.row) * job.frame.width + place.column;
        const size_t count = job.frame.width - place.column < kLanes ? job.frame.width - place.column : kLanes;
        std::memcpy(job.frame.colour + 3 * pixel, pixels.colour, 3 * count);
        std::memcpy(job.frame.face + pixel, pixels.face, count);
        std::memcpy(job.frame.material + pixel, pixels.material, count);
    }
    return words_read;
}

} // namespace voxrt::model
