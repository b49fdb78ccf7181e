// Which voxels of a tile lie inside a surface with holes: those where its generalized winding number exceeds 1/2
// (Jacobson, Kavan and Sorkine-Hornung 2013; cap_winding.h).
//
// That number is the winding number of the capped surface, known for every voxel, less what the caps add. Where no
// boundary of a hole is near, what they add changes smoothly and is expanded to second order (near_caps.h). Cubes are
// classified from large to small. Where the caps add less than 1/2, the capped surface decides; where no surface passes
// a cube, one voxel may decide all; else the cube is split. In bricks that stay mixed, cells of 8 and 4 voxels are
// expanded, and each region of voxels that no surface separates takes its whole number from one voxel. What is left,
// at the boundaries and close to 1/2, is summed voxel by voxel, with smaller and smaller errors. A voxel within the
// rounding error of 1/2 counts as outside.
//
// Cost: bricks near boundaries, and bricks that the surface of 1/2 passes; fourfold per level.
#pragma once

#include "../coverage/tile_surface.h"
#include "../holes/cap_winding.h"
#include "../holes/near_caps.h"
#include "../mesh/mesh_analysis.h"
#include "brick_cell.h"
#include "tile_voxels.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace voxrt::voxelize {

class GeneralizedInside {
public:
    /// How the voxels of a brick are decided. `capped`: a voxel is inside where the winding number of the capped
    /// surface is not zero. `mixed`: voxel by voxel. `rough`: voxel by voxel, near the boundary of a hole.
    enum class Class : uint8_t { outside, inside, capped, mixed, rough };
    static bool is_mixed(Class c) { return c == Class::mixed || c == Class::rough; }

    /// What the classification needs to know of a brick: the capped surface's winding number at two of its voxels.
    struct Brick {
        int corner = 0, middle = 0; // voxels (0, 0, 0) and (4, 4, 4)
        bool has_surface = false;
    };

    /// Begins a tile. The inside lies within `box`. Every brick() must then be set before classify().
    void reset(const CapWinding& caps, const VoxelBox& box, const Window& window) {
        caps_ = &caps;
        all_ = caps.all();
        side_ = window.top + 1;
        height_ = (side_ + kBrickSide - 1) / kBrickSide;
        x0_ = window.x0;
        y0_ = window.y0;
        const int last[3] = {window.x1, window.y1, window.top};
        const int first[3] = {window.x0, window.y0, 0};
        for (int i = 0; i < 3; ++i) {
            low_[i] = std::max(box.low[i], first[i]);
            high_[i] = std::min(box.high[i], last[i]);
        }
        bricks_.resize(size_t(kTileColumns) * height_);
        classes_.assign(bricks_.size(), Class::outside);
    }

    Brick& brick(int column, int k) { return bricks_[size_t(column) * height_ + k]; }

    /// Classifies all bricks.
    void classify() {
        for (int k = 0; k < height_; k += kTileBricks)
            classify_cube(0, 0, k, kTileBricks);
    }

    Class class_of(int column, int k) const { return classes_[size_t(column) * height_ + k]; }

    /// A brick's voxels within the box: where the inside may be.
    Slices box_of(int column, int k) const {
        const int x = x0_ + column % kTileBricks * kBrickSide, y = y0_ + column / kTileBricks * kBrickSide;
        uint64_t columns = 0;
        for (int bit = 0; bit < 64; ++bit) {
            const int u = x + column_x(bit), v = y + column_y(bit);
            if (u >= low_[0] && u <= high_[0] && v >= low_[1] && v <= high_[1])
                columns |= uint64_t{1} << bit;
        }
        Slices box{};
        for (int z = 0; z < kBrickSide; ++z)
            if (k * kBrickSide + z >= low_[2] && k * kBrickSide + z <= high_[2])
                box[z] = columns;
        return box;
    }

    /// The voxels of a mixed brick that are inside and have no surface. `numbers`: the capped surface's winding number
    /// of each voxel, by slice and bit.
    Slices inside(int column, int k, const Slices& surface, const std::vector<int>& numbers) {
        x_ = x0_ + column % kTileBricks * kBrickSide;
        y_ = y0_ + column / kTileBricks * kBrickSide;
        z_ = k * kBrickSide;
        numbers_ = numbers.data();
        surface_ = &surface;
        undecided_ = box_of(column, k);
        within_ = {};
        for (int z = 0; z < kBrickSide; ++z)
            undecided_[z] &= ~surface[z];
        const Cell brick{0, 0, 0, std::min(side_, kBrickSide)};
        double far_error = kFine;
        bool first = true;
        if (class_of(column, k) == Class::rough) {
            classify_parts_apart(brick, kCoarse);
            classify_parts_apart(brick, kFine);
            far_error /= kFiner;
        }
        for (; far_error >= kFinest && !is_empty(undecided_); far_error /= kFiner) {
            const bool by_cells = first || count_undecided(brick) > kFewVoxels;
            first = false;
            const Ball ball = by_cells ? Ball{centre_of(brick), radius_of(brick)} : around_undecided();
            near_.gather(*caps_, all_, ball.centre, ball.radius, far_error, NearCaps::kAll);
            if (by_cells) {
                rough_ = {};
                classify_cell(brick);
                classify_one_by_one(rough_);
            } else {
                classify_one_by_one(undecided_);
            }
            if (near_.error_bound() < kRounding)
                break;
        }
        if (!is_empty(undecided_))
            classify_one_by_one(undecided_);
        for (int z = 0; z < kBrickSide; ++z)
            for (; undecided_[z] != 0; undecided_[z] &= undecided_[z] - 1) {
                const int bit = std::countr_zero(undecided_[z]);
                if (is_inside(sample(z, bit), numbers_[z * 64 + bit]))
                    within_[z] |= uint64_t{1} << bit;
            }
        return within_;
    }

    /// Those of the voxels with surface of a mixed brick whose sample point is inside.
    Slices inside_at_surface(int column, int k, const Slices& surface, const std::vector<int>& numbers) {
        const Slices box = box_of(column, k);
        x_ = x0_ + column % kTileBricks * kBrickSide;
        y_ = y0_ + column / kTileBricks * kBrickSide;
        z_ = k * kBrickSide;
        Slices found{};
        for (int z = 0; z < kBrickSide; ++z)
            for (uint64_t left = surface[z] & box[z]; left != 0; left &= left - 1) {
                const int bit = std::countr_zero(left);
                if (is_inside(sample(z, bit), numbers[size_t(z * 64 + bit)]))
                    found[z] |= uint64_t{1} << bit;
            }
        return found;
    }

private:
    static constexpr double kSqrt3 = 1.7320508075688772;
    static constexpr double kTie = 0.5 + 1e-6;          // above 1/2 by more than rounding
    static constexpr double kSample = 0.5 + 1.0 / 8192; // the sample point of a voxel is on its column's ray
    // Errors of one node of caps: for cubes; for voxels near a boundary; for others; where all else is exact.
    static constexpr double kCubeError = 1.0 / 256, kCoarse = 1.0 / 1024, kFine = 1.0 / (1 << 13);
    static constexpr double kFinest = 1.0 / (1 << 22), kFiner = 16;
    static constexpr size_t kManyCaps = 64;     // near a cube: its parts are asked instead
    static constexpr double kRounding = 1e-7;   // the error of an angle that is not doubtful
    static constexpr double kRoundable = 0.375; // error from which a whole number can be told
    static constexpr int kFewVoxels = 16;       // so few are decided one by one

    using Cell = BrickCell;
    struct Ball {
        Point centre;
        double radius;
    };

    bool outside_box(int x, int y, int z, int side) const {
        return x > high_[0] || y > high_[1] || z > high_[2] || x + side <= low_[0] || y + side <= low_[1] ||
               z + side <= low_[2];
    }

    void classify_cube(int bx, int by, int k, int bricks) {
        const int x = x0_ + bx * kBrickSide, y = y0_ + by * kBrickSide, z = k * kBrickSide, side = bricks * kBrickSide;
        if (outside_box(x, y, z, side))
            return;
        const Class result = class_of_cube(bx, by, k, bricks);
        if (is_mixed(result) && bricks > 1) {
            const int step = bricks / 2;
            for (int i = 0; i < 8; ++i)
                classify_cube(bx + (i & 1) * step, by + (i >> 1 & 1) * step, k + (i >> 2) * step, step);
            return;
        }
        for (int v = by; v < by + bricks; ++v)
            for (int u = bx; u < bx + bricks; ++u)
                std::fill_n(classes_.begin() + slot(u, v, k), std::min(bricks, height_ - k), result);
    }

    ptrdiff_t slot(int bx, int by, int k) const { return ptrdiff_t(by * kTileBricks + bx) * height_ + k; }

    bool any_surface(int bx, int by, int k, int bricks) const {
        for (int v = by; v < by + bricks; ++v)
            for (int u = bx; u < bx + bricks; ++u)
                for (int w = k; w < k + bricks; ++w)
                    if (bricks_[slot(u, v, w)].has_surface)
                        return true;
        return false;
    }

    Class class_of_cube(int bx, int by, int k, int bricks) {
        const int x = x0_ + bx * kBrickSide, y = y0_ + by * kBrickSide, z = k * kBrickSide, side = bricks * kBrickSide;
        const bool clear =
            x + side <= side_ && y + side <= side_ && z + side <= side_ && !any_surface(bx, by, k, bricks);
        const double middle = (side - 1) / 2.0 + kSample, radius = (side - 1) / 2.0 * kSqrt3;
        const Point centre{x + middle, y + middle, z + middle};
        if (!near_.gather(*caps_, all_, centre, radius, kCubeError, kManyCaps))
            return Class::rough;
        const NearCaps::Change change = near_.find_change(centre, radius, 0.5);
        const double error = 2 * change.error_bound + near_.error_bound() + kRounding;
        if (!(error < 0.5) || (change.crossed && !clear))
            return Class::rough;
        // From the sample point of a voxel, where the winding number of the capped surface is known.
        const Brick& brick = bricks_[slot(bx + bricks / 2, by + bricks / 2, k + bricks / 2)];
        const double half = side / 2 + kSample, off = half - middle;
        bool doubtful;
        const double angle = near_.find_angle({x + half, y + half, z + half}, doubtful);
        const double spread = change.most(radius) + std::abs(change.at({off, off, off})) + error;
        if (doubtful)
            return Class::rough;
        if (!change.crossed && std::abs(angle) + spread < 0.5)
            return Class::capped;
        if (!clear)
            return Class::mixed;
        const double there = std::abs((bricks > 1 ? brick.corner : brick.middle) - angle);
        return there - spread > kTie ? Class::inside : there + spread < 0.5 ? Class::outside : Class::mixed;
    }

    Point centre_of(const Cell& cell) const {
        const double middle = (cell.side - 1) / 2.0 + kSample;
        return {x_ + cell.x + middle, y_ + cell.y + middle, z_ + cell.z + middle};
    }
    static double radius_of(const Cell& cell) { return (cell.side - 1) / 2.0 * kSqrt3; }
    Point sample(int z, int bit) const {
        return {x_ + column_x(bit) + kSample, y_ + column_y(bit) + kSample, z_ + z + kSample};
    }
    int count_undecided(const Cell& cell) const {
        int count = 0;
        for (int z = cell.z; z < cell.z + cell.side; ++z)
            count += std::popcount(undecided_[z] & square_of(cell));
        return count;
    }

    /// Holds the undecided voxels, of which there are some.
    Ball around_undecided() const {
        uint64_t columns = 0;
        int low[3] = {kBrickSide, kBrickSide, kBrickSide}, high[3] = {0, 0, 0};
        for (int z = 0; z < kBrickSide; ++z)
            if (undecided_[z] != 0) {
                columns |= undecided_[z];
                low[2] = std::min(low[2], z);
                high[2] = z;
            }
        for (; columns != 0; columns &= columns - 1) {
            const int at[2] = {column_x(std::countr_zero(columns)), column_y(std::countr_zero(columns))};
            for (int i = 0; i < 2; ++i) {
                low[i] = std::min(low[i], at[i]);
                high[i] = std::max(high[i], at[i]);
            }
        }
        double half[3];
        for (int i = 0; i < 3; ++i)
            half[i] = (high[i] - low[i]) / 2.0;
        return {{x_ + low[0] + half[0] + kSample, y_ + low[1] + half[1] + kSample, z_ + low[2] + half[2] + kSample},
                std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2])};
    }

    /// Whether a voxel is inside, with as small an error as the decision takes.
    bool is_inside(const Point& q, int number) const {
        for (const double tolerance : {1e-3, 1e-5}) {
            const double there = std::abs(number - caps_->at(q, tolerance));
            if (there - tolerance > kTie || there + tolerance < 0.5)
                return there > 0.5;
        }
        return std::abs(number - caps_->at(q, 0)) > kTie;
    }

    /// What is known of the angle in a cell: its value at the centre, and how it changes.
    struct Expansion {
        Point centre;
        NearCaps::Change change;
        double error_bound; // of the value and of its change
        double angle = 0;
        double at(const Point& q) const { return angle + change.at({q.x - centre.x, q.y - centre.y, q.z - centre.z}); }
    };

    /// Decides what an expansion about the centre of the cell can, then of its parts. Parts where the angle is not
    /// smooth are left to classify_one_by_one.
    void classify_cell(const Cell& cell) {
        if (count_undecided(cell) == 0)
            return;
        const Ball ball{centre_of(cell), radius_of(cell)};
        Expansion expansion{ball.centre, near_.find_change(ball.centre, ball.radius, kRoundable), 0};
        expansion.error_bound = expansion.change.error_bound + near_.error_bound() + kRounding;
        if (expansion.error_bound < kRoundable) {
            bool doubtful;
            expansion.angle = near_.find_angle(expansion.centre, doubtful);
            if (expansion.change.crossed)
                classify_regions(cell, expansion);
            else if (!doubtful)
                for (int z = cell.z; z < cell.z + cell.side; ++z)
                    for (uint64_t left = undecided_[z] & square_of(cell); left != 0; left &= left - 1) {
                        const int bit = std::countr_zero(left);
                        decide(z, bit, std::abs(numbers_[z * 64 + bit] - expansion.at(sample(z, bit))),
                               expansion.error_bound);
                    }
            if (expansion.change.error_bound < near_.error_bound())
                return; // the next gathering knows more
        }
        classify_parts(cell);
    }

    /// Decides what it can near the boundary of a hole. Most voxels there are far from 1/2, and few caps are near
    /// enough to a part of the brick to matter for it.
    void classify_parts_apart(const Cell& brick, double far_error) {
        if (is_empty(undecided_))
            return;
        const int side = std::max(1, brick.side / 2);
        caps_->split(all_, centre_of(brick), radius_of(brick), far_error, side, NearCaps::kAll, seen_);
        for (int x = 0; x < brick.side; x += side)
            for (int y = 0; y < brick.side; y += side)
                for (int z = 0; z < brick.side; z += side) {
                    const Cell part{x, y, z, side};
                    if (count_undecided(part) == 0)
                        continue;
                    near_.gather(*caps_, seen_, centre_of(part), radius_of(part), far_error, NearCaps::kAll);
                    rough_ = {};
                    classify_cell(part);
                    classify_one_by_one(rough_);
                }
    }

    void classify_parts(const Cell& cell) {
        const int half = cell.side / 2;
        if (cell.side > kBrickSide / 2)
            for (int i = 0; i < 8; ++i)
                classify_cell({cell.x + (i & 1) * half, cell.y + (i >> 1 & 1) * half, cell.z + (i >> 2) * half, half});
        else
            for (int z = cell.z; z < cell.z + cell.side; ++z)
                rough_[z] |= undecided_[z] & square_of(cell);
    }

    /// Decides a voxel where a winding number leaves no doubt.
    void decide(int z, int bit, double number, double error) {
        if (number - error > kTie)
            within_[z] |= uint64_t{1} << bit;
        else if (!(number + error < 0.5))
            return;
        undecided_[z] &= ~(uint64_t{1} << bit);
    }

    /// Decides voxels with an angle of their own each.
    void classify_one_by_one(const Slices& voxels) {
        NearCaps::Batch batch;
        int slices[NearCaps::kBatch], bits[NearCaps::kBatch];
        const double error = near_.error_bound() + kRounding;
        const auto finish = [&] {
            if (batch.count == 0)
                return;
            near_.find_angles(batch);
            for (int i = 0; i < batch.count; ++i)
                if (!batch.doubtful[i])
                    decide(slices[i], bits[i], std::abs(numbers_[slices[i] * 64 + bits[i]] - batch.angle[i]), error);
            batch.clear();
        };
        for (int z = 0; z < kBrickSide; ++z)
            for (uint64_t left = undecided_[z] & voxels[z]; left != 0; left &= left - 1) {
                const int bit = std::countr_zero(left);
                slices[batch.count] = z;
                bits[batch.count] = bit;
                batch.add(sample(z, bit));
                if (batch.count == NearCaps::kBatch)
                    finish();
            }
        finish();
    }

    /// Decides where caps pass the cell. In a region of voxels that no surface separates, the number of the surface
    /// changes smoothly, whatever caps pass it. So one voxel tells by which whole number the expansion is off.
    void classify_regions(const Cell& cell, const Expansion& expansion) {
        const uint64_t square = square_of(cell);
        Slices left{};
        for (int z = cell.z; z < cell.z + cell.side; ++z)
            left[z] = ~(*surface_)[z] & square;
        for (int z = cell.z; z < cell.z + cell.side; ++z)
            while (left[z] != 0) {
                Slices region{};
                region[z] = left[z] & (~left[z] + 1);
                const int first = std::countr_zero(region[z]);
                grow(region, left, cell);
                uint64_t wanted = 0;
                for (int w = cell.z; w < cell.z + cell.side; ++w) {
                    left[w] &= ~region[w];
                    wanted |= region[w] & undecided_[w];
                }
                if (wanted == 0)
                    continue;
                bool doubtful;
                const double angle = near_.find_angle(sample(z, first), doubtful);
                if (doubtful)
                    continue;
                const double whole = numbers_[z * 64 + first] - std::round(angle - expansion.at(sample(z, first)));
                for (int w = cell.z; w < cell.z + cell.side; ++w)
                    for (uint64_t some = region[w] & undecided_[w]; some != 0; some &= some - 1) {
                        const int bit = std::countr_zero(some);
                        decide(w, bit, std::abs(whole - expansion.at(sample(w, bit))), expansion.error_bound);
                    }
            }
    }

    const CapWinding* caps_ = nullptr;
    CapWinding::Seen all_, seen_; // from anywhere; from the brick
    int side_ = 0, height_ = 0, x0_ = 0, y0_ = 0;
    int low_[3] = {}, high_[3] = {};
    std::vector<Brick> bricks_;
    std::vector<Class> classes_;

    // The current mixed brick.
    int x_ = 0, y_ = 0, z_ = 0;
    const int* numbers_ = nullptr;
    const Slices* surface_ = nullptr;
    Slices undecided_{}, within_{}, rough_{}; // rough_: where expansions do not help
    NearCaps near_;
};

} // namespace voxrt::voxelize
