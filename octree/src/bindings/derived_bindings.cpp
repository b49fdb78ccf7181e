#include "../budget/fit_candidates.h"
#include "../budget/sight_costs.h"
#include "../build/coarsen.h"
#include "../pool/shared_size.h"
#include "../sight/hidden.h"
#include "../sight/interior.h"
#include "../sight/means.h"
#include "../sight/surface.h"
#include "../words/encoded_rows.h"
#include "bindings.h"

#include <nanobind/stl/string.h>

#include <string>

namespace nb = nanobind;
using namespace nb::literals;

namespace voxrt::octree {
namespace {

using python::to_numpy;
using python::to_read_only_numpy;

nb::object bind_encoded_rows(const Vector<Word>& words, unsigned block_bits) {
    if (block_bits > 29)
        throw std::invalid_argument("block_bits is " + std::to_string(block_bits) + ", not 0 ... 29");
    std::vector<std::uint32_t> rows = run([&] { return encoded_rows(words.data(), words.shape(0), block_bits); });
    const std::size_t count = rows.size();
    return to_numpy(std::move(rows), {count});
}

std::size_t bind_shared_words(const Vector<Word>& words, unsigned depth) { return run_on(words, depth, shared_words); }

nb::object bind_coarsen(const Vector<Word>& words, unsigned depth, unsigned level) {
    return words_to_numpy(run_on(words, depth, [&](const Memory& memory) { return coarsened(memory, level); }));
}

nb::object bind_fit_candidates(const Vector<Word>& words, unsigned depth, std::size_t limit,
                               const nb::ndarray<const std::uint8_t, nb::shape<-1, 3>, nb::c_contig>& colours) {
    const Memory memory = memory_of(words, depth);
    const auto costs = sight_costs({reinterpret_cast<const Colour*>(colours.data()), colours.shape(0)});
    nb::list result;
    std::string problem;
    try {
        for (Words& fit : run([&] { return fit_candidates(memory, limit, *costs); }))
            result.append(words_to_numpy(std::move(fit)));
    } catch (const DoesNotFit& failure) {
        problem = failure.what();
    }
    return nb::make_tuple(result, problem);
}

nb::object bind_surface_change(const Vector<Word>& first, const Vector<Word>& second, unsigned depth) {
    const SurfaceChange change = run_on(first, second, depth, surface_change);
    return nb::make_tuple(change.surface, change.changed);
}

nb::object bind_hidden_voxels(const Vector<Word>& words, unsigned depth) {
    return words_to_numpy(run_on(words, depth, hidden_voxels));
}

nb::object bind_fill_hidden(const Vector<Word>& words, const Vector<Word>& hidden, unsigned depth,
                            std::uint8_t material) {
    return words_to_numpy(
        run_on(words, hidden, depth, [&](const Memory& a, const Memory& b) { return fill_hidden(a, b, material); }));
}

nb::object bind_share_hidden(const Vector<Word>& words, const Vector<Word>& hidden, unsigned depth) {
    return words_to_numpy(run_on(words, hidden, depth, share_hidden));
}

nb::object bind_mean_materials(const Vector<Word>& words, unsigned depth, const Rows<std::uint16_t, 3>& light) {
    require(light.shape(0) <= 256, "light must have 256 rows at most");
    const Memory memory = memory_of(words, depth);
    std::vector<LinearLight> materials(light.shape(0));
    for (std::size_t id = 0; id < materials.size(); ++id)
        for (std::size_t channel = 0; channel < 3; ++channel)
            materials[id][channel] = light(id, channel);
    std::vector<std::uint8_t> means = run([&] { return mean_materials(memory, materials); });
    const std::size_t count = means.size();
    return to_read_only_numpy(std::move(means), {count});
}

} // namespace

void bind_derived(nb::module_& m) {
    m.def("encoded_rows", &bind_encoded_rows, "words"_a.noconvert(), "block_bits"_a);
    m.def("shared_words", &bind_shared_words, "words"_a.noconvert(), "depth"_a);
    m.def("coarsen", &bind_coarsen, "words"_a.noconvert(), "depth"_a, "level"_a);
    m.def("mean_materials", &bind_mean_materials, "words"_a.noconvert(), "depth"_a, "light"_a.noconvert());
    m.def("fit_candidates", &bind_fit_candidates, "words"_a.noconvert(), "depth"_a, "limit"_a, "colours"_a);
    m.def("surface_change", &bind_surface_change, "first"_a.noconvert(), "second"_a.noconvert(), "depth"_a);
    m.def("hidden_voxels", &bind_hidden_voxels, "words"_a.noconvert(), "depth"_a);
    m.def("fill_hidden", &bind_fill_hidden, "words"_a.noconvert(), "hidden"_a.noconvert(), "depth"_a, "material"_a);
    m.def("share_hidden", &bind_share_hidden, "words"_a.noconvert(), "hidden"_a.noconvert(), "depth"_a);
}

} // namespace voxrt::octree
