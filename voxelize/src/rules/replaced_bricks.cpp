#include "replaced_bricks.h"

#include "../grid/brick.h"

#include <algorithm>

namespace voxrt::voxelize {
namespace {

class Replacement {
public:
    Replacement(SparseVoxels& voxels, const ReplacedBricks& replaced)
        : voxels_(voxels), bricks_(replaced.bricks), cells_(replaced.cells) {}

    void replace() {
        out_.depth = voxels_.depth;
        merge_bricks();
        for (size_t i = 0; i < voxels_.octant_codes.size(); ++i)
            add_octant(voxels_.octant_codes[i], voxels_.octant_levels[i], voxels_.octant_materials[i]);
        std::sort(octants_.begin(), octants_.end(),
                  [](const Octant& a, const Octant& b) { return a.corner < b.corner; });
        for (const Octant& octant : octants_) {
            out_.octant_codes.push_back(octant.corner >> 3 * (octant.level - kBrickBits));
            out_.octant_levels.push_back(octant.level);
            out_.octant_materials.push_back(octant.material);
        }
        voxels_.brick_codes = std::move(out_.brick_codes);
        voxels_.brick_masks = std::move(out_.brick_masks);
        voxels_.brick_materials = std::move(out_.brick_materials);
        voxels_.brick_rows = std::move(out_.brick_rows);
        voxels_.cells = std::move(out_.cells);
        voxels_.octant_codes = std::move(out_.octant_codes);
        voxels_.octant_levels = std::move(out_.octant_levels);
        voxels_.octant_materials = std::move(out_.octant_materials);
    }

private:
    void merge_bricks() {
        const size_t most = voxels_.brick_codes.size() + bricks_.size();
        out_.brick_codes.reserve(most);
        out_.brick_masks.reserve(most);
        out_.brick_materials.reserve(most);
        out_.brick_rows.reserve(most);
        size_t next = 0;
        auto add_before = [&](uint64_t code) {
            for (; next < bricks_.size() && bricks_[next].code < code; ++next)
                add(bricks_[next]);
        };
        for (size_t i = 0; i < voxels_.brick_codes.size(); ++i) {
            const uint64_t code = voxels_.brick_codes[i];
            add_before(code);
            if (next < bricks_.size() && bricks_[next].code == code) {
                add(bricks_[next++]);
                continue;
            }
            const int32_t row = voxels_.brick_rows[i];
            push(code, voxels_.brick_masks[i], voxels_.brick_materials[i],
                 row < 0 ? nullptr : &voxels_.cells[size_t(row)]);
        }
        add_before(~uint64_t{0});
    }

    void add(const ReplacedBrick& brick) {
        if (brick.material != 0 && is_full(brick.mask))
            push_octant(brick.code, kBrickBits, brick.material);
        else if (!is_empty(brick.mask))
            push(brick.code, brick.mask, brick.material, brick.material == 0 ? &cells_[brick.row] : nullptr);
    }

    void push(uint64_t code, const std::array<uint64_t, 8>& mask, uint8_t material,
              const std::array<uint8_t, 512>* cells) {
        out_.brick_codes.push_back(code);
        out_.brick_masks.push_back(mask);
        out_.brick_materials.push_back(material);
        out_.brick_rows.push_back(cells == nullptr ? -1 : int32_t(out_.cells.size()));
        if (cells != nullptr)
            out_.cells.push_back(*cells);
    }

    void add_octant(uint64_t code, uint8_t level, uint8_t material) {
        const int bits = 3 * (level - kBrickBits);
        const auto first = std::lower_bound(bricks_.begin(), bricks_.end(), code << bits,
                                            [](const ReplacedBrick& b, uint64_t c) { return b.code < c; });
        if (first == bricks_.end() || first->code >> bits != code) {
            push_octant(code, level, material);
        } else if (level > kBrickBits) {
            for (uint64_t part = 0; part < 8; ++part)
                add_octant(code << 3 | part, uint8_t(level - 1), material);
        }
    }

    void push_octant(uint64_t code, uint8_t level, uint8_t material) {
        octants_.push_back({code << 3 * (level - kBrickBits), level, material});
    }

    struct Octant {
        uint64_t corner; // Morton code of its corner / 8
        uint8_t level, material;
    };

    SparseVoxels& voxels_;
    const LargeVector<ReplacedBrick>& bricks_;
    const std::vector<std::array<uint8_t, 512>>& cells_;
    SparseVoxels out_;
    std::vector<Octant> octants_;
};

} // namespace

void replace_bricks(SparseVoxels& voxels, const ReplacedBricks& replaced) {
    if (!replaced.bricks.empty())
        Replacement(voxels, replaced).replace();
}

} // namespace voxrt::voxelize
