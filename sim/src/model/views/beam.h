// How large a picture a board can trace while its screen is drawn.
//
// A board without a frame buffer traces each line before the screen needs it. A line of 640 pixels lasts 800 clocks of
// 25 MHz. A picture of half the size has four times as long for each pixel. The cycles are those of the ray tracer
// itself; whoever searches counts them:
//
//     BeamSearch search(cameras, clock_hz);
//     while (!search.ended())
//         search.give(cycles_of(search.band()));
#pragma once

#include "framing.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace voxrt::sim {

/// Columns and rows of the screen.
constexpr int32_t kScreenWidth = 640, kScreenHeight = 480;

/// By how many lines of the screen each row of a picture is early, at least; below 0 where a row is late. `rows`:
/// cycles of each row. `line`: cycles of a line of the screen. A row is shown on 2^scale lines. `buffer_lines`: rows of
/// a picture that the board's line buffer holds.
double beam_lead(const std::vector<double>& rows, double line, int scale, int buffer_lines);

struct BeamFit {
    int scale;                // 0: pictures of 640 x 480 pixels; 1: 320 x 240; 2: 160 x 120
    double cycles_per_pixel;  // the mean of the view that takes longest
    double lead;              // of beam_lead()
    double frames_per_second; // in the view that takes longest
};

/// The largest pictures that a board traces in time, of eight views of an orbit. Small pictures of all choose the two
/// that take longest.
class BeamSearch {
public:
    /// `cameras`: those of the orbit, for pictures of 640 x 480; one or more. `clock_hz`: the clock of the ray tracer.
    /// `buffer_lines`: of its line buffer, one or more.
    BeamSearch(const std::vector<Camera>& cameras, double clock_hz, int buffer_lines);

    /// Rows of a picture, as a picture of its own.
    struct Band {
        Camera camera;
        int32_t width, rows;
    };

    bool ended() const { return ended_; }
    /// Bands of the present picture whose cycles are wanted.
    int left() const;
    /// The band whose cycles are wanted next, or one of those after it.
    Band band(int ahead = 0) const;
    /// Takes the cycles of the next band.
    void give(double cycles);

    /// How many pictures are complete, of how many at most.
    size_t done() const { return ended_ ? total() : done_; }
    size_t total() const { return (views_.size() > slowest_ ? views_.size() : 0) + slowest_ + 1; }

    /// What was found; call it after the end.
    BeamFit fit() const;

private:
    struct Picture {
        int scale;
        std::vector<double> rows; // cycles
        double lead;
    };

    void finish(Picture picture);

    std::vector<Camera> views_;
    double line_; // cycles of a line of the screen
    int buffer_lines_;
    size_t slowest_;                // views that are measured
    std::vector<double> estimates_; // leads of all views
    std::vector<size_t> order_;     // of the views
    size_t done_ = 0;
    bool ended_ = false;
    size_t view_ = 0, chosen_view_ = 0; // places in the order
    int scale_ = 1, band_ = 0;
    std::vector<double> rows_;
    Picture chosen_{};
};

} // namespace voxrt::sim
