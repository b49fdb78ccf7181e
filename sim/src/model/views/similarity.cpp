#include "similarity.h"

#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace voxrt::sim {

namespace {

using Values = std::vector<double>; // one per pixel

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);

std::array<double, 2 * kRadius + 1> window() {
    std::array<double, 2 * kRadius + 1> weights;
    double sum = 0;
    for (int i = -kRadius; i <= kRadius; ++i)
        sum += weights[i + kRadius] = std::exp(-(i * i) / (2 * kSigma * kSigma));
    for (double& weight : weights)
        weight /= sum;
    return weights;
}

/// A place of a line that is continued by its mirror image on both sides.
std::size_t mirrored(long at, long length) {
    const long period = 2 * length;
    at = ((at % period) + period) % period;
    return static_cast<std::size_t>(at < length ? at : period - 1 - at);
}

/// Columns first, then rows. The inner loops run along a row, so that compilers make vectors of them.
Values blurred(const Values& values, std::size_t width, std::size_t height) {
    static const auto weights = window();
    Values down(values.size()), found(values.size()), line(width + 2 * kRadius);
    for (std::size_t row = 0; row < height; ++row)
        for (int k = -kRadius; k <= kRadius; ++k) {
            const double* from =
                values.data() + width * mirrored(static_cast<long>(row) + k, static_cast<long>(height));
            for (std::size_t i = 0; i < width; ++i)
                down[width * row + i] += weights[k + kRadius] * from[i];
        }
    for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t i = 0; i < line.size(); ++i)
            line[i] = down[width * row + mirrored(static_cast<long>(i) - kRadius, static_cast<long>(width))];
        for (std::size_t k = 0; k < weights.size(); ++k)
            for (std::size_t i = 0; i < width; ++i)
                found[width * row + i] += weights[k] * line[i + k];
    }
    return found;
}

Values luma(const std::uint8_t* picture, std::size_t pixels) { // ITU-R BT.601
    Values found(pixels);
    for (std::size_t i = 0; i < pixels; ++i)
        found[i] = 0.299 * picture[3 * i] + 0.587 * picture[3 * i + 1] + 0.114 * picture[3 * i + 2];
    return found;
}

Values product(const Values& a, const Values& b) {
    Values found(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        found[i] = a[i] * b[i];
    return found;
}

} // namespace

double peak_signal_to_noise(const std::uint8_t* picture, const std::uint8_t* other, std::size_t pixels) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < 3 * pixels; ++i) {
        const int apart = picture[i] - other[i];
        sum += static_cast<std::uint64_t>(apart * apart);
    }
    if (sum == 0)
        return std::numeric_limits<double>::infinity();
    return 10 * std::log10(255.0 * 255.0 / (static_cast<double>(sum) / static_cast<double>(3 * pixels)));
}

double structural_similarity(const std::uint8_t* picture, const std::uint8_t* other, std::size_t width,
                             std::size_t height) {
    const std::size_t pixels = width * height;
    const Values x = luma(picture, pixels), y = luma(other, pixels);
    const auto blur = [&](const Values& values) { return blurred(values, width, height); };
    const Values mean_x = blur(x), mean_y = blur(y);
    const Values square_x = blur(product(x, x)), square_y = blur(product(y, y)), both = blur(product(x, y));
    double sum = 0;
    for (std::size_t i = 0; i < pixels; ++i) {
        const double a = mean_x[i], b = mean_y[i];
        const double variance_x = square_x[i] - a * a, variance_y = square_y[i] - b * b, covariance = both[i] - a * b;
        sum += ((2 * a * b + kC1) * (2 * covariance + kC2)) / ((a * a + b * b + kC1) * (variance_x + variance_y + kC2));
    }
    return sum / static_cast<double>(pixels);
}

} // namespace voxrt::sim
