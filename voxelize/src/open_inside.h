// Which voxels of a tile lie inside a surface with holes: those where its generalized winding number is beyond 1/2.
//
// That number is the one of the surface with its holes capped, known for every voxel, less what the caps add. Cubes are
// looked at from large to small, each knowing what its parent found out about the caps. Where no surface passes a cube,
// the number changes smoothly, and one voxel may decide all; where the caps add less than 1/2, the number of the capped
// surface decides; else the cube is cut. A voxel that rounding alone could turn counts as outside.
//
// Bound: bricks of surface, and voxels near holes.
#pragma once

#include "hole_winding.h"
#include "object_layer.h"
#include "survey.h"
#include "tile_voxels.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace voxrt {

class OpenInside {
public:
    /// Of a brick. `capped`: inside is where the winding number of the capped surface is not zero.
    enum class Verdict : uint8_t { outside, inside, capped, mixed };

    /// What the settling of large cubes asks of a brick: the capped surface's winding number at two of its voxels.
    struct Brick {
        int corner = 0, middle = 0; // voxels (0, 0, 0) and (4, 4, 4)
        bool surface = false;
    };

    /// The inside lies within `box`; every brick is then to be told before settle().
    void start(const HoleWinding& holes, const VoxelBox& box, const Window& window) {
        holes_ = &holes;
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
        verdicts_.assign(bricks_.size(), Verdict::outside);
        mixed_.resize(bricks_.size());
        views_.clear();
    }

    Brick& brick(int column, int k) { return bricks_[size_t(column) * height_ + k]; }

    void settle() {
        const HoleView all = holes_->start();
        for (int k = 0; k < height_; k += kTileBricks)
            settle_cube(0, 0, k, kTileBricks, all, 0);
    }

    Verdict verdict(int column, int k) const { return verdicts_[size_t(column) * height_ + k]; }

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

    /// The voxels of a mixed brick that are inside, the surface's left out. `numbers`: the capped surface's winding
    /// numbers there.
    Slices inside(int column, int k, const Slices& surface, const std::vector<int>& numbers) {
        x_ = x0_ + column % kTileBricks * kBrickSide;
        y_ = y0_ + column / kTileBricks * kBrickSide;
        z_ = k * kBrickSide;
        numbers_ = numbers.data();
        surface_ = &surface;
        Slices open = box_of(column, k), within{};
        for (int z = 0; z < kBrickSide; ++z)
            open[z] &= ~surface[z];
        decide({0, 0, 0, std::min(side_, kBrickSide)}, views_[mixed_[size_t(column) * height_ + k]], 0, open, within);
        return within;
    }

private:
    static constexpr double kRootOfThree = 1.7320508075688772;
    static constexpr double kTie = 0.5 + 1e-6; // what is beyond by rounding alone is not
    // A voxel is asked where its column's ray runs.
    static constexpr double kSample = 0.5 + 1.0 / 8192;

    struct Cell {
        int x, y, z, side; // in a brick
    };
    bool beyond_box(int x, int y, int z, int side) const {
        return x > high_[0] || y > high_[1] || z > high_[2] || x + side <= low_[0] || y + side <= low_[1] ||
               z + side <= low_[2];
    }

    /// Looks at a cube whose lowest corner is at (x, y, z); returns how far from the view's centre its voxels are
    /// asked. Where caps pass a clear cube, one without surface, it is looked at from a voxel, where the number is
    /// known.
    double look(const HoleView& from, int x, int y, int z, int side, bool clear, HoleView& to) const {
        double middle = (side - 1) / 2.0;
        holes_->look(from, {x + middle + kSample, y + middle + kSample, z + middle + kSample}, middle * kRootOfThree,
                     to);
        if (!to.crossed || !clear)
            return middle * kRootOfThree;
        middle = side / 2;
        holes_->look(from, {x + middle + kSample, y + middle + kSample, z + middle + kSample}, middle * kRootOfThree,
                     to);
        return middle * kRootOfThree;
    }

    static Point gradient(const HoleView& view) {
        const Point &f = view.far.gradient, &n = view.near.gradient;
        return {f.x + n.x, f.y + n.y, f.z + n.z};
    }
    static double error(const HoleView& view) { return view.far.error + view.near.error + view.doubt; }

    void settle_cube(int bx, int by, int k, int bricks, const HoleView& from, int level) {
        const int x = x0_ + bx * kBrickSide, y = y0_ + by * kBrickSide, z = k * kBrickSide, side = bricks * kBrickSide;
        if (beyond_box(x, y, z, side))
            return;
        const bool within = x + side <= side_ && y + side <= side_ && z + side <= side_;
        const bool clear = within && !has_surface(bx, by, k, bricks);
        HoleView& view = levels_[level];
        const double reach = look(from, x, y, z, side, clear, view);
        const Verdict verdict = verdict_of(view, reach, bx, by, k, bricks, clear);
        if (verdict == Verdict::mixed && bricks > 1) {
            const int step = bricks / 2;
            for (int i = 0; i < 8; ++i)
                settle_cube(bx + (i & 1) * step, by + (i >> 1 & 1) * step, k + (i >> 2) * step, step, view, level + 1);
            return;
        }
        for (int v = by; v < by + bricks; ++v)
            for (int u = bx; u < bx + bricks; ++u)
                std::fill_n(verdicts_.begin() + place(u, v, k), std::min(bricks, height_ - k), verdict);
        if (verdict == Verdict::mixed) {
            mixed_[place(bx, by, k)] = uint32_t(views_.size());
            views_.push_back(view);
        }
    }

    ptrdiff_t place(int bx, int by, int k) const { return ptrdiff_t(by * kTileBricks + bx) * height_ + k; }

    bool has_surface(int bx, int by, int k, int bricks) const {
        for (int v = by; v < by + bricks; ++v)
            for (int u = bx; u < bx + bricks; ++u)
                for (int w = k; w < k + bricks; ++w)
                    if (bricks_[place(u, v, w)].surface)
                        return true;
        return false;
    }

    Verdict verdict_of(const HoleView& view, double reach, int bx, int by, int k, int bricks, bool clear) const {
        const Point g = gradient(view);
        const double off = std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z) * reach + error(view);
        const double angle = view.far.angle + view.near.angle;
        if (!view.crossed && std::abs(angle) + off < 0.5)
            return Verdict::capped;
        if (!clear)
            return Verdict::mixed;
        const int half = bricks / 2;
        const Brick& middle = bricks_[place(bx + half, by + half, k + half)];
        const double there = std::abs((bricks > 1 ? middle.corner : middle.middle) - angle);
        return there - off > kTie ? Verdict::inside : there + off < 0.5 ? Verdict::outside : Verdict::mixed;
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

    /// Decides the voxels of a cell that are open, none of which has surface.
    void decide(const Cell& cell, const HoleView& view, int level, Slices& open, Slices& within) {
        const double off = error(view);
        if (off < 0.5 && (!view.crossed || is_clear(cell))) {
            const Point g = gradient(view);
            const double angle = view.far.angle + view.near.angle;
            const int half = cell.side / 2;
            const int at_centre = numbers_[(cell.z + half) * 64 + column_bit(cell.x + half, cell.y + half)];
            for (int z = cell.z; z < cell.z + cell.side; ++z)
                for (uint64_t left = open[z] & square_of(cell); left != 0; left &= left - 1) {
                    const int bit = std::countr_zero(left);
                    const int number = view.crossed ? at_centre : numbers_[z * 64 + bit];
                    const double there =
                        std::abs(number - angle - g.x * (x_ + column_x(bit) + kSample - view.centre.x) -
                                 g.y * (y_ + column_y(bit) + kSample - view.centre.y) -
                                 g.z * (z_ + z + kSample - view.centre.z));
                    if (there - off > kTie)
                        within[z] |= uint64_t{1} << bit;
                    else if (!(there + off < (off == 0 ? kTie : 0.5)))
                        continue;
                    open[z] &= ~(uint64_t{1} << bit);
                }
        }
        uint64_t left = 0;
        for (int z = cell.z; z < cell.z + cell.side; ++z)
            left |= open[z] & square_of(cell);
        if (left == 0)
            return;
        if (cell.side == 1) {
            if (ask(cell))
                within[cell.z] |= left;
            return;
        }
        const int half = cell.side / 2;
        for (int i = 0; i < 8; ++i) {
            const Cell part{cell.x + (i & 1) * half, cell.y + (i >> 1 & 1) * half, cell.z + (i >> 2) * half, half};
            uint64_t asked = 0;
            for (int z = part.z; z < part.z + half; ++z)
                asked |= open[z] & square_of(part);
            if (asked == 0)
                continue;
            look(view, x_ + part.x, y_ + part.y, z_ + part.z, half, is_clear(part), levels_[level]);
            decide(part, levels_[level], level + 1, open, within);
        }
    }

    /// Whether a voxel is inside, as exactly as that takes.
    bool ask(const Cell& cell) const {
        const Point q{x_ + cell.x + kSample, y_ + cell.y + kSample, z_ + cell.z + kSample};
        const int number = numbers_[cell.z * 64 + column_bit(cell.x, cell.y)];
        for (const double tolerance : {1e-2, 1e-4}) {
            const double there = std::abs(number - holes_->at(q, tolerance));
            if (there - tolerance > kTie || there + tolerance < 0.5)
                return there > 0.5;
        }
        return std::abs(number - holes_->at(q, 0)) > kTie;
    }

    const HoleWinding* holes_ = nullptr;
    int side_ = 0, height_ = 0, x0_ = 0, y0_ = 0;
    int low_[3] = {}, high_[3] = {};
    std::vector<Brick> bricks_;
    std::vector<Verdict> verdicts_;
    std::vector<uint32_t> mixed_; // by brick: its view
    std::vector<HoleView> views_; // of mixed bricks
    HoleView levels_[4];          // of the cubes, then of the cells about what is looked at

    // The brick looked into.
    int x_ = 0, y_ = 0, z_ = 0;
    const int* numbers_ = nullptr;
    const Slices* surface_ = nullptr;
};

} // namespace voxrt
