// Runs the native code of baked light without Python, for the sanitizers: `make sanitize` builds it with each of them.
//
// Random worlds, with random triangles near them or none, some of them with normals that are zero or no numbers: every
// step of baking runs on one thread and on three, and light is received by rays and by the sweep, by each engine; the
// results must be equal, no more light than an open sky gives, and the memory as solid as before. Prints a line and
// exits with 1 where anything is wrong.
#include "world.h"

#include <voxrt/bake/light/baked_light.h>
#include <voxrt/bake/surface/placed_triangles.h>
#include <voxrt/octree/query/diff.h>

#include <cmath>
#include <limits>
#include <string>

using namespace voxrt;
using namespace exercise;

namespace {

constexpr int kMaterials = 5;

struct Mesh {
    std::vector<double> positions, directions;
    std::vector<int32_t> triangles, rows;
};

double number(Random& random, double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
}

Mesh mesh(Random& random, double side) {
    constexpr double kWild[] = {0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
    Mesh made;
    const int vertices = 3 + upto(random, 9), directions = upto(random, 6);
    for (int i = 0; i < 3 * vertices; ++i)
        made.positions.push_back(number(random, -0.2 * side, 1.2 * side));
    for (int i = 0; i < 3 * directions; ++i)
        made.directions.push_back(upto(random, 9) == 0 ? kWild[upto(random, 2)] : number(random, -2, 2));
    for (int i = 3 * (1 + upto(random, 12)); i > 0; --i) {
        made.triangles.push_back(upto(random, vertices - 1));
        if (directions > 0)
            made.rows.push_back(upto(random, directions) - 1);
    }
    return made;
}

sim::PlacedTriangles triangles(Random& random, double side) {
    std::vector<Mesh> meshes;
    std::vector<sim::NormalMesh> views;
    std::vector<sim::PlacedMesh> objects;
    for (int i = upto(random, 2); i > 0; --i)
        meshes.push_back(mesh(random, side));
    for (const Mesh& one : meshes) {
        views.push_back({one.positions, one.triangles, one.directions, one.rows});
        for (int i = upto(random, 2); i > 0; --i) {
            sim::PlacedMesh placed{views.size() - 1, {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}};
            if (upto(random, 1) == 0)
                for (double& value : placed.transform)
                    value = number(random, -1, 1);
            objects.push_back(placed);
        }
    }
    return sim::place_triangles(views, objects, {0, 0, 0}, 1);
}

struct Light {
    std::vector<int64_t> received, full;
    bool operator==(const Light&) const = default;
};

Light receive(const octree::VerifiedMemory& memory, const sim::SurfacePoints& points, const sim::Directions& directions,
              int threads, sim::Method method, const sim::LightEngine& engine) {
    const size_t count = points.voxels.size();
    Light light{std::vector<int64_t>(count), std::vector<int64_t>(count)};
    sim::receive_light(memory, {count, points.origins.data(), points.normals.data()}, directions.view(),
                       light.received.data(), light.full.data(), threads, method, engine);
    return light;
}

Light receive_in_all_ways(const octree::VerifiedMemory& memory, const sim::SurfacePoints& points,
                          const sim::Directions& directions) {
    const sim::LightEngine& fastest = sim::light_engines()[0];
    Light light = receive(memory, points, directions, 1, sim::Method::automatic, fastest);
    check(receive(memory, points, directions, 3, sim::Method::rays, fastest) == light, "light depends on the threads");
    for (const sim::LightEngine& engine : sim::light_engines()) {
        check(receive(memory, points, directions, 1, sim::Method::rays, engine) == light, "an engine's rays differ");
        try {
            check(receive(memory, points, directions, 3, sim::Method::sweep, engine) == light,
                  "an engine's sweep differs");
        } catch (const std::invalid_argument&) { // a direction that the sweep does not take
        }
    }
    // The full light is that of directions of weight 1.
    const int64_t most =
        directions.weights.empty() ? 0 : *std::max_element(directions.weights.begin(), directions.weights.end());
    for (size_t i = 0; i < light.received.size(); ++i)
        check(light.received[i] >= 0 && light.received[i] <= light.full[i] * most,
              "a point receives more than there is");
    return light;
}

void exercise_bake(Random& random, unsigned depth) {
    const octree::Words words = world(random, depth, kMaterials);
    const octree::VerifiedMemory memory({words.data(), words.size(), depth});
    std::vector<voxelize::TableMaterial> materials{{"empty", {0, 0, 0}, false, true}};
    for (int i = 1; i < kMaterials; ++i)
        materials.push_back({"material " + std::to_string(i),
                             {uint8_t(random()), uint8_t(random()), uint8_t(random())},
                             i > 1 && upto(random, 3) == 0,
                             true});
    const sim::ExposedBricks bricks = sim::exposed_bricks(memory, 1), again = sim::exposed_bricks(memory, 3);
    check(bricks.cells == again.cells && bricks.exposed == again.exposed && bricks.octant_codes == again.octant_codes,
          "bricks depend on the number of threads");
    const sim::PlacedTriangles placed = triangles(random, 1 << depth);
    const sim::SurfacePoints points = sim::surface_points(memory, bricks, placed.view(), 1);
    const sim::SurfacePoints others = sim::surface_points(memory, bricks, placed.view(), 3);
    check(points.voxels == others.voxels && points.origins == others.origins && points.normals == others.normals,
          "points depend on the number of threads");
    sim::Daylight daylight;
    daylight.samples = 1 + upto(random, 40);
    for (double& part : daylight.sun)
        part = upto(random, 3) == 0 ? 0 : number(random, -2, 2);
    for (double& part : daylight.sky)
        part = number(random, 0, 16);
    const Light sun = receive_in_all_ways(memory, points, sim::sun_direction(daylight.sun));
    const Light sky = receive_in_all_ways(memory, points, sim::sky_directions(daylight.samples));
    const sim::LitVoxels lit =
        sim::light_voxels(points.voxels, bricks.cells, {sun.received, sky.received, sky.full}, materials, daylight);
    const sim::BricksView view{
        depth, bricks.brick_codes, bricks.cells, bricks.octant_codes, bricks.octant_levels, bricks.octant_materials};
    const int colours = 1 + upto(random, sim::kMostBakedColours - 1);
    const sim::BakedMemory one = sim::bake_memory(view, lit.rows, lit.colours, materials, colours, 1);
    const sim::BakedMemory other = sim::bake_memory(view, lit.rows, lit.colours, materials, colours, 3);
    check(one.words == other.words, "a baked memory depends on the number of threads");
    check(one.materials.size() <= 256, "a baked memory has more than 255 materials");
    const octree::VerifiedMemory baked({one.words.data(), one.words.size(), depth});
    const octree::Difference change = octree::diff(memory.memory(), baked.memory());
    check(change.appeared == 0 && change.vanished == 0, "baking adds or removes voxels");
}

} // namespace

int main() {
    Random random(29);
    for (unsigned depth = 1; depth <= 5; ++depth)
        for (int round = 0; round < 8; ++round)
            exercise_bake(random, depth);
    std::puts("bake: ok");
}
