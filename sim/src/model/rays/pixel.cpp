#include "pixel.h"

#include "ray.h"

#include <algorithm>

namespace voxrt::sim {
namespace {

constexpr int32_t kLightUnit = 2 * kPositionUnit;

// floor((2 c part + whole) / (2 whole)): c part / whole, rounded half up.
void scale_colour(const uint8_t* from, WideKey part, WideKey whole, uint8_t* to) {
    for (int channel = 0; channel < 3; ++channel)
        to[channel] = static_cast<uint8_t>((2 * from[channel] * part + whole) / (2 * whole));
}

struct Square {
    WideKey part, whole; // of one component, of the length
};
Square square_of(const int64_t vector[3], int axis) {
    WideKey squares[3], whole = 0;
    for (int i = 0; i < 3; ++i)
        whole += squares[i] = WideKey{vector[i]} * vector[i];
    return {squares[axis], whole};
}

// The brightness of a face, where it does not depend on the angle: 1/kFaceUnit. `d` is the ray's component across it.
WideKey face_brightness(const Shading& shading, uint8_t face, int64_t d) {
    return shading.flat ? kFaceUnit : (*shading.faces)[2 * face + (d < 0 ? 1 : 0)];
}

// Whether `shadow_ray`, whose direction ends at the light, meets a solid cell before the light.
template <class Key>
bool is_shadowed(const octree::VerifiedMemory& memory, const Line& shadow_ray, uint32_t& words_read) {
    Key light_time = 1;
    for (const int64_t component : shadow_ray.direction)
        if (component != 0)
            light_time *= component < 0 ? -component : component;
    const Hit<Key> hit = Ray<Key>(memory, shadow_ray).trace();
    words_read += hit.words_read;
    return hit.material != 0 && hit.time < light_time;
}

template <class Key>
void light_colour(const octree::VerifiedMemory& memory, const Shading& shading, const Ray<Key>& ray,
                  const Hit<Key>& hit, const Line& line, Pixel& pixel) {
    const uint8_t* const surface = shading.materials + 3 * hit.material;
    const Light& light = *shading.light;
    Line shadow_ray{{}, {}, kLightUnit};
    for (int axis = 0; axis < 3; ++axis) {
        shadow_ray.origin[axis] = axis == hit.face
                                      ? int64_t{kLightUnit} * (hit.cell[axis] + (line.direction[axis] < 0 ? 1 : 0))
                                      : 2 * ray.sub_cell(hit, axis) + 1;
        shadow_ray.direction[axis] = 2 * int64_t{light.position[axis]} - shadow_ray.origin[axis];
    }
    const int64_t towards = shadow_ray.direction[hit.face];
    const bool faces_away = towards == 0 || (towards > 0) == (line.direction[hit.face] > 0);
    const bool dark =
        faces_away || (key_fits_64(shadow_ray) ? is_shadowed<int64_t>(memory, shadow_ray, pixel.words_read)
                                               : is_shadowed<WideKey>(memory, shadow_ray, pixel.words_read));
    const Square square = square_of(shadow_ray.direction, hit.face);
    if (shading.flat || shading.faces)
        scale_colour(surface,
                     face_brightness(shading, hit.face, line.direction[hit.face]) * (dark ? light.ambient : 256),
                     WideKey{kFaceUnit} * 256, pixel.colour);
    else if (dark || 256 * square.part <= light.ambient * square.whole)
        scale_colour(surface, light.ambient, 256, pixel.colour);
    else
        scale_colour(surface, square.part, square.whole, pixel.colour);
}

template <class Key>
Pixel traced(const octree::VerifiedMemory& memory, const Shading& shading, const Lod& lod, Line line) {
    Pixel pixel{{}, 0, kFaceNone, 0};
    uint32_t sum[3] = {0, 0, 0};
    Ray<Key> ray(memory, line);
    ray.use(lod, line);
    for (int bounce = 0;; ++bounce) {
        const Hit<Key> hit = ray.trace();
        pixel.words_read += hit.words_read;
        pixel.material = hit.material;
        pixel.face = hit.face;
        const uint8_t* const surface = shading.materials + 3 * hit.material;
        if (hit.face == kFaceNone) {
            std::copy_n(surface, 3, pixel.colour);
            return pixel;
        }
        if (shading.bounces == 0 || !shading.mirrors[hit.material]) {
            if (shading.light)
                light_colour(memory, shading, ray, hit, line, pixel);
            else if (shading.flat || shading.faces)
                scale_colour(surface, face_brightness(shading, hit.face, line.direction[hit.face]), kFaceUnit,
                             pixel.colour);
            else if (const Square square = square_of(line.direction, hit.face); true)
                scale_colour(surface, square.part, square.whole, pixel.colour);
            return pixel;
        }
        for (int channel = 0; channel < 3; ++channel)
            sum[channel] += surface[channel];
        if (bounce == shading.bounces) {
            const uint32_t mirrors = static_cast<uint32_t>(bounce) + 1;
            for (int channel = 0; channel < 3; ++channel)
                pixel.colour[channel] = static_cast<uint8_t>((2 * sum[channel] + mirrors) / (2 * mirrors));
            return pixel;
        }
        // The mirror image of the ray, from the plane on.
        const int64_t plane = hit.cell[hit.face] + (line.direction[hit.face] < 0 ? 1 : 0);
        line.origin[hit.face] = 2 * kPositionUnit * plane - line.origin[hit.face];
        line.direction[hit.face] = -line.direction[hit.face];
        ray = Ray<Key>(memory, line);
        ray.start_behind(hit.time, hit.face);
    }
}

} // namespace

Pixel trace_pixel(const octree::VerifiedMemory& memory, const Shading& shading, const Lod& lod, const int32_t origin[3],
                  const int32_t direction[3]) {
    Line line{}, farthest{};
    for (int axis = 0; axis < 3; ++axis) {
        line.origin[axis] = origin[axis];
        line.direction[axis] = direction[axis];
        const int64_t distance = int64_t{origin[axis]} < 0 ? -int64_t{origin[axis]} : int64_t{origin[axis]};
        farthest.origin[axis] = distance + (int64_t{2 * kPositionUnit * shading.bounces} << memory.depth());
        farthest.direction[axis] = direction[axis];
    }
    return key_fits_64(farthest) ? traced<int64_t>(memory, shading, lod, line)
                                 : traced<WideKey>(memory, shading, lod, line);
}

} // namespace voxrt::sim
