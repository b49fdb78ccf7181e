#include "beam.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace voxrt::sim {

namespace {

constexpr double kPixelHz = 25e6;
constexpr int kLinePixels = 800, kLines = 525; // with the blanking
constexpr int kFirstScale = 1, kLargestScale = 2;
constexpr int kEstimateScale = 3; // of pictures that choose views: one pixel for 4 x 4 of the first scale
constexpr int kBands = 12;
constexpr size_t kViews = 8, kSlowest = 2;
constexpr double kSafety = 1.05; // for what lies between the views

} // namespace

double beam_lead(const std::vector<double>& rows, double line, int scale, int buffer_lines) {
    const double shown = std::ldexp(line, scale);
    const double blanking = (kLines - kScreenHeight) * line;
    double end = 0, lead = std::numeric_limits<double>::infinity();
    for (size_t row = 0; row < rows.size(); ++row) {
        const double number = static_cast<double>(row);
        // A row needs a free place in the line buffer: that of the row which has just been shown to its end.
        const double free = blanking + (number - buffer_lines + 1) * shown;
        const double begin = number < buffer_lines ? end : std::max(end, free);
        end = begin + kSafety * rows[row];
        lead = std::min(lead, (blanking + number * shown - end) / line);
    }
    return lead;
}

BeamSearch::BeamSearch(const std::vector<Camera>& cameras, double clock_hz, int buffer_lines)
    : line_(clock_hz * kLinePixels / kPixelHz), buffer_lines_(buffer_lines) {
    if (cameras.empty() || !(clock_hz > 0) || buffer_lines < 1)
        throw std::invalid_argument("a search needs a camera, a clock above 0 Hz, and a line or more");
    const size_t count = std::min(kViews, cameras.size());
    for (size_t i = 0; i < count; ++i) {
        views_.push_back(cameras[i * cameras.size() / kViews]);
        order_.push_back(i);
    }
    slowest_ = std::min(kSlowest, count);
    if (count > kSlowest)
        scale_ = kEstimateScale;
}

BeamSearch::Band BeamSearch::band(int ahead) const {
    if (ended_ || ahead < 0 || ahead >= left())
        throw std::invalid_argument("the picture has no such band");
    const int32_t width = kScreenWidth >> scale_, height = kScreenHeight >> scale_, rows = height / kBands;
    Camera camera = refit(views_[order_[view_]], {kScreenWidth, kScreenHeight}, {width, height});
    // direction = look + right (column - W / 2) + up (H / 2 - row): a band is a picture with another look.
    const int32_t shift = height / 2 - (band_ + ahead) * rows - rows / 2;
    for (int axis = 0; axis < 3; ++axis)
        camera.look[axis] += shift * camera.up[axis];
    // refit finds the largest registers that hold this look. They are rounded anew: some directions move by 1 %.
    return {refit(camera, {rows, rows}, {width, rows}), width, rows};
}

void BeamSearch::give(double cycles) {
    if (ended_)
        throw std::logic_error("the search has ended");
    const int32_t rows = (kScreenHeight >> scale_) / kBands;
    const int32_t part = scale_ == kEstimateScale ? 1 << (kEstimateScale - kFirstScale) : 1;
    rows_.insert(rows_.end(), static_cast<size_t>(part * rows), part * cycles / rows);
    if (++band_ < kBands)
        return;
    band_ = 0;
    ++done_;
    const int scale = scale_ == kEstimateScale ? kFirstScale : scale_;
    const double lead = beam_lead(rows_, line_, scale, buffer_lines_);
    finish({scale, std::exchange(rows_, {}), lead});
}

void BeamSearch::finish(Picture picture) {
    if (scale_ == kEstimateScale) {
        estimates_.push_back(picture.lead);
        if (++view_ < views_.size())
            return;
        std::stable_sort(order_.begin(), order_.end(),
                         [&](size_t a, size_t b) { return estimates_[a] < estimates_[b]; });
        scale_ = kFirstScale;
        view_ = 0;
        return;
    }
    if (scale_ != kFirstScale) {
        if (scale_ == kLargestScale || picture.lead >= 0)
            chosen_ = std::move(picture);
        ended_ = true;
        return;
    }
    if (view_ == 0 || picture.lead < chosen_.lead) {
        chosen_ = std::move(picture);
        chosen_view_ = view_;
    }
    if (++view_ < slowest_)
        return;
    view_ = chosen_view_;
    // Pictures of twice the side take nearly twice as long per row, and rows have half the time.
    std::vector<double> estimate;
    for (const double row : chosen_.rows)
        estimate.insert(estimate.end(), 2, 2 * row);
    if (chosen_.lead < 0)
        scale_ = kLargestScale;
    else if (beam_lead(estimate, line_, 0, buffer_lines_) >= 0)
        scale_ = 0;
    else
        ended_ = true;
}

int BeamSearch::left() const { return kBands - band_; }

BeamFit BeamSearch::fit() const {
    double cycles = 0;
    for (const double row : chosen_.rows)
        cycles += row;
    const double screens = std::max(1.0, std::ceil(cycles / (line_ * kLines)));
    const double pixels = static_cast<double>((kScreenWidth >> chosen_.scale) * (kScreenHeight >> chosen_.scale));
    return {chosen_.scale, cycles / pixels, chosen_.lead, kPixelHz / (kLinePixels * kLines * screens)};
}

} // namespace voxrt::sim
