#include "dense.h"

#include "../pool/breadth_first.h"
#include "brick.h"

#include <voxrt/voxelize/work/interrupt.h>

#include <algorithm>

namespace voxrt::octree {
namespace {

class DenseBuilder {
public:
    DenseBuilder(const std::uint8_t* cells, std::size_t size_x, std::size_t size_y, std::size_t size_z)
        : cells_(cells), sizes_{size_x, size_y, size_z}, bricks_(pool_) {
        for (unsigned i = 0; i < 8; ++i)
            for (unsigned axis = 0; axis < 3; ++axis)
                spread_[i] |= ((i >> axis) & 1u) << (3 * axis);
    }

    Words build(unsigned depth) {
        const Node root = octant(0, 0, 0, depth);
        return breadth_first_words(pool_, root);
    }

private:
    Node octant(std::size_t x, std::size_t y, std::size_t z, unsigned level) {
        if (x >= sizes_[0] || y >= sizes_[1] || z >= sizes_[2])
            return kEmpty;
        if (level <= 3)
            return brick(x, y, z, level);
        const std::size_t half = std::size_t{1} << (level - 1);
        Block children;
        for (unsigned i = 0; i < 8; ++i)
            children[i] = octant(x + (i & 1) * half, y + (i >> 1 & 1) * half, z + (i >> 2) * half, level - 1);
        return pool_.intern(children);
    }

    Node brick(std::size_t x0, std::size_t y0, std::size_t z0, unsigned level) {
        work_.count_step();
        const std::size_t side = std::size_t{1} << level;
        const std::size_t nx = std::min(side, sizes_[0] - x0);
        const std::size_t ny = std::min(side, sizes_[1] - y0);
        const std::size_t nz = std::min(side, sizes_[2] - z0);
        std::uint8_t morton[512] = {};
        for (std::size_t x = 0; x < nx; ++x)
            for (std::size_t y = 0; y < ny; ++y) {
                const std::uint8_t* run = cells_ + ((x0 + x) * sizes_[1] + y0 + y) * sizes_[2] + z0;
                const unsigned base = spread_[x] | spread_[y] << 1;
                for (std::size_t z = 0; z < nz; ++z)
                    morton[base | spread_[z] << 2] = run[z];
            }
        switch (level) {
        case 1:
            return bricks_.from_cells8(morton);
        case 2:
            return bricks_.from_cells64(morton);
        default:
            return bricks_.from_cells(morton);
        }
    }

    const std::uint8_t* cells_;
    std::size_t sizes_[3];
    unsigned spread_[8] = {};
    BlockPool pool_;
    BrickBuilder bricks_;
    voxelize::WorkCounter& work_ = voxelize::WorkCounter::current();
};

} // namespace

Words build_dense(const std::uint8_t* cells, std::size_t size_x, std::size_t size_y, std::size_t size_z,
                  unsigned depth) {
    return DenseBuilder(cells, size_x, size_y, size_z).build(depth);
}

} // namespace voxrt::octree
