// Runs the native colour code without Python, for the sanitizers: `make sanitize` builds it with each of them.
//
// Random surfaces: images of 1 to 9 pixels per side, every way of wrapping, texture coordinates, vertex colours,
// corners and factors of any size, infinite and not a number among them, cut away or not, mirrors, meshes without
// appearances. Each step of assigning colours runs on one thread and on three; the results must be equal, every
// material an id of the table, and palettes no larger than asked for, with each colour's entry among them. Prints a
// line and exits with 1 where anything is wrong.
#include <voxrt/voxelize/colour/assign_colours.h>
#include <voxrt/voxelize/colour/assign_materials.h>
#include <voxrt/voxelize/colour/palette.h>
#include <voxrt/voxelize/colour/raster_cells.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <random>
#include <set>

using namespace voxrt::voxelize;

namespace {

using Random = std::mt19937_64;

[[noreturn]] void fail(const char* what) {
    std::printf("colour: %s\n", what);
    std::exit(1);
}

void check(bool holds, const char* what) {
    if (!holds)
        fail(what);
}

int upto(Random& random, int most) { return std::uniform_int_distribution<int>(0, most)(random); }

/// A number as files have them; where `wild`, seldom one that they should not have.
double number(Random& random, double low, double high, bool wild) {
    constexpr double kWild[] = {0,
                                -0.0,
                                1e300,
                                -1e300,
                                1e-300,
                                1e18,
                                std::numeric_limits<double>::infinity(),
                                -1e18,
                                -1e9,
                                std::numeric_limits<double>::quiet_NaN()};
    if (wild && upto(random, 7) == 0)
        return kWild[upto(random, static_cast<int>(std::size(kWild)) - 1)];
    return std::uniform_real_distribution<double>(low, high)(random);
}

struct Mesh {
    std::vector<double> positions, uv, colours;
    std::vector<int32_t> triangles, rows;
    std::vector<uint8_t> materials;
    std::vector<Appearance> entries;

    Surface surface() const { return {entries, rows, std::span(uv), std::span(colours)}; }
};

struct World {
    std::vector<std::vector<uint8_t>> images;
    std::vector<Mesh> meshes;
    std::vector<VariedObject> objects;
    std::vector<TableMaterial> materials{{"empty", {0, 0, 0}, false, true}};
};

Texture texture(Random& random, World& world) {
    const int width = 1 + upto(random, 8), height = 1 + upto(random, 8);
    auto& pixels = world.images.emplace_back(static_cast<size_t>(4 * width * height));
    for (uint8_t& value : pixels)
        value = static_cast<uint8_t>(upto(random, 3) == 0 ? 255 : upto(random, 255));
    const auto wrap = [&] { return static_cast<Wrap>(upto(random, 2)); };
    return {{pixels.data(), width, height}, wrap(), wrap(), upto(random, 1) == 0};
}

Mesh mesh(Random& random, World& world, bool wild, bool far) {
    Mesh made;
    const int vertices = 3 + upto(random, 20), triangles = 1 + upto(random, 30), entries = upto(random, 3);
    for (int i = 0; i < entries; ++i) {
        Appearance& one = made.entries.emplace_back();
        one.name = "surface " + std::to_string(upto(random, 5));
        one.mirror = upto(random, 3) == 0;
        one.cutoff = upto(random, 1) == 0 ? 0 : number(random, 0, 1, wild);
        for (double& factor : one.factor)
            factor = upto(random, 1) == 0 ? 1 : number(random, 0, 1, wild);
        if (upto(random, 2) != 0)
            one.texture = texture(random, world);
    }
    for (int i = 0; i < 3 * vertices; ++i)
        made.positions.push_back(number(random, -1, 1, far));
    for (int t = 0; t < triangles; ++t) {
        made.rows.push_back(upto(random, entries) - 1);
        made.materials.push_back(static_cast<uint8_t>(1 + upto(random, static_cast<int>(world.materials.size()) - 2)));
        const bool plain = upto(random, 1) == 0;
        for (int corner = 0; corner < 3; ++corner) {
            made.triangles.push_back(upto(random, vertices - 1));
            for (int i = 0; i < 2; ++i)
                made.uv.push_back(number(random, -2, 3, wild));
            for (int i = 0; i < 4; ++i)
                made.colours.push_back(plain ? 1 : number(random, 0, 1, wild));
        }
    }
    return made;
}

/// `wild`: some numbers are none that a file should have; `far`: of positions and transforms too.
World world(Random& random, bool wild, bool far) {
    World made;
    for (int i = upto(random, 6); i >= 0; --i)
        made.materials.push_back({"material " + std::to_string(i),
                                  {uint8_t(upto(random, 255)), uint8_t(upto(random, 255)), uint8_t(upto(random, 255))},
                                  upto(random, 3) == 0,
                                  upto(random, 2) != 0});
    for (int i = upto(random, 2); i >= 0; --i)
        made.meshes.push_back(mesh(random, made, wild, far));
    for (size_t i = 0; i < made.meshes.size(); ++i)
        for (int j = upto(random, 2); j >= 0; --j) {
            VariedObject& object = made.objects.emplace_back(VariedObject{i, {}});
            for (double& value : object.transform)
                value = number(random, -1, 1, far);
        }
    return made;
}

bool equal(const std::vector<TableMaterial>& a, const std::vector<TableMaterial>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const TableMaterial& one, const TableMaterial& other) {
        return one.name == other.name && one.colour == other.colour && one.mirror == other.mirror &&
               one.authored == other.authored;
    });
}

/// Equal bits: corners that are not numbers are equal too.
bool equal(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

struct Loaded {
    std::vector<FileMesh> meshes;
    std::vector<TableMaterial> materials;
    bool full = false; // refused: too many materials
};

Loaded loaded(const World& world, int threads) {
    Loaded made;
    MaterialTable table(world.materials[0]);
    for (size_t i = 1; i < world.materials.size(); ++i)
        table.add(world.materials[i]);
    for (const Mesh& mesh : world.meshes)
        made.meshes.push_back({std::span(mesh.positions), mesh.triangles, mesh.surface(), mesh.materials});
    try {
        assign_materials(made.meshes, table, threads);
    } catch (const TooManyMaterials&) {
        made.full = true;
    }
    made.materials = table.entries();
    return made;
}

Coloured coloured(const World& world, const Loaded& from, double voxel_size, int colours, int threads) {
    std::vector<VariedMesh> meshes;
    std::array<uint8_t, 256> used{};
    for (size_t i = 0; i < world.meshes.size(); ++i) {
        Surface surface = world.meshes[i].surface();
        surface.rows = from.meshes[i].rows;
        meshes.push_back(
            {std::span(world.meshes[i].positions), world.meshes[i].triangles, from.meshes[i].materials, surface});
        for (const uint8_t id : from.meshes[i].materials)
            used[id] = 1;
    }
    return assign_colours(meshes, world.objects, from.materials, used, voxel_size, colours, threads);
}

void exercise(Random& random, bool wild, bool far) {
    const World scene = world(random, wild, far);
    for (const Mesh& one : scene.meshes)
        check(visible_triangles(one.surface(), 1) == visible_triangles(one.surface(), 3),
              "visible triangles depend on the number of threads");
    const Loaded alone = loaded(scene, 1), three = loaded(scene, 3);
    check(equal(alone.materials, three.materials), "materials depend on the number of threads");
    for (size_t i = 0; i < alone.meshes.size(); ++i) {
        const FileMesh &one = alone.meshes[i], &other = three.meshes[i];
        check(one.materials == other.materials && one.rows == other.rows && one.transparent == other.transparent,
              "a mesh's materials depend on the number of threads");
        for (const uint8_t id : one.materials)
            check(id < alone.materials.size(), "a triangle has a material that the table lacks");
    }
    const double voxel_size = number(random, 0.02, 0.5, false);
    const int colours = 1 + upto(random, 253);
    const Coloured result = coloured(scene, alone, voxel_size, colours, 1);
    const Coloured again = coloured(scene, alone, voxel_size, colours, 3);
    check(equal(result.materials, again.materials), "the palette depends on the number of threads");
    check(result.materials.size() <= MaterialTable::kLimit + 1, "the table has more than 255 materials");
    for (size_t i = 0; i < result.meshes.size(); ++i) {
        const MaterialMap &one = result.meshes[i], &other = again.meshes[i];
        check(one.sizes == other.sizes && one.cells == other.cells && one.materials == other.materials &&
                  equal(one.coordinates, other.coordinates),
              "rasters depend on the number of threads");
        int64_t cells = 0;
        for (size_t t = 0; t < one.materials.size(); ++t)
            cells += int64_t{one.sizes[2 * t]} * one.sizes[2 * t + 1];
        check(cells == static_cast<int64_t>(one.cells.size()), "a raster has cells without a place");
        for (const uint8_t id : one.cells)
            check(id < result.materials.size(), "a cell has a material that the table lacks");
    }
}

void exercise_palette(Random& random) {
    const int distinct = 1 + upto(random, 400), count = 1 + upto(random, 254);
    std::vector<Srgb> colours;
    std::vector<double> weights;
    std::set<Srgb> different;
    for (int i = upto(random, 3000) + 1; i > 0; --i) {
        const int code = upto(random, distinct) * 40503;
        colours.push_back({uint8_t(code), uint8_t(code >> 8), uint8_t(code >> 16)});
        different.insert(colours.back());
        weights.push_back(upto(random, 9) == 0 ? 0 : std::ldexp(number(random, 0, 1, false), upto(random, 1200) - 600));
    }
    const Palette palette = quantize(colours, std::span<const double>(weights), count);
    check(palette.entries.size() <= static_cast<size_t>(count), "a palette has more entries than asked for");
    check(palette.rows.size() == colours.size(), "a colour has no entry");
    check(std::is_sorted(palette.entries.begin(), palette.entries.end()), "a palette is not sorted");
    for (size_t i = 0; i < colours.size(); ++i) {
        check(palette.rows[i] < palette.entries.size(), "a colour's entry is beyond the palette");
        if (different.size() <= static_cast<size_t>(count))
            check(palette.entries[palette.rows[i]] == colours[i], "a palette that could be exact is not");
    }
}

} // namespace

int main() {
    Random random(20);
    for (int round = 0; round < 150; ++round) {
        exercise(random, false, false);
        exercise(random, true, false);
        exercise_palette(random);
    }
    for (int round = 0; round < 3; ++round) // these have as many cells as a scene may have
        exercise(random, true, true);
    std::puts("colour: ok");
}
