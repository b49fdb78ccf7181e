// A number as the sum of two float64, about 106 bits: what large triangles take to be cut exactly enough.
// Algorithms: Dekker 1971; Knuth, The Art of Computer Programming, volume 2, section 4.2.2.
#pragma once

#include <cmath>

namespace voxrt::voxelize {

class TwoDoubles {
public:
    TwoDoubles(double value = 0) : high_(value) {}

    explicit operator double() const { return high_ + low_; }

    friend TwoDoubles operator+(const TwoDoubles& a, const TwoDoubles& b) {
        const TwoDoubles sum = exact_sum(a.high_, b.high_);
        return exact_sum(sum.high_, sum.low_ + a.low_ + b.low_);
    }
    friend TwoDoubles operator-(const TwoDoubles& a, const TwoDoubles& b) { return a + TwoDoubles(-b.high_, -b.low_); }
    friend TwoDoubles operator*(const TwoDoubles& a, const TwoDoubles& b) {
        const double product = a.high_ * b.high_;
        const double error = std::fma(a.high_, b.high_, -product);
        return exact_sum(product, error + (a.high_ * b.low_ + a.low_ * b.high_));
    }
    friend TwoDoubles operator/(const TwoDoubles& a, const TwoDoubles& b) {
        const double first = a.high_ / b.high_;
        const TwoDoubles rest = a - b * TwoDoubles(first);
        const double second = rest.high_ / b.high_;
        const TwoDoubles last = rest - b * TwoDoubles(second);
        return exact_sum(first, second) + TwoDoubles(last.high_ / b.high_);
    }
    friend bool operator<(const TwoDoubles& a, const TwoDoubles& b) {
        return a.high_ < b.high_ || (a.high_ == b.high_ && a.low_ < b.low_);
    }

private:
    TwoDoubles(double high, double low) : high_(high), low_(low) {}

    static TwoDoubles exact_sum(double a, double b) {
        const double sum = a + b, part = sum - a;
        return {sum, (a - (sum - part)) + (b - part)};
    }

    double high_, low_ = 0;
};

} // namespace voxrt::voxelize
