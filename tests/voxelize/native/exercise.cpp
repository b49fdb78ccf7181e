// Runs the native voxelizer without Python, for the sanitizers: `make sanitize` builds it with each of them.
//
// Random soups, closed and holed spheres, open ones and such inside out in one object, huge and tiny triangles,
// instances, analytic solids and hulls, with and without materials that vary over triangles, on grids of every small
// depth, filled or not. Every scene is voxelized on one thread, and on three with each instruction set; the results
// must be equal. Then long work is interrupted in the middle of its jobs. Prints a line and exits with 1 where anything
// is wrong.
#include <voxrt/voxelize/coverage/vector_coverage.h>
#include <voxrt/voxelize/scene/convex_hull.h>
#include <voxrt/voxelize/tiles/voxelizer.h>

#include <cstdio>
#include <cstring>
#include <functional>
#include <numbers>
#include <random>

using namespace voxrt::voxelize;

namespace {

struct Mesh {
    std::vector<double> positions;
    std::vector<int32_t> triangles;
    std::vector<uint8_t> materials;
    std::vector<int32_t> raster_sizes;
    std::vector<float> raster_coordinates;
    std::vector<uint8_t> raster_materials;
    std::vector<int64_t> raster_starts;

    MeshView view() const {
        return {positions, triangles, materials, {raster_sizes, raster_coordinates, raster_materials, raster_starts}};
    }

    /// Gives each triangle a raster of random materials, 0 among them, some of it beyond the triangle and mirrored;
    /// every fifth keeps its material.
    void add_rasters(std::mt19937_64& random) {
        std::uniform_int_distribution<int> side(1, 6), material(0, 5);
        std::uniform_real_distribution<float> coordinate(-1, 7);
        for (size_t t = 0; t < materials.size(); ++t) {
            const int columns = t % 5 == 0 ? 0 : side(random), rows = t % 5 == 0 ? 0 : side(random);
            raster_sizes.insert(raster_sizes.end(), {columns, rows});
            raster_starts.push_back(int64_t(raster_materials.size()));
            for (int i = 0; i < 6; ++i)
                raster_coordinates.push_back(coordinate(random));
            for (int i = 0; i < columns * rows; ++i)
                raster_materials.push_back(uint8_t(material(random)));
        }
    }
    void add(const Mesh& other) {
        for (const int32_t v : other.triangles)
            triangles.push_back(v + int32_t(positions.size() / 3));
        positions.insert(positions.end(), other.positions.begin(), other.positions.end());
        materials.insert(materials.end(), other.materials.begin(), other.materials.end());
    }
    /// Leaves out the triangles above a height.
    void cut(double height) {
        for (size_t t = materials.size(); t-- > 0;)
            if (positions[3 * triangles[3 * t] + 2] > height) {
                triangles.erase(triangles.begin() + ptrdiff_t(3 * t), triangles.begin() + ptrdiff_t(3 * t + 3));
                materials.erase(materials.begin() + ptrdiff_t(t));
            }
    }
    void add(const double (&corners)[9], uint8_t material) {
        for (int i = 0; i < 3; ++i) {
            triangles.push_back(int32_t(positions.size() / 3));
            positions.insert(positions.end(), corners + 3 * i, corners + 3 * i + 3);
        }
        materials.push_back(material);
    }
};

using Random = std::mt19937_64;

Mesh soup(Random& random, double side, double spread) {
    std::uniform_real_distribution<double> place(-0.2 * side, 1.2 * side), offset(-spread, spread);
    Mesh mesh;
    for (int t = 0; t < 60; ++t) {
        const double at[3] = {place(random), place(random), place(random)};
        double corners[9];
        for (int i = 0; i < 9; ++i) {
            corners[i] = at[i % 3] + offset(random);
            if (t % 4 == 0) // on planes between voxels
                corners[i] = std::nearbyint(corners[i]);
        }
        mesh.add(corners, uint8_t(1 + t % 3));
    }
    return mesh;
}

/// A sphere of rings and segments; every `hole`-th triangle left out where hole > 0.
Mesh sphere(double x, double y, double z, double radius, int rings, int hole, bool inverted) {
    auto point = [&](int ring, int segment, double* to) {
        const double polar = std::numbers::pi * ring / rings,
                     around = std::numbers::pi * (segment % (2 * rings)) / rings;
        const double across = ring == 0 || ring == rings ? 0 : std::sin(polar);
        to[0] = x + radius * across * std::cos(around);
        to[1] = y + radius * across * std::sin(around);
        to[2] = z + radius * std::cos(polar);
    };
    Mesh mesh;
    int number = 0;
    for (int ring = 0; ring < rings; ++ring)
        for (int segment = 0; segment < 2 * rings; ++segment)
            for (int half = 0; half < 2; ++half) {
                if ((ring == 0 && half == 1) || (ring == rings - 1 && half == 0))
                    continue;
                double corners[9];
                point(ring + (half == 0), segment, corners);
                point(ring + (half == 0), segment + 1, corners + (half == 0 ? 3 : 6));
                point(ring + (half == 1), segment + (half == 1), corners + (half == 0 ? 6 : 3));
                if (inverted)
                    std::swap_ranges(corners, corners + 3, corners + 3);
                if (hole == 0 || ++number % hole != 0)
                    mesh.add(corners, 1);
            }
    return mesh;
}

/// A hash of the bytes of arrays.
template <typename... Arrays> uint64_t fingerprint_of(const Arrays&... arrays) {
    uint64_t hash = 0xCBF2'9CE4'8422'2325; // FNV-1a
    const auto add = [&hash](const auto& array) {
        const auto* bytes = reinterpret_cast<const unsigned char*>(array.data());
        for (size_t i = 0; i < array.size() * sizeof(array[0]); ++i)
            hash = (hash ^ bytes[i]) * 0x100'0000'01B3;
    };
    (add(arrays), ...);
    return hash;
}

uint64_t fingerprint(const SparseVoxels& voxels) {
    return fingerprint_of(voxels.brick_codes, voxels.brick_masks, voxels.brick_materials, voxels.brick_rows,
                          voxels.cells, voxels.octant_codes, voxels.octant_levels, voxels.octant_materials,
                          voxels.object_voxels, voxels.object_modes, voxels.object_notes);
}

uint64_t fingerprint(const ObjectVolumes& found) {
    return fingerprint_of(found.objects, found.voxels, found.volumes, found.whole, found.known);
}

/// The first thread's scene: parts over some meshes, in voxels.
struct Scene {
    std::vector<Mesh> meshes;
    std::vector<std::array<double, 12>> frames;
    std::vector<PartKind> kinds;
    std::vector<size_t> mesh_of;

    void add(PartKind kind, size_t mesh, std::array<double, 12> frame) {
        for (double& value : frame)
            value *= kUnit;
        kinds.push_back(kind);
        mesh_of.push_back(mesh);
        frames.push_back(frame);
    }
    void add(size_t mesh, double scale, double shift) {
        add(PartKind::mesh, mesh, {scale, 0, 0, shift, 0, scale, 0, shift, 0, 0, scale, shift});
    }
};

/// The parts of a scene.
class Parts {
public:
    explicit Parts(const Scene& scene) {
        for (const Mesh& mesh : scene.meshes)
            views_.push_back(mesh.view());
        for (size_t p = 0; p < scene.kinds.size(); ++p) {
            const bool mesh = scene.kinds[p] == PartKind::mesh;
            parts_.push_back({scene.kinds[p], mesh ? &views_[scene.mesh_of[p]] : nullptr, scene.frames[p].data(),
                              uint8_t(mesh ? 0 : 4), uint32_t(p)});
        }
    }
    const std::vector<PartView>& get() const { return parts_; }

private:
    std::vector<MeshView> views_;
    std::vector<PartView> parts_;
};

bool agree(const Scene& scene, int depth) {
    const Parts held(scene);
    std::vector<PartView> parts = held.get();
    for (const Fill fill : {Fill::surface, Fill::solid, Fill::automatic})
        for (const int choice : {0, 1, 2, 3}) { // all by touch; by centre; by all three; by half, thin parts dropped
            const Thin thin = choice == 3 ? Thin::drop : Thin::keep;
            for (size_t p = 0; p < parts.size(); ++p) {
                parts[p].rule = choice == 2 ? Rule(p % 3) : choice == 3 ? Rule::half : Rule(choice);
                parts[p].fill = choice == 2 ? Fill((size_t(fill) + p / 3) % 3) : fill;
            }
            const uint64_t alone = fingerprint(voxelize(depth, parts, parts.size(), 1, thin));
            for (const CoverageEngine& engine : coverage_engines())
                if (alone != fingerprint(voxelize(depth, parts, parts.size(), 3, thin, engine.instructions))) {
                    std::printf("depth %d: three threads and %s give another result\n", depth, engine.instructions);
                    return false;
                }
        }
    return true;
}

bool volumes_agree(const Scene& scene, int depth) {
    const Parts held(scene);
    const auto volumes = [&](int threads) { return find_volumes(depth, held.get(), held.get().size(), threads); };
    const ObjectVolumes alone = volumes(1);
    if (!alone.volumes.empty() && fingerprint(alone) == fingerprint(volumes(3)))
        return true;
    std::printf("depth %d: three threads find other volumes, or one finds none\n", depth);
    return false;
}

struct Stopped {};

/// Whether work that is one job on one thread can be interrupted at each of its checks, and leaves nothing behind; at
/// least `least` checks are expected.
bool can_be_interrupted(const Scene& scene, int least) {
    const Parts held(scene);
    const std::vector<PartView>& parts = held.get();
    constexpr int depth = 5; // a single tile
    int checks = 0;
    const auto run = [&](int threads, std::function<void()> check) {
        checks = 0;
        const InterruptScope scope(std::move(check));
        return fingerprint(voxelize(depth, parts, parts.size(), threads));
    };
    const uint64_t whole = run(1, [&checks] { ++checks; });
    const int all = checks;
    if (all < least) {
        std::printf("%d checks, fewer than %d\n", all, least);
        return false;
    }
    for (const int threads : {1, 3})
        for (int last = 1; last <= (threads == 1 ? all : 1); last += std::max(1, all / 8)) {
            try {
                run(threads, [&checks, last] {
                    if (++checks >= last)
                        throw Stopped();
                });
                std::printf("went on after check %d of %d\n", last, all);
                return false;
            } catch (const Stopped&) {
            }
        }
    return run(1, [] {}) == whole;
}

} // namespace

int main() {
    Random random(1);
    bool good = true;
    for (int depth = 1; depth <= 5; ++depth) {
        const double side = 1 << depth;
        Scene scene;
        scene.meshes = {soup(random, side, 1),
                        soup(random, side, side),
                        soup(random, side, 20 * side),
                        sphere(side / 2, side / 2, side / 2, side * 0.4, 12, 0, false),
                        sphere(side / 3, side / 2, side / 2, side * 0.3, 12, 7, false),
                        sphere(side / 2, side / 3, side / 2, side * 0.7, 6, 0, true)};
        scene.meshes.push_back(sphere(side / 2, side / 2, side / 3, side * 0.5, 8, 0, false));
        scene.meshes.push_back(sphere(side / 2, side / 2, side / 3, side * 0.5, 8, 9, false));
        // Components that are open, have holes, are inside out or the wall of a cavity, in one object; then instances,
        // mirrored.
        Mesh mixed = sphere(side / 2, side / 2, side / 2, side * 0.4, 9, 0, false);
        mixed.add(sphere(side / 2, side / 2, side / 2, side * 0.2, 7, 0, true));
        mixed.add(sphere(side * 0.8, side / 2, side / 2, side * 0.3, 8, 0, true));
        scene.meshes.push_back(mixed);
        mixed.add(sphere(side * 0.2, side / 2, side / 2, side * 0.25, 8, 11, false));
        Mesh bowl = sphere(side / 2, side * 0.8, side / 2, side * 0.3, 8, 0, false);
        bowl.cut(side * 0.55);
        mixed.add(bowl);
        scene.meshes.push_back(mixed);
        for (const size_t mesh : {0, 1, 2, 6, 7, 8, 9})
            scene.meshes[mesh].add_rasters(random);
        for (size_t mesh = 0; mesh < scene.meshes.size(); ++mesh)
            scene.add(mesh, 1, 0);
        for (int i = 0; i < 5; ++i) // instances
            scene.add(i % 2 == 0 ? 3 : 4, 0.3, side * i / 7);
        for (const size_t mesh : {8, 9})
            scene.add(PartKind::mesh, mesh, {-0.7, 0, 0, side, 0, 0.7, 0.1, 0, 0, 0, 0.7, 0});
        scene.add(PartKind::box, 0, {1, 1, 1, side / 2, side * 2, side / 3});
        scene.add(PartKind::ball, 0, {side / 2, side / 2, 0, side / 3});
        scene.add(PartKind::ellipsoid, 0,
                  {side / 3, 1, 0, side / 2, 0, side / 5, 0, side / 2, 1, 0, side / 4, side / 2});
        good = agree(scene, depth) && good;
        good = volumes_agree(scene, depth) && good;

        std::vector<Vertex> points;
        std::uniform_int_distribution<int32_t> coordinate(0, depth);
        for (int i = 0; i < 200; ++i)
            points.push_back({coordinate(random) * 4096, coordinate(random) * 4096, coordinate(random) * 4096});
        good = convex_hull(points).size() >= 12 && good;
    }

    Scene large; // of many tiles
    large.meshes = {sphere(64, 64, 64, 50, 12, 0, false), sphere(64, 64, 64, 50, 12, 7, false)};
    for (int i = 0; i < 4; ++i)
        large.add(i % 2, 1, 5 * i);
    good = volumes_agree(large, 7) && good;

    Scene closed, holed; // the work is in coverage and components; in boundaries and holes
    closed.meshes = {sphere(16, 16, 16, 12, 110, 0, false)};
    closed.meshes[0].add(sphere(16, 16, 16, 9, 110, 0, true));
    holed.meshes = {sphere(16, 16, 16, 12, 110, 9, false)};
    for (Scene* scene : {&closed, &holed}) {
        scene->add(0, 1, 0);
        good = can_be_interrupted(*scene, 4) && good;
    }
    return good ? 0 : 1;
}
