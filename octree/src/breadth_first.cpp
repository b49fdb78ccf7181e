#include "breadth_first.h"

namespace voxrt::octree {

std::vector<Word> breadth_first_words(const BlockPool& pool, Node root) {
    constexpr Word unvisited = 0;
    std::vector<Word> address(pool.size(), unvisited);
    std::vector<Node> order;
    const auto word_of = [&](Node node) -> Word {
        if (is_leaf(node))
            return node;
        if (address[node] == unvisited) {
            address[node] = static_cast<Word>(1 + 8 * order.size());
            order.push_back(node);
        }
        return address[node];
    };
    std::vector<Word> words;
    words.reserve(1 + 8 * pool.size());
    words.push_back(word_of(root));
    for (std::size_t next = 0; next < order.size(); ++next)
        for (const Node child : pool[order[next]])
            words.push_back(word_of(child));
    return words;
}

} // namespace voxrt::octree
