// Which voxels of a tile lie inside a surface with holes: those where its generalized winding number exceeds 1/2
// (Jacobson, Kavan and Sorkine-Hornung 2013; cap_winding.h).
//
// That number is the winding number of the capped surface, known for every voxel, less what the caps add. Cubes are
// classified from large to small, each with the expansion that its parent handed down. Where no surface passes a cube,
// the number changes smoothly, and one voxel may decide all; where the caps add less than 1/2, the capped surface
// decides; else the cube is split. A voxel within the rounding error of 1/2 counts as outside.
//
// Cost: bricks with surface, and voxels near holes.
#pragma once

#include "cap_winding.h"
#include "mesh_analysis.h"
#include "tile_surface.h"
#include "tile_voxels.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace voxrt::voxelize {

class GeneralizedInside {
public:
    /// Of a brick. `capped`: inside where the winding number of the capped surface is not zero. `mixed`: voxel by
    /// voxel.
    enum class Class : uint8_t { outside, inside, capped, mixed };

    /// What the classification needs to know of a brick: the capped surface's winding number at two of its voxels.
    struct Brick {
        int corner = 0, middle = 0; // voxels (0, 0, 0) and (4, 4, 4)
        bool has_surface = false;
    };

    /// Begins a tile. The inside lies within `box`. Every brick() must then be set before classify().
    void reset(const CapWinding& caps, const VoxelBox& box, const Window& window) {
        caps_ = &caps;
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
        mixed_.resize(bricks_.size());
        expansions_.clear();
    }

    Brick& brick(int column, int k) { return bricks_[size_t(column) * height_ + k]; }

    /// Classifies all bricks.
    void classify() {
        const LocalExpansion all = caps_->unresolved();
        for (int k = 0; k < height_; k += kTileBricks)
            classify_cube(0, 0, k, kTileBricks, all, 0);
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
        Slices undecided = box_of(column, k), within{};
        for (int z = 0; z < kBrickSide; ++z)
            undecided[z] &= ~surface[z];
        classify_cell({0, 0, 0, std::min(side_, kBrickSide)}, expansions_[mixed_[size_t(column) * height_ + k]], 0,
                      undecided, within);
        return within;
    }

private:
    static constexpr double kSqrt3 = 1.7320508075688772;
    static constexpr double kTie = 0.5 + 1e-6;          // above 1/2 by more than rounding
    static constexpr double kSample = 0.5 + 1.0 / 8192; // the sample point of a voxel is on its column's ray

    struct Cell {
        int x, y, z, side; // in a brick
    };
    bool outside_box(int x, int y, int z, int side) const {
        return x > high_[0] || y > high_[1] || z > high_[2] || x + side <= low_[0] || y + side <= low_[1] ||
               z + side <= low_[2];
    }

    /// Expands about a cube whose lowest corner is (x, y, z); returns the largest distance of its sample points from
    /// the centre. Where caps pass a clear cube, one without surface, the centre is the sample point of a voxel, where
    /// the capped surface's winding number is known.
    double expand(const LocalExpansion& from, int x, int y, int z, int side, bool clear, LocalExpansion& to) const {
        double middle = (side - 1) / 2.0;
        caps_->expand(from, {x + middle + kSample, y + middle + kSample, z + middle + kSample}, middle * kSqrt3, to);
        if (!to.crossed || !clear)
            return middle * kSqrt3;
        middle = side / 2;
        caps_->expand(from, {x + middle + kSample, y + middle + kSample, z + middle + kSample}, middle * kSqrt3, to);
        return middle * kSqrt3;
    }

    static Point gradient(const LocalExpansion& e) {
        const Point &f = e.far.gradient, &n = e.near.gradient;
        return {f.x + n.x, f.y + n.y, f.z + n.z};
    }
    static double error_bound(const LocalExpansion& e) {
        return e.far.error_bound + e.near.error_bound + e.remainder_bound;
    }

    void classify_cube(int bx, int by, int k, int bricks, const LocalExpansion& from, int level) {
        const int x = x0_ + bx * kBrickSide, y = y0_ + by * kBrickSide, z = k * kBrickSide, side = bricks * kBrickSide;
        if (outside_box(x, y, z, side))
            return;
        const bool within = x + side <= side_ && y + side <= side_ && z + side <= side_;
        const bool clear = within && !any_surface(bx, by, k, bricks);
        LocalExpansion& expansion = levels_[level];
        const double radius = expand(from, x, y, z, side, clear, expansion);
        const Class result = class_from(expansion, radius, bx, by, k, bricks, clear);
        if (result == Class::mixed && bricks > 1) {
            const int step = bricks / 2;
            for (int i = 0; i < 8; ++i)
                classify_cube(bx + (i & 1) * step, by + (i >> 1 & 1) * step, k + (i >> 2) * step, step, expansion,
                              level + 1);
            return;
        }
        for (int v = by; v < by + bricks; ++v)
            for (int u = bx; u < bx + bricks; ++u)
                std::fill_n(classes_.begin() + slot(u, v, k), std::min(bricks, height_ - k), result);
        if (result == Class::mixed) {
            mixed_[slot(bx, by, k)] = uint32_t(expansions_.size());
            expansions_.push_back(expansion);
        }
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

    Class class_from(const LocalExpansion& expansion, double radius, int bx, int by, int k, int bricks,
                     bool clear) const {
        const Point g = gradient(expansion);
        const double error = std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z) * radius + error_bound(expansion);
        const double angle = expansion.far.angle + expansion.near.angle;
        if (!expansion.crossed && std::abs(angle) + error < 0.5)
            return Class::capped;
        if (!clear)
            return Class::mixed;
        const int half = bricks / 2;
        const Brick& middle = bricks_[slot(bx + half, by + half, k + half)];
        const double there = std::abs((bricks > 1 ? middle.corner : middle.middle) - angle);
        return there - error > kTie ? Class::inside : there + error < 0.5 ? Class::outside : Class::mixed;
    }

    static uint64_t square_of(const Cell& cell) {
        return cell.side == kBrickSide ? ~uint64_t{0}
                                       : ((uint64_t{1} << cell.side * cell.side) - 1) << column_bit(cell.x, cell.y);
    }
    bool is_clear(const Cell& cell) const {
        uint64_t any = 0;
        for (int z = cell.z; z < cell.z + cell.side; ++z)
            any |= (*surface_)[z] & square_of(cell);
        return any == 0;
    }

    /// Classifies the undecided voxels of a cell, none of which has surface.
    void classify_cell(const Cell& cell, const LocalExpansion& expansion, int level, Slices& undecided,
                       Slices& within) {
        const double error = error_bound(expansion);
        if (error < 0.5 && (!expansion.crossed || is_clear(cell))) {
            const Point g = gradient(expansion);
            const double angle = expansion.far.angle + expansion.near.angle;
            const int half = cell.side / 2;
            const int at_centre = numbers_[(cell.z + half) * 64 + column_bit(cell.x + half, cell.y + half)];
            for (int z = cell.z; z < cell.z + cell.side; ++z)
                for (uint64_t left = undecided[z] & square_of(cell); left != 0; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    const int number = expansion.crossed ? at_centre : numbers_[z * 64 + bit];
                    const double there =
                        std::abs(number - angle - g.x * (x_ + column_x(bit) + kSample - expansion.centre.x) -
                                 g.y * (y_ + column_y(bit) + kSample - expansion.centre.y) -
                                 g.z * (z_ + z + kSample - expansion.centre.z));
                    if (there - error > kTie)
                        within[z] |= uint64_t{1} << bit;
                    else if (!(there + error < (error == 0 ? kTie : 0.5)))
                        continue;
                    undecided[z] &= ~(uint64_t{1} << bit);
                }
        }
        uint64_t left = 0;
        for (int z = cell.z; z < cell.z + cell.side; ++z)
            left |= undecided[z] & square_of(cell);
        if (left == 0)
            return;
        if (cell.side == 1) {
            if (is_inside(cell))
                within[cell.z] |= left;
            return;
        }
        const int half = cell.side / 2;
        for (int i = 0; i < 8; ++i) {
            const Cell part{cell.x + (i & 1) * half, cell.y + (i >> 1 & 1) * half, cell.z + (i >> 2) * half, half};
            uint64_t some = 0;
            for (int z = part.z; z < part.z + half; ++z)
                some |= undecided[z] & square_of(part);
            if (some == 0)
                continue;
            expand(expansion, x_ + part.x, y_ + part.y, z_ + part.z, half, is_clear(part), levels_[level]);
            classify_cell(part, levels_[level], level + 1, undecided, within);
        }
    }

    /// Whether a voxel is inside, with as small an error as the decision takes.
    bool is_inside(const Cell& cell) const {
        const Point q{x_ + cell.x + kSample, y_ + cell.y + kSample, z_ + cell.z + kSample};
        const int number = numbers_[cell.z * 64 + column_bit(cell.x, cell.y)];
        for (const double tolerance : {1e-2, 1e-4}) {
            const double there = std::abs(number - caps_->at(q, tolerance));
            if (there - tolerance > kTie || there + tolerance < 0.5)
                return there > 0.5;
        }
        return std::abs(number - caps_->at(q, 0)) > kTie;
    }

    const CapWinding* caps_ = nullptr;
    int side_ = 0, height_ = 0, x0_ = 0, y0_ = 0;
    int low_[3] = {}, high_[3] = {};
    std::vector<Brick> bricks_;
    std::vector<Class> classes_;
    std::vector<uint32_t> mixed_;            // by brick: the number of its expansion
    std::vector<LocalExpansion> expansions_; // of mixed bricks
    LocalExpansion levels_[4];               // of the cubes, then of the cells around the current one

    // The current mixed brick.
    int x_ = 0, y_ = 0, z_ = 0;
    const int* numbers_ = nullptr;
    const Slices* surface_ = nullptr;
};

} // namespace voxrt::voxelize
