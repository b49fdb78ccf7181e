// The C interface of voxrt.wasm: what a board shows of the memory, turning.
#include "export.h"
#include "interface_error.h"
#include "memory.h"

#include <voxrt/octree/words/encoded_rows.h>
#include <voxrt/sim/views/beam.h>
#include <voxrt/sim/views/framing.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <vector>

namespace {

using namespace voxrt;
using namespace voxrt::web;

std::vector<int32_t> registers;
std::vector<uint32_t> rows;
std::optional<sim::BeamSearch> search;
std::array<double, 6> figures;

void append(const sim::Camera& camera) {
    for (const auto& triple : {camera.position, camera.look, camera.right, camera.up})
        registers.insert(registers.end(), triple, triple + 3);
}

std::vector<sim::Camera> cameras(int count, int width, int height) {
    return sim::orbit(sim::outline_points(loaded()), width, height, count);
}

sim::BeamSearch& running() {
    if (!search)
        throw std::logic_error("there is no search: call vx_beam first");
    return *search;
}

} // namespace

/// The rows of a board's octree memory of 2^block_bits blocks; returns how many.
EXPORT(vx_encode) double vx_encode(int block_bits) {
    return guarded([&] {
        const octree::Memory& memory = loaded().memory();
        rows = octree::encoded_rows(memory.words, memory.size, static_cast<unsigned>(block_bits));
        return static_cast<double>(rows.size());
    });
}
EXPORT(vx_encoded_rows) const uint32_t* vx_encoded_rows() { return rows.data(); }

/// The cameras of an orbit: 12 registers each, in vx_registers(). Returns 0.
EXPORT(vx_orbit) int vx_orbit(int count, int width, int height) {
    return guarded([&] {
        registers.clear();
        for (const sim::Camera& camera : cameras(count, width, height))
            append(camera);
        return 0;
    });
}
EXPORT(vx_registers) const int32_t* vx_registers() { return registers.data(); }

/// Begins the search for the largest pictures that a board traces in time, of an orbit of `count` cameras; returns 0.
EXPORT(vx_beam) int vx_beam(int count, double clock_hz, int buffer_lines) {
    return guarded([&] {
        search.emplace(cameras(count, sim::kScreenWidth, sim::kScreenHeight), clock_hz, buffer_lines);
        return 0;
    });
}
/// The band whose cycles are wanted next: its camera is in vx_registers(). Returns 65536 * columns + rows; 0 after the
/// end of the search.
EXPORT(vx_beam_band) int vx_beam_band() {
    return guarded([&] {
        registers.clear();
        if (running().ended())
            return 0;
        const sim::BeamSearch::Band band = running().band();
        append(band.camera);
        return static_cast<int>(band.width << 16 | band.rows);
    });
}
/// Takes the cycles of that band; returns 0.
EXPORT(vx_beam_give) int vx_beam_give(double cycles) {
    return guarded([&] {
        running().give(cycles);
        return 0;
    });
}
/// What was found: scale, cycles per pixel, lead, frames per second; pictures done, of how many. 6 numbers.
EXPORT(vx_beam_figures) const double* vx_beam_figures() {
    const sim::BeamFit fit = search ? search->fit() : sim::BeamFit{};
    figures = {static_cast<double>(fit.scale),
               fit.cycles_per_pixel,
               fit.lead,
               fit.frames_per_second,
               search ? static_cast<double>(search->done()) : 0,
               search ? static_cast<double>(search->total()) : 0};
    return figures.data();
}
