// vector_coverage.h's CoverageEngine for the instruction set of the including file, which defines VOXRT_COVERAGE as its
// name, and VOXRT_INSTRUCTIONS as that of the set.
//
// The tests are those of triangle_coverage.h. Coordinates are whole and below 2^25, so products of two are exact in
// doubles, multiples of 1/4 too. A quotient is the nearest whole number to a product with a reciprocal: that product's
// error is below 2^-39, and its distance from where the whole number changes is at least 2^-38. The plane is walked
// with whole quotients and remainders, as PlaneWalk does it. Remainders of a narrow triangle are below 2^51, and held
// in doubles; those of others are integers.
//
// Cost, in operations on eight doubles: 40 per edge and eight rows, 20 per edge and eight columns, 25 per row and eight
// columns.
#include "../vectors/lanes.h"
#include "covered_bytes.h"
#include "vector_coverage.h"
#include "vector_halves.h"
#include "vector_plane.h"
#include "vector_sheets.h"

namespace voxrt::voxelize {
namespace {

// Where the rays of columns are in their voxels.
constexpr double kSample = (kUnit + 1) / 2.0, kCentre = kUnit / 2.0;

// An edge, upwards along one axis.
struct Edge {
    int from, to; // corners
    double begin, end, run, reciprocal;

    Edge(const double* p, int corner) : from(corner), to(corner == 2 ? 0 : corner + 1) {
        if (p[from] > p[to]) {
            const int swapped = from;
            from = to;
            to = swapped;
        }
        begin = p[from];
        end = p[to];
        run = end - begin;
        reciprocal = 1 / (run * kVoxel); // infinite where it passes no plane
    }

    // From its begin to planes or lines; not a number where it passes none of them.
    Lanes to_planes(const Lanes& planes) const {
        const Lanes none = all(__builtin_nan(""));
        return if_less(all(begin), planes, if_less(planes, all(end), planes - all(begin), none), none);
    }
};

// Where an edge passes planes, along another axis q.
class Passing {
public:
    Passing(const Edge& edge, const double* q)
        : start_(q[edge.from] * edge.run - edge.run * (kVoxel / 2)), rise_(q[edge.to] - q[edge.from]), run_(edge.run),
          reciprocal_(edge.reciprocal) {}

    // `along`: from the edge's begin. The voxel that holds the point; where it lies between two, the upper and lower
    // one.
    Lanes upper(const Lanes& along) const { return at(along, 0.5); }
    Lanes lower(const Lanes& along) const { return at(along, -0.5); }
    // The first column whose ray lies beyond the point; a ray at the centre lies beside it, so that one through the
    // point is beyond. `along`: 1/4 further.
    Lanes first_ray_beyond(const Lanes& along, double ray) const {
        return at(along, (kVoxel - ray) * run_ - rise_ / 4 + (ray == kCentre ? -0.5 : 0.25));
    }

private:
    Lanes at(const Lanes& along, double offset) const {
        return nearest_whole((all(rise_) * along + all(start_ + offset)) * all(reciprocal_));
    }
    double start_, rise_, run_, reciprocal_;
};

struct Extents {
    alignas(64) double lo[kTileSide + 2 * kLanes], hi[kTileSide + 2 * kLanes];

    void set(int place, const EightExtents& extents) {
        store(lo + place, extents.lo);
        store(hi + place, extents.hi);
    }
    EightExtents at(int place) const { return {load(lo + place), load(hi + place)}; }

    // From planes to the slabs between them.
    void join(int slabs) {
        for (int i = 0; i < slabs; i += kLanes) {
            EightExtents joined = at(i), above = at(i + 1);
            joined.extend(above.lo, above.hi);
            set(i, joined);
        }
    }
    // Adds a corner (p, q) to the slabs that contain it, two where it lies between them.
    void extend(int first, int slabs, double p, double q) {
        const auto along = static_cast<int64_t>(p), across = static_cast<int64_t>(q);
        const double low = voxel_floor(across), high = voxel_below(across);
        for (int slab = voxel_below(along) - first; slab <= voxel_floor(along) - first; ++slab)
            if (slab >= 0 && slab < slabs) {
                lo[slab] = low < lo[slab] ? low : lo[slab];
                hi[slab] = high > hi[slab] ? high : hi[slab];
            }
    }
};

// The rows of a triangle in a window: which columns it may cover, whose rays it crosses, and where it is along z.
struct Rows {
    Extents z;
    alignas(32) int32_t from[kTileSide + kLanes], to[kTileSide + kLanes]; // columns
    alignas(32) int32_t crossed_from[kTileSide + kLanes], crossed_to[kTileSide + kLanes];

    // Rows y0 ... y0 + count - 1, columns x0 ... x1; voxels up to `top`. `ray`: kSample or kCentre.
    Rows(const Corners& t, int y0, int count, int x0, int x1, double top, bool crosses, double ray) {
        const Edge edges[3] = {{t.y, 0}, {t.y, 1}, {t.y, 2}};
        Extents x, ends;
        for (int base = 0; base <= count; base += kLanes) {
            const Lanes planes = ramp((y0 + base) * kVoxel, kVoxel), rays = planes + all(ray + 0.25);
            EightExtents eight_x, eight_z, eight_ends;
            for (const Edge& edge : edges) {
                const Lanes along = edge.to_planes(planes);
                const Passing across(edge, t.x);
                eight_x.extend(across.upper(along), across.lower(along));
                const Passing upwards(edge, t.z);
                eight_z.extend(upwards.upper(along), upwards.lower(along));
                if (crosses) {
                    const Lanes beyond = across.first_ray_beyond(edge.to_planes(rays), ray);
                    eight_ends.extend(beyond, beyond);
                }
            }
            x.set(base, eight_x);
            z.set(base, eight_z);
            ends.set(base, eight_ends);
        }
        x.join(count);
        z.join(count);
        for (int i = 0; i < 3; ++i) {
            x.extend(y0, count, t.y[i], t.x[i]);
            z.extend(y0, count, t.y[i], t.z[i]);
        }
        const Lanes bottom = all(t.bottom), one = all(1);
        for (int base = 0; base < count; base += kLanes) {
            const EightExtents eight_x = x.at(base), eight_ends = ends.at(base);
            const Lanes first = larger(eight_x.lo, all(x0)), last = smaller(eight_x.hi, all(x1));
            store_as_int(from + base, first);
            store_as_int(to + base, last);
            store_as_int(crossed_from + base, larger(eight_ends.lo, first));
            store_as_int(crossed_to + base, smaller(eight_ends.hi - one, last));
            const EightExtents eight_z = z.at(base);
            z.set(base, {eight_z.lo + bottom, smaller(eight_z.hi + bottom, all(top))});
        }
    }
};

// Where the columns from x0 on are along z.
inline void find_columns(const Corners& t, int x0, int count, Extents& z) {
    const Edge edges[3] = {{t.x, 0}, {t.x, 1}, {t.x, 2}};
    for (int base = 0; base <= count; base += kLanes) {
        const Lanes planes = ramp((x0 + base) * kVoxel, kVoxel);
        EightExtents eight;
        for (const Edge& edge : edges) {
            const Lanes along = edge.to_planes(planes);
            const Passing upwards(edge, t.z);
            eight.extend(upwards.upper(along), upwards.lower(along));
        }
        z.set(base, eight);
    }
    z.join(count);
    for (int i = 0; i < 3; ++i)
        z.extend(x0, count, t.x[i], t.z[i]);
    const Lanes bottom = all(t.bottom);
    for (int base = 0; base < count; base += kLanes) {
        const EightExtents eight = z.at(base);
        z.set(base, {eight.lo + bottom, eight.hi + bottom});
    }
}

// Bits first ... last, which are 0 ... 63 or none.
inline uint64_t bits_between(int first, int last) {
    return first > last ? 0 : ~uint64_t{0} << first & ~uint64_t{0} >> (63 - last);
}

// By mask: its bits, each as a whole byte.
constexpr auto kWholeBytes = [] {
    std::array<ColumnBytes, 256> bytes{};
    for (unsigned mask = 0; mask < 256; ++mask)
        for (int i = 0; i < 8; ++i)
            bytes[mask] |= static_cast<ColumnBytes>(mask >> i & 1 ? 0xFF : 0) << 8 * i;
    return bytes;
}();

// Whether a point is in the closed triangle, seen along z.
inline bool is_over(const Corners& t, double x, double y) {
    bool left = false, right = false;
    for (int a = 0; a < 3; ++a) {
        const int b = a == 2 ? 0 : a + 1;
        const double side = (t.x[b] - t.x[a]) * (y - t.y[a]) - (t.y[b] - t.y[a]) * (x - t.x[a]);
        left = left || side > 0;
        right = right || side < 0;
    }
    return !(left && right);
}

// A part of a window: columns x0 ... x1, rows y0 ... y1 and voxels up to `top`.
struct Area {
    int x0, x1, y0, y1, top;
};

template <class Wide, class Rest, bool centres>
inline void cover_area(const Corners& t, const Area& area, const Wanted& wanted, Pieces* pieces, TileSurface& surface) {
    const auto [x0, x1, y0, y1, top] = area;
    const int first_group = x0 / kLanes, first_column = first_group * kLanes;
    const Rows rows(t, y0, y1 - y0 + 1, x0, x1, top, wanted.crosses, centres ? kCentre : kSample);
    Extents columns;
    find_columns(t, first_column, x1 - first_column + 1, columns);
    PlaneRows<Wide, Rest> plane(t, first_column, y0);
    for (int y = y0; y <= y1; ++y, plane.end_row()) {
        const int row = y - y0, from = rows.from[row], to = rows.to[row];
        const double row_lo = rows.z.lo[row], row_hi = rows.z.hi[row];
        if (from > to || row_lo > row_hi)
            continue;
        const int highest = static_cast<int>(row_hi), first_brick = static_cast<int>(row_lo) >> kBrickBits,
                  last_brick = (highest + (centres && highest < top)) >> kBrickBits;
        const uint64_t covered = bits_between(from, to);
        const uint64_t crossed = bits_between(rows.crossed_from[row], rows.crossed_to[row]);
        const uint64_t before =
            centres && wanted.sheets != nullptr ? extend_row(*wanted.sheets, plane.enters(), y, covered, crossed) : 0;
        plane.begin_row();
        for (int group = first_group; group <= to / kLanes; ++group, plane.end_group()) {
            const ColumnBytes inside = kWholeBytes[covered >> group * kLanes & 0xFF];
            if (inside == 0)
                continue;
            const ColumnBytes crossing = kWholeBytes[crossed >> group * kLanes & 0xFF];
            EightExtents z = columns.at((group - first_group) * kLanes);
            z.lo = larger(z.lo, all(row_lo));
            z.hi = smaller(z.hi, all(row_hi));
            plane.narrow(z);
            z.lo = smaller(z.lo, all(kBeyond)); // all fit 32 bits
            alignas(32) int32_t lo[kLanes], hi[kLanes], above[kLanes];
            if constexpr (centres) {
                Mask on;
                Lanes heights;
                const Lanes below = smaller(larger(plane.centres(on, heights), all(-kBeyond)), all(kBeyond));
                if (wanted.sheets != nullptr) {
                    const int shift = group * kLanes;
                    extend_group(*wanted.sheets, plane.enters(), y * kTileSide + shift, covered >> shift,
                                 before >> shift, crossed >> shift, floats(heights), plane.slope_x() / 2,
                                 plane.slope_y() / 2);
                }
                store_as_int(above, if_less(below, all(top), below + all(1), all(kBeyond)));
                uint64_t held = wanted.holds ? on & (covered >> group * kLanes) : 0;
                for (alignas(64) double voxels[kLanes]; held != 0; held &= held - 1) {
                    store(voxels, below);
                    const int lane = __builtin_ctzll(held), x = group * kLanes + lane;
                    if (voxels[lane] > top || !is_over(t, x * kVoxel + kCentre, y * kVoxel + kCentre))
                        continue;
                    if (wanted.sheets != nullptr)
                        surface.note_on_centre(x, y, static_cast<int>(voxels[lane]));
                    else
                        surface.hold_in_tile(x, y, static_cast<int>(voxels[lane]));
                }
            }
            store_as_int(lo, z.lo);
            store_as_int(hi, larger(z.hi, z.lo - all(1)));
            if (pieces != nullptr) {
                alignas(64) double above_corners[kLanes];
                store(above_corners, plane.above_corners(z.lo));
                const uint64_t columns = covered >> group * kLanes & 0xFF & ~uint64_t{less(z.hi, z.lo)};
                pieces->add_columns(columns, group, y, lo, hi, above_corners);
            }
            for (int brick = first_brick; brick <= last_brick; brick += IntervalBytes::kBricks) {
                const IntervalBytes bytes(lo, hi, centres ? above : lo, brick * kBrickSide);
                for (int i = 0; i < IntervalBytes::kBricks && brick + i <= last_brick; ++i) {
                    const ColumnBytes marked = bytes.marked[i] & crossing;
                    if ((bytes.inside[i] & inside) != 0)
                        surface.add_row(group, y, brick + i, bytes.inside[i] & inside, marked, plane.enters());
                    else if (marked != 0)
                        surface.cross_row(group, y, brick + i, marked, plane.enters());
                }
            }
        }
    }
}

// Whether rays upwards enter the solid.
inline bool is_wound_clockwise(const Corners& t) {
    return (t.x[1] - t.x[0]) * (t.y[2] - t.y[0]) < (t.y[1] - t.y[0]) * (t.x[2] - t.x[0]);
}

// A triangle in a window, and which part of the window may hold it.
struct Placed {
    Corners corners;
    Area area;
    bool is_outside, is_narrow;

    Placed(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w) {
        auto least = [](int32_t u, int32_t v, int32_t s) { return u < v ? (u < s ? u : s) : (v < s ? v : s); };
        auto most = [](int32_t u, int32_t v, int32_t s) { return u > v ? (u > s ? u : s) : (v > s ? v : s); };
        const int left = voxel_floor(least(a.x, b.x, c.x)) - w.x0, front = voxel_floor(least(a.y, b.y, c.y)) - w.y0;
        const int right = voxel_below(most(a.x, b.x, c.x)) - w.x0, back = voxel_below(most(a.y, b.y, c.y)) - w.y0;
        area = {left > 0 ? left : 0, right < w.x1 - w.x0 ? right : w.x1 - w.x0, front > 0 ? front : 0,
                back < w.y1 - w.y0 ? back : w.y1 - w.y0, w.top};
        Corners& t = corners;
        t.bottom = voxel_floor(least(a.z, b.z, c.z));
        is_outside = area.x0 > area.x1 || area.y0 > area.y1 || t.bottom > w.top;
        if (is_outside)
            return;
        const Vertex* vertices[3] = {&a, &b, &c};
        for (int i = 0; i < 3; ++i) {
            t.x[i] = static_cast<double>(vertices[i]->x - w.x0 * kUnit);
            t.y[i] = static_cast<double>(vertices[i]->y - w.y0 * kUnit);
            t.z[i] = static_cast<double>(vertices[i]->z - t.bottom * kUnit);
        }
        const auto width = [](const double (&p)[3]) {
            const double low = p[0] < p[1] ? (p[0] < p[2] ? p[0] : p[2]) : (p[1] < p[2] ? p[1] : p[2]);
            const double high = p[0] > p[1] ? (p[0] > p[2] ? p[0] : p[2]) : (p[1] > p[2] ? p[1] : p[2]);
            return high - low;
        };
        is_narrow = width(t.x) < kNarrowExtent && width(t.y) < kNarrowExtent && width(t.z) < kNarrowExtent;
    }
};

CutTriangle cut_triangle(const Placed& placed, const Vertex& a, const Vertex& b, const Vertex& c) {
    const double z[3] = {static_cast<double>(a.z), static_cast<double>(b.z), static_cast<double>(c.z)};
    return {placed.corners.x, placed.corners.y, z};
}

void cover_by_vectors(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, const Wanted& wanted,
                      TileSurface& surface) {
    const Placed placed(a, b, c, w);
    if (placed.is_outside)
        return;
    const auto cover = placed.is_narrow && wanted.centres ? cover_area<int64_t, Lanes, true>
                       : placed.is_narrow                 ? cover_area<int64_t, Lanes, false>
                       : wanted.centres                   ? cover_area<int128, LongLanes, true>
                                                          : cover_area<int128, LongLanes, false>;
    if (!wanted.pieces) {
        cover(placed.corners, placed.area, wanted, nullptr, surface);
        return;
    }
    const CutTriangle cut = cut_triangle(placed, a, b, c);
    Pieces pieces(cut, surface);
    cover(placed.corners, placed.area, wanted, &pieces, surface);
    pieces.finish();
}

template <bool halves>
void add_to_sheet(const Vertex& a, const Vertex& b, const Vertex& c, const Window& w, ColumnSheets& sheets,
                  TileSurface& surface) {
    const Placed placed(a, b, c, w);
    if (placed.is_outside)
        return;
    const auto [x0, x1, y0, y1, top] = placed.area;
    const bool sheet = is_wound_clockwise(placed.corners);
    const ColumnSheets::Rows& columns = halves ? sheets.halved[sheet] : sheets.doubtful;
    const CoveredColumns covered(placed.corners.x, placed.corners.y, sheet);
    uint64_t wanted[kTileSide], any = 0;
    for (int y = y0; y <= y1; ++y) {
        wanted[y] = 0;
        for (uint64_t left = columns[static_cast<size_t>(y)] & bits_between(x0, x1); left != 0; left &= left - 1) {
            const int x = __builtin_ctzll(left);
            wanted[y] |= static_cast<uint64_t>(covered.has(x, y)) << x;
        }
        any |= wanted[y];
    }
    if (any == 0)
        return;
    const CutTriangle cut = cut_triangle(placed, a, b, c);
    const auto add_all = [&](auto&& pieces) {
        for (int y = y0; y <= y1; ++y)
            for (uint64_t left = wanted[y]; left != 0; left &= left - 1)
                pieces.add_column(__builtin_ctzll(left), y);
        pieces.finish();
    };
    if constexpr (halves)
        add_all(HalvedVoxels(cut, sheets, sheet));
    else
        add_all(Pieces(cut, surface));
}

} // namespace

const CoverageEngine VOXRT_COVERAGE{VOXRT_INSTRUCTIONS, cover_by_vectors, find_doubts, add_to_sheet<true>,
                                    add_to_sheet<false>};

} // namespace voxrt::voxelize
