#include "ellipsoid.h"

namespace voxrt::voxelize {

Ellipsoid::Ellipsoid(const double* frame) {
    int64_t map[3][3];
    for (int i = 0; i < 3; ++i) {
        centre_[i] = int64_t(std::nearbyint(frame[4 * i + 3]));
        for (int k = 0; k < 3; ++k)
            map[i][k] = int64_t(std::nearbyint(frame[4 * i + k]));
    }
    auto find_adjugate = [this] {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
                adjugate_[j][i] = int128(square_[a][c]) * square_[b][d] - int128(square_[a][d]) * square_[b][c];
            }
        determinant_ = {};
        for (int j = 0; j < 3; ++j)
            determinant_.add(adjugate_[0][j], square_[0][j]);
    };
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            square_[i][j] = map[i][0] * map[j][0] + map[i][1] * map[j][1] + map[i][2] * map[j][2];
    find_adjugate();
    if (determinant_ <= WideInteger{}) { // never below 0
        for (int i = 0; i < 3; ++i)
            ++square_[i][i];
        find_adjugate();
    }
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            shape_[i][j] = double(square_[i][j]) / (double(kUnit) * double(kUnit));
    find_principal_axes();
    // The condition of S is at most trace^3 / D. float64 loses at most so many roundings of Q, and the root of that of
    // an interval's end, where the line hardly meets the ellipsoid.
    const double trace = double(square_[0][0]) + double(square_[1][1]) + double(square_[2][2]);
    const double determinant = std::ldexp(double(determinant_.high), 64) + double(determinant_.low);
    rounding_ = 256 * DBL_EPSILON * (trace / determinant * trace * trace);
    const double size = std::sqrt(trace) / kUnit;
    tolerance_ = kSlack + 4 * size * std::sqrt(rounding_);
    is_round_ = tolerance_ < 0.25 && rounding_ < 1e-3;
}

/// Jacobi's rotations: each clears one entry beside the diagonal. Any rotation gives right bounds, the principal axes
/// the tightest.
void Ellipsoid::find_principal_axes() {
    double s[3][3];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            s[i][j] = shape_[i][j];
            principal_[i][j] = i == j;
        }
    for (int sweep = 0; sweep < 24; ++sweep) {
        const int p = sweep % 3, q = (p + 1) % 3;
        if (s[p][q] == 0)
            continue;
        const double angle = 0.5 * std::atan2(2 * s[p][q], s[q][q] - s[p][p]);
        const double c = std::cos(angle), t = std::sin(angle);
        for (int k = 0; k < 3; ++k) { // S J
            const double a = s[k][p], b = s[k][q];
            s[k][p] = c * a - t * b;
            s[k][q] = t * a + c * b;
        }
        for (int k = 0; k < 3; ++k) { // J^T S, and the axes J^T
            const double a = s[p][k], b = s[q][k], m = principal_[p][k], n = principal_[q][k];
            s[p][k] = c * a - t * b;
            s[q][k] = t * a + c * b;
            principal_[p][k] = c * m - t * n;
            principal_[q][k] = t * m + c * n;
        }
    }
    for (int k = 0; k < 3; ++k) {
        const double* n = principal_[k];
        double square = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                square += n[i] * shape_[i][j] * n[j];
        reach_[k] = std::sqrt(std::max(square, 0.0) + 1e-14 * (shape_[0][0] + shape_[1][1] + shape_[2][2]));
    }
}

} // namespace voxrt::voxelize
