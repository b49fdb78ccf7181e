// Edits a World without Python, for the sanitizers: `make sanitize` builds it with each of them.
//
// Random edits of every small depth are held against an array of the voxels, with a memory that gets the patches and
// with threads that read live roots meanwhile. Prints a line and exits with 1 where something is wrong.
#include "editing.h"

#include <cstdio>
#include <random>

using namespace editing;

int main() {
    std::mt19937_64 random(1);
    bool good = true;
    for (unsigned depth = 1; depth <= 4; ++depth)
        for (const std::size_t blocks : {std::size_t{60}, kBlockLimit}) {
            const auto fail = [&](const char* what) {
                std::printf("depth %u: %s\n", depth, what);
                good = false;
            };
            Editing editing([&](std::uint64_t count) { return random() % count; }, fail, depth,
                            {memory_size(blocks), 3 * (depth - 1)});
            for (int step = 0; step < 400; ++step)
                editing.step();
            editing.finish();
        }
    return good ? 0 : 1;
}
