#include "views_bindings.h"

#include "../views/beam.h"
#include "../views/framing.h"

#include <voxrt/voxelize/bindings/python.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace nb = nanobind;

namespace voxrt::sim {

namespace {

using python::NamedTuple;
using python::to_numpy;

using Points = nb::ndarray<const double, nb::shape<-1, 3>, nb::c_contig, nb::device::cpu>;
using Cameras = nb::ndarray<const int32_t, nb::shape<-1, 4, 3>, nb::c_contig, nb::device::cpu>;

NamedTuple band_type;

void append(std::vector<int32_t>& all, const Camera& camera) {
    for (const auto& triple : {camera.position, camera.look, camera.right, camera.up})
        all.insert(all.end(), triple, triple + 3);
}

nb::object orbit_of(const Points& points, int width, int height, int count) {
    if (points.shape(0) == 0 || width < 1 || height < 1 || count < 1)
        throw std::invalid_argument("an orbit needs points, a size and a number of cameras");
    std::vector<Point> places(points.shape(0));
    for (size_t i = 0; i < places.size(); ++i)
        std::copy_n(points.data() + 3 * i, 3, places[i].begin());
    std::vector<int32_t> all;
    for (const Camera& camera : orbit(places, width, height, count))
        append(all, camera);
    return to_numpy(std::move(all), {static_cast<size_t>(count), 4, 3});
}

void new_search_in(BeamSearch* place, const Cameras& cameras, double clock_hz, int buffer_lines) {
    std::vector<Camera> list(cameras.shape(0));
    for (size_t i = 0; i < list.size(); ++i) {
        const int32_t* at = cameras.data() + 12 * i;
        for (int32_t* triple : {list[i].position, list[i].look, list[i].right, list[i].up})
            for (int axis = 0; axis < 3; ++axis)
                triple[axis] = *at++;
    }
    new (place) BeamSearch(list, clock_hz, buffer_lines);
}

nb::object band_of(const BeamSearch& search, int ahead) {
    const BeamSearch::Band band = search.band(ahead);
    std::vector<int32_t> all;
    append(all, band.camera);
    return band_type(to_numpy(std::move(all), {4, 3}), band.width, band.rows);
}

nb::object fit_of(const BeamSearch& search) {
    const BeamFit fit = search.fit();
    return nb::make_tuple(fit.scale, fit.cycles_per_pixel, fit.lead, fit.frames_per_second);
}

} // namespace

void bind_views(nb::module_& m) {
    band_type = NamedTuple(m, "Band", {"camera", "width", "rows"}, "Rows of a picture, as a picture of its own.");
    m.def("orbit", &orbit_of, nb::arg("points"), nb::arg("width"), nb::arg("height"), nb::arg("count"),
          "Cameras around points, float64 (N, 3), voxels: their registers, int32, shape (count, 4, 3). framing.h");
    m.def("beam_lead", &beam_lead, nb::arg("rows"), nb::arg("line"), nb::arg("scale"), nb::arg("buffer_lines"),
          "beam.h");
    nb::class_<BeamSearch>(m, "BeamSearch", "The largest pictures that a board traces in time: beam.h.")
        .def("__init__", &new_search_in, nb::arg("cameras"), nb::arg("clock_hz"), nb::arg("buffer_lines"),
             "cameras: int32, shape (N, 4, 3), for pictures of 640 x 480.")
        .def_prop_ro("ended", &BeamSearch::ended)
        .def_prop_ro("done", &BeamSearch::done, "Pictures that are complete.")
        .def_prop_ro("total", &BeamSearch::total, "Pictures, at most.")
        .def_prop_ro("left", &BeamSearch::left, "Bands of the present picture whose cycles are wanted.")
        .def("band", &band_of, nb::arg("ahead") = 0,
             "The band whose cycles are wanted next, or one after it. ValueError: there is none.")
        .def("give", &BeamSearch::give, nb::arg("cycles"), "Take the cycles of that band.")
        .def("fit", &fit_of, "Scale, cycles per pixel, lead and frames per second: BeamFit of beam.h.");
}

} // namespace voxrt::sim
