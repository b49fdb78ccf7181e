// The ray tracer that the report compared its hardware with (appendix B.2), re-implemented from its description, to
// compare the exact model with.
//
//     original MEMORY DEPTH WIDTH HEIGHT CAMERA... [PICTURE]   ->  "CPU-seconds hits checksum" on stdout
//
// MEMORY holds hexadecimal words in the report dialect; CAMERA is twelve whole numbers: position (voxels), look, right,
// up. PICTURE is a file for the picture's bytes: red, green, blue a pixel, (40 m, 80 m, 120 m) mod 256 for material m.
// A ray stands on whole voxels. It looks up the octant it stands in, from the root; if that is empty it takes steps
// along its direction, first doubled until they are as long as the octant and then halved, keeping those that end in
// the octant or one voxel outside, until it stands outside.
//
// Compiled with -DAS_PUBLISHED it handles its data as the appendix does: coordinates are heap-allocated vectors, passed
// and returned by value, and an octant's number is read from a string of binary digits. Without, it is the algorithm at
// its best, on plain arrays.
#include "../octree/src/words/words.h"

#include <array>
#include <bitset>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>
#include <vector>

namespace {

#ifdef AS_PUBLISHED
using Vector = std::vector<int>;
using Argument = Vector;
#else
using Vector = std::array<int, 3>;
using Argument = const Vector&;
#endif

struct Octant {
    uint32_t word;
    int side;
    Vector lowest, highest; // voxels, both inside
};

Octant octant_at(const std::vector<uint32_t>& words, int depth, Argument position) {
    Octant found{words[0], 1 << depth, {0, 0, 0}, {0, 0, 0}};
    for (int level = depth - 1; !voxrt::octree::is_leaf(found.word); --level) {
        found.side /= 2;
        uint32_t index = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int bit = position[axis] >> level & 1;
            found.lowest[axis] += bit * found.side;
            index |= static_cast<uint32_t>(bit) << axis;
        }
#ifdef AS_PUBLISHED
        std::string digits;
        for (int axis = 2; axis >= 0; --axis)
            digits += std::bitset<10>(static_cast<unsigned>(position[axis])).to_string()[9 - level];
        index = static_cast<uint32_t>(std::stoi(digits, nullptr, 2));
#endif
        found.word = words[found.word + index];
    }
    for (int axis = 0; axis < 3; ++axis)
        found.highest[axis] = found.lowest[axis] + found.side - 1;
    return found;
}

enum class Place { inside, just_outside, beyond };

Place place_of(Argument position, const Octant& octant) {
    Place place = Place::inside;
    for (int axis = 0; axis < 3; ++axis) {
        if (position[axis] < octant.lowest[axis] - 1 || position[axis] > octant.highest[axis] + 1)
            return Place::beyond;
        if (position[axis] < octant.lowest[axis] || position[axis] > octant.highest[axis])
            place = Place::just_outside;
    }
    return place;
}

Vector step_out(Vector position, Vector step, const Octant& octant) {
    const auto longer_than_step = [&] {
        const int64_t x = step[0], y = step[1], z = step[2], side = octant.side;
        return x * x + y * y + z * z < side * side;
    };
    while (longer_than_step())
        for (int& component : step)
            component *= 2;
    while (place_of(position, octant) != Place::just_outside) {
        Vector next = position;
        for (int axis = 0; axis < 3; ++axis)
            next[axis] += step[axis];
        if (place_of(next, octant) != Place::beyond)
            position = next;
        for (int& component : step)
            component = std::abs(component) > 1 ? component / 2 : component >= 0 ? 1 : -1;
    }
    return position;
}

// The squared cosine between the direction and the normal of the face that the ray stands at.
double brightness(Argument position, Argument direction, const Octant& octant) {
    double length = 0;
    for (const int component : direction)
        length += static_cast<double>(component) * component;
    length = std::sqrt(length);
    for (int axis = 0; axis < 3; ++axis)
        if (position[axis] == octant.lowest[axis] || position[axis] == octant.highest[axis]) {
            const double cosine = direction[axis] / length;
            return cosine * cosine;
        }
    return 1;
}

} // namespace

int main(int count, char** arguments) {
    if (count != 17 && count != 18) {
        std::fprintf(stderr, "usage: original MEMORY DEPTH WIDTH HEIGHT, twelve numbers of the camera [PICTURE]\n");
        return 2;
    }
    std::vector<uint32_t> words;
    std::ifstream file(arguments[1]);
    for (std::string line; file >> line;)
        words.push_back(static_cast<uint32_t>(std::stoul(line, nullptr, 16)));
    const int depth = std::atoi(arguments[2]), width = std::atoi(arguments[3]), height = std::atoi(arguments[4]);
    Vector camera[4] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}; // position, look, right, up
    for (int i = 0; i < 12; ++i)
        camera[i / 3][i % 3] = std::atoi(arguments[5 + i]);
    const auto& [position, look, right, up] = camera;

    std::vector<uint8_t> image(static_cast<size_t>(width) * height * 3);
    int hits = 0;
    const std::clock_t started = std::clock();
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            Vector direction = look;
            for (int axis = 0; axis < 3; ++axis)
                direction[axis] += right[axis] * (column - width / 2) + up[axis] * (height / 2 - row);
            Vector ray = position;
            const int last = (1 << depth) - 1;
            const auto in_world = [&] {
                return ray[0] >= 0 && ray[1] >= 0 && ray[2] >= 0 && ray[0] <= last && ray[1] <= last && ray[2] <= last;
            };
            while (in_world()) {
                const Octant octant = octant_at(words, depth, ray);
                const int material = voxrt::octree::material(octant.word);
                if (material == 0) {
                    ray = step_out(ray, direction, octant);
                    continue;
                }
                const double shade = brightness(ray, direction, octant);
                for (int channel = 0; channel < 3; ++channel)
                    image[3 * (static_cast<size_t>(row) * width + column) + channel] =
                        static_cast<uint8_t>(std::lround(shade * (40 * material * (channel + 1) % 256)));
                ++hits;
                break;
            }
        }
    const double taken = static_cast<double>(std::clock() - started) / CLOCKS_PER_SEC;
    unsigned sum = 0; // so that no compiler drops the image
    for (const uint8_t byte : image)
        sum += byte;
    if (count == 18)
        std::ofstream(arguments[17], std::ios::binary)
            .write(reinterpret_cast<const char*>(image.data()), static_cast<std::streamsize>(image.size()));
    std::printf("%.9f %d %u\n", taken, hits, sum);
}
