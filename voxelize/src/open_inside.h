// Which voxels of a tile lie inside a surface with holes: those where its generalized winding number is beyond 1/2.
//
// That number is the one of the surface with its holes capped, known for every voxel, less what the caps add. Along a
// way past the surface it changes smoothly, and as the rim of the holes alone lets it: nearly linearly within cubes
// that are small beside their distance from the rim. So in a cube one voxel of each piece that the surface leaves is
// asked; where that decides no others, as at the rim and on the surface in the middle of a hole's doubt, the cube is
// cut.
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
    enum class Verdict : uint8_t { outside, inside, mixed };

    /// What the settling of large cubes asks of a brick: the closed surface's winding number at two of its voxels.
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
    }

    Brick& brick(int column, int k) { return bricks_[size_t(column) * height_ + k]; }

    void settle() {
        for (int k = 0; k < height_; k += kTileBricks)
            settle_cube(0, 0, k, kTileBricks);
    }

    Verdict verdict(int column, int k) const { return verdicts_[size_t(column) * height_ + k]; }

    /// The voxels of a brick that are inside, the surface's left out of a mixed one. `numbers`: the closed surface's
    /// winding numbers there; asked of mixed ones only.
    Slices inside(int column, int k, const Slices& surface, const std::vector<int>& numbers) {
        Slices box = box_of(column, k), within{};
        if (verdict(column, k) == Verdict::inside)
            return box;
        if (verdict(column, k) == Verdict::outside)
            return within;
        x_ = x0_ + column % kTileBricks * kBrickSide;
        y_ = y0_ + column / kTileBricks * kBrickSide;
        z_ = k * kBrickSide;
        for (int z = 0; z < kBrickSide; ++z)
            box[z] &= ~surface[z];
        decide({0, 0, 0, std::min(side_, kBrickSide)}, box, numbers.data(), within);
        return within;
    }

private:
    static constexpr double kHalfDiagonal = 0.8660254037844386;
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

    /// The voxel about a cube's middle, as it is asked, and how far from it voxels of the cube are asked.
    static Point sample(int x, int y, int z, int side) {
        return {x + side / 2 + kSample, y + side / 2 + kSample, z + side / 2 + kSample};
    }
    static double reach(int side) { return side / 2 * 2 * kHalfDiagonal; }

    void settle_cube(int bx, int by, int k, int bricks) {
        const int x = x0_ + bx * kBrickSide, y = y0_ + by * kBrickSide, z = k * kBrickSide, side = bricks * kBrickSide;
        if (beyond_box(x, y, z, side))
            return;
        Verdict verdict = Verdict::mixed;
        if (x + side <= side_ && y + side <= side_ && z + side <= side_)
            verdict = verdict_of(bx, by, k, bricks, sample(x, y, z, side), reach(side));
        if (verdict == Verdict::mixed && bricks > 1) {
            const int step = bricks / 2;
            for (int i = 0; i < 8; ++i)
                settle_cube(bx + (i & 1) * step, by + (i >> 1 & 1) * step, k + (i >> 2) * step, step);
            return;
        }
        for (int v = by; v < by + bricks; ++v)
            for (int u = bx; u < bx + bricks; ++u)
                std::fill_n(verdicts_.begin() + ptrdiff_t(v * kTileBricks + u) * height_ + k, bricks, verdict);
    }

    Verdict verdict_of(int bx, int by, int k, int bricks, const Point& q, double reach) {
        for (int v = by; v < by + bricks; ++v)
            for (int u = bx; u < bx + bricks; ++u)
                for (int w = k; w < k + bricks; ++w)
                    if (brick(v * kTileBricks + u, w).surface)
                        return Verdict::mixed;
        const HoleRim::Slope slope = holes_->slope(q, reach);
        const Point& g = slope.gradient;
        double change = std::sqrt(g.x * g.x + g.y * g.y + g.z * g.z) * reach + slope.error;
        if (!(change < 0.5))
            return Verdict::mixed;
        const int half = bricks / 2;
        const Brick& middle = brick((by + half) * kTileBricks + bx + half, k + half);
        const HoleWinding::Measured caps = holes_->measured_at(q);
        const double number = std::abs((bricks > 1 ? middle.corner : middle.middle) - caps.angle);
        change += caps.error;
        return number - change > kTie ? Verdict::inside : number + change < 0.5 ? Verdict::outside : Verdict::mixed;
    }

    /// A brick's voxels within the box.
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

    /// Decides the voxels `asked` of a cell, none of which has surface.
    void decide(const Cell& cell, const Slices& asked, const int* numbers, Slices& within) {
        const uint64_t square = cell.side == kBrickSide
                                    ? ~uint64_t{0}
                                    : ((uint64_t{1} << cell.side * cell.side) - 1) << column_bit(cell.x, cell.y);
        Slices open{};
        for (int z = cell.z; z < cell.z + cell.side; ++z)
            open[z] = asked[z] & square;
        if (is_empty(open))
            return;
        if (cell.side == 1) {
            const Point q = sample(x_ + cell.x, y_ + cell.y, z_ + cell.z, 1);
            if (std::abs(numbers[cell.z * 64 + column_bit(cell.x, cell.y)] - holes_->at(q)) > kTie)
                within[cell.z] |= open[cell.z];
            return;
        }
        const double middle = (cell.side - 1) / 2.0 + kSample; // of the points where its voxels are asked
        const HoleRim::Slope slope = holes_->slope({x_ + cell.x + middle, y_ + cell.y + middle, z_ + cell.z + middle},
                                                   (cell.side - 1) * kHalfDiagonal);
        if (slope.error < 0.24) { // twice it, below, decides nothing beyond 1/2
            Slices left = open;
            for (int z = cell.z; z < cell.z + cell.side; ++z)
                while (left[z] != 0)
                    decide_piece(cell, take_piece(cell, z, std::countr_zero(left[z]), left), slope, numbers, open,
                                 within);
        }
        const int half = cell.side / 2;
        for (int i = 0; i < 8; ++i)
            decide({cell.x + (i & 1) * half, cell.y + (i >> 1 & 1) * half, cell.z + (i >> 2) * half, half}, open,
                   numbers, within);
    }

    struct Voxel {
        int z, bit; // in a brick
    };

    /// Moves the voxels of a cell that are joined to one by their sides from `left` to a list, that one first.
    const std::vector<Voxel>& take_piece(const Cell& cell, int z, int bit, Slices& left) {
        piece_.clear();
        auto take = [&](int x, int y, int z) {
            const uint64_t one = uint64_t{1} << column_bit(x, y);
            if (left[z] & one) {
                left[z] ^= one;
                piece_.push_back({z, column_bit(x, y)});
            }
        };
        take(column_x(bit), column_y(bit), z);
        for (size_t i = 0; i < piece_.size(); ++i) {
            const Voxel at = piece_[i];
            const int x = column_x(at.bit), y = column_y(at.bit);
            if (x > cell.x)
                take(x - 1, y, at.z);
            if (x + 1 < cell.x + cell.side)
                take(x + 1, y, at.z);
            if (y > cell.y)
                take(x, y - 1, at.z);
            if (y + 1 < cell.y + cell.side)
                take(x, y + 1, at.z);
            if (at.z > cell.z)
                take(x, y, at.z - 1);
            if (at.z + 1 < cell.z + cell.side)
                take(x, y, at.z + 1);
        }
        return piece_;
    }

    /// Decides those voxels of a piece, joined past the surface, that the slope from one of them can, and takes them
    /// off `open`. The slope is that of a potential wherever the rim is not, so the way from one to another does not
    /// matter.
    void decide_piece(const Cell& cell, const std::vector<Voxel>& piece, const HoleRim::Slope& slope,
                      const int* numbers, Slices& open, Slices& within) const {
        const int sx = column_x(piece[0].bit), sy = column_y(piece[0].bit), sz = piece[0].z;
        const Point seed = sample(x_ + sx, y_ + sy, z_ + sz, 1);
        const HoleWinding::Measured caps = cell.side == kBrickSide
                                               ? holes_->measured_at(seed)
                                               : HoleWinding::Measured{holes_->at(seed), HoleWinding::kDipoleError};
        const double start = numbers[sz * 64 + piece[0].bit] - caps.angle;
        // Both the seed and the voxel may lie off the line.
        const double error = 2 * slope.error + caps.error;
        for (const Voxel& v : piece) {
            const double number = std::abs(start - slope.gradient.x * (column_x(v.bit) - sx) -
                                           slope.gradient.y * (column_y(v.bit) - sy) - slope.gradient.z * (v.z - sz));
            if (number - error > kTie)
                within[v.z] |= uint64_t{1} << v.bit;
            else if (!(number + error < 0.5))
                continue;
            open[v.z] &= ~(uint64_t{1} << v.bit);
        }
    }

    const HoleWinding* holes_ = nullptr;
    int side_ = 0, height_ = 0, x0_ = 0, y0_ = 0;
    int low_[3] = {}, high_[3] = {};
    int x_ = 0, y_ = 0, z_ = 0; // of the brick looked into
    std::vector<Brick> bricks_;
    std::vector<Verdict> verdicts_;
    std::vector<Voxel> piece_;
};

} // namespace voxrt
