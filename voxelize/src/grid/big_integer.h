// Integers of any size, for the few decisions that floating point leaves open.
#pragma once

#include "fixed_point.h"

#include <algorithm>
#include <vector>

namespace voxrt::voxelize {

class BigInteger {
public:
    BigInteger(int128 value = 0) : negative_(value < 0) {
        auto rest = static_cast<unsigned __int128>(value);
        for (rest = negative_ ? -rest : rest; rest != 0; rest >>= 64)
            limbs_.push_back(static_cast<uint64_t>(rest));
    }

    /// -1, 0 or 1.
    int sign() const { return limbs_.empty() ? 0 : negative_ ? -1 : 1; }

    BigInteger operator-() const {
        BigInteger turned = *this;
        turned.negative_ = !negative_ && !limbs_.empty();
        return turned;
    }
    friend BigInteger operator+(const BigInteger& a, const BigInteger& b) {
        if (a.negative_ == b.negative_)
            return {sum(a.limbs_, b.limbs_), a.negative_};
        return is_less(a.limbs_, b.limbs_) ? BigInteger(difference(b.limbs_, a.limbs_), b.negative_)
                                           : BigInteger(difference(a.limbs_, b.limbs_), a.negative_);
    }
    friend BigInteger operator-(const BigInteger& a, const BigInteger& b) { return a + -b; }
    friend BigInteger operator*(const BigInteger& a, const BigInteger& b) {
        std::vector<uint64_t> product(a.limbs_.size() + b.limbs_.size(), 0);
        for (size_t i = 0; i < a.limbs_.size(); ++i) {
            uint64_t carry = 0;
            for (size_t j = 0; j < b.limbs_.size(); ++j) {
                const unsigned __int128 part =
                    static_cast<unsigned __int128>(a.limbs_[i]) * b.limbs_[j] + product[i + j] + carry;
                product[i + j] = static_cast<uint64_t>(part);
                carry = static_cast<uint64_t>(part >> 64);
            }
            product[i + b.limbs_.size()] = carry;
        }
        return {std::move(product), a.negative_ != b.negative_};
    }
    friend bool operator==(const BigInteger&, const BigInteger&) = default;

private:
    using Limbs = std::vector<uint64_t>; // least significant first, the last is not 0

    BigInteger(Limbs limbs, bool negative) : limbs_(std::move(limbs)) {
        while (!limbs_.empty() && limbs_.back() == 0)
            limbs_.pop_back();
        negative_ = negative && !limbs_.empty();
    }

    static bool is_less(const Limbs& a, const Limbs& b) {
        if (a.size() != b.size())
            return a.size() < b.size();
        return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
    }
    static Limbs sum(const Limbs& a, const Limbs& b) {
        const Limbs &more = a.size() < b.size() ? b : a, &less = a.size() < b.size() ? a : b;
        Limbs found = more;
        uint64_t carry = 0;
        for (size_t i = 0; i < found.size() && (carry != 0 || i < less.size()); ++i) {
            const unsigned __int128 part =
                static_cast<unsigned __int128>(found[i]) + (i < less.size() ? less[i] : 0) + carry;
            found[i] = static_cast<uint64_t>(part);
            carry = static_cast<uint64_t>(part >> 64);
        }
        if (carry != 0)
            found.push_back(carry);
        return found;
    }
    static Limbs difference(const Limbs& more, const Limbs& less) {
        Limbs found = more;
        uint64_t borrow = 0;
        for (size_t i = 0; i < found.size() && (borrow != 0 || i < less.size()); ++i) {
            const unsigned __int128 taken = static_cast<unsigned __int128>(i < less.size() ? less[i] : 0) + borrow;
            borrow = found[i] < taken;
            found[i] -= static_cast<uint64_t>(taken);
        }
        return found;
    }

    Limbs limbs_;
    bool negative_ = false;
};

} // namespace voxrt::voxelize
