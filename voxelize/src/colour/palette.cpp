#include "palette.h"

#include "../work/interrupt.h"
#include "srgb.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace voxrt::voxelize {
namespace {

// Beyond this many colours, those that share the upper 5 bits of each channel stay together: entries are farther apart.
constexpr size_t kDistinct = 1 << 14;
constexpr int kMostRounds = 32;    // of k-means; few colours still move after twenty
constexpr int kFraction = 4;       // of a code, in the places of points
constexpr double kWhole = 1 << 30; // the sum of all weights

uint32_t packed(const Srgb& one) { return uint32_t{one[0]} << 16 | uint32_t{one[1]} << 8 | one[2]; }
Srgb unpacked(uint32_t code) { return {uint8_t(code >> 16), uint8_t(code >> 8), uint8_t(code)}; }

/// Distinct colours, ascending, and the index of each colour among them.
class DistinctColours {
public:
    explicit DistinctColours(std::span<const Srgb> colours) : seen_(1 << 18), rank_(1 << 18) {
        for (const Srgb& one : colours)
            seen_[packed(one) >> 6] |= uint64_t{1} << (packed(one) & 63);
        uint32_t rank = 0;
        for (size_t word = 0; word < seen_.size(); ++word) {
            rank_[word] = rank;
            for (uint64_t bits = seen_[word]; bits != 0; bits &= bits - 1)
                codes_.push_back(static_cast<uint32_t>(word << 6 | static_cast<unsigned>(std::countr_zero(bits))));
            rank = static_cast<uint32_t>(codes_.size());
        }
    }

    const std::vector<uint32_t>& codes() const { return codes_; }

    size_t index(const Srgb& one) const {
        const uint32_t code = packed(one);
        const uint64_t below = seen_[code >> 6] & ((uint64_t{1} << (code & 63)) - 1);
        return rank_[code >> 6] + static_cast<unsigned>(std::popcount(below));
    }

private:
    std::vector<uint64_t> seen_;
    std::vector<uint32_t> rank_, codes_;
};

struct Point {
    std::array<int32_t, 3> place; // sRGB, in 1/kFraction
    int64_t weight;
};

/// Sums over points. Weights stay below 2^32 together and places below 2^10, so squares fit too.
struct Sums {
    int64_t weight = 0, squares = 0;
    std::array<int64_t, 3> place{};

    void add(const Point& point, int64_t sign = 1) {
        weight += sign * point.weight;
        for (int axis = 0; axis < 3; ++axis) {
            place[axis] += sign * point.weight * point.place[axis];
            squares += sign * point.weight * point.place[axis] * point.place[axis];
        }
    }
    /// The part of the sum of squared distances from the mean that depends on how points are divided.
    double explained() const {
        double sum = 0;
        for (const int64_t one : place)
            sum += double(one) * double(one);
        return weight > 0 ? sum / double(weight) : 0;
    }
    std::array<int32_t, 3> mean() const {
        std::array<int32_t, 3> found;
        for (int axis = 0; axis < 3; ++axis)
            found[axis] = static_cast<int32_t>((2 * place[axis] + weight) / (2 * weight));
        return found;
    }
};

/// A run of points, and its best division in two.
struct Group {
    size_t first, end, middle = 0;
    double gain = 0; // by which its division lessens the sum of squares; 0: it has none
};

/// Orders the points of a group along the channel that varies most, and finds where to divide them.
Group with_division(std::vector<Point>& points, size_t first, size_t end) {
    Group group{first, end};
    Sums all;
    std::array<double, 3> squares{};
    for (size_t i = first; i < end; ++i) {
        all.add(points[i]);
        for (int axis = 0; axis < 3; ++axis)
            squares[axis] += double(points[i].weight) * points[i].place[axis] * points[i].place[axis];
    }
    int widest = 0;
    std::array<double, 3> variance;
    for (int axis = 0; axis < 3; ++axis) {
        variance[axis] = squares[axis] - double(all.place[axis]) * double(all.place[axis]) / double(all.weight);
        if (variance[axis] > variance[widest])
            widest = axis;
    }
    std::sort(points.begin() + static_cast<ptrdiff_t>(first), points.begin() + static_cast<ptrdiff_t>(end),
              [&](const Point& one, const Point& other) {
                  return one.place[widest] != other.place[widest] ? one.place[widest] < other.place[widest]
                                                                  : one.place < other.place;
              });
    Sums left, right = all;
    for (size_t i = first; i + 1 < end; ++i) {
        left.add(points[i]);
        right.add(points[i], -1);
        if (points[i].place[widest] == points[i + 1].place[widest])
            continue;
        const double gain = left.explained() + right.explained() - all.explained();
        if (gain > group.gain) {
            group.gain = gain;
            group.middle = i + 1;
        }
    }
    count_work(static_cast<uint32_t>(16 * (end - first)));
    return group;
}

/// Divides points into at most `count` groups; returns their means.
std::vector<std::array<int32_t, 3>> divided(std::vector<Point> points, size_t count) {
    std::vector<Group> groups{with_division(points, 0, points.size())};
    while (groups.size() < count) {
        const auto best = std::max_element(groups.begin(), groups.end(),
                                           [](const Group& one, const Group& other) { return one.gain < other.gain; });
        if (!(best->gain > 0))
            break;
        const Group one = *best;
        *best = with_division(points, one.first, one.middle);
        groups.push_back(with_division(points, one.middle, one.end));
    }
    std::vector<std::array<int32_t, 3>> means;
    for (const Group& group : groups) {
        Sums sums;
        for (size_t i = group.first; i < group.end; ++i)
            sums.add(points[i]);
        means.push_back(sums.mean());
    }
    return means;
}

/// The index of the mean nearest to a place, the first where several are.
uint32_t nearest(const std::array<int32_t, 3>& place, const std::array<std::vector<int32_t>, 3>& means) {
    uint32_t best = std::numeric_limits<uint32_t>::max();
    for (size_t k = 0; k < means[0].size(); ++k) { // 22 bits of distance and 8 of the index
        const int32_t x = place[0] - means[0][k], y = place[1] - means[1][k], z = place[2] - means[2][k];
        best = std::min(best, static_cast<uint32_t>(x * x + y * y + z * z) << 8 | static_cast<uint32_t>(k));
    }
    return best & 255;
}

/// The group of each point, at most `count`.
std::vector<uint8_t> grouped(const std::vector<Point>& points, size_t count) {
    std::array<std::vector<int32_t>, 3> means;
    for (const auto& mean : divided(points, count))
        for (size_t axis = 0; axis < 3; ++axis)
            means[axis].push_back(mean[axis]);
    std::vector<uint8_t> groups(points.size());
    for (int round = 0; round < kMostRounds; ++round) {
        bool moved = false;
        std::vector<Sums> sums(means[0].size());
        for (size_t i = 0; i < points.size(); ++i) {
            const auto group = static_cast<uint8_t>(nearest(points[i].place, means));
            moved |= group != groups[i];
            groups[i] = group;
            sums[group].add(points[i]);
            count_work(static_cast<uint32_t>(means[0].size() / 8 + 1));
        }
        if (!moved && round > 0)
            break;
        for (size_t group = 0; group < sums.size(); ++group)
            if (sums[group].weight > 0)
                for (size_t axis = 0; axis < 3; ++axis)
                    means[axis][group] = sums[group].mean()[axis];
    }
    return groups;
}

/// Points for colours, or for cells of colours where there are many; and the point of each colour.
std::vector<Point> points_of(const std::vector<uint32_t>& codes, const std::vector<double>& cover,
                             std::vector<uint32_t>& point_of) {
    const double whole = std::accumulate(cover.begin(), cover.end(), 0.0);
    const auto weight_of = [&](double share) {
        return whole > 0 ? std::max<int64_t>(1, static_cast<int64_t>(std::floor(share / whole * kWhole + 0.5))) : 1;
    };
    point_of.resize(codes.size());
    std::vector<Sums> cells;
    std::vector<uint32_t> cell_of(codes.size() > kDistinct ? 1 << 15 : 0, std::numeric_limits<uint32_t>::max());
    for (size_t i = 0; i < codes.size(); ++i) {
        const Srgb srgb = unpacked(codes[i]);
        uint32_t cell = static_cast<uint32_t>(i);
        if (!cell_of.empty()) {
            uint32_t& number = cell_of[unsigned{srgb[0]} >> 3 << 10 | unsigned{srgb[1]} >> 3 << 5 | srgb[2] >> 3];
            if (number == std::numeric_limits<uint32_t>::max())
                number = static_cast<uint32_t>(cells.size());
            cell = number;
        }
        if (cell == cells.size())
            cells.emplace_back();
        point_of[i] = cell;
        cells[cell].add({{kFraction * srgb[0], kFraction * srgb[1], kFraction * srgb[2]}, weight_of(cover[i])});
    }
    std::vector<Point> points;
    for (const Sums& cell : cells)
        points.push_back({cell.mean(), cell.weight});
    return points;
}

} // namespace

Palette quantize(std::span<const Srgb> colours, const Numbers& weights, int count) {
    const DistinctColours distinct(colours);
    const std::vector<uint32_t>& codes = distinct.codes();
    Palette palette;
    palette.rows.resize(colours.size());
    if (codes.size() <= static_cast<size_t>(count)) {
        for (const uint32_t code : codes)
            palette.entries.push_back(unpacked(code));
        for (size_t i = 0; i < colours.size(); ++i)
            palette.rows[i] = static_cast<uint8_t>(distinct.index(colours[i]));
        return palette;
    }
    std::vector<double> cover(codes.size());
    for (size_t i = 0; i < colours.size(); ++i)
        cover[distinct.index(colours[i])] += weights[i];
    std::vector<uint32_t> point_of;
    const std::vector<uint8_t> groups = grouped(points_of(codes, cover, point_of), static_cast<size_t>(count));

    std::array<double, 256> covered{};
    for (size_t i = 0; i < codes.size(); ++i)
        covered[groups[point_of[i]]] += cover[i];
    std::array<std::array<double, 4>, 256> light{}; // sums of light times share, then the sum of shares
    for (size_t i = 0; i < codes.size(); ++i) {
        const uint8_t group = groups[point_of[i]];
        const double share = covered[group] > 0 ? cover[i] : 1; // a group of no area has a mean too
        const Srgb srgb = unpacked(codes[i]);
        for (size_t channel = 0; channel < 3; ++channel)
            light[group][channel] += share * SrgbCurve::get().linear()[srgb[channel]];
        light[group][3] += share;
    }
    std::array<uint32_t, 256> entry_of{};
    std::vector<uint32_t> entries;
    for (size_t group = 0; group < light.size(); ++group) {
        if (light[group][3] == 0)
            continue;
        Srgb mean;
        for (size_t channel = 0; channel < 3; ++channel)
            mean[channel] = srgb_from_linear(light[group][channel] / light[group][3]);
        entries.push_back(entry_of[group] = packed(mean));
    }
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
    for (const uint32_t entry : entries)
        palette.entries.push_back(unpacked(entry));
    std::array<uint8_t, 256> row_of{};
    for (size_t group = 0; group < row_of.size(); ++group)
        row_of[group] =
            static_cast<uint8_t>(std::lower_bound(entries.begin(), entries.end(), entry_of[group]) - entries.begin());
    for (size_t i = 0; i < colours.size(); ++i)
        palette.rows[i] = row_of[groups[point_of[distinct.index(colours[i])]]];
    return palette;
}

} // namespace voxrt::voxelize
