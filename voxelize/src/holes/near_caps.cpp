#include "near_caps.h"

#include "../work/interrupt.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxrt::voxelize {
namespace {

constexpr double kInverse4Pi = 1 / (4 * std::numbers::pi);
constexpr double kDoubt = 1e-6; // of the product of distances: where rounding may tell the wrong side of a cap
constexpr double kLineSum = std::numbers::pi / 2; // of 1 / d^4 along a line, times its distance^3
constexpr double kUnderflow = 1e-250;             // of a product that has lost digits
constexpr int kCapsPerScaling = 6;                // products of so many tangents stay in the range of float64

Point minus(const Point& a, const Point& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The distance of the origin from the edge a … b.
double distance_from(const Point& a, const Point& edge, double square) {
    const double along = std::clamp(-dot(a, edge) / square, 0.0, 1.0);
    const Point p{a.x + along * edge.x, a.y + along * edge.y, a.z + along * edge.z};
    return std::sqrt(dot(p, p));
}

/// Points relative to the centre, and for each the product of all tangents of half angles, as a complex number.
struct Points {
    double x[NearCaps::kBatch], y[NearCaps::kBatch], z[NearCaps::kBatch];
    double re[NearCaps::kBatch], im[NearCaps::kBatch];
    double wraps[NearCaps::kBatch]; // full turns that the product has lost
    double doubt[NearCaps::kBatch]; // caps for which rounding may tell the wrong side
};

/// Van Oosterom and Strackee, "The Solid Angle of a Plane Triangle", 1983: the tangent of half the angle is over /
/// under. `distances`: room for kLanes per vertex.
template <int kLanes>
inline __attribute__((always_inline)) void sum_tangents(const std::vector<NearCaps::Cap>& caps,
                                                        const std::vector<Point>& vertices,
                                                        double* __restrict__ distances, Points& points) {
    double px[kLanes], py[kLanes], pz[kLanes], re[kLanes], im[kLanes], wraps[kLanes], doubt[kLanes];
    for (int i = 0; i < kLanes; ++i) {
        px[i] = points.x[i];
        py[i] = points.y[i];
        pz[i] = points.z[i];
        re[i] = 1;
        im[i] = wraps[i] = doubt[i] = 0;
    }
    for (size_t v = 0; v < vertices.size(); ++v) {
        const Point a = vertices[v];
        for (int i = 0; i < kLanes; ++i) {
            const double x = a.x - px[i], y = a.y - py[i], z = a.z - pz[i];
            distances[v * kLanes + i] = std::sqrt(x * x + y * y + z * z);
        }
    }
    int unscaled = 0;
    for (const NearCaps::Cap& cap : caps) {
        const double* a = distances + size_t{cap.corners[0]} * kLanes;
        const double* b = distances + size_t{cap.corners[1]} * kLanes;
        const double* c = distances + size_t{cap.corners[2]} * kLanes;
        const double nx = cap.normal.x, ny = cap.normal.y, nz = cap.normal.z, height = cap.height;
        const double ab = cap.sides[0], bc = cap.sides[1], ca = cap.sides[2];
        for (int i = 0; i < kLanes; ++i) {
            const double la = a[i], lb = b[i], lc = c[i];
            const double aa = la * la, bb = lb * lb, cc = lc * lc, size = la * lb * lc;
            const double over = height - nx * px[i] - ny * py[i] - nz * pz[i];
            const double under = size + 0.5 * ((aa + bb - ab) * lc + (bb + cc - bc) * la + (cc + aa - ca) * lb);
            const double limit = kDoubt * size;
            doubt[i] += std::max(under, std::abs(over)) <= limit ? 1.0 : 0.0;
            const double x = re[i] * under - im[i] * over, y = re[i] * over + im[i] * under;
            // Beyond pi the sign of y is opposite to that of both angles.
            const double before = std::copysign(1.0, im[i]), added = std::copysign(0.25, over);
            wraps[i] += (0.25 * before + added) * (1 - before * std::copysign(1.0, y));
            re[i] = x;
            im[i] = y;
        }
        if (++unscaled == kCapsPerScaling) {
            unscaled = 0;
            for (int i = 0; i < kLanes; ++i) {
                const double scale = 1 / (std::abs(re[i]) + std::abs(im[i]));
                re[i] *= scale;
                im[i] *= scale;
            }
        }
    }
    for (int i = 0; i < kLanes; ++i) {
        points.re[i] = re[i];
        points.im[i] = im[i];
        points.wraps[i] = wraps[i];
        points.doubt[i] = doubt[i];
    }
}

constexpr int kFew = 4;

// Wider vectors where the processor has them. They round alike, since products and sums are not fused.
// Sanitizers cannot resolve such functions before they start.
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__) &&                           \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define VOXRT_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define VOXRT_WIDE
#endif
VOXRT_WIDE void sum_batch(const std::vector<NearCaps::Cap>& caps, const std::vector<Point>& vertices, double* distances,
                          Points& points) {
    sum_tangents<NearCaps::kBatch>(caps, vertices, distances, points);
}
VOXRT_WIDE void sum_few(const std::vector<NearCaps::Cap>& caps, const std::vector<Point>& vertices, double* distances,
                        Points& points) {
    sum_tangents<kFew>(caps, vertices, distances, points);
}
#undef VOXRT_WIDE

} // namespace

uint32_t NearCaps::local_vertex(const CapWinding& caps, uint32_t vertex) {
    Mark& mark = vertex_marks_[vertex];
    if (mark.gathering != gathering_) {
        mark = {gathering_, uint32_t(vertices_.size())};
        vertices_.push_back(minus(caps.vertex(vertex), seen_.centre));
    }
    return mark.local;
}

bool NearCaps::gather(const CapWinding& caps, const CapWinding::Seen& outer, const Point& centre, double radius,
                      double far_error, size_t most) {
    caps_.clear();
    edges_.clear();
    vertices_.clear();
    vertex_marks_.resize(std::max(vertex_marks_.size(), caps.vertex_count()));
    cap_marks_.resize(std::max(cap_marks_.size(), caps.count()));
    if (++gathering_ == 0) {
        std::fill(vertex_marks_.begin(), vertex_marks_.end(), Mark{});
        std::fill(cap_marks_.begin(), cap_marks_.end(), 0);
        gathering_ = 1;
    }
    if (!caps.split(outer, centre, radius, far_error, 0, most, seen_))
        return false;
    for (const uint32_t node : seen_.near)
        cap_marks_[caps.cap_of(node)] = gathering_;
    for (const uint32_t node : seen_.near) {
        const uint32_t number = caps.cap_of(node);
        Cap cap;
        for (int i = 0; i < 3; ++i)
            cap.corners[i] = local_vertex(caps, caps.corner(number, i));
        const Point &a = vertices_[cap.corners[0]], &b = vertices_[cap.corners[1]], &c = vertices_[cap.corners[2]];
        const Point ab = minus(b, a), bc = minus(c, b), ca = minus(a, c);
        cap.normal = cross(ab, minus(c, a));
        cap.height = dot(cap.normal, a);
        cap.sides[0] = dot(ab, ab);
        cap.sides[1] = dot(bc, bc);
        cap.sides[2] = dot(ca, ca);
        caps_.push_back(cap);
        for (int i = 0; i < 3; ++i) {
            const uint32_t across = caps.across(number, i);
            if (cap.sides[i] > 0 && (across == CapWinding::kNoCap || cap_marks_[across] != gathering_))
                edges_.push_back({cap.corners[i], cap.corners[i == 2 ? 0 : i + 1], std::sqrt(cap.sides[i])});
        }
    }
    distances_.resize(std::max(distances_.size(), vertices_.size() * kBatch));
    count_work(8 * uint32_t(caps_.size()));
    return true;
}

void NearCaps::find_angles(Batch& batch) {
    // Beyond the last point the batch repeats it: all loops have one of two lengths.
    const bool few = batch.count <= kFew;
    const int lanes = few ? kFew : kBatch;
    Points points;
    for (int i = 0; i < lanes; ++i) {
        const int j = std::min(i, batch.count - 1);
        points.x[i] = batch.x[j] - seen_.centre.x;
        points.y[i] = batch.y[j] - seen_.centre.y;
        points.z[i] = batch.z[j] - seen_.centre.z;
    }
    (few ? sum_few : sum_batch)(caps_, vertices_, distances_.data(), points);
    for (int i = 0; i < batch.count; ++i) {
        const double half = std::atan2(points.im[i], points.re[i]) + 2 * std::numbers::pi * points.wraps[i];
        batch.angle[i] = 2 * kInverse4Pi * half + seen_.far.angle + seen_.far.gradient.x * points.x[i] +
                         seen_.far.gradient.y * points.y[i] + seen_.far.gradient.z * points.z[i];
        batch.doubtful[i] = points.doubt[i] > 0 || !std::isfinite(half) ||
                            !(std::abs(points.re[i]) + std::abs(points.im[i]) > kUnderflow);
    }
    count_work(uint32_t(2 + caps_.size() * (few ? 2 : 6)));
}

double NearCaps::find_angle(const Point& point, bool& doubtful) {
    Batch batch;
    batch.add(point);
    find_angles(batch);
    doubtful = batch.doubtful[0];
    return batch.angle[0];
}

NearCaps::Change NearCaps::find_change(const Point& centre, double radius, double limit) const {
    Change found;
    found.gradient = seen_.far.gradient;
    const Point q = minus(centre, seen_.centre);
    count_work(uint32_t(edges_.size() * 3 + caps_.size()));
    for (const Edge& edge : edges_) {
        // The field of a short wire is direction x d / d^3. It is a derivative of 1 / d, so that its second derivatives
        // are at most 6 / d^4 in any directions. Summed along the edge or, where that is less, along the whole line.
        const Point a = minus(vertices_[edge.from], q), ab = minus(vertices_[edge.to], vertices_[edge.from]);
        const double gap = distance_from(a, ab, edge.length * edge.length) - radius, part = radius / gap;
        if (gap > 0)
            found.error_bound += kInverse4Pi * part * part * part * std::min(edge.length / gap, kLineSum);
        if (gap <= 0 || found.error_bound > limit) {
            found.error_bound = std::numeric_limits<double>::infinity();
            return found;
        }
    }
    for (const Edge& edge : edges_) {
        const Point a = minus(vertices_[edge.from], q), b = minus(vertices_[edge.to], q);
        // The field of the edge: scale * along. Its derivatives: of the scale, then of the direction.
        const double la = std::sqrt(dot(a, a)), lb = std::sqrt(dot(b, b)), product = la * lb;
        const double turned = product + dot(a, b), scale = kInverse4Pi * (la + lb) / (product * turned);
        const Point along = cross(a, b);
        const double of_a = (1 / la + lb / turned - 1 / (la + lb)) / la + 1 / turned;
        const double of_b = (1 / lb + la / turned - 1 / (la + lb)) / lb + 1 / turned;
        const Point change{of_a * a.x + of_b * b.x, of_a * a.y + of_b * b.y, of_a * a.z + of_b * b.z};
        found.gradient.x += scale * along.x;
        found.gradient.y += scale * along.y;
        found.gradient.z += scale * along.z;
        // Only the symmetric part matters, and a cross product has none.
        found.second[0] += scale * along.x * change.x;
        found.second[1] += scale * along.y * change.y;
        found.second[2] += scale * along.z * change.z;
        found.second[3] += scale * (along.x * change.y + along.y * change.x) / 2;
        found.second[4] += scale * (along.y * change.z + along.z * change.y) / 2;
        found.second[5] += scale * (along.z * change.x + along.x * change.z) / 2;
    }
    for (const Cap& cap : caps_) {
        const double height = cap.height - dot(cap.normal, q);
        if (height * height > radius * radius * dot(cap.normal, cap.normal))
            continue;
        // Outside one edge by more than the radius, in the plane.
        bool outside = false;
        for (int i = 0; i < 3 && !outside; ++i) {
            const Point& a = vertices_[cap.corners[i]];
            const Point ab = minus(vertices_[cap.corners[i == 2 ? 0 : i + 1]], a), beside = cross(ab, cap.normal);
            const double off = dot(beside, minus(q, a));
            outside = off > 0 && off * off > radius * radius * dot(beside, beside);
        }
        if (!outside) {
            found.crossed = true;
            break;
        }
    }
    return found;
}

} // namespace voxrt::voxelize
