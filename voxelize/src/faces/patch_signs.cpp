#include "patch_signs.h"

#include <algorithm>
#include <cmath>

namespace voxrt::voxelize {
namespace {

constexpr size_t kLooked = 4; // faces of each patch that lines pass
constexpr double kPoints[3][3] = {{0.31, 0.34, 0.35}, {0.55, 0.29, 0.16}, {0.13, 0.23, 0.64}}; // of each, barycentric
constexpr size_t kMostPatches = 128;
constexpr double kNearly = 1e-3;
constexpr size_t kMostSteps = 1 << 24;
constexpr size_t kMostPasses = 1 << 27, kMostAtAll = 1 << 29; // of lines past faces
constexpr int kUnknown = 2;

constexpr int32_t Vertex::* kAxes[3] = {&Vertex::x, &Vertex::y, &Vertex::z};

double twice_area(const std::array<Vertex, 3>& c, int u, int v) {
    const auto at = [&](int corner, int axis) { return double(c[size_t(corner)].*kAxes[axis]); };
    return (at(1, u) - at(0, u)) * (at(2, v) - at(0, v)) - (at(1, v) - at(0, v)) * (at(2, u) - at(0, u));
}

double whole_area(const std::array<Vertex, 3>& c) {
    return std::hypot(twice_area(c, 1, 2), twice_area(c, 2, 0), twice_area(c, 0, 1));
}

/// Looks along lines from both sides.
class Looker {
public:
    Looker(uint32_t patches, const std::vector<PatchFace>& faces) : faces_(faces), seen_(patches, {0, 0}) {
        int32_t low = INT32_MAX, high = INT32_MIN;
        for (const PatchFace& face : faces)
            for (const Vertex& v : face.corners)
                for (const auto axis : kAxes) {
                    low = std::min(low, v.*axis);
                    high = std::max(high, v.*axis);
                }
        room_ = 4 + (double(high) - low) / (1 << 21);
        std::vector<std::vector<std::pair<double, uint32_t>>> largest(patches);
        for (uint32_t f = 0; f < faces.size(); ++f) {
            auto& own = largest[faces[f].patch];
            own.push_back({-whole_area(faces[f].corners), f});
            std::sort(own.begin(), own.end());
            own.resize(std::min(own.size(), kLooked));
        }
        const size_t most = std::max<size_t>(1, kMostPasses / (3 * patches * faces.size())); // points per patch
        for (const auto& own : largest) {
            size_t looked = 0;
            for (const auto& [area, f] : own)
                for (const auto& point : kPoints)
                    for (int axis = 0; axis < 3 && looked < 3 * most; ++axis, ++looked)
                        look(faces[f].corners, point, axis);
        }
    }

    /// How a patch counts as it is seen from outside.
    int sign_of(uint32_t patch) const {
        const auto [plus, minus] = seen_[patch];
        return (plus > 0) == (minus > 0) ? kUnknown : plus > 0 ? 1 : -1;
    }
    /// Whether it is seen from both sides.
    bool is_seen_from_both(uint32_t patch) const { return seen_[patch].first > 0 && seen_[patch].second > 0; }

private:
    struct Hit {
        double at, room;
        const PatchFace* face;
        int upwards; // 1 where the normal points along the axis
    };

    void look(const std::array<Vertex, 3>& through, const double* point, int axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto at_point = [&](int a) {
            double sum = 0;
            for (size_t i = 0; i < 3; ++i)
                sum += point[i] * (through[i].*kAxes[a]);
            return sum;
        };
        const double qu = at_point(u), qv = at_point(v);
        hits_.clear();
        count_work(uint32_t(faces_.size() / 8));
        for (const PatchFace& face : faces_) {
            const std::array<Vertex, 3>& c = face.corners;
            const auto [left, right] = std::minmax({c[0].*kAxes[u], c[1].*kAxes[u], c[2].*kAxes[u]});
            const auto [near, far] = std::minmax({c[0].*kAxes[v], c[1].*kAxes[v], c[2].*kAxes[v]});
            if (qu < left - room_ || qu > right + room_ || qv < near - room_ || qv > far + room_)
                continue;
            const double area = twice_area(c, u, v);
            double inside = 1e300, at = 0;
            for (size_t i = 0; i < 3; ++i) {
                const Vertex &p = c[(i + 1) % 3], &q = c[(i + 2) % 3];
                const double du = double(q.*kAxes[u]) - p.*kAxes[u], dv = double(q.*kAxes[v]) - p.*kAxes[v];
                const double part = du * (qv - p.*kAxes[v]) - dv * (qu - p.*kAxes[u]);
                inside = std::min(inside, (area < 0 ? -part : part) / std::max(std::hypot(du, dv), 1e-9));
                at += part * (c[i].*kAxes[axis]);
            }
            if (inside < -room_)
                continue;
            if (inside < room_)
                return; // past an edge
            hits_.push_back({at / area, room_ * (1 + whole_area(c) / std::abs(area)), &face, area > 0 ? 1 : -1});
        }
        std::sort(hits_.begin(), hits_.end(), [](const Hit& a, const Hit& b) { return a.at < b.at; });
        note_first(hits_.begin(), hits_.end(), 1);
        note_first(hits_.rbegin(), hits_.rend(), -1);
    }

    /// What a line meets first, on its way along the axis or against it, where nothing lies upon it.
    template <class At> void note_first(At first, At last, int way) {
        if (first == last)
            return;
        for (At other = first + 1; other != last && std::abs(other->at - first->at) < first->room + other->room;
             ++other)
            if (other->face->patch != first->face->patch)
                return;
        const int sign = -way * first->upwards * first->face->direction;
        ++(sign > 0 ? seen_[first->face->patch].first : seen_[first->face->patch].second);
    }

    const std::vector<PatchFace>& faces_;
    double room_;
    std::vector<std::pair<int, int>> seen_; // by patch: how often it was seen to count 1, and -1
    std::vector<Hit> hits_;
};

/// Completes signs so that all edges balance.
class Equations {
public:
    explicit Equations(std::vector<PatchBalance> edges) : edges_(std::move(edges)) {
        for (PatchBalance& edge : edges_)
            std::sort(edge.begin(), edge.end());
        std::sort(edges_.begin(), edges_.end());
        edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
    }

    bool complete(std::vector<int>& signs) {
        if (!follow(signs))
            return false;
        ++steps_;
        const auto unknown = std::find(signs.begin(), signs.end(), kUnknown);
        if (unknown == signs.end())
            return true;
        for (const int sign : {0, 1, -1}) {
            std::vector<int> tried = signs;
            tried[size_t(unknown - signs.begin())] = sign;
            if (complete(tried)) {
                signs = tried;
                return true;
            }
        }
        return false;
    }

private:
    /// Finds the signs that others leave no choice; returns whether they can balance.
    bool follow(std::vector<int>& signs) {
        for (bool found = true; found;) {
            found = false;
            steps_ += edges_.size();
            if (steps_ > kMostSteps)
                return false;
            for (const PatchBalance& edge : edges_) {
                int sum = 0, unknown = 0;
                std::pair<uint32_t, int> last{};
                for (const auto& [patch, times] : edge)
                    if (signs[patch] != kUnknown) {
                        sum += signs[patch] * times;
                    } else if (times != 0) {
                        ++unknown;
                        last = {patch, times};
                    }
                if (unknown == 0 && sum != 0)
                    return false;
                if (unknown != 1)
                    continue;
                if (sum % last.second != 0 || std::abs(sum / last.second) > 1)
                    return false;
                signs[last.first] = -sum / last.second;
                found = true;
            }
        }
        return true;
    }

    std::vector<PatchBalance> edges_;
    size_t steps_ = 0;
};

/// Whether faces nearly close: their areas, as vectors along their normals, add up to nothing.
bool nearly_close(const std::vector<PatchFace>& faces, uint32_t patch) {
    double sum[3] = {}, area = 0;
    for (const PatchFace& face : faces)
        if (face.patch == patch) {
            for (int axis = 0; axis < 3; ++axis)
                sum[axis] += face.direction * twice_area(face.corners, (axis + 1) % 3, (axis + 2) % 3);
            area += whole_area(face.corners);
        }
    return std::hypot(sum[0], sum[1], sum[2]) < kNearly * area;
}

} // namespace

void BodyPatches::add_edge(const std::vector<EdgeUse>& uses) {
    if (is_left_out_)
        return;
    PatchBalance edge;
    for (const EdgeUse& use : uses) {
        const auto face = std::lower_bound(faces_.begin(), faces_.end(), use.face,
                                           [](const PatchFace& f, uint32_t number) { return f.face < number; });
        const int times = use.is_upwards ? face->direction : -face->direction;
        const auto place =
            std::find_if(edge.begin(), edge.end(), [&](const auto& other) { return other.first == face->patch; });
        if (place != edge.end())
            place->second += times;
        else
            edge.push_back({face->patch, times});
    }
    edges_.push_back(std::move(edge));
}

PatchSigns BodyPatches::look() {
    if (is_left_out_)
        return {};
    std::vector<uint32_t> names;
    for (const PatchFace& face : faces_)
        names.push_back(face.patch);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    PatchSigns found;
    if (names.size() < 2 || names.size() > kMostPatches || 3 * names.size() * faces_.size() > kMostAtAll ||
        (is_said_ && names.size() * faces_.size() > kFewFaces))
        return found;
    const auto number = [&](uint32_t& patch) {
        patch = uint32_t(std::lower_bound(names.begin(), names.end(), patch) - names.begin());
    };
    for (PatchFace& face : faces_)
        number(face.patch);
    for (PatchBalance& edge : edges_)
        for (auto& [patch, times] : edge)
            number(patch);
    std::vector<bool> is_open(names.size(), false);
    for (const PatchBalance& edge : edges_)
        if (edge.size() == 1 && edge[0].second != 0)
            is_open[edge[0].first] = true;
    const Looker looker(uint32_t(names.size()), faces_);
    std::vector<int> signs(names.size());
    for (uint32_t patch = 0; patch < signs.size(); ++patch) {
        const int seen = looker.sign_of(patch);
        found.are_sure = found.are_sure && (is_open[patch] ? std::abs(seen) != 1 || !nearly_close(faces_, patch)
                                                           : !looker.is_seen_from_both(patch));
        signs[patch] = is_open[patch] ? 0 : seen;
    }
    bool as_seen = true, against = true;
    for (const PatchFace& face : faces_)
        if (const int sign = signs[face.patch] * face.direction; std::abs(sign) == 1) {
            as_seen = as_seen && face.counted * sign > 0;
            against = against && face.counted * sign < 0;
        }
    if (as_seen || against)
        return found;
    if (Equations(std::move(edges_)).complete(signs))
        for (const PatchFace& face : faces_)
            found.by_face.push_back({face.face, signs[face.patch] * face.direction});
    else
        found.are_sure = false;
    return found;
}

} // namespace voxrt::voxelize
