#include "baked_light.h"

#include "received_light.h"

#include <voxrt/octree/build/build.h>
#include <voxrt/voxelize/colour/srgb.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <numeric>
#include <string>

namespace voxrt::sim {

namespace {

constexpr std::size_t kMostInside = 16;                           // materials of voxels that are not exposed
constexpr double kSumOfUnitLight = double(std::int64_t{1} << 44); // of light 1 from a direction that is faced
constexpr double kWeight = 1 << 16;
constexpr double kDark = 0.1; // of the sun and an open sky: voxels that receive less have points at their faces

using Counts = std::array<std::int64_t, 256>;

// Voxels that are not baked, by material.
Counts count_inside(const BricksView& bricks, std::span<const std::uint64_t> rows) {
    Counts inside{};
    for (const std::uint8_t material : bricks.cells)
        ++inside[material];
    for (const std::uint64_t row : rows)
        --inside[bricks.cells[row]];
    for (std::size_t i = 0; i < bricks.octant_materials.size(); ++i)
        inside[bricks.octant_materials[i]] += std::int64_t{1} << 3 * bricks.octant_levels[i];
    return inside;
}

struct Kept {
    std::vector<int> ids;                  // that stay: mirrors and the commonest
    std::array<std::uint8_t, 256> nearest; // what each id becomes where it is not exposed: the one of nearest colour
};

Kept choose_kept(const Counts& inside, const std::vector<voxelize::TableMaterial>& materials) {
    std::vector<int> order;
    std::size_t mirrors = 0;
    for (int id = 1; id < 256; ++id)
        if (inside[id] != 0) {
            order.push_back(id);
            mirrors += materials.at(id).mirror;
        }
    std::sort(order.begin(), order.end(), [&](int a, int b) {
        if (materials[a].mirror != materials[b].mirror)
            return materials[a].mirror;
        return inside[a] != inside[b] ? inside[a] > inside[b] : a < b;
    });
    Kept kept;
    kept.ids.assign(order.begin(), order.begin() + std::min(order.size(), std::max(kMostInside, mirrors)));
    std::iota(kept.nearest.begin(), kept.nearest.end(), std::uint8_t{0});
    const auto distance = [&](int a, int b) {
        int sum = 0;
        for (int channel = 0; channel < 3; ++channel) {
            const int apart = materials[a].colour[channel] - materials[b].colour[channel];
            sum += apart * apart;
        }
        return sum;
    };
    for (std::size_t i = kept.ids.size(); i < order.size(); ++i)
        kept.nearest[order[i]] =
            static_cast<std::uint8_t>(*std::min_element(kept.ids.begin(), kept.ids.end(), [&](int a, int b) {
                return distance(a, order[i]) < distance(b, order[i]);
            }));
    return kept;
}

// The new table: kept materials keep their ids, and palette[i] gets free[i].
std::vector<voxelize::TableMaterial> baked_table(const std::vector<voxelize::TableMaterial>& before,
                                                 const std::vector<int>& kept,
                                                 const std::vector<voxelize::Srgb>& palette,
                                                 const std::vector<std::uint8_t>& free) {
    std::map<int, voxelize::TableMaterial> made{{0, before[0]}};
    for (const int id : kept)
        made.emplace(id, before[id]);
    std::vector<std::string> names;
    for (const auto& [_, material] : made)
        names.push_back(material.name);
    for (std::size_t i = 0; i < palette.size(); ++i) {
        char name[16];
        std::snprintf(name, sizeof name, "lit #%02x%02x%02x", palette[i][0], palette[i][1], palette[i][2]);
        std::string own = name;
        while (std::find(names.begin(), names.end(), own) != names.end())
            own += "'";
        names.push_back(own);
        made.emplace(free[i], voxelize::TableMaterial{own, palette[i]});
    }
    std::vector<voxelize::TableMaterial> table;
    for (int id = 0; id <= made.rbegin()->first; ++id) // ids that nothing uses any more keep their materials
        table.push_back(made.contains(id) ? made.at(id) : before.at(id));
    return table;
}

// The light of the sun and the share of the sky's at each point.
class VoxelLight {
public:
    VoxelLight(const ReceivedLight& received, const Daylight& daylight)
        : received_(received), strength_(daylight.sun_light()),
          mean_sky_((daylight.sky[0] + daylight.sky[1] + daylight.sky[2]) / 3) {}

    double sun(std::size_t i) const { return strength_ * static_cast<double>(received_.sun[i]) / kSumOfUnitLight; }
    double sky(std::size_t i) const {
        return static_cast<double>(received_.sky[i]) /
               (kWeight * static_cast<double>(std::max<std::int64_t>(received_.open_sky[i], 1)));
    }
    double total(std::size_t i) const { return sun(i) + mean_sky_ * sky(i); }
    double brightest() const { return strength_ + mean_sky_; }

private:
    ReceivedLight received_;
    double strength_, mean_sky_;
};

} // namespace

MeasuredLight measure_light(const octree::VerifiedMemory& memory, std::span<const std::uint64_t> brick_codes,
                            const SurfacePoints& points, const Daylight& daylight, int threads) {
    const Directions sun = sun_direction(daylight.sun), sky = sky_directions(daylight.samples);
    const auto measured = [&](const SurfacePoints& at) {
        const std::size_t count = at.voxels.size();
        MeasuredLight light{at.voxels, {}, {}, {}};
        std::vector<std::int64_t> unused(count);
        for (auto* one : {&light.sun, &light.sky, &light.open_sky})
            one->resize(count);
        const PointsView view{count, at.origins.data(), at.normals.data()};
        receive_light(memory, view, sun.view(), light.sun.data(), unused.data(), threads, Method::automatic,
                      light_engines()[0]);
        receive_light(memory, view, sky.view(), light.sky.data(), light.open_sky.data(), threads, Method::automatic,
                      light_engines()[0]);
        return light;
    };
    const MeasuredLight first = measured(points);
    const VoxelLight light(first.view(), daylight);
    std::vector<std::uint64_t> dark;
    for (std::size_t i = 0, next; i < first.points.size(); i = next) {
        double most = 0;
        for (next = i; next < first.points.size() && first.points[next] == first.points[i]; ++next)
            most = std::max(most, light.total(next));
        if (most < kDark * light.brightest())
            dark.push_back(first.points[i]);
    }
    const MeasuredLight faces = measured(face_points(memory, brick_codes, dark));
    MeasuredLight all;
    for (std::size_t i = 0, face = 0; i < first.points.size(); ++i) {
        all.add(first, i, 1);
        if (i + 1 == first.points.size() || first.points[i + 1] != first.points[i])
            for (; face < faces.points.size() && faces.points[face] == first.points[i]; ++face)
                all.add(faces, face, 2);
    }
    return all;
}

LitVoxels light_voxels(std::span<const std::uint64_t> points, std::span<const std::uint8_t> cells,
                       const ReceivedLight& received, const std::vector<voxelize::TableMaterial>& materials,
                       const Daylight& daylight) {
    const std::array<double, 256>& linear = voxelize::SrgbCurve::get().linear();
    const VoxelLight light(received, daylight);
    LitVoxels lit;
    for (std::size_t i = 0, next; i < points.size(); i = next) {
        std::size_t best = i;
        for (next = i + 1; next < points.size() && points[next] == points[i]; ++next) // all of a voxel
            if (light.total(next) > light.total(best))
                best = next;
        const voxelize::TableMaterial& material = materials.at(cells[points[i]]);
        if (material.mirror)
            continue;
        voxelize::Srgb colour;
        for (int channel = 0; channel < 3; ++channel) {
            const double channel_light = light.sun(best) + light.sky(best) * daylight.sky[channel];
            colour[channel] = voxelize::srgb_from_linear(linear[material.colour[channel]] * channel_light);
        }
        lit.rows.push_back(points[i]);
        lit.sun.push_back(light.sun(best));
        lit.sky.push_back(light.sky(best));
        lit.colours.push_back(colour);
    }
    return lit;
}

BakedMemory bake_memory(const BricksView& bricks, std::span<const std::uint64_t> rows,
                        std::span<const voxelize::Srgb> lit, const std::vector<voxelize::TableMaterial>& materials,
                        int colours, int threads) {
    const Kept kept = choose_kept(count_inside(bricks, rows), materials);
    std::vector<std::uint8_t> free;
    for (int id = 1; id < 256; ++id)
        if (std::find(kept.ids.begin(), kept.ids.end(), id) == kept.ids.end())
            free.push_back(static_cast<std::uint8_t>(id));
    const std::vector<double> weights(lit.size(), 1.0);
    const voxelize::Palette palette = voxelize::quantize(lit, voxelize::Numbers(std::span<const double>(weights)),
                                                         std::min(colours, static_cast<int>(free.size())));

    std::vector<std::uint8_t> cells(bricks.cells.begin(), bricks.cells.end());
    for (std::uint8_t& material : cells)
        material = kept.nearest[material];
    for (std::size_t i = 0; i < rows.size(); ++i)
        cells[rows[i]] = free[palette.rows[i]];
    std::vector<std::uint8_t> octants;
    for (const std::uint8_t material : bricks.octant_materials)
        octants.push_back(kept.nearest[material]);

    const std::size_t count = bricks.codes.size();
    std::vector<std::uint64_t> masks(8 * count);
    for (std::size_t i = 0; i < cells.size(); ++i)
        masks[i / 64] |= std::uint64_t{cells[i] != 0} << i % 64;
    const std::vector<std::uint8_t> mixed(count, 0);
    std::vector<std::int32_t> brick_rows(count);
    std::iota(brick_rows.begin(), brick_rows.end(), 0);
    return {octree::build({bricks.depth, count, bricks.codes.data(), masks.data(), mixed.data(), brick_rows.data(),
                           count, cells.data(), octants.size(), bricks.octant_codes.data(), bricks.octant_levels.data(),
                           octants.data()},
                          threads),
            baked_table(materials, kept.ids, palette.entries, free)};
}

} // namespace voxrt::sim
