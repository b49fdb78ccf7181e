// Bytes of columns against loops over voxels: IntervalBytes, slices_of, morton_columns. Prints nothing where all agree.
#include <voxrt/voxelize/coverage/covered_bytes.h>
#include <voxrt/voxelize/grid/brick.h>

#include <cstdio>
#include <random>

using namespace voxrt::voxelize;

namespace {

bool intervals_agree(std::mt19937& random) {
    alignas(32) int32_t lo[8], hi[8], marks[8];
    const int base = 8 * static_cast<int>(random() % 8192);
    for (int i = 0; i < 8; ++i) {
        lo[i] = std::max(0, base - 12 + static_cast<int>(random() % 60));
        hi[i] = lo[i] + static_cast<int>(random() % (random() % 8 == 0 ? 65536 : 40)) - 2;
        if (random() % 5 == 0) {
            lo[i] = 1 << 30;
            hi[i] = lo[i] - 1;
        }
        marks[i] = random() % 5 == 0 ? 1 << 30 : base - 12 + static_cast<int>(random() % 60);
    }
    const IntervalBytes bytes(lo, hi, marks, base);
    for (int brick = 0; brick < IntervalBytes::kBricks; ++brick) {
        ColumnBytes inside = 0, marked = 0;
        for (int i = 0; i < 8; ++i)
            for (int bit = 0; bit < 8; ++bit) {
                const int z = base + 8 * brick + bit;
                inside |= ColumnBytes{lo[i] <= z && z <= hi[i]} << (8 * i + bit);
                marked |= ColumnBytes{marks[i] == z} << (8 * i + bit);
            }
        if (bytes.inside[brick] != inside || bytes.marked[brick] != marked)
            return false;
    }
    return true;
}

bool slices_agree(std::mt19937_64& random) {
    Columns columns;
    for (uint64_t& row : columns)
        row = random();
    const Slices slices = slices_of(columns);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 8; ++x)
            for (int z = 0; z < 8; ++z)
                if ((columns[y] >> (8 * x + z) & 1) != (slices[z] >> column_bit(x, y) & 1))
                    return false;
    const Slices words = morton_order(slices);
    for (uint32_t y = 0; y < 8; ++y)
        for (uint32_t x = 0; x < 8; ++x)
            for (uint32_t z = 0; z < 8; ++z) {
                const auto code = static_cast<unsigned>(morton(x, y, z));
                if ((words[code / 64] >> code % 64 & 1) != (columns[y] >> (8 * x + z) & 1))
                    return false;
            }
    return true;
}

} // namespace

int main() {
    std::mt19937 random(1);
    std::mt19937_64 wide(1);
    for (int i = 0; i < 100000; ++i)
        if (!intervals_agree(random) || !slices_agree(wide)) {
            std::puts("bytes of columns differ from the voxels one by one");
            return 1;
        }
}
