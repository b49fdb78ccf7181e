#include "daylight.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>

namespace voxrt::sim {

namespace {

using Vector = std::array<double, 3>;

constexpr double kGround = 0.5; // of the sky's light, from below the horizon
constexpr double kSunSteps = 1000;
constexpr int kLeastSteps = 4, kMostSteps = 16;
constexpr double kUnit = 1 << 14, kFullWeight = 1 << 16;

double length(const Vector& v) { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

void add(Directions& directions, const Vector& step, double weight) {
    const double size = std::max(length(step), 1.0);
    for (const double part : step) {
        directions.steps.push_back(static_cast<std::int32_t>(part));
        directions.units.push_back(static_cast<std::int16_t>(std::nearbyint(kUnit * part / size)));
    }
    directions.weights.push_back(static_cast<std::int32_t>(std::nearbyint(weight)));
}

// All triples of integers up to `most` without a common factor, but those along x alone.
std::vector<Vector> primitive(int most) {
    std::vector<Vector> found;
    for (int x = -most; x <= most; ++x)
        for (int y = -most; y <= most; ++y)
            for (int z = -most; z <= most; ++z)
                if ((y != 0 || z != 0) && std::gcd(std::gcd(x, y), z) == 1)
                    found.push_back({double(x), double(y), double(z)});
    return found;
}

std::vector<Vector> nearest(const std::vector<Vector>& wanted, const std::vector<Vector>& steps) {
    std::vector<Vector> units;
    for (const Vector& step : steps) {
        const double size = length(step);
        units.push_back({step[0] / size, step[1] / size, step[2] / size});
    }
    std::vector<Vector> found;
    for (const Vector& one : wanted) {
        std::size_t best = 0;
        double most = -2;
        for (std::size_t i = 0; i < units.size(); ++i) {
            const double cosine = one[0] * units[i][0] + one[1] * units[i][1] + one[2] * units[i][2];
            const double rounded = std::nearbyint(cosine * 1e9); // so that ties fall alike on every machine
            if (rounded > most) {
                most = rounded;
                best = i;
            }
        }
        found.push_back(steps[best]);
    }
    return found;
}

} // namespace

double Daylight::sun_light() const { return sun[0] != 0 || sun[1] != 0 || sun[2] != 0 ? kSunLight : 0; }

Directions sun_direction(const std::array<double, 3>& sun) {
    Directions found;
    const double size = length(sun);
    if (size > 0)
        add(found,
            {std::nearbyint(kSunSteps * sun[0] / size), std::nearbyint(kSunSteps * sun[1] / size),
             std::nearbyint(kSunSteps * sun[2] / size)},
            kFullWeight);
    return found;
}

Directions sky_directions(int samples) {
    if (samples < 1 || samples > kMostSamples)
        throw std::invalid_argument("samples is " + std::to_string(samples) + ", not 1 ... 4096");
    std::vector<Vector> wanted;
    for (int i = 0; i < 2 * samples; ++i) {
        const double number = i + 0.5;
        const double height = 1 - number / samples;
        const double turn = std::numbers::pi * (1 + std::sqrt(5.0)) * number;
        const double across = std::sqrt(1 - height * height);
        wanted.push_back({across * std::cos(turn), height, across * std::sin(turn)});
    }
    std::vector<Vector> steps;
    for (int most = kLeastSteps; most <= kMostSteps; ++most) {
        steps = nearest(wanted, primitive(most));
        if (std::set<Vector>(steps.begin(), steps.end()).size() == steps.size())
            break;
    }
    Directions found;
    for (const Vector& step : steps)
        add(found, step, kFullWeight * (step[1] > 0 ? 1 : step[1] < 0 ? kGround : (1 + kGround) / 2));
    return found;
}

} // namespace voxrt::sim
