#include "thin_parts.h"

#include "rule.h"
#include "thin_voxels.h"

namespace voxrt::voxelize {
namespace {

/// A brick with candidates that may still be taken away.
struct ThinBrick {
    uint32_t brick;
    std::array<uint32_t, 27> around;
    Slices candidates, taken;
};

// The 27 voxels around one: bit x + 3 y + 9 z, each 0 … 2.
constexpr uint32_t kNoCorners = [] {
    uint32_t found = 0;
    for (int n = 0; n < 27; ++n)
        if (n % 3 == 1 || n / 3 % 3 == 1 || n / 9 == 1)
            found |= 1u << n;
    return found & ~kMiddle;
}();

/// The neighbours of each: by a side, or at all.
template <bool by_sides> constexpr std::array<uint32_t, 27> neighbours() {
    std::array<uint32_t, 27> found{};
    for (int a = 0; a < 27; ++a)
        for (int b = 0; b < 27; ++b) {
            const int d[3] = {a % 3 - b % 3, a / 3 % 3 - b / 3 % 3, a / 9 - b / 9};
            int most = 0, sum = 0;
            for (int i : d) {
                most = std::max(most, i < 0 ? -i : i);
                sum += i < 0 ? -i : i;
            }
            if (by_sides ? sum == 1 : most == 1)
                found[size_t(a)] |= 1u << b;
        }
    return found;
}

/// What of `set` is reached from `from`.
template <bool by_sides> uint32_t reached(uint32_t from, uint32_t set) {
    static constexpr std::array<uint32_t, 27> beside = neighbours<by_sides>();
    uint32_t all = from;
    for (uint32_t front = from; front != 0;) {
        uint32_t next = 0;
        for (; front != 0; front &= front - 1)
            next |= beside[size_t(std::countr_zero(front))];
        front = next & set & ~all;
        all |= front;
    }
    return all;
}

/// Whether taking the middle voxel away leaves all connections.
bool is_simple(uint32_t filled) {
    filled &= ~kMiddle;
    if (filled == 0 || reached<false>(filled & (~filled + 1), filled) != filled)
        return false;
    const uint32_t empty = ~filled & kNoCorners, sides = empty & kSideMask;
    return sides != 0 && (sides & ~reached<true>(sides & (~sides + 1), empty)) == 0;
}

uint32_t bits_around(const BrickWindow<2>& window, int x, int y, int z) {
    uint32_t found = 0;
    for (int dz = 0; dz < 3; ++dz)
        for (int dy = 0; dy < 3; ++dy)
            found |= uint32_t(window.row(y + dy - 1, z + dz - 1) >> (x + window.kFirst - 1) & 7) << (3 * dy + 9 * dz);
    return found;
}

/// Whether each touched voxel around (x, y, z), which is taken away, is filled or has a filled neighbour.
bool leaves_none_alone(const BrickWindow<2>& filled, const BrickWindow<2>& touched, int x, int y, int z) {
    uint32_t left = bits_around(touched, x, y, z);
    for (; left != 0; left &= left - 1) {
        const int n = std::countr_zero(left);
        const int u = x + n % 3 - 1, v = y + n / 3 % 3 - 1, w = z + n / 9 - 1;
        uint32_t any = 0;
        for (int dz = -1; dz <= 1; ++dz)
            for (int dy = -1; dy <= 1; ++dy) {
                uint32_t row = filled.row(v + dy, w + dz);
                if (v + dy == y && w + dz == z)
                    row &= ~(1u << (x + filled.kFirst));
                any |= row >> (u + filled.kFirst - 1) & 7;
            }
        if (any == 0)
            return false;
    }
    return true;
}

/// The voxels of a brick that belong to thin parts.
Slices find_thin(const RuleBricks& bricks, size_t i) {
    if (bricks[i].is_thick)
        return {};
    const auto filled = [](const RuleBrick& b) -> const Slices& { return b.filled; };
    return thin_voxels(thin_in_column(bricks[i], {}, {}),
                       [&](uint32_t wanted) { return bricks.sets(bricks.around(i, wanted), filled); });
}

/// The voxels of a brick that are not filled, of thin parts or beside one of their voxels.
Slices find_candidates(const RuleBricks& bricks, const LargeVector<Slices>& thin, size_t i,
                       const std::array<uint32_t, 27>& around) {
    static constexpr Slices none{};
    std::array<const Slices*, 27> near;
    for (size_t n = 0; n < 27; ++n)
        near[n] = around[n] < RuleBricks::kFull ? &thin[around[n]] : &none;
    if (std::all_of(near.begin(), near.end(), [](const Slices* one) { return is_empty(*one); }))
        return {};
    BrickWindow<1> window;
    window.gather(near);
    window.dilate();
    Slices found = window.middle();
    const Slices removed = bricks[i].removed();
    for (int z = 0; z < kBrickSide; ++z)
        found[z] &= removed[z];
    return found;
}

/// Takes away what may go of a brick in one turn.
void take(const RuleBricks& bricks, ThinBrick& thin, int turn) {
    const uint64_t code = bricks[thin.brick].code;
    thin.taken = {};
    auto first = [&](int axis, int wanted) { // the first voxel of the turn along an axis
        const int corner = int(gather_bits(code >> axis)) * kBrickSide % 3;
        return (wanted - corner + 3) % 3;
    };
    uint64_t square = 0;
    for (int y = first(1, turn / 3 % 3); y < kBrickSide; y += 3)
        for (int x = first(0, turn % 3); x < kBrickSide; x += 3)
            square |= uint64_t{1} << column_bit(x, y);
    bool any = false;
    for (int z = first(2, turn / 9); z < kBrickSide; z += 3)
        any = any || (thin.candidates[z] & square) != 0;
    if (!any)
        return;
    BrickWindow<2> filled, touched;
    filled.gather(bricks.sets(thin.around, [](const RuleBrick& b) -> const Slices& { return b.filled; }));
    touched.gather(bricks.sets(thin.around, [](const RuleBrick& b) -> const Slices& { return b.touched; }));
    for (int z = first(2, turn / 9); z < kBrickSide; z += 3)
        for (uint64_t left = thin.candidates[z] & square; left != 0; left &= left - 1) {
            const int bit = std::countr_zero(left), x = column_x(bit), y = column_y(bit);
            if (is_simple(bits_around(filled, x, y, z)) && leaves_none_alone(filled, touched, x, y, z))
                thin.taken[z] |= uint64_t{1} << bit;
        }
}

} // namespace

void keep_thin_parts(RuleBricks& bricks, const Workers& workers, std::vector<AddedVoxels>* added) {
    constexpr size_t kBricks = 64; // per job
    const size_t jobs = (bricks.size() + kBricks - 1) / kBricks;
    LargeVector<Slices> of_thin_parts;
    of_thin_parts.resize(bricks.size());
    std::vector<uint8_t> has_some(jobs);
    workers.run(jobs, [&](size_t job, int) {
        for (size_t i = job * kBricks; i < std::min(bricks.size(), (job + 1) * kBricks); ++i) {
            count_work(100);
            of_thin_parts[i] = find_thin(bricks, i);
            has_some[job] |= uint8_t{!is_empty(of_thin_parts[i])};
        }
    });
    if (std::none_of(has_some.begin(), has_some.end(), [](uint8_t some) { return some != 0; }))
        return;
    std::vector<std::vector<ThinBrick>> found(jobs);
    workers.run(jobs, [&](size_t job, int) {
        for (size_t i = job * kBricks; i < std::min(bricks.size(), (job + 1) * kBricks); ++i) {
            count_work(100);
            if (is_empty(bricks[i].removed()))
                continue;
            const std::array<uint32_t, 27> around = bricks.around(i);
            const Slices candidates = find_candidates(bricks, of_thin_parts, i, around);
            if (!is_empty(candidates))
                found[job].push_back({uint32_t(i), around, candidates, {}});
        }
    });
    std::vector<ThinBrick> thin;
    for (const auto& part : found)
        thin.insert(thin.end(), part.begin(), part.end());
    for (const ThinBrick& t : thin)
        for (int z = 0; z < kBrickSide; ++z)
            bricks[t.brick].filled[z] |= t.candidates[z];
    const size_t thin_jobs = (thin.size() + kBricks - 1) / kBricks;
    for (int turn = 0; turn < 27; ++turn) {
        workers.run(thin_jobs, [&](size_t job, int) {
            for (size_t i = job * kBricks; i < std::min(thin.size(), (job + 1) * kBricks); ++i) {
                count_work(100);
                take(bricks, thin[i], turn);
            }
        });
        for (const ThinBrick& t : thin)
            for (int z = 0; z < kBrickSide; ++z)
                bricks[t.brick].filled[z] &= ~t.taken[z];
    }
    if (added == nullptr)
        return;
    for (const ThinBrick& t : thin)
        if (const Slices left = without(t.candidates, without(t.candidates, bricks[t.brick].filled)); !is_empty(left))
            added->push_back({t.brick, left});
}

} // namespace voxrt::voxelize
