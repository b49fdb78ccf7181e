#include "turned_pieces.h"

#include "closure.h"
#include "triangle_tree.h"
#include "vertex_groups.h"

#include <bit>

namespace voxrt {
namespace {

constexpr uint32_t kNoPiece = 0xFFFF'FFFF, kNoVertex = 0xFFFF'FFFF;
constexpr size_t kFewPieces = 512; // each looked at beside each
constexpr size_t kRun = 16;        // triangles looked up at once

using Corners = std::array<uint32_t, 3>;

int sign_of(int128 v) { return v < 0 ? -1 : v > 0; }

/// Six times the volume of a tetrahedron: on which side of plane abc, seen against its normal, d lies.
int128 volume6_of(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d) {
    const int128 ax = int128(a.x) - d.x, ay = int128(a.y) - d.y, az = int128(a.z) - d.z;
    const int128 bx = int128(b.x) - d.x, by = int128(b.y) - d.y, bz = int128(b.z) - d.z;
    const int128 cx = int128(c.x) - d.x, cy = int128(c.y) - d.y, cz = int128(c.z) - d.z;
    return ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx);
}

/// Seen from above, on which side of uv q lies; a q on the line is moved by an infinitesimal along x, then y.
int side_of(const Vertex& u, const Vertex& v, const Vertex& q) {
    const int128 vx = int128(v.x) - u.x, vy = int128(v.y) - u.y;
    const int128 turn = vx * (int128(q.y) - u.y) - vy * (int128(q.x) - u.x);
    return turn != 0 ? sign_of(turn) : vy != 0 ? -sign_of(vy) : sign_of(vx);
}

/// Whether edge pq passes through triangle abc, its rim included, from one side of its plane to the other.
bool passes(const Vertex& p, const Vertex& q, const Vertex& a, const Vertex& b, const Vertex& c) {
    if (sign_of(volume6_of(a, b, c, p)) * sign_of(volume6_of(a, b, c, q)) >= 0)
        return false;
    const int u = sign_of(volume6_of(p, q, a, b)), v = sign_of(volume6_of(p, q, b, c)),
              w = sign_of(volume6_of(p, q, c, a));
    return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

/// Whether q, in the plane of triangle abc and in its box, lies on it.
bool holds(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& q) {
    for (const auto& [i, j] : {std::pair{&Vertex::x, &Vertex::y}, {&Vertex::y, &Vertex::z}, {&Vertex::z, &Vertex::x}}) {
        auto side = [&, i = i, j = j](const Vertex& u, const Vertex& v) {
            return sign_of((int128(v.*i) - u.*i) * (int128(q.*j) - u.*j) -
                           (int128(v.*j) - u.*j) * (int128(q.*i) - u.*i));
        };
        const int u = side(a, b), v = side(b, c), w = side(c, a);
        if (!((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)))
            return false;
    }
    return true;
}

struct Piece {
    std::vector<uint32_t> triangles, vertices;
    TriangleBox box;
    int128 volume6 = 0;
    bool capped = false;
    int turn = 1; // -1: taken the other way round
};

/// A surface and what closes it, cut into connected pieces.
class ClosedPieces {
public:
    ClosedPieces(const MeshView& mesh, const std::vector<Vertex>& vertices, const Boundary* boundary)
        : mesh_(mesh), vertices_(vertices), boundary_(boundary), groups_(vertices.size()) {
        size_t joins = 0;
        for (size_t t = 0; t < count(); ++t)
            if (counts(t)) {
                pulse(1);
                const Corners c = corners(t);
                joins += groups_.join(c[0], c[1]);
                joins += groups_.join(c[0], c[2]);
            }
        is_one_ = joins + 1 >= vertices.size();
    }

    /// One piece alone, vertices that no triangle uses apart.
    bool is_one() const { return is_one_; }

    void cut() {
        weld();
        std::vector<uint32_t> piece_at(vertices_.size(), kNoPiece), seen(vertices_.size(), kNoPiece);
        piece_of_.assign(count(), kNoPiece);
        for (size_t t = 0; t < count(); ++t) {
            if (!counts(t))
                continue;
            pulse(5);
            const Corners c = corners(t);
            uint32_t& piece = piece_at[groups_.of(c[0])];
            if (piece == kNoPiece) {
                piece = uint32_t(pieces_.size());
                pieces_.emplace_back();
            }
            piece_of_[t] = piece;
            Piece& own = pieces_[piece];
            own.capped = own.capped || t >= mesh_.triangle_count();
            for (const uint32_t v : c) {
                own.box.add(vertices_[v]);
                if (seen[v] == kNoPiece)
                    own.vertices.push_back(v);
                seen[v] = piece;
            }
            own.triangles.push_back(uint32_t(t));
            own.volume6 += volume6_of(vertices_[c[0]], vertices_[c[1]], vertices_[c[2]], vertices_[own.vertices[0]]);
        }
    }

    /// Whether some piece faces inwards and may be turned, while others face outwards.
    bool are_mixed() const {
        bool in = false, out = false;
        for (const Piece& piece : pieces_) {
            if (piece.capped && piece.volume6 < 0)
                return false;
            in = in || piece.volume6 < 0;
            out = out || piece.volume6 > 0 || piece.capped;
        }
        return in && out;
    }

    void settle() {
        std::vector<std::pair<TriangleBox, uint32_t>> boxes;
        for (uint32_t i = 0; i < pieces_.size(); ++i)
            if (may_be_around(i))
                for (const uint32_t t : pieces_[i].triangles)
                    boxes.push_back({box_of(t), t});
        const TriangleTree tree(std::move(boxes));
        std::vector<uint32_t> order(pieces_.size());
        for (uint32_t i = 0; i < order.size(); ++i)
            order[i] = i;
        // What lies around a piece comes before it.
        std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
            const Piece &p = pieces_[a], &q = pieces_[b];
            if (p.box.size() != q.box.size())
                return p.box.size() > q.box.size();
            const int128 u = p.volume6 < 0 ? -p.volume6 : p.volume6, v = q.volume6 < 0 ? -q.volume6 : q.volume6;
            return u != v ? u > v : a < b;
        });
        rank_.resize(pieces_.size());
        for (uint32_t i = 0; i < order.size(); ++i)
            rank_[order[i]] = i;
        for (const uint32_t index : order) {
            Piece& piece = pieces_[index];
            if (piece.capped)
                continue;
            int number = 0;
            uint32_t nearest = kNoPiece;
            for (const Around& around : find_around(index, tree)) {
                number += around.winding * pieces_[around.piece].turn;
                if (nearest == kNoPiece || rank_[around.piece] > rank_[nearest])
                    nearest = around.piece;
            }
            piece.turn = number != 0 ? pieces_[nearest].turn : piece.volume6 < 0 ? -1 : 1;
        }
    }

    std::shared_ptr<const TurnedPieces> turned() const {
        auto found = std::make_shared<TurnedPieces>();
        for (const Piece& piece : pieces_)
            found->count += piece.turn < 0;
        if (found->count == 0 || found->count == pieces_.size())
            return nullptr;
        found->triangles.resize(mesh_.triangle_count());
        for (size_t t = 0; t < mesh_.triangle_count(); ++t)
            found->triangles[t] = counts(t) && pieces_[piece_of_[t]].turn < 0;
        return found;
    }

private:
    /// A piece that lies around another: its winding number there, as it faces by itself.
    struct Around {
        uint32_t piece;
        int winding;
        bool touched; // then not around
    };

    size_t count() const { return mesh_.triangle_count() + (boundary_ != nullptr ? boundary_->caps.size() : 0); }
    bool counts(size_t t) const {
        return t >= mesh_.triangle_count() || boundary_ == nullptr || boundary_->shell_only.empty() ||
               boundary_->shell_only[t] == 0;
    }
    Corners corners(size_t t) const {
        if (t >= mesh_.triangle_count())
            return boundary_->caps[t - mesh_.triangle_count()];
        const int32_t* c = mesh_.triangles.data() + 3 * t;
        return {uint32_t(c[0]), uint32_t(c[1]), uint32_t(c[2])};
    }
    /// False where no other piece's box is in its own.
    bool may_be_around(uint32_t own) const {
        if (pieces_.size() > kFewPieces)
            return true;
        for (uint32_t i = 0; i < pieces_.size(); ++i)
            if (i != own && pieces_[own].box.holds(pieces_[i].box))
                return true;
        return false;
    }
    TriangleBox box_of(uint32_t t) const {
        TriangleBox box;
        for (const uint32_t v : corners(t))
            box.add(vertices_[v]);
        return box;
    }

    /// Joins vertices at one place, where their indices do not close by themselves.
    void weld() {
        std::vector<uint64_t> sums(vertices_.size(), 0);
        for (size_t t = 0; t < mesh_.triangle_count(); ++t) {
            pulse(5);
            const auto [a, b, c] = corners(t);
            sums[groups_.of(a)] +=
                boundary_key(vertex_key(vertices_[a]), vertex_key(vertices_[b]), vertex_key(vertices_[c]));
        }
        std::vector<uint32_t> loose;
        for (uint32_t v = 0; v < vertices_.size(); ++v)
            if (sums[groups_.of(v)] != 0)
                loose.push_back(v);
        std::vector<uint32_t> first(std::bit_ceil(2 * loose.size() + 1), kNoVertex); // by hash, then the next place
        for (const uint32_t v : loose) {
            pulse(5);
            size_t place = vertex_key(vertices_[v]) & (first.size() - 1);
            while (first[place] != kNoVertex && !(vertices_[first[place]] == vertices_[v]))
                place = (place + 1) & (first.size() - 1);
            if (first[place] == kNoVertex)
                first[place] = v;
            else
                groups_.join(first[place], v);
        }
    }

    /// The pieces' winding numbers about a vertex, by the triangles above it.
    std::vector<Around> look_up(uint32_t own, uint32_t vertex, const TriangleTree& tree) const {
        const Vertex& q = vertices_[vertex];
        std::vector<Around> found;
        auto at = [&](uint32_t piece) -> Around& {
            for (Around& around : found)
                if (around.piece == piece)
                    return around;
            return found.emplace_back(Around{piece, 0, false});
        };
        const TriangleBox above{{q.x, q.y, q.z}, {q.x, q.y, INT32_MAX}};
        tree.find(above, [&](uint32_t t) {
            const uint32_t piece = piece_of_[t];
            if (piece == kNoPiece || rank_[piece] >= rank_[own])
                return;
            const Corners corner = corners(t);
            const Vertex &a = vertices_[corner[0]], &b = vertices_[corner[1]], &c = vertices_[corner[2]];
            const int height = sign_of(volume6_of(a, b, c, q));
            if (height == 0) {
                if (std::min({a.z, b.z, c.z}) <= q.z && holds(a, b, c, q))
                    at(piece).touched = true;
                return;
            }
            const int turn = side_of(a, b, q);
            if (turn != 0 && side_of(b, c, q) == turn && side_of(c, a, q) == turn && height == turn)
                at(piece).winding += turn;
        });
        std::erase_if(found, [](const Around& around) { return around.touched || around.winding == 0; });
        return found;
    }

    std::vector<Around> find_around(uint32_t own, const TriangleTree& tree) const {
        const Piece& piece = pieces_[own];
        std::vector<Around> around = look_up(own, piece.vertices[0], tree);
        // What is near none of a triangle is around all of it, or none of it.
        std::vector<uint32_t> near;
        for (size_t from = 0; from < piece.triangles.size() && !around.empty(); from += kRun) {
            const size_t to = std::min(from + kRun, piece.triangles.size());
            TriangleBox box;
            for (size_t i = from; i < to; ++i)
                box.add(box_of(piece.triangles[i]));
            near.clear();
            tree.find(box, [&](uint32_t t) {
                if (std::any_of(around.begin(), around.end(),
                                [&](const Around& one) { return one.piece == piece_of_[t]; }))
                    near.push_back(t);
            });
            for (size_t i = from; i < to && !near.empty(); ++i)
                keep_around(own, corners(piece.triangles[i]), near, tree, around);
        }
        return around;
    }

    /// Keeps what is around a triangle as well.
    void keep_around(uint32_t own, const Corners& c, const std::vector<uint32_t>& near, const TriangleTree& tree,
                     std::vector<Around>& around) const {
        for (const uint32_t v : c) {
            const std::vector<Around> here = look_up(own, v, tree);
            std::erase_if(around, [&](const Around& one) {
                return std::none_of(here.begin(), here.end(), [&](const Around& other) {
                    return other.piece == one.piece && other.winding == one.winding;
                });
            });
        }
        TriangleBox box;
        for (const uint32_t v : c)
            box.add(vertices_[v]);
        for (const uint32_t t : near)
            if (box.meets(box_of(t)))
                std::erase_if(around,
                              [&](const Around& one) { return one.piece == piece_of_[t] && cross(c, corners(t)); });
    }

    bool cross(const Corners& c, const Corners& d) const {
        auto at = [this](uint32_t v) -> const Vertex& { return vertices_[v]; };
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            if (passes(at(c[i]), at(c[j]), at(d[0]), at(d[1]), at(d[2])) ||
                passes(at(d[i]), at(d[j]), at(c[0]), at(c[1]), at(c[2])))
                return true;
        }
        return false;
    }

    const MeshView& mesh_;
    const std::vector<Vertex>& vertices_;
    const Boundary* boundary_;
    VertexGroups groups_;
    bool is_one_;
    std::vector<uint32_t> piece_of_; // by triangle
    std::vector<Piece> pieces_;      // by first triangle
    std::vector<uint32_t> rank_;     // by piece: larger ones first
};

} // namespace

std::shared_ptr<const TurnedPieces> find_turned_pieces(const MeshView& mesh, const std::vector<Vertex>& vertices,
                                                       const Boundary* boundary) {
    ClosedPieces pieces(mesh, vertices, boundary);
    if (pieces.is_one())
        return nullptr;
    pieces.cut();
    if (!pieces.are_mixed())
        return nullptr;
    pieces.settle();
    return pieces.turned();
}

} // namespace voxrt
