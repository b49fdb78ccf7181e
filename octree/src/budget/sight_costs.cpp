#include "sight_costs.h"

#include <algorithm>
#include <cmath>

namespace voxrt::octree {

namespace {

using Light = std::array<double, 3>;

/// How bright the faces along the three axes are in the default picture of a scene.
constexpr std::array<double, 3> kFaces = {0.21, 0.25, 0.54};

/// How many times the colour of another material counts: it stands out where a face that turns is lost among others.
constexpr double kStandingOut = 6;

/// A ray that a new solid cell stops would mostly have met a face close by, and now and then the background.
constexpr double kPassed = 0.5;     // the share of the error of a face that turns
constexpr double kBackground = 0.1; // the share of the error of a face before the background

constexpr double kGrey = 150; // the channels of a material whose colour is not known

double squares(const Light& a, double bright_a, const Light& b, double bright_b) {
    double sum = 0;
    for (int channel = 0; channel < 3; ++channel) {
        const double apart = bright_a * a[channel] - bright_b * b[channel];
        sum += apart * apart;
    }
    return sum;
}

/// The mean over all pairs of faces along different axes.
template <class Value> double mean_of_turns(Value value) {
    double sum = 0;
    for (const double a : kFaces)
        for (const double b : kFaces)
            if (a != b)
                sum += value(a, b);
    return sum / 6;
}

std::uint32_t rounded(double cost) { return static_cast<std::uint32_t>(std::max(8.0, std::nearbyint(cost))); }

} // namespace

std::unique_ptr<AppearanceCosts> sight_costs(std::span<const Colour> colours) {
    std::array<Light, 256> table;
    table.fill({kGrey, kGrey, kGrey});
    for (std::size_t i = 0; i < std::min<std::size_t>(colours.size(), 256); ++i)
        table[i] = {double(colours[i][0]), double(colours[i][1]), double(colours[i][2])};
    const double unit =
        256 / mean_of_turns([](double a, double b) { return 3 * ((kGrey * (a - b)) * (kGrey * (a - b))); });
    const double mean_square =
        (kFaces[0] * kFaces[0] + kFaces[1] * kFaces[1] + kFaces[2] * kFaces[2]) / static_cast<double>(kFaces.size());
    auto costs = std::make_unique<AppearanceCosts>();
    for (int i = 0; i < 256; ++i) {
        for (int j = 0; j < 256; ++j) {
            const double other = colours.empty() && i != j ? 128 : 0;
            const double same = kStandingOut * unit * mean_square * squares(table[i], 1, table[j], 1);
            const double turned =
                same + unit * mean_of_turns([&](double a, double b) { return squares(table[i], a, table[j], b); });
            costs->same_axis[i][j] = i == j ? 0 : rounded(same + other);
            costs->other_axis[i][j] = rounded(turned + other);
            if (i != j)
                continue;
            double behind = 0;
            for (const double face : kFaces)
                behind += squares(table[i], face, table[0], 1);
            costs->occlusion[i] = rounded(kPassed * turned + kBackground * (unit * (behind / 3)));
        }
    }
    return costs;
}

} // namespace voxrt::octree
