#include "fit_candidates.h"

#include "../build/coarsen.h"
#include "../sight/hidden.h"
#include "budget.h"

#include <string>

namespace voxrt::octree {

namespace {

/// However small the budget, octants of more than 1/8 of the world's side are never filled up.
constexpr unsigned kLevelsKept = 3;

/// With fewer blocks there is time to start from a world four times as fine as what fits, not twice.
constexpr std::size_t kManyBlocks = 30'000;

} // namespace

std::vector<Words> fit_candidates(const Memory& shared, std::size_t words, const AppearanceCosts& costs) {
    std::vector<Words> worlds{{shared.words, shared.words + shared.size}};
    while (worlds.back().size() > words && worlds.size() + kLevelsKept <= shared.depth)
        worlds.push_back(coarsened(shared, static_cast<unsigned>(worlds.size())));
    if (const std::size_t least = worlds.back().size(); least > words)
        throw DoesNotFit("the octree does not fit " + std::to_string(words) +
                         " words: as coarse as it may become it takes " + std::to_string(least) +
                         "; give it at least " + std::to_string(least) + " words");
    const std::size_t finer = block_count(shared.size) > kManyBlocks ? 2 : 3;
    const auto finest = static_cast<unsigned>(worlds.size() > finer ? worlds.size() - finer : 0);
    const Memory world{worlds[finest].data(), worlds[finest].size(), shared.depth};
    const Words hidden = hidden_voxels(world);
    std::vector<Words> found = fit_bricks(world, {hidden.data(), hidden.size(), shared.depth}, finest, costs, words);
    found.insert(found.begin(), worlds.back());
    return found;
}

} // namespace voxrt::octree
