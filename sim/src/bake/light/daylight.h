// A sun and a sky, and the directions from which their light is sampled.
#pragma once

#include "received_light.h"

#include <array>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

// A distant sun and a sky that shines evenly. The sun's light on a surface that faces it is kSunLight.
struct Daylight {
    std::array<double, 3> sun{1, 3, 2};       // towards it, scene frame, any length; zeros for none
    std::array<double, 3> sky{0.4, 0.4, 0.4}; // linear light on an open surface that faces up
    int samples = 64;                         // directions in the half space above a surface, 1 ... kMostSamples
    double sun_light() const;
};

inline constexpr double kSunLight = 0.65;
inline constexpr int kMostSamples = 4096;

// Directions towards light, as receive_light() takes them.
struct Directions {
    std::vector<std::int32_t> steps;
    std::vector<std::int16_t> units;
    std::vector<std::int32_t> weights;
    DirectionsView view() const { return {weights.size(), steps.data(), units.data(), weights.data()}; }
};

// The direction towards the sun, rounded to integers below 2^10; none for no sun.
Directions sun_direction(const std::array<double, 3>& sun);

// 2 * samples directions, all around and nearly evenly spread: those of a spherical Fibonacci lattice (Swinbank and
// Purser, "Fibonacci grids", 2006), each replaced by the nearest direction of small integers, all different. Along
// these, rays from voxel centres meet voxel centres. From below the horizon comes half as much light, as from bright
// ground.
Directions sky_directions(int samples);

} // namespace voxrt::sim
